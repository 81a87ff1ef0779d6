// Holding the shaft while a brake opens, see brake_release_hold.c.

#ifndef STILLSPIN_FIRMWARE_DRIVE_BRAKE_RELEASE_HOLD_H
#define STILLSPIN_FIRMWARE_DRIVE_BRAKE_RELEASE_HOLD_H

#include "firmware/mode/mode.h"

typedef struct {
  uint32_t left;              // periods
  uint32_t reference_bam;     // electrical angle to be held
  int32_t current_per_accel;  // A (Q20) per acceleration (Q8), Q20
} hold_t;

extern hold_t brake_release_hold;

/// Holds the shaft for hold_time from now.
void hold_begin(drive_t* d);
void hold_end(void);
static inline bool hold_is_on(const drive_t* d) { return brake_release_hold.left > 0u && d->state == DRIVE_RUN; }

/// One period, while it is on: the torque current that holds the shaft, A.
int32_t hold_step_q20(const drive_t* d);

#endif
