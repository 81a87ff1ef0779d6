#include "estimators/slopes.h"

#define PERIOD_Q17 ((int32_t)1310720000L)  // ESTIMATOR_PERIOD_TICKS

// 1 / n, Q30, rounded up: a sum's mean comes out as the division has it, cut off.
static const int32_t per_samples_q30[5] = {0, 1073741824L, 536870912L, 357913942L, 268435456L};

// Mean code of a sum, Q8.
static int32_t mean_q8(uint16_t sum, int16_t samples) {
  return (int32_t)q_shr64((int64_t)((int32_t)sum * 256) * per_samples_q30[samples], 30);
}

void slopes_evaluate(const slopes_config_t* c, const slopes_trim_t* trim, const slopes_sums_t* sums,
                     estimator_window_t* w) {
  const int32_t start_a = mean_q8(sums->start_a, c->start_samples);
  const int32_t start_b = mean_q8(sums->start_b, c->start_samples);
  const int32_t end_a = mean_q8(sums->end_a, c->end_samples);
  const int32_t end_b = mean_q8(sums->end_b, c->end_samples);
  const int32_t half_q30 = q_mul(c->amps_per_code_q30, trim->mismatch_q30, 30);
  const int32_t gain_a = c->amps_per_code_q30 - half_q30;
  const int32_t gain_b = c->amps_per_code_q30 + half_q30;
  // Codes (Q8) to A (Q20) is a factor amps_per_code (Q30) >> 18.
  const int32_t per_period_q17 = (PERIOD_Q17 + w->span_ticks / 2) / w->span_ticks;
  const ab_t change_q20 = frame_clarke2(q_mul(end_a - start_a, gain_a, 18), q_mul(end_b - start_b, gain_b, 18));
  w->slope_q20.alpha = q_mul_sat(change_q20.alpha, per_period_q17, 17);
  w->slope_q20.beta = q_mul_sat(change_q20.beta, per_period_q17, 17);
  w->current_q20 = frame_clarke2(q_mul((start_a + end_a) / 2 - trim->offset_a_q8, gain_a, 18),
                                 q_mul((start_b + end_b) / 2 - trim->offset_b_q8, gain_b, 18));
}
