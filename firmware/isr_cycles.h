// Run time of the steps of the control interrupt on the chip, in cycles of SYSCLKOUT: what the virtual chip lets pass.
//
// Estimates, no measurement of the compiler's code: operations counted in every period of runs at 5, 80, 600 and 2000
// rpm with the default position source, and of each step its worst period of all. A 32 x 32 bit product with rounding
// counts 13 cycles, two of them with one rounding 20, one that is only added up 8, an upper half 6, a saturation 8, a
// reciprocal 70 and a 32 bit division 60, operands fetched; to the modulation come 1000 for placing and sorting edges.
// All worst steps in one period need three windows, the millisecond's tasks and a polarity that is not confirmed yet:
// 8800; the mean over a run is 6900. Not in it: position source 2 or a hold, which evaluate the windows twice, and what
// follows when the compare values are written, serial port and scope. They make a compare value that is written too
// late be seen too late.

#ifndef STILLSPIN_FIRMWARE_ISR_CYCLES_H
#define STILLSPIN_FIRMWARE_ISR_CYCLES_H

#define CYCLES_READ_SAMPLES 1150u
#define CYCLES_READ_SLICES 400u  // no windows to evaluate
#define CYCLES_ESTIMATE 4450u
#define CYCLES_ESTIMATE_FLUX 400u   // beside the observer, which leaves its regression for it
#define CYCLES_ESTIMATE_BLIND 900u  // without windows: the observers only predict
#define CYCLES_SUPERVISE 850u
#define CYCLES_SUPERVISE_BLIND 100u
#define CYCLES_CONTROL 850u
#define CYCLES_MODULATE 1550u
#define CYCLES_SERIAL 120u  // two octets each way
#define CYCLES_REFER 550u   // references of the hysteresis
#define CYCLES_WINDOW 60u
#define CYCLES_SLICE 120u
#define CYCLES_SCOPE 210u  // while it records: four channels and the trigger

#endif
