// Holding the shaft while a brake opens, see hold.c.

#ifndef STILLSPIN_FIRMWARE_START_HOLD_H
#define STILLSPIN_FIRMWARE_START_HOLD_H

#include "estimators/avv.h"

typedef struct {
  uint32_t left;           // periods
  uint32_t reference_bam;  // electrical angle to be held
  int32_t offset_bpp;      // of the speed that the back-EMF tells
  avv_t avv;
} hold_t;

#endif
