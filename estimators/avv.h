// AVV: the rotor angle from how the current deviation differs between voltage vectors (seed paper, section 4, eqs
// (37)-(41)).
//
// The differences between windows depend on L^-1(theta) alone: y = ds - Y0 dv = 1/2 dY S(2 theta) dv. Any two or three
// distinct vectors will do; the windows are weighted with the square of their span (their information). The model's own
// slope at the observed angle is taken off first, which removes what resistance, back-EMF and rotation change between
// the windows' instants; what is left is turned into the angle error by atan2, valid for any error up to a quarter
// turn. 2 theta leaves the polarity open: the observer's own half turn is kept, polarity.h finds the right one at the
// start.

#ifndef STILLSPIN_ESTIMATORS_AVV_H
#define STILLSPIN_ESTIMATORS_AVV_H

#include "estimators/regression.h"
#include "estimators/tracking_observer.h"

typedef struct {
  int32_t bandwidth_short_q30;  // bandwidth * T of the tracking observer with windows that tell little
  int32_t bandwidth_long_q30;   // and with long windows; 0 < short <= long < 0.1
} avv_config_t;

typedef struct {
  tracking_observer_t observer;
  regression_t regression;  // of the last step
  int32_t error_bam;        // last measured angle error; while AVV rests, of the observer's regression
  uint16_t is_near;         // 1: what was last regressed may be learnt from; written by who learns
} avv_t;

void avv_preset(avv_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8);

/// Angle error that a regression tells, binary angle; valid for any error below a quarter turn.
int32_t avv_angle_error(const regression_t* r, const machine_model_t* m);

/// With an error beyond it the regression is not linear: nothing is learnt from it.
#define AVV_NEAR_BAM 178956971L  // 15 degrees

estimator_output_t avv_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in);

/// 2 theta as printed, (37) to (41): of two active vectors the slopes as they are, each along its own voltage and less
/// that under the period's zero vector, through an arc tangent. The print takes three active vectors, and a period has
/// two: the third phase is what the three's sum, constant by (37), leaves of it. The angle is that in the middle of the
/// period in which the windows lie. False, with nothing written, where a period has no two of them and a zero vector.
bool avv_printed_angle(const estimator_input_t* in, uint32_t* doubled_bam);

/// avv_step with that angle, for comparison; the print does not say what follows it, here the same tracking observer
/// with the lower bandwidth does. No regression: there is nothing to learn from.
estimator_output_t avv_printed_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in);

#endif
