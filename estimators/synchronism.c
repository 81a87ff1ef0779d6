#include "estimators/synchronism.h"

#include "estimators/deviation.h"
#include "estimators/window_sum.h"
#include "hal/qmath/qcall.h"

#define DEBOUNCE_PER_BAD 8     // a good period takes back an eighth of what a bad one adds
#define DEBOUNCE_END 1048576L  // far beyond any fault, and as many periods of it stay in 31 bits
#define SQUARE_SHIFT 22u
#define LAG 4  // ms that a speed may be known late
#define LIMIT_MAX 32768000L
#define TURNS_END_Q16 21361414L  // 2048 V
#define HALF_PI_Q30 1686629713L
#define APART_LIMIT_BAM 1073741824L
#define ONE_Q30 1073741824L
#define ONE_Q24 16777216L
#define LONG_TICKS 5000L  // windows of this length together: the floor is meant for them
#define RATIO_END_Q8 46340L
#define CHANGE_END_Q19 268435456L   // 512 A
#define CURRENT_BITS 29u            // 512 A
#define VOLTAGE_BITS 30u            // 2048 V
#define VOLTAGE_END_Q19 702545920L  // 1340 V: two thirds of a link of 2000 V, and the devices' drops

void synchronism_reset(synchronism_t* s) {
  static const synchronism_t fresh = {{0, 0}, 0, 0, 0, 0};
  *s = fresh;
}

static void add(window_sum_t* sum, ab_t x, int32_t share_q30) { window_sum_add(sum, x.alpha, x.beta, share_q30); }

static ab_t mean_of(const window_sum_t* sum, unsigned bits) {
  const ab_t mean = {window_sum_mean(sum->x, bits), window_sum_mean(sum->y, bits)};
  return mean;
}

static ab_t within(ab_t x, int32_t end) {
  const ab_t limited = {q_limit(x.alpha, end), q_limit(x.beta, end)};
  return limited;
}

// All windows as one, weighted with their spans, so that a net voltage of unequal windows stays small: the inductances
// of a saturated machine are not those of the model. One loop after the other, so that each has few numbers of its own.
void synchronism_look(synchronism_seen_t* seen, const machine_model_t* m, const estimator_window_t windows[],
                      uint16_t count, uint32_t angle_bam) {
  estimator_window_t mean = {{0, 0}, {0, 0}, {0, 0}, 0, 0, false};
  int32_t share_q30[ESTIMATOR_WINDOWS];
  window_sum_t current = {0, 0};
  window_sum_t voltage = {0, 0};
  int32_t total = 0;
  int32_t middle_q15 = 0;
  for (uint16_t k = 0; k < count; k++) total += windows[k].span_ticks;
  seen->span_ticks = q_min(total, PERIOD_TICKS);
  if (total <= 0) return;
  const int32_t per_tick_q30 = ONE_Q30 / total;
  for (uint16_t k = 0; k < count; k++) {
    share_q30[k] = q_share_q30(windows[k].span_ticks, per_tick_q30);
    middle_q15 += q_shr(share_q30[k], 15) * windows[k].middle_tick;
  }
  mean.span_ticks = (int16_t)seen->span_ticks;
  mean.middle_tick = (int16_t)q_clamp(q_shr(middle_q15, 15), 0, PERIOD_TICKS);
  for (uint16_t k = 0; k < count; k++) {
    mean.change_q19.alpha += windows[k].change_q19.alpha;
    mean.change_q19.beta += windows[k].change_q19.beta;
    add(&current, windows[k].current_q20, share_q30[k]);
  }
  mean.change_q19 = within(mean.change_q19, CHANGE_END_Q19);
  mean.current_q20 = mean_of(&current, CURRENT_BITS);
  for (uint16_t k = 0; k < count; k++) add(&voltage, windows[k].voltage_q19, share_q30[k]);
  mean.voltage_q19 = within(mean_of(&voltage, VOLTAGE_BITS), VOLTAGE_END_Q19);
  seen->residual_q20 = deviation_evaluate(m, &mean, angle_bam, seen->speed_bpp).residual_q20;
}

// Of numbers below 2^30.
static void follow(int32_t* mean, int32_t x, unsigned shift) { *mean += q_shr(x - *mean, shift); }

