// Inertia learnt from run-ups (estimators/inertia_match.h).

#ifndef STILLSPIN_FIRMWARE_DRIVE_INERTIA_H
#define STILLSPIN_FIRMWARE_DRIVE_INERTIA_H

#include "estimators/inertia_match.h"
#include "firmware/mode/mode.h"

extern inertia_match_t inertia_match;

/// Learns; once a millisecond.
void drive_match_inertia(drive_t* d);

#endif
