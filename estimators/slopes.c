#include "estimators/slopes.h"

#define PERIOD_Q17 ((int32_t)1310720000L)  // ESTIMATOR_PERIOD_TICKS
#define COUNT_Q14 ((int32_t)16384)         // 4095 codes of 4 and 4 conversions stay in 31 bits

void slopes_design(slopes_config_t* c) {
  const int32_t n = c->start_samples * c->end_samples;
  c->amps_per_count_q36 = q_div(c->amps_per_code_q30, n, 6);
}

slopes_scale_t slopes_scale(const slopes_config_t* c, const slopes_trim_t* trim) {
  const int32_t n = c->start_samples * c->end_samples;
  const int32_t half_q36 = q_mul_floor(c->amps_per_count_q36, trim->mismatch_q30, 30);
  const slopes_scale_t scale = {c->amps_per_count_q36 - half_q36,
                                c->amps_per_count_q36 + half_q36,
                                trim->offset_a_q8 * (2 * n * (COUNT_Q14 / 2 / 256)),
                                trim->offset_b_q8 * (2 * n * (COUNT_Q14 / 2 / 256)),
                                c->start_samples,
                                c->end_samples};
  return scale;
}

void slopes_evaluate(const slopes_scale_t* c, const slopes_sums_t* sums, estimator_window_t* w) {
  const int32_t start_a = (int32_t)sums->start_a * c->end_samples;
  const int32_t start_b = (int32_t)sums->start_b * c->end_samples;
  const int32_t end_a = (int32_t)sums->end_a * c->start_samples;
  const int32_t end_b = (int32_t)sums->end_b * c->start_samples;
  const int32_t per_period_q17 = (PERIOD_Q17 + w->span_ticks / 2) / w->span_ticks;
  const int32_t change_a_q20 = q_mul_floor((end_a - start_a) * COUNT_Q14, c->gain_a_q36, 30);
  const int32_t change_b_q20 = q_mul_floor((end_b - start_b) * COUNT_Q14, c->gain_b_q36, 30);
  // The upper word of the product: the sum of both bursts as counts Q13 makes a current Q18.
  const int32_t middle_a_q18 = q_mul_hi((start_a + end_a) * (COUNT_Q14 / 2) - c->offset_a_q14, c->gain_a_q36);
  const int32_t middle_b_q18 = q_mul_hi((start_b + end_b) * (COUNT_Q14 / 2) - c->offset_b_q14, c->gain_b_q36);
  const ab_t change_q20 = frame_clarke2(change_a_q20, change_b_q20);
  w->slope_q20.alpha = q_mul_sat(change_q20.alpha, per_period_q17, 17);
  w->slope_q20.beta = q_mul_sat(change_q20.beta, per_period_q17, 17);
  w->current_q20 = frame_clarke2(middle_a_q18 * 4, middle_b_q18 * 4);
}
