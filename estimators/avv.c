#include "estimators/avv.h"

#include "estimators/deviation.h"

#define SPREAD_MIN_Q8 (400L * 256L)  // (20 V)^2: less is one and the same vector
// log2 of the information of windows that are as short, and as long, as the bandwidths are meant for.
#define SHORT_LOG2 21
#define LONG_LOG2 27

void avv_preset(avv_t* s, uint32_t angle_bam, int32_t speed_bpp, int32_t load_accel_q8) {
  tracking_observer_preset(&s->observer, angle_bam, speed_bpp, load_accel_q8);
  s->error_bam = 0;
}

// Information weight of a window: the square of its span.
static int32_t weight_of(const estimator_window_t* w) { return q_shr((int32_t)w->span_ticks * w->span_ticks, 12); }

static int32_t weighted(int32_t x, int32_t share_q30) { return q_mul(x, share_q30, 30); }

static void regress(const deviation_t d[], const int32_t share_q30[], uint16_t count, int32_t weight,
                    avv_regression_t* r) {
  dq_t v = {0, 0};
  dq_t s = {0, 0};
  for (uint16_t k = 0; k < count; k++) {
    v.d += weighted(d[k].voltage_q16.d, share_q30[k]);
    v.q += weighted(d[k].voltage_q16.q, share_q30[k]);
    s.d += weighted(d[k].residual_q20.d, share_q30[k]);
    s.q += weighted(d[k].residual_q20.q, share_q30[k]);
  }
  const avv_regression_t empty = {0, 0, 0, 0, 0, 0};
  *r = empty;
  for (uint16_t k = 0; k < count; k++) {
    const dq_t dv = {q_shr(d[k].voltage_q16.d - v.d, 2), q_shr(d[k].voltage_q16.q - v.q, 2)};  // Q14
    const dq_t ds = {d[k].residual_q20.d - s.d, d[k].residual_q20.q - s.q};
    const int32_t dd_q8 = q_mul(dv.d, dv.d, 20);
    const int32_t qq_q8 = q_mul(dv.q, dv.q, 20);
    const int32_t vd_sd = q_mul_sat(dv.d, ds.d, 18);
    const int32_t vq_sq = q_mul_sat(dv.q, ds.q, 18);
    r->spread_q8 += weighted(dd_q8 + qq_q8, share_q30[k]);
    r->along_q16 += weighted(q_add_sat(vd_sd, vq_sq), share_q30[k]);
    r->mirror_q16 += weighted(q_sub_sat(vd_sd, vq_sq), share_q30[k]);
    const int32_t vq_sd = q_mul_sat(dv.q, ds.d, 18);
    const int32_t vd_sq = q_mul_sat(dv.d, ds.q, 18);
    r->cross_q16 += weighted(q_add_sat(vd_sq, vq_sd), share_q30[k]);
    r->curl_q16 += weighted(q_sub_sat(vd_sq, vq_sd), share_q30[k]);
  }
  if (r->spread_q8 >= SPREAD_MIN_Q8) r->information = q_mul_sat(r->spread_q8, weight, 8);
}

static void measure(avv_t* s, const estimator_input_t* in) {
  deviation_t d[ESTIMATOR_WINDOWS];
  int32_t share_q30[ESTIMATOR_WINDOWS];
  int32_t total = 0;
  for (uint16_t k = 0; k < in->window_count; k++) {
    d[k] = deviation_evaluate(in->model, &in->windows[k], s->observer.angle_bam, s->observer.speed_bpp);
    total += weight_of(&in->windows[k]);
  }
  const int32_t per_weight_q30 = (total > 0) ? q_div(1, total, 30) : 0;
  for (uint16_t k = 0; k < in->window_count; k++) share_q30[k] = weight_of(&in->windows[k]) * per_weight_q30;
  regress(d, share_q30, in->window_count, total, &s->regression);
}

// Half the angle of (1/2 dY spread + mirror, cross): eq (41) in the observed frame.
static int32_t angle_error(const avv_regression_t* r, const machine_model_t* m) {
  const int32_t saliency_q16 = q_mul_sat((m->yd_q30 - m->yq_q30) / 2, r->spread_q8, 22);
  return (int32_t)q_atan2(r->cross_q16, q_add_sat(saliency_q16, r->mirror_q16)) / 2;
}

// Information in powers of two, with two bits of fraction.
static int32_t log2_q2(int32_t x) {
  int32_t whole = 0;
  int32_t rest = x;
  while (rest >= 8) {
    rest = q_shr(rest, 1);
    whole++;
  }
  return (whole + 2) * 4 + (rest - 4);
}

static int32_t bandwidth_q30(const avv_config_t* c, int32_t information) {
  const int32_t above = q_clamp(log2_q2(information) - 4 * SHORT_LOG2, 0, 4 * (LONG_LOG2 - SHORT_LOG2));
  return c->bandwidth_short_q30 +
         (c->bandwidth_long_q30 - c->bandwidth_short_q30) / (4 * (LONG_LOG2 - SHORT_LOG2)) * above;
}

estimator_output_t avv_step(avv_t* s, const avv_config_t* c, const estimator_input_t* in) {
  tracking_observer_predict(&s->observer, in->torque_accel_q8);
  measure(s, in);
  if (s->regression.information > 0) {
    s->error_bam = angle_error(&s->regression, in->model);
    tracking_observer_correct(&s->observer, s->error_bam, bandwidth_q30(c, s->regression.information));
  }
  const estimator_output_t out = {s->observer.angle_bam, s->observer.speed_bpp, s->observer.load_accel_q8,
                                  (s->regression.information > 0) ? 32767 : 0};
  return out;
}
