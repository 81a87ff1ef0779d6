#include "estimators/regression.h"

#include "estimators/window_sum.h"

#define SPREAD_MIN_Q8 (400L * 256L)  // (20 V)^2: less is one and the same vector

// Information weight of a window: the square of its span.
static int32_t weight_of(const estimator_window_t* w) { return q_shr((int32_t)w->span_ticks * w->span_ticks, 12); }

static void add(window_sum_t* sum, dq_t x, int32_t share_q30) { window_sum_add(sum, x.d, x.q, share_q30); }

static dq_t mean_of(const window_sum_t* sum) {
  const dq_t mean = {window_sum_mean(sum->x, 30), window_sum_mean(sum->y, 30)};
  return mean;
}

// 1 / total, Q30; what is left of the rounding is far below the noise.
static int32_t per_total_q30(int32_t total) {
  return (int32_t)((1073741824uL + (uint32_t)total / 2u) / (uint32_t)total);
}

static void average(regression_t* r, const deviation_t d[], const estimator_input_t* in, const int32_t share_q30[],
                    dq_t* voltage_q16) {
  window_sum_t voltage = {0, 0};
  window_sum_t residual = {0, 0};
  for (uint16_t k = 0; k < in->window_count; k++) {
    add(&voltage, d[k].voltage_q16, share_q30[k]);
    add(&residual, d[k].residual_q20, share_q30[k]);
  }
  *voltage_q16 = mean_of(&voltage);
  r->mean_q20 = mean_of(&residual);
}

// The residuals' differences (columns) against those of the voltages.
typedef struct {
  window_sum_t by_d, by_q;
  int64_t spread;
} projection_t;

static void project(projection_t* p, const regression_t* r, const deviation_t* d, dq_t mean_voltage_q16,
                    int32_t share_q30) {
  // Differences of voltage as Q14: 400 V and more fit into the products.
  const dq_t dv = {q_shr(d->voltage_q16.d - mean_voltage_q16.d, 2), q_shr(d->voltage_q16.q - mean_voltage_q16.q, 2)};
  const dq_t ds = {d->residual_q20.d - r->mean_q20.d, d->residual_q20.q - r->mean_q20.q};
  const dq_t part = {q_mul_floor(dv.d, share_q30, 30), q_mul_floor(dv.q, share_q30, 30)};
  p->spread = q_mac(q_mac(p->spread, part.d, dv.d), part.q, dv.q);
  add(&p->by_d, ds, part.d);
  add(&p->by_q, ds, part.q);
}

static void resolve(regression_t* r, const projection_t* p) {
  r->spread_q8 = q_sat64(q_shr64(p->spread, 20));
  r->along_q16 = q_sat64(q_shr64(p->by_d.x + p->by_q.y, 18));
  r->mirror_q16 = q_sat64(q_shr64(p->by_d.x - p->by_q.y, 18));
  r->cross_q16 = q_sat64(q_shr64(p->by_d.y + p->by_q.x, 18));
  r->curl_q16 = q_sat64(q_shr64(p->by_d.y - p->by_q.x, 18));
}

void regression_evaluate(regression_t* r, const deviation_t d[], const estimator_input_t* in) {
  static const regression_t empty = {0, 0, 0, 0, 0, 0, {0, 0}};
  int32_t share_q30[ESTIMATOR_WINDOWS];
  int32_t total = 0;
  dq_t voltage_q16;
  projection_t p = {{0, 0}, {0, 0}, 0};
  for (uint16_t k = 0; k < in->window_count; k++) {
    share_q30[k] = weight_of(&in->windows[k]);
    total += share_q30[k];
  }
  if (total <= 0) {
    *r = empty;
    return;
  }
  const int32_t per_weight_q30 = per_total_q30(total);
  for (uint16_t k = 0; k < in->window_count; k++) share_q30[k] = q_share_q30(share_q30[k], per_weight_q30);
  average(r, d, in, share_q30, &voltage_q16);
  for (uint16_t k = 0; k < in->window_count; k++) project(&p, r, &d[k], voltage_q16, share_q30[k]);
  resolve(r, &p);
  r->information = (r->spread_q8 >= SPREAD_MIN_Q8) ? q_mul_sat(r->spread_q8, total, 8) : 0;
}
