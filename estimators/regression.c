#include "estimators/regression.h"

#define SPREAD_MIN_Q8 (400L * 256L)  // (20 V)^2: less is one and the same vector

// Information weight of a window: the square of its span.
static int32_t weight_of(const estimator_window_t* w) { return q_shr((int32_t)w->span_ticks * w->span_ticks, 12); }

// 1 / total, Q30; what is left of the rounding is far below the noise.
static int32_t per_total_q30(int32_t total) {
  return (int32_t)((1073741824uL + (uint32_t)total / 2u) / (uint32_t)total);
}

// What a window's change adds to the mean slope, A per period: within 512, more no machine makes.
static int32_t part_q20(int32_t change_q17, int32_t per_change_q20) {
  return q_sat_bits(q_product(change_q17, per_change_q20), 17, 29);
}

// The residuals' differences (columns) against those of the voltages.
typedef struct {
  dq_t mean_q14;  // voltage; 400 V and more fit into the products
  int64_t dd_q34, dq_q34, qd_q34, qq_q34, spread_q28;
} projection_t;

static void project(projection_t* p, const deviation_change_t* c, dq_t part_q20, int32_t share_q30) {
  const dq_t v_q14 = {q_shr(c->voltage_q17.d, 3) - p->mean_q14.d, q_shr(c->voltage_q17.q, 3) - p->mean_q14.q};
  p->spread_q28 =
      q_mac(q_mac(p->spread_q28, q_mul_hi(v_q14.d * 4, share_q30), v_q14.d), q_mul_hi(v_q14.q * 4, share_q30), v_q14.q);
  p->dd_q34 = q_mac(p->dd_q34, part_q20.d, v_q14.d);
  p->dq_q34 = q_mac(p->dq_q34, part_q20.d, v_q14.q);
  p->qd_q34 = q_mac(p->qd_q34, part_q20.q, v_q14.d);
  p->qq_q34 = q_mac(p->qq_q34, part_q20.q, v_q14.q);
}

static void resolve(regression_t* r, const projection_t* p) {
  r->spread_q8 = q_sat64(q_shr64(p->spread_q28, 20));
  r->along_q16 = q_sat64(q_shr64(p->dd_q34 + p->qq_q34, 18));
  r->mirror_q16 = q_sat64(q_shr64(p->dd_q34 - p->qq_q34, 18));
  r->cross_q16 = q_sat64(q_shr64(p->qd_q34 + p->dq_q34, 18));
  r->curl_q16 = q_sat64(q_shr64(p->qd_q34 - p->dq_q34, 18));
}

void regression_evaluate(regression_t* r, const deviation_change_t seen[], const estimator_input_t* in) {
  static const regression_t empty = {0, 0, 0, 0, 0, 0, {0, 0}};
  int32_t share_q30[ESTIMATOR_WINDOWS];
  dq_t part[ESTIMATOR_WINDOWS];
  dq_t mean_q20 = {0, 0};
  projection_t p = {{0, 0}, 0, 0, 0, 0, 0};
  int32_t total = 0;
  for (uint16_t k = 0; k < in->window_count; k++) total += weight_of(&in->windows[k]);
  if (total <= 0) {
    *r = empty;
    return;
  }
  const int32_t per_weight_q30 = per_total_q30(total);
  for (uint16_t k = 0; k < in->window_count; k++) {
    share_q30[k] = q_share_q30(weight_of(&in->windows[k]), per_weight_q30);
    // Of a change, its slope's share.
    const int32_t per_change_q20 = q_mul_floor(share_q30[k] / in->windows[k].span_ticks, ESTIMATOR_PERIOD_TICKS, 10);
    part[k].d = part_q20(seen[k].left_q17.d, per_change_q20);
    part[k].q = part_q20(seen[k].left_q17.q, per_change_q20);
    mean_q20.d += part[k].d;
    mean_q20.q += part[k].q;
    p.mean_q14.d += q_mul_floor(seen[k].voltage_q17.d, share_q30[k], 33);
    p.mean_q14.q += q_mul_floor(seen[k].voltage_q17.q, share_q30[k], 33);
  }
  for (uint16_t k = 0; k < in->window_count; k++) project(&p, &seen[k], part[k], share_q30[k]);
  r->mean_q20 = mean_q20;
  resolve(r, &p);
  r->information = (r->spread_q8 >= SPREAD_MIN_Q8) ? q_mul_sat(r->spread_q8, total, 8) : 0;
}
