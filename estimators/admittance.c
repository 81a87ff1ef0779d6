#include "estimators/admittance.h"

void admittance_init(admittance_t* s, const machine_model_t* m) {
  s->nominal_mean_q30 = m->yd_q30 / 2 + m->yq_q30 / 2;
  s->nominal_half_q30 = (m->yd_q30 - m->yq_q30) / 2;
  s->mean_q30 = s->nominal_mean_q30;
  s->half_q30 = s->nominal_half_q30;
}

// Admittance error that a residual (V A per period, Q16) over a spread (V^2, Q8) stands for, Q30.
static int32_t error_q30(int32_t residual_q16, int32_t spread_q8) { return q_div(residual_q16, spread_q8, 22); }

void admittance_step(admittance_t* s, const avv_regression_t* r, int32_t share_q30) {
  if (r->information <= 0) return;
  const int32_t mean = s->mean_q30 + q_mul(error_q30(r->along_q16, r->spread_q8), share_q30, 30);
  const int32_t half = s->half_q30 + q_mul(error_q30(r->mirror_q16, r->spread_q8), share_q30, 30);
  s->mean_q30 = q_clamp(mean, s->nominal_mean_q30 / 4 * 3, s->nominal_mean_q30 / 2 * 3);
  // Both admittances stay positive, whatever the windows say.
  const int32_t half_max = q_min(q_shl_sat(s->nominal_half_q30, 1), s->mean_q30 / 10 * 9);
  s->half_q30 = q_clamp(half, q_min(s->nominal_half_q30 / 3, half_max), half_max);
}

void admittance_apply(const admittance_t* s, machine_model_t* m) {
  machine_model_set_admittance(m, s->mean_q30 + s->half_q30, s->mean_q30 - s->half_q30);
}
