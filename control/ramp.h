// Slew-rate limiter of a reference; it also tells its own slope, which the speed controller feeds forward.

#ifndef STILLSPIN_CONTROL_RAMP_H
#define STILLSPIN_CONTROL_RAMP_H

#include "hal/qmath/qmath.h"

typedef struct {
  int32_t value;
  int32_t step;  // slope: the change made by the last call, or the one that the next target is expected to make
  int32_t jump;  // of the last target, where nothing limits it
} ramp_t;

/// Moves towards the target by at most `rate` per call. Rate 0 jumps; what the last two jumps have in common is the
/// slope of a target that moves by itself, and a single jump has none.
static inline int32_t ramp_step(ramp_t* r, int32_t target, int32_t rate) {
  const int32_t distance = q_sub_sat(target, r->value);
  if (rate != 0) {
    r->step = q_clamp(distance, -rate, rate);
    r->value = q_add_sat(r->value, r->step);
    return r->value;
  }
  r->step = q_clamp(distance, q_min(r->jump, 0), q_max(r->jump, 0));
  r->jump = distance;
  r->value = target;
  return r->value;
}

#endif
