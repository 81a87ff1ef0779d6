// Cogging: the part of the load that repeats with the rotor's angle.
//
// At a crawl the load observer chases it, and the shaft with it; but it is a known function of the angle with two
// unknown numbers, load = a cos(n theta) + b sin(n theta). They learn from the same correction as the load itself,
// which makes the observer exact for that one wave (an internal model of it). Learnt only while the shaft crawls:
// below, the wave stands still and is like any load; above, it is faster than the observer. Seed papers have no such
// term.
//
// Accelerations as in estimator.h: binary angle per period^2, Q8.

#ifndef STILLSPIN_ESTIMATORS_COGGING_H
#define STILLSPIN_ESTIMATORS_COGGING_H

#include <stdbool.h>

#include "control/frame.h"

typedef struct {
  int32_t order;     // n, waves per electrical turn; 0: no cogging is assumed
  int32_t slow_bpp;  // learns above this speed,
  int32_t fast_bpp;  // and below this one; is taken into account below three times it
  int32_t bound_q8;  // largest amplitude believed
} cogging_config_t;

typedef struct {
  int32_t cos_q8, sin_q8;  // a, b
  int32_t now_q8;          // cogging at the present angle
  rotation_t wave;
  bool active;
} cogging_t;

/// Acceleration that the cogging takes away at an angle, and keeps the wave for learning.
int32_t cogging_load(cogging_t* s, const cogging_config_t* c, uint32_t angle_bam, int32_t speed_bpp);

/// Takes a correction of the load observed at that angle.
void cogging_learn(cogging_t* s, const cogging_config_t* c, int32_t speed_bpp, int32_t correction_q8);

#endif