// A code of the converter is an EMF error that grows as the windows get shorter, and so does the share of them in which
// a current is clamped at zero: hence the square.
static int32_t floor_q16(const synchronism_config_t* c, int32_t span_ticks) {
  const int32_t ratio_q8 = q_clamp(LONG_TICKS * 256 / span_ticks, 256, RATIO_END_Q8);
  return q_sat64(q_shr64(q_product(c->floor_q16, ratio_q8 * ratio_q8), 16));
}

static int32_t magnitude(int32_t x) { return (x > 0) ? x : -x; }

// A speed that is known late follows: then it changes against the error. One that is lost goes anywhere.
static int32_t lag_q16(int32_t change_q16, int32_t error_q16) {
  if ((change_q16 ^ error_q16) >= 0) return 0;  // of one sign
  return LAG * magnitude(change_q16);
}

// What the speed has changed since its mean is what it changes in a millisecond.
static void follow_limit(synchronism_t* s, const synchronism_config_t* c, const machine_model_t* m,
                         const synchronism_seen_t* seen, int32_t error_q16, unsigned shift) {
  const int32_t turns_q16 = q_limit(q_mul_hi(m->emf_q16, seen->speed_bpp), TURNS_END_Q16);
  const int32_t emf_q16 = q_shr(q_mul_hi(turns_q16 * 32, HALF_PI_Q30), 1);  // 2 pi times as much
  const int32_t moved_q16 =
      q_mul_floor(magnitude(emf_q16), c->share_q15, 15) + lag_q16(emf_q16 - s->emf_q16, error_q16);
  follow(&s->emf_q16, emf_q16, shift);
  s->limit_q16 = q_clamp(q_min(floor_q16(c, seen->span_ticks), LIMIT_MAX) + moved_q16, 0, LIMIT_MAX);
}

// What is far beyond the limit counts as half as much again: so it takes a while to get there, and no longer to come
// back. What the frame turns besides comes in V per rad, Q16, and turns: 2 pi is 25/4.
static void follow_errors(synchronism_t* s, dq_t error_q16, int32_t turned, unsigned shift) {
  const int32_t most_q16 = s->limit_q16 + s->limit_q16 / 2;
  const int32_t q_q16 = q_limit(error_q16.q, most_q16);
  const int32_t besides_q16 = q_shr(q_limit(turned, most_q16) * 25, 2);
  follow(&s->error_q16.d, q_limit(error_q16.d, most_q16), shift);
  follow(&s->error_q16.q, q_q16, shift);
  follow(&s->turned_q16, q_limit(q_q16 + besides_q16, most_q16), shift);
}

// What a period adds: 8 e^2 / limit^2 with the larger of the two errors along q, nothing up to the limit.
static int32_t debounce_per_period(const synchronism_t* s) {
  const int32_t q_q16 = q_max(magnitude(s->error_q16.q), magnitude(s->turned_q16));
  const int32_t error = q_mul_add_floor(s->error_q16.d, s->error_q16.d, q_q16, q_q16, SQUARE_SHIFT);
  const int32_t limit = q_mul_floor(s->limit_q16, s->limit_q16, SQUARE_SHIFT);
  return (error > limit) ? DEBOUNCE_PER_BAD + q_min((error - limit) / (limit / DEBOUNCE_PER_BAD + 1), DEBOUNCE_END) : 0;
}

bool synchronism_judge(synchronism_t* s, const synchronism_config_t* c, const machine_model_t* m,
                       const synchronism_seen_t* seen, int32_t apart_bam) {
  if (seen->span_ticks <= 0) return false;
  // A quarter of one period, half of several: these are a millisecond's mean, in which the steps of the current repeat.
  const unsigned shift = (seen->periods > 2) ? 1u : 2u;
  // 1 - K_qd is yq/yd but for the square of the tilt.
  const dq_t error_q16 = {q_mul_sat(qc_over(seen->residual_q20.d, m->per_yq, 26), ONE_Q24 - m->k_qd_q24, 24),
                          qc_over(seen->residual_q20.q, m->per_yq, 26)};
  follow_limit(s, c, m, seen, error_q16.q, shift);
  follow_errors(s, error_q16, q_mul_hi(m->emf_q16, seen->ahead_bpp), shift);
  int32_t per_period = debounce_per_period(s);
  if (q_limit(apart_bam, APART_LIMIT_BAM) != apart_bam) per_period = q_max(per_period, DEBOUNCE_PER_BAD);
  s->debounce = (per_period > 0) ? s->debounce + per_period * seen->periods : q_max(s->debounce - seen->periods, 0);
  return s->debounce > c->bad_periods * DEBOUNCE_PER_BAD;
}
