// Hysteresis in the place of current control and modulation.

#ifndef STILLSPIN_FIRMWARE_HYSTERESIS_STEPS_H
#define STILLSPIN_FIRMWARE_HYSTERESIS_STEPS_H

#include "firmware/mode/mode.h"

bool drive_hysteresis(drive_t* d);             // switches it on and off with the state; true while it is on
void drive_hysteresis_samples(drive_t* d);     // in the place of the windows
void drive_hysteresis_slice(hysteresis_t* h);  // the slice interrupt

#endif
