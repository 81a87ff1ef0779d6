// Holding the shaft while a brake opens, see hold.c.

#ifndef STILLSPIN_FIRMWARE_DRIVE_BRAKE_HOLD_H
#define STILLSPIN_FIRMWARE_DRIVE_BRAKE_HOLD_H

#include <stdint.h>

typedef struct {
  uint32_t left;              // periods
  uint32_t reference_bam;     // electrical angle to be held
  int32_t current_per_accel;  // A (Q20) per acceleration (Q8), Q20
} hold_t;

#endif
