// The machine's incremental inverse inductance as a full 2 x 2 tensor, from pairs of windows under different vectors.
//
// The difference of two windows of one period is ds = Y dv: resistance, back-EMF and drops cancel to first order, and
// the rest is in the model's own slope, which is taken off beforehand (deviation.h). Sums of dv dv' and ds dv' over
// many periods give Y = (sum ds dv')(sum dv dv')^-1 exactly, whichever directions dv took. The symmetric part is the
// machine; the antisymmetric one is the mismatch of the two current sensors (sensor_match.h).

#ifndef STILLSPIN_ESTIMATORS_INVERSE_INDUCTANCE_TENSOR_H
#define STILLSPIN_ESTIMATORS_INVERSE_INDUCTANCE_TENSOR_H

#include "estimators/deviation.h"

typedef struct {
  int64_t vv_dd, vv_dq, vv_qq;         // V^2, Q12
  int64_t sv_dd, sv_dq, sv_qd, sv_qq;  // A V per period, Q26: slope component first
  int32_t count;
} tensor_sums_t;

/// Saliency axis and eigenvalues of a tensor.
typedef struct {
  int32_t mean_q30, half_q30;  // (Y1 + Y2)/2 and (Y1 - Y2)/2 with Y1 >= Y2, A per V and period
  int32_t axis_bam;            // direction of Y1 (the smaller inductance), -1/4..1/4 turn from the frame's d-axis
  int32_t across_q30;          // antisymmetric part
} tensor_axes_t;

void tensor_reset(tensor_sums_t* s);

/// Adds a pair of windows: their voltages and residuals in the frame of the model's d-axis.
void tensor_add(tensor_sums_t* s, const deviation_t* first, const deviation_t* second);

/// Solves for the tensor that the sums and the model (whose slopes were taken off) stand for. Returns false when there
/// are no sums or the vectors had one direction only.
bool tensor_solve(const tensor_sums_t* s, const machine_model_t* m, tensor_axes_t* out);

/// Inductance in mH, Q20, of an inverse inductance in A per V and period of 100 us, Q30.
int32_t tensor_inductance_q20(int32_t y_q30);

#endif
