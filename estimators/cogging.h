// Cogging: the part of the load that repeats with the rotor's angle.
//
// At a crawl the load observer chases it, and the shaft with it; but it is a known function of the angle with two
// unknown numbers, load = a cos(n theta) + b sin(n theta). They are fitted, together with the mean, to the load that is
// observed: a least-mean-squares step for every sixteenth of a wave that the shaft turns by, so that how fast they
// learn is a matter of the way and not of the time, and a shaft that stands teaches nothing. (To learn from the load's
// corrections instead, as an internal model would, turns the two numbers rather than correcting them: well below the
// observer's bandwidth the correction is the load's derivative, a quarter of a wave ahead.) The observed load is late;
// the fit belongs to the angle at which the shaft was then, as the phase advance of adaptive feedforward cancellation
// does (Bodson and Douglas, 1997). What the wave takes over goes from the load, so that their sum stays.
//
// Accelerations as in estimator.h: binary angle per period^2, Q8.

#ifndef STILLSPIN_ESTIMATORS_COGGING_H
#define STILLSPIN_ESTIMATORS_COGGING_H

#include <stdbool.h>

#include "control/frame.h"

#define COGGING_BOUND_END_Q8 1073741823L  // so that two amplitudes differ by 31 bits

typedef struct {
  int32_t order;      // n, waves per electrical turn; 0: no cogging is assumed
  int32_t crawl_bpp;  // at least 1: learns below this speed, is taken into account below three times it
  int32_t bound_q8;   // largest amplitude believed, up to COGGING_BOUND_END_Q8
} cogging_config_t;

typedef struct {
  int32_t cos_q8, sin_q8;  // a, b
  int32_t mean_q8;         // what the load swings about
  int32_t now_q8;          // cogging at the present angle
  uint32_t stepped_bam;    // phase of the wave at the last step of learning
  int32_t known_q30;       // share of it that is learnt, 0..1
  int32_t order;           // of what is learnt
  rotation_t wave;
  bool active;
} cogging_t;

typedef struct {
  uint32_t angle_bam;  // at which the load was what it is now observed to be
  int32_t speed_bpp;
  int32_t load_q8;  // without cogging
} cogging_seen_t;

/// Acceleration that the cogging takes away at an angle, and keeps the wave for learning.
int32_t cogging_load(cogging_t* s, const cogging_config_t* c, uint32_t angle_bam, int32_t speed_bpp);

/// Learns; once a millisecond. Returns the acceleration at the present angle that has gone from the load to the wave.
int32_t cogging_learn(cogging_t* s, const cogging_config_t* c, const cogging_seen_t* in);

#endif
