#include "estimators/polarity.h"

#include "hal/qmath/qcall.h"

#define HALF (POLARITY_SEGMENT / 2)
#define PAUSES 6
#define PASSES_MAX 6
#define SIGMA_MIN_Q8 (4L * 256L)
#define RESPONSE_MAX 32  // quarters of what was expected

// Sign of the current and weight of the angle in the segments of a pattern.
static const int16_t drive_sign[POLARITY_SEGMENTS] = {0, 1, -1, 0, -1, 1, 0};
static const int16_t angle_weight[POLARITY_SEGMENTS] = {-1, 0, 0, 2, 0, 0, -1};

void polarity_begin(polarity_t* s, uint32_t angle_bam, int32_t current_q20, int32_t accel_q8) {
  s->passes = 0;
  s->current_q20 = current_q20;
  // Two patterns, each with an excursion of accel * n^2.
  s->expected_bam = qc_mul_sat(accel_q8, (int32_t)POLARITY_SEGMENT * POLARITY_SEGMENT * 2, 8);
  s->response_bam = 0;
  s->rough_bam = 0;
  s->sigma_q8 = 0;
  s->bounded = false;
  polarity_again(s, angle_bam);
}

void polarity_again(polarity_t* s, uint32_t angle_bam) {
  s->tick = 0;
  s->passes = q_min16((int16_t)(s->passes + 1), PASSES_MAX);
  s->last_bam = angle_bam;
  s->origin_bam = angle_bam;
  s->result = POLARITY_PENDING;
}

// Standard error of the response, the mean of all passes. Neighbouring angles differ by 1.13 sigma in the mean; the
// weights 1, 2, 1 of two patterns over means of HALF angles, halved, leave 0.39 sigma of it: 0.34 times the mean
// difference.
static int32_t error_bam(const polarity_t* s) {
  static const int16_t per_root_q14[PASSES_MAX] = {16384, 11585, 9459, 8192, 7327, 6689};
  const int32_t rough = s->rough_bam / (PAUSES * (HALF - 1) * s->passes);
  return qc_mul_sat(qc_mul_sat(rough, 89129L, 10), per_root_q14[s->passes - 1], 14);  // 2^-8 back to one, times 0.34
}

static polarity_result_t judge(polarity_t* s) {
  const int32_t threshold = q_max(s->expected_bam / 4, 1);
  const int32_t response = s->response_bam / s->passes;
  s->sigma_q8 = q_div(qc_abs_sat(response), q_max(error_bam(s), 1), 8);
  if (s->sigma_q8 < SIGMA_MIN_Q8) return POLARITY_AMBIGUOUS;
  if (s->bounded && qc_abs_sat(response) / RESPONSE_MAX >= threshold) return POLARITY_AMBIGUOUS;
  if (response >= threshold) return POLARITY_RIGHT;
  return (response <= -threshold) ? POLARITY_WRONG : POLARITY_AMBIGUOUS;
}

static void look_at_scatter(polarity_t* s, uint32_t angle_bam) {
  if (s->tick % POLARITY_SEGMENT == HALF) return;  // no neighbour inside this pause
  s->rough_bam = qc_add_sat(s->rough_bam, q_shr(qc_abs_sat(angle_diff_bam(angle_bam, s->last_bam)), 8));
}

int32_t polarity_step(polarity_t* s, uint32_t angle_bam) {
  if (s->tick >= POLARITY_LENGTH) return 0;
  const int16_t segment = (int16_t)((s->tick / POLARITY_SEGMENT) % POLARITY_SEGMENTS);
  const int16_t sign = (s->tick < POLARITY_LENGTH / 2) ? 1 : -1;
  // Only the second half of a pause counts: the current has died away.
  if (s->tick % POLARITY_SEGMENT >= HALF) {
    const int32_t moved = angle_diff_bam(angle_bam, s->origin_bam) / (2 * HALF);
    s->response_bam = qc_add_sat(s->response_bam, sign * angle_weight[segment] * moved);
    if (angle_weight[segment] != 0) look_at_scatter(s, angle_bam);
  }
  s->last_bam = angle_bam;
  const int32_t current = sign * drive_sign[segment] * s->current_q20;
  s->tick++;
  if (s->tick == POLARITY_LENGTH) s->result = judge(s);
  return current;
}
