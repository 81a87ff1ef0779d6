#include "estimators/regression.h"

#define SPREAD_MIN_Q8 (400L * 256L)  // (20 V)^2: less is one and the same vector

// Information weight of a window: the square of its span.
static int32_t weight_of(const estimator_window_t* w) { return q_shr((int32_t)w->span_ticks * w->span_ticks, 12); }

static dq_t weighted(dq_t x, int32_t share_q30) {
  const dq_t y = {q_mul(x.d, share_q30, 30), q_mul(x.q, share_q30, 30)};
  return y;
}

static void add(dq_t* sum, dq_t x) {
  sum->d += x.d;
  sum->q += x.q;
}

static void project(regression_t* r, const deviation_t* d, dq_t mean_voltage_q16, int32_t share_q30) {
  // Differences of voltage as Q14: 400 V and more fit into the products.
  const dq_t dv = {q_shr(d->voltage_q16.d - mean_voltage_q16.d, 2), q_shr(d->voltage_q16.q - mean_voltage_q16.q, 2)};
  const dq_t ds = {d->residual_q20.d - r->mean_q20.d, d->residual_q20.q - r->mean_q20.q};
  const dq_t part = weighted(dv, share_q30);
  r->spread_q8 += q_mul(part.d, dv.d, 20) + q_mul(part.q, dv.q, 20);
  const int32_t vd_sd = q_mul_sat(part.d, ds.d, 18);
  const int32_t vq_sq = q_mul_sat(part.q, ds.q, 18);
  const int32_t vq_sd = q_mul_sat(part.q, ds.d, 18);
  const int32_t vd_sq = q_mul_sat(part.d, ds.q, 18);
  r->along_q16 += q_add_sat(vd_sd, vq_sq);
  r->mirror_q16 += q_sub_sat(vd_sd, vq_sq);
  r->cross_q16 += q_add_sat(vd_sq, vq_sd);
  r->curl_q16 += q_sub_sat(vd_sq, vq_sd);
}

void regression_evaluate(regression_t* r, const deviation_t d[], const estimator_input_t* in) {
  static const regression_t empty = {0, 0, 0, 0, 0, 0, {0, 0}, {0, 0}};
  int32_t share_q30[ESTIMATOR_WINDOWS];
  int32_t total = 0;
  dq_t voltage = {0, 0};
  *r = empty;
  for (uint16_t k = 0; k < in->window_count; k++) total += weight_of(&in->windows[k]);
  if (total <= 0) return;
  const int32_t per_weight_q30 = q_div(1, total, 30);
  for (uint16_t k = 0; k < in->window_count; k++) {
    share_q30[k] = weight_of(&in->windows[k]) * per_weight_q30;
    add(&voltage, weighted(d[k].voltage_q16, share_q30[k]));
    add(&r->mean_q20, weighted(d[k].residual_q20, share_q30[k]));
    add(&r->current_q20, weighted(d[k].current_q20, share_q30[k]));
  }
  for (uint16_t k = 0; k < in->window_count; k++) project(r, &d[k], voltage, share_q30[k]);
  if (r->spread_q8 >= SPREAD_MIN_Q8) r->information = q_mul_sat(r->spread_q8, total, 8);
}
