#include "estimators/slopes.h"

#define CHANGE_Q15 ((int32_t)32768)               // 4095 codes of 4 and 4 conversions stay in 31 bits,
#define PER_COUNT_END_Q36 ((int32_t)1073741824L)  // 0.125 A per code, eight products of samples
#define SUM_Q13 ((int32_t)8192)                   // and those of both bursts

void slopes_design(slopes_config_t* c) {
  const int32_t n = c->start_samples * c->end_samples;
  c->amps_per_count_q36 = q_min(q_div(c->amps_per_code_q30, n, 6), PER_COUNT_END_Q36);
}

// Gain and Clarke together: alpha is phase a, beta = (a + 2 b) / sqrt(3).
slopes_scale_t slopes_scale(const slopes_config_t* c, const slopes_trim_t* trim) {
  const int32_t n = c->start_samples * c->end_samples;
  const int32_t half_q36 = q_mul_floor(c->amps_per_count_q36, trim->mismatch_q30, 30);
  const int32_t gain_a_q36 = c->amps_per_count_q36 - half_q36;
  const int32_t gain_b_q36 = c->amps_per_count_q36 + half_q36;
  const slopes_scale_t scale = {gain_a_q36,
                                q_mul_floor(gain_a_q36, FRAME_SQRT3_INV_Q30, 30),
                                q_mul_floor(gain_b_q36, FRAME_SQRT3_INV_Q30, 29),
                                trim->offset_a_q8 * (2 * n * (SUM_Q13 / 256)),
                                trim->offset_b_q8 * (2 * n * (SUM_Q13 / 256)),
                                c->start_samples,
                                c->end_samples};
  return scale;
}

// Upper words of the products: counts Q15 make amperes Q19, counts Q13 Q17.
static int32_t alpha_of(const slopes_scale_t* c, int32_t a) { return q_mul_hi(a, c->alpha_a_q36); }
static int32_t beta_of(const slopes_scale_t* c, int32_t a, int32_t b) {
  return q_mul_hi(a, c->beta_a_q36) + q_mul_hi(b, c->beta_b_q36);
}

void slopes_evaluate(const slopes_scale_t* c, const slopes_sums_t* sums, estimator_window_t* w) {
  const int32_t start_a = (int32_t)sums->start_a * c->end_samples;
  const int32_t start_b = (int32_t)sums->start_b * c->end_samples;
  const int32_t end_a = (int32_t)sums->end_a * c->start_samples;
  const int32_t end_b = (int32_t)sums->end_b * c->start_samples;
  const int32_t change_a_q15 = (end_a - start_a) * CHANGE_Q15;
  const int32_t change_b_q15 = (end_b - start_b) * CHANGE_Q15;
  const int32_t sum_a_q13 = (end_a + start_a) * SUM_Q13 - c->offset_a_q13;
  const int32_t sum_b_q13 = (end_b + start_b) * SUM_Q13 - c->offset_b_q13;
  w->change_q19.alpha = alpha_of(c, change_a_q15);
  w->change_q19.beta = beta_of(c, change_a_q15, change_b_q15);
  // Both bursts together are twice the current: Q17 of the sum is Q18 of it.
  w->current_q20.alpha = alpha_of(c, sum_a_q13) * 4;
  w->current_q20.beta = beta_of(c, sum_a_q13, sum_b_q13) * 4;
}
