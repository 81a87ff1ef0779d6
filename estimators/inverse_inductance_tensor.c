#include "estimators/inverse_inductance_tensor.h"

#include "estimators/fit.h"
#include "hal/qmath/qcall.h"

#define TENTH_Q20 104858L         // 100 us in ms: mH = ms / (A per V and period)
#define SPREAD_MIN_Q28 26843546L  // determinant of the normalised sums: a tenth of that of evenly spread vectors

void tensor_reset(tensor_sums_t* s) {
  static const tensor_sums_t none = {0, 0, 0, 0, 0, 0, 0, 0};
  *s = none;
}

void tensor_add(tensor_sums_t* s, const deviation_t* first, const deviation_t* second) {
  const dq_t v = {q_shr(first->voltage_q16.d - second->voltage_q16.d, 10),
                  q_shr(first->voltage_q16.q - second->voltage_q16.q, 10)};
  const dq_t r = {first->residual_q20.d - second->residual_q20.d, first->residual_q20.q - second->residual_q20.q};
  q_gather(&s->vv_dd, q_product(v.d, v.d));
  q_gather(&s->vv_dq, q_product(v.d, v.q));
  q_gather(&s->vv_qq, q_product(v.q, v.q));
  q_gather(&s->sv_dd, q_product(r.d, v.d));
  q_gather(&s->sv_dq, q_product(r.d, v.q));
  q_gather(&s->sv_qd, q_product(r.q, v.d));
  q_gather(&s->sv_qq, q_product(r.q, v.q));
  s->count = qc_add_sat(s->count, 1);
}

// One row of the quotient: (d, q) times the inverse of [a b; b c].
static dq_t row(int64_t sd, int64_t sq, int64_t mean, dq_t abc_d, int32_t c_q28, int32_t det_q28) {
  const int32_t e_d = fit_ratio(sd, mean, 16);
  const int32_t e_q = fit_ratio(sq, mean, 16);
  const dq_t top = {q_mul_sub_sat(e_d, c_q28, e_q, abc_d.q, 28), q_mul_sub_sat(e_q, abc_d.d, e_d, abc_d.q, 28)};
  const dq_t y = {q_div(top.d, det_q28, 28), q_div(top.q, det_q28, 28)};
  return y;
}

bool tensor_solve(const tensor_sums_t* s, const machine_model_t* m, tensor_axes_t* out) {
  const int64_t mean = q_shr64(s->vv_dd, 1) + q_shr64(s->vv_qq, 1);
  if (mean <= 0) return false;  // no sums, or pairs without a difference
  const dq_t ab_q28 = {fit_ratio(s->vv_dd, mean, 28), fit_ratio(s->vv_dq, mean, 28)};
  const int32_t c_q28 = fit_ratio(s->vv_qq, mean, 28);
  const int32_t det_q28 = q_mul_sub_sat(ab_q28.d, c_q28, ab_q28.q, ab_q28.q, 28);
  if (det_q28 < SPREAD_MIN_Q28) return false;
  dq_t slope_d = row(s->sv_dd, s->sv_dq, mean, ab_q28, c_q28, det_q28);
  dq_t slope_q = row(s->sv_qd, s->sv_qq, mean, ab_q28, c_q28, det_q28);
  slope_d.d = qc_add_sat(slope_d.d, m->yd_q30);
  slope_q.q = qc_add_sat(slope_q.q, m->yq_q30);
  const int32_t difference = qc_sub_sat(slope_d.d, slope_q.q);
  const int32_t twice_cross = qc_add_sat(slope_d.q, slope_q.d);
  out->mean_q30 = slope_d.d / 2 + slope_q.q / 2;
  out->half_q30 = q_hypot(difference, twice_cross) / 2;
  out->axis_bam = (int32_t)q_atan2(twice_cross, difference) / 2;
  out->across_q30 = slope_q.d / 2 - slope_d.q / 2;
  return true;
}

int32_t tensor_inductance_q20(int32_t y_q30) { return q_div(TENTH_Q20, y_q30, 30); }
