// Inertia learnt from run-ups (estimators/inertia_match.h), and what a current makes of it.

#ifndef STILLSPIN_FIRMWARE_DRIVE_INERTIA_H
#define STILLSPIN_FIRMWARE_DRIVE_INERTIA_H

#include "estimators/inertia_match.h"
#include "firmware/mode/mode.h"

extern inertia_match_t inertia_match;

/// Electrical acceleration by currents, binary angle per period^2, Q8.
int32_t drive_accel_q8(const drive_t* d, int32_t id_q20, int32_t iq_q20);

/// Learns; once a millisecond.
void drive_match_inertia(const drive_t* d, drive_estimate_t* e, speed_controller_t* speed);

#endif
