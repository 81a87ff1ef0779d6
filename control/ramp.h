// Slew-rate limiter of a reference; it also tells its own slope, which the speed controller feeds forward.

#ifndef STILLSPIN_CONTROL_RAMP_H
#define STILLSPIN_CONTROL_RAMP_H

#include "hal/qmath/qmath.h"

typedef struct {
  int32_t value;
  int32_t step;  // change made by the last call
} ramp_t;

/// Moves towards the target by at most `rate` per call; rate 0 jumps.
static inline int32_t ramp_step(ramp_t* r, int32_t target, int32_t rate) {
  const int32_t distance = q_sub_sat(target, r->value);
  r->step = (rate == 0) ? 0 : q_clamp(distance, -rate, rate);
  r->value = (rate == 0) ? target : q_add_sat(r->value, r->step);
  return r->value;
}

#endif
