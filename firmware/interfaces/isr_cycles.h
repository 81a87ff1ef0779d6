// Run time of the steps of the control interrupt on the chip, in cycles of SYSCLKOUT: what the virtual chip lets pass.
//
// Estimates from operations, no measurement on the chip: a 32 x 32 bit product with rounding 13 cycles, one that is
// only added up 8, an upper half 6, a saturation 8, a reciprocal 70. By what other C28x code takes the steps need more
// (docs/isr-cost.md), and `make isr-cost` says by how much. Not in it: position source 2 or a hold, which evaluate the
// windows twice. Serial port and scope come when the compare values are written: a value that is written too late is
// seen too late.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_ISR_CYCLES_H
#define STILLSPIN_FIRMWARE_INTERFACES_ISR_CYCLES_H

#define CYCLES_READ_SAMPLES 1000u
#define CYCLES_READ_SLICES 400u  // no windows to evaluate
#define CYCLES_ESTIMATE 2400u
#define CYCLES_ESTIMATE_FLUX 400u        // beside the observer, which leaves its regression for it
#define CYCLES_ESTIMATE_NO_WINDOWS 900u  // without windows: the observers only predict
#define CYCLES_SUPERVISE 620u
#define CYCLES_SUPERVISE_NO_WINDOWS 100u
#define CYCLES_CONTROL 900u
#define CYCLES_MODULATE 1400u
#define CYCLES_SERIAL 120u  // two octets each way
#define CYCLES_REFER 550u   // references of the hysteresis
#define CYCLES_WINDOW 110u
#define CYCLES_SLICE 120u
#define CYCLES_SCOPE 600u  // while it records: four channels, of the dearest signals, and the trigger

#endif
