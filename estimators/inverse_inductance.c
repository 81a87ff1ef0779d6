#include "estimators/inverse_inductance.h"

#include "hal/qmath/qcall.h"

#define WEAK_SHIFT 3u  // an eighth of Y0: next to no saliency may be as much, of either sign

typedef struct {
  int32_t mean_q30, half_q30;
} inverse_inductance_t;

// Y0 and 1/2 dY at no current as the parameters have them.
static inverse_inductance_t nominal(const machine_model_t* m) {
  const machine_point_t* const p = &m->map.points[0];
  const inverse_inductance_t y = {q_shr(p->ydd_q30, 1) + q_shr(p->yqq_q30, 1), q_shr(p->ydd_q30 - p->yqq_q30, 1)};
  return y;
}

static void trim(machine_model_t* m, int32_t mean_q30, int32_t half_q30) {
  const inverse_inductance_t y = nominal(m);
  const int32_t mean = q_clamp(mean_q30, -q_shr(y.mean_q30, 2), q_shr(y.mean_q30, 1));
  // Both inverse inductances stay positive, whatever the windows say: an eighth of the mean is left.
  int32_t most = q_min(2 * y.half_q30, y.mean_q30 + mean - q_shr(y.mean_q30 + mean, 3));
  int32_t least = q_min(y.half_q30 / 3, most);
  if (inverse_inductance_is_weak(m)) {
    most = q_shr(y.mean_q30, WEAK_SHIFT);
    least = -most;
  }
  machine_model_trim(m, mean, q_clamp(half_q30, least - y.half_q30, most - y.half_q30));
}

void inverse_inductance_step(machine_model_t* m, const regression_t* r, q_inverse_t per_spread, int32_t share_q30) {
  if (r->information <= 0) return;
  // Inverse inductance error that a residual (V A per period, Q16) over a spread (V^2, Q8) stands for.
  const int32_t mean_q30 = m->trim.mean_q30 + q_mul(qc_over(r->along_q16, per_spread, 22), share_q30, 30);
  const int32_t half_q30 = m->trim.half_q30 + q_mul(qc_over(r->mirror_q16, per_spread, 22), share_q30, 30);
  trim(m, mean_q30, half_q30);
}

void inverse_inductance_preset(machine_model_t* m, int32_t mean_q30, int32_t half_q30) {
  const inverse_inductance_t y = nominal(m);
  // What little shows at rest is no axis.
  trim(m, qc_sub_sat(mean_q30, y.mean_q30), inverse_inductance_is_weak(m) ? 0 : qc_sub_sat(half_q30, y.half_q30));
  machine_model_settle(m);
}
