// Run time of the steps of the control interrupt on the chip, in cycles of SYSCLKOUT: what the virtual chip lets pass.
//
// Estimates: instructions counted natively, times 1.3 for wait states and 32-bit arithmetic on a 16-bit data path. They
// make a compare value that is written too late be seen too late; they are no measurement of the compiler's code.

#ifndef STILLSPIN_FIRMWARE_ISR_CYCLES_H
#define STILLSPIN_FIRMWARE_ISR_CYCLES_H

#define CYCLES_READ_SAMPLES 700u
#define CYCLES_ESTIMATE 3000u
#define CYCLES_SUPERVISE 100u
#define CYCLES_CONTROL 400u
#define CYCLES_MODULATE 1600u
#define CYCLES_WINDOW 60u

#endif
