#include "estimators/saturation.h"

#include "hal/qmath/qcall.h"

#define RELATIVE_MAX_Q30 536870912L  // no inductance is taken to change by more than half
#define FLOOR_SHARE 650              // of the mean inverse inductance: 0.15 %
#define PASSES_MAX 8
#define STEP_END_Q30 268435456L  // between two rounds, 0.25 A per V and period: the squares of 8 passes fit
#define SCORE_MIN_Q15 11469L     // 0.35
#define SCORE_MAX_Q15 \
  65536L  // 2: at 40 V on motor A, where the current hardly follows, a wrong answer had 3.0 at 5.1 standard errors
#define ROUNDS_A_SIDE (SATURATION_ROUNDS * SATURATION_SEGMENTS / 2)
#define DIFFERENCES (SATURATION_SEGMENTS * (SATURATION_ROUNDS - 1))
#define PER_ROOT_Q32 277238947uL  // 1 / sqrt(DIFFERENCES * ROUNDS_A_SIDE)
#if DIFFERENCES * ROUNDS_A_SIDE != 240
#error "PER_ROOT_Q32 is that of 240"
#endif

static const int16_t segment_sign[SATURATION_SEGMENTS] = {1, -1, -1, 1};

// Change of an inverse inductance from -I to +I: -2 I slope y.
static int32_t expected_change(int32_t y_q30, int32_t slope_q30, int32_t current_q20) {
  const int32_t relative_q30 = q_clamp(qc_mul_sat(slope_q30, 2 * current_q20, 20), -RELATIVE_MAX_Q30, RELATIVE_MAX_Q30);
  return -qc_mul(y_q30, relative_q30, 30);
}

static dq_t expected(const machine_model_t* m, const saturation_slopes_t* slopes, int32_t current_q20) {
  const dq_t y_q30 = {expected_change(m->yd_q30, slopes->d_q30, current_q20),
                      expected_change(m->yq_q30, slopes->q_q30, current_q20)};
  return y_q30;
}

static int32_t floor_of(const machine_model_t* m) { return (m->yd_q30 / 2 + m->yq_q30 / 2) / FLOOR_SHARE; }

bool saturation_is_visible(const machine_model_t* m, const saturation_slopes_t* slopes, int32_t current_q20) {
  const dq_t change = expected(m, slopes, current_q20);
  return q_hypot(change.d, change.q) > 3 * SATURATION_SIGMA_MIN / 2 * floor_of(m);
}

void saturation_begin(saturation_t* s, const machine_model_t* m, const saturation_slopes_t* slopes,
                      int32_t current_q20) {
  const dq_t change = expected(m, slopes, current_q20);
  static const saturation_t fresh = {0};
  *s = fresh;
  s->current_q20 = current_q20;
  s->expected_q30 = q_hypot(change.d, change.q);
  s->unit_d_q30 = q_div(change.d, s->expected_q30, 30);
  s->unit_q_q30 = q_div(change.q, s->expected_q30, 30);
  s->floor_q30 = floor_of(m);
  s->passes = 1;
  s->result = POLARITY_PENDING;
}

void saturation_again(saturation_t* s) {
  s->tick = 0;
  s->passes = q_min16((int16_t)(s->passes + 1), PASSES_MAX);
  s->result = POLARITY_PENDING;
}

// What the period says about the inverse inductances, projected on the expected change.
static int32_t projected_q30(const saturation_t* s, const regression_t* r, const machine_model_t* m) {
  const int32_t yd_q30 = qc_add_sat(m->yd_q30, q_div(qc_add_sat(r->along_q16, r->mirror_q16), r->spread_q8, 22));
  const int32_t yq_q30 = qc_add_sat(m->yq_q30, q_div(qc_sub_sat(r->along_q16, r->mirror_q16), r->spread_q8, 22));
  return qc_add_sat(qc_mul_sat(yd_q30, s->unit_d_q30, 30), qc_mul_sat(yq_q30, s->unit_q_q30, 30));
}

static void judge(saturation_t* s) {
  const int32_t passes = s->passes;
  const int32_t change = s->change_q30 / passes;
  // A difference of two rounds has twice the variance of one; the change is that of two means of ROUNDS_A_SIDE rounds.
  const uint32_t deviation = q_umul_hi(q_sqrt64(s->scatter), PER_ROOT_Q32) / (uint32_t)passes;
  const int32_t error = q_hypot((int32_t)deviation, s->floor_q30);
  s->score_q15 = q_div(change, s->expected_q30, 15);
  s->sigma_q8 = q_div(qc_abs_sat(change), q_max(error, 1), 8);
  const int32_t size = qc_abs_sat(s->score_q15);
  const bool clear = size > SCORE_MIN_Q15 && size < SCORE_MAX_Q15 && s->sigma_q8 >= SATURATION_SIGMA_MIN * 256L;
  s->result = !clear ? POLARITY_AMBIGUOUS : (change > 0) ? POLARITY_RIGHT : POLARITY_WRONG;
}

static void end_round(saturation_t* s, int16_t round, int32_t sign) {
  const int32_t mean = s->round_q30;
  if (round > 0) {
    const int32_t step = q_limit(qc_sub_sat(mean, s->last_q30), STEP_END_Q30);
    s->scatter += (uint64_t)q_product(step, step);
  }
  s->last_q30 = mean;
  s->round_q30 = 0;
  s->change_q30 = qc_add_sat(s->change_q30, sign * (mean / ROUNDS_A_SIDE));
}

int32_t saturation_resistance_q24(const saturation_t* s, const machine_model_t* m) {
  if (s->missing_count == 0) return 0;
  const int32_t volts_q16 = q_div(s->missing_q20 / s->missing_count, m->yd_q30, 26);
  return q_neg_sat(q_div(volts_q16, s->current_q20, 28));
}

// Sums over all passes, at most 8 of 144 periods.
static void add_missing(saturation_t* s, const regression_t* r, int32_t sign) {
  if (r->information <= 0) return;
  s->missing_q20 = qc_add_sat(s->missing_q20, sign * r->mean_q20.d);
  s->missing_count++;
}

int32_t saturation_step(saturation_t* s, const regression_t* r, const machine_model_t* m) {
  if (s->tick >= SATURATION_LENGTH) return 0;
  const int16_t segment = s->tick / SATURATION_SEGMENT;
  const int16_t inside = (int16_t)(s->tick % SATURATION_SEGMENT - SATURATION_SETTLE);
  const int32_t sign = segment_sign[segment];
  const int32_t slew = s->current_q20 / 20;  // a jump would leave the alternating layout
  s->reference_q20 = q_clamp(sign * s->current_q20, s->reference_q20 - slew, s->reference_q20 + slew);
  if (inside >= 0) {
    add_missing(s, r, sign);
    // Shares of the mean and not a sum: the inverse inductances of a machine with little inductance fill the format.
    s->round_q30 += ((r->information > 0) ? projected_q30(s, r, m) : s->last_q30) / SATURATION_ROUND;
    if (inside % SATURATION_ROUND == SATURATION_ROUND - 1) end_round(s, (int16_t)(inside / SATURATION_ROUND), sign);
  }
  s->tick++;
  if (s->tick == SATURATION_LENGTH) judge(s);
  return s->reference_q20;
}
