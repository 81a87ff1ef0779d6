#include "estimators/admittance.h"

// Admittance error that a residual (V A per period, Q16) over a spread (V^2, Q8) stands for, Q30.
static int32_t error_q30(int32_t residual_q16, int32_t spread_q8) { return q_div(residual_q16, spread_q8, 22); }

void admittance_step(machine_model_t* m, const regression_t* r, int32_t share_q30) {
  if (r->information <= 0) return;
  const machine_point_t* const p = &m->map.points[0];
  const int32_t mean = p->ydd_q30 / 2 + p->yqq_q30 / 2;
  const int32_t half = (p->ydd_q30 - p->yqq_q30) / 2;
  machine_trim_t* const t = &m->trim;
  t->mean_q30 += q_mul(error_q30(r->along_q16, r->spread_q8), share_q30, 30);
  t->half_q30 += q_mul(error_q30(r->mirror_q16, r->spread_q8), share_q30, 30);
  t->mean_q30 = q_clamp(t->mean_q30, -mean / 4, mean / 2);
  // Both admittances stay positive, whatever the windows say.
  const int32_t half_max = q_min(q_shl_sat(half, 1), (mean + t->mean_q30) / 10 * 9);
  t->half_q30 = q_clamp(t->half_q30, q_min(half / 3, half_max) - half, half_max - half);
}
