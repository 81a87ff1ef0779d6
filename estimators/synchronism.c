#include "estimators/synchronism.h"

#include "estimators/deviation.h"

#define MEAN_SHIFT 2
#define DOUBT_PER_BAD 8L  // a good period takes back an eighth of what a bad one adds
#define APART_LIMIT_BAM 1073741824L

void synchronism_reset(synchronism_t* s) {
  static const synchronism_t fresh = {{0, 0}, 0, 0};
  *s = fresh;
}

static void add(ab_t* sum, ab_t x, int32_t share_q30) {
  sum->alpha += q_mul(x.alpha, share_q30, 30);
  sum->beta += q_mul(x.beta, share_q30, 30);
}

// All windows as one, weighted with their spans: every difference of two bursts carries the same noise.
static bool mean_window(const estimator_input_t* in, estimator_window_t* mean) {
  const ab_t none = {0, 0};
  int32_t total = 0;
  int32_t middle_q30 = 0;
  for (uint16_t k = 0; k < in->window_count; k++) total += in->windows[k].span_ticks;
  if (total <= 0) return false;
  const int32_t per_tick_q30 = q_div(1, total, 30);
  mean->slope_q20 = none;
  mean->current_q20 = none;
  mean->voltage_q16 = none;
  for (uint16_t k = 0; k < in->window_count; k++) {
    const estimator_window_t* const w = &in->windows[k];
    const int32_t share_q30 = w->span_ticks * per_tick_q30;
    add(&mean->slope_q20, w->slope_q20, share_q30);
    add(&mean->current_q20, w->current_q20, share_q30);
    add(&mean->voltage_q16, w->voltage_q16, share_q30);
    middle_q30 += q_mul(share_q30, w->middle_tick, 15);
  }
  mean->middle_tick = (int16_t)q_shr(middle_q30, 15);
  mean->span_ticks = (int16_t)q_min(total, PERIOD_TICKS);
  mean->zero_vector = false;
  return true;
}

// L/T, V per (A per period), Q16.
static int32_t volts_per_slope_q16(const machine_model_t* m, int32_t inductance_q30) {
  return q_mul_sat(inductance_q30, m->periods_per_second, 14);
}

static void follow(int32_t* mean, int32_t x) { *mean += q_shr_round(q_sub_sat(x, *mean), MEAN_SHIFT); }

static void watch_emf(synchronism_t* s, const synchronism_config_t* c, const machine_model_t* m, const deviation_t* d) {
  follow(&s->error_q16.d, q_mul_sat(d->residual_q20.d, volts_per_slope_q16(m, m->ld_q30), 20));
  follow(&s->error_q16.q, q_mul_sat(d->residual_q20.q, volts_per_slope_q16(m, m->lq_q30), 20));
  const int32_t emf_q16 = q_abs_sat(q_mul_sat(m->emf_q16, d->w_q30, 30));
  s->limit_q16 = q_add_sat(c->floor_q16, q_mul(emf_q16, c->share_q15, 15));
}

bool synchronism_step(synchronism_t* s, const synchronism_config_t* c, const estimator_input_t* in, uint32_t angle_bam,
                      int32_t speed_bpp, int32_t apart_bam) {
  estimator_window_t mean;
  if (!mean_window(in, &mean)) return false;
  const deviation_t d = deviation_evaluate(in->model, &mean, angle_bam, speed_bpp);
  watch_emf(s, c, in->model, &d);
  const bool bad = q_hypot(s->error_q16.d, s->error_q16.q) > s->limit_q16 || q_abs_sat(apart_bam) > APART_LIMIT_BAM;
  s->doubt = bad ? s->doubt + DOUBT_PER_BAD : q_max(s->doubt - 1, 0);
  return s->doubt > c->bad_periods * DOUBT_PER_BAD;
}
