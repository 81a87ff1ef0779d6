#include "estimators/axis.h"

#include "hal/qmath/qcall.h"

void axis_add(axis_t* s, const regression_t* r) {
  if (r->information <= 0 || axis_is_complete(s)) return;
  s->spread_q8 = qc_add_sat(s->spread_q8, r->spread_q8);
  s->along_q16 = qc_add_sat(s->along_q16, r->along_q16);
  s->mirror_q16 = qc_add_sat(s->mirror_q16, r->mirror_q16);
  s->cross_q16 = qc_add_sat(s->cross_q16, r->cross_q16);
  s->curl_q16 = qc_add_sat(s->curl_q16, r->curl_q16);
  s->count++;
}

axis_result_t axis_evaluate(const axis_t* s, const machine_model_t* m) {
  const int32_t mean_q30 = m->yd_q30 / 2 + m->yq_q30 / 2;
  const int32_t half_q30 = (m->yd_q30 - m->yq_q30) / 2;
  const int32_t saliency_q16 = qc_add_sat(qc_mul_sat(half_q30, s->spread_q8, 22), s->mirror_q16);
  axis_result_t out;
  out.angle_bam = (int32_t)q_atan2(s->cross_q16, saliency_q16) / 2;
  out.mean_q30 = qc_add_sat(mean_q30, q_div(s->along_q16, s->spread_q8, 22));
  out.half_q30 = q_div(q_hypot(s->cross_q16, saliency_q16), s->spread_q8, 22);
  return out;
}
