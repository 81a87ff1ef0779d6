// What a period's windows say together: the residuals (deviation.h) regressed on the voltages that they were seen
// under.
//
// Differences between windows depend on L^-1(theta) alone, and any two or three distinct vectors will do (seed paper,
// eqs (37)-(41)). The windows are weighted with the square of their span (their information). The four projections of
// the residuals' differences on those of the voltages belong to the errors of the mean inverse inductance, of the
// saliency, of the angle and of the sensors' match; the mean residual belongs to resistance and back-EMF.

#ifndef STILLSPIN_ESTIMATORS_REGRESSION_H
#define STILLSPIN_ESTIMATORS_REGRESSION_H

#include "estimators/deviation.h"

typedef struct {
  int32_t spread_q8;    // mean |dv|^2, V^2
  int32_t along_q16;    // residual along dv, V A per period: error of the mean inverse inductance
  int32_t mirror_q16;   // residual along the mirrored dv: error of the saliency
  int32_t cross_q16;    // residual across the mirrored dv: angle error
  int32_t curl_q16;     // residual across dv: mismatch of the two current sensors
  int32_t information;  // spread times the windows' weight, 0 when there are no two distinct vectors
  dq_t mean_q20;        // weighted mean residual, A per period
} regression_t;

/// Regression over what the input's windows show, all of them at one angle and speed.
void regression_evaluate(regression_t* r, const deviation_change_t seen[], const estimator_input_t* in);

#endif
