// The axis of the saliency from scratch: angle and inverse inductances of a machine that stands, in one go.
//
// Over a full round of the alternating layout the directions of dv are even, so the sums of AVV's regression, taken in
// a *fixed* frame, separate: along dv only the mean inverse inductance is left, along the mirrored dv half of the
// saliency times cos 2 theta, across it times sin 2 theta. Angle and both inverse inductances follow without iteration
// and without knowing any inductance; a tracking observer that starts from a guess can sit a quarter turn off for long,
// and with inductances that are 30 % wrong it is led by the direction of dv.
//
// Result within 1 degree of motor A's axis, with half a turn left open. Not valid while the shaft turns by more than a
// few degrees within AXIS_PERIODS.

#ifndef STILLSPIN_ESTIMATORS_AXIS_H
#define STILLSPIN_ESTIMATORS_AXIS_H

#include "estimators/regression.h"

#define AXIS_PERIODS 12  // two rounds of six

typedef struct {
  int32_t spread_q8, along_q16, mirror_q16, cross_q16, curl_q16;  // sums, see regression_t
  uint16_t count;
} axis_t;

typedef struct {
  int32_t angle_bam;           // axis relative to the frame of the regressions, -quarter..quarter turn
  int32_t mean_q30, half_q30;  // Y0 T and 1/2 dY T
} axis_result_t;

static inline void axis_begin(axis_t* s) {
  const axis_t none = {0, 0, 0, 0, 0, 0};
  *s = none;
}

/// Takes the regression of one period, made at always the same angle; none once complete. Rounds are whole where no
/// period in between has shown nothing: a direction more than the others would be a share of the saliency.
void axis_add(axis_t* s, const regression_t* r);

static inline bool axis_is_complete(const axis_t* s) { return s->count >= AXIS_PERIODS; }

/// Whether the saliency is too small to show an axis: below a sixteenth of the mean, Lq less than an eighth above Ld.
/// The two rounds of a start are sure of it within a fortieth.
static inline bool axis_is_hidden(int32_t mean_q30, int32_t half_q30) { return half_q30 < q_shr(mean_q30, 4); }

/// m: the model that the regressions were made with.
axis_result_t axis_evaluate(const axis_t* s, const machine_model_t* m);

#endif
