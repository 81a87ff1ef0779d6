// Tracking observer: angle, speed and load from angle errors and the torque that the current makes.
//
// Third order: angle += speed; speed += torque acceleration - load; the error corrects all three with a triple pole at
// -bandwidth. Because the torque is fed forward, the speed does not lag behind what the drive itself does; only the
// load is seen late. Gains l1 = 3x, l2 = 3x^2, l3 = x^3 with x = bandwidth * T.

#ifndef STILLSPIN_ESTIMATORS_TRACKING_OBSERVER_H
#define STILLSPIN_ESTIMATORS_TRACKING_OBSERVER_H

#include "estimators/estimator.h"

typedef struct {
  uint32_t angle_bam;
  int32_t speed_bpp;  // within 1.9 rad per period
  int32_t load_accel_q8;
  int32_t speed_remainder_q8;  // what of the acceleration was less than one unit of speed
} tracking_observer_t;

static inline void tracking_observer_preset(tracking_observer_t* s, uint32_t angle_bam, int32_t speed_bpp,
                                            int32_t load_accel_q8) {
  s->angle_bam = angle_bam;
  s->speed_bpp = speed_bpp;
  s->load_accel_q8 = load_accel_q8;
  s->speed_remainder_q8 = 0;
}

/// Moves on by one period.
void tracking_observer_predict(tracking_observer_t* s, int32_t torque_accel_q8);

/// Corrects with an angle error (measured minus observed); bandwidth_step_q30 = bandwidth * T, below 0.1.
void tracking_observer_correct(tracking_observer_t* s, int32_t error_bam, int32_t bandwidth_step_q30);

#endif
