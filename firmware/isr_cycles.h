// Run time of the steps of the control interrupt on the chip, in cycles of SYSCLKOUT: what the virtual chip lets pass.
//
// Estimates, no measurement of the compiler's code: operations counted over whole runs (420 32 x 32 bit products with
// rounding, 67 upper halves, 13 divisions, 133 saturations per period) at 13, 6, 250 and 8 cycles, shared out over the
// steps by their instructions. They make a compare value that is written too late be seen too late.

#ifndef STILLSPIN_FIRMWARE_ISR_CYCLES_H
#define STILLSPIN_FIRMWARE_ISR_CYCLES_H

#define CYCLES_READ_SAMPLES 1200u
#define CYCLES_READ_SLICES 400u  // no windows to evaluate
#define CYCLES_ESTIMATE 4500u
#define CYCLES_ESTIMATE_BLIND 900u  // without windows: the observers only predict
#define CYCLES_SUPERVISE 100u  // without the synchronism check, some 800 with three windows: see docs/architecture.md
#define CYCLES_CONTROL 500u
#define CYCLES_MODULATE 2200u
#define CYCLES_REFER 550u  // references of the hysteresis
#define CYCLES_WINDOW 60u
#define CYCLES_SLICE 120u

#endif
