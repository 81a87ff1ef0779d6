#include "estimators/slopes.h"

#define PERIOD_Q17 ((int32_t)1310720000L)  // ESTIMATOR_PERIOD_TICKS

void slopes_evaluate(const slopes_config_t* c, const slopes_trim_t* trim, const slopes_sums_t* sums,
                     estimator_window_t* w) {
  // Whole codes times both numbers of conversions, so that nothing is divided: of the change Q0, of the middle Q9.
  const int32_t n = c->start_samples * c->end_samples;
  const int32_t start_a = (int32_t)sums->start_a * c->end_samples;
  const int32_t start_b = (int32_t)sums->start_b * c->end_samples;
  const int32_t end_a = (int32_t)sums->end_a * c->start_samples;
  const int32_t end_b = (int32_t)sums->end_b * c->start_samples;
  const int32_t per_code_q30 = c->amps_per_code_q30 / n;
  const int32_t half_q30 = q_mul(per_code_q30, trim->mismatch_q30, 30);
  const int32_t gain_a = per_code_q30 - half_q30;
  const int32_t gain_b = per_code_q30 + half_q30;
  const int32_t per_period_q17 = (PERIOD_Q17 + w->span_ticks / 2) / w->span_ticks;
  const int32_t change_a = q_mul((end_a - start_a) * 256, gain_a, 18);
  const int32_t change_b = q_mul((end_b - start_b) * 256, gain_b, 18);
  const ab_t change_q20 = frame_clarke2(change_a, change_b);
  w->slope_q20.alpha = q_mul_sat(change_q20.alpha, per_period_q17, 17);
  w->slope_q20.beta = q_mul_sat(change_q20.beta, per_period_q17, 17);
  const int32_t middle_a_q9 = (start_a + end_a) * 256 - 2 * n * trim->offset_a_q8;
  const int32_t middle_b_q9 = (start_b + end_b) * 256 - 2 * n * trim->offset_b_q8;
  w->current_q20 = frame_clarke2(q_mul(middle_a_q9, gain_a, 19), q_mul(middle_b_q9, gain_b, 19));
}
