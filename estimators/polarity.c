#include "estimators/polarity.h"

#define HALF (POLARITY_SEGMENT / 2)

// Sign of the current and weight of the angle in the segments of a pattern.
static const int16_t drive_sign[POLARITY_SEGMENTS] = {0, 1, -1, 0, -1, 1, 0};
static const int16_t angle_weight[POLARITY_SEGMENTS] = {-1, 0, 0, 2, 0, 0, -1};

void polarity_begin(polarity_t* s, uint32_t angle_bam, int32_t current_q20, int32_t accel_q8) {
  s->tick = 0;
  s->current_q20 = current_q20;
  // Two patterns, each with an excursion of accel * n^2.
  s->expected_bam = q_mul_sat(accel_q8, (int32_t)POLARITY_SEGMENT * POLARITY_SEGMENT * 2, 8);
  s->response_bam = 0;
  s->origin_bam = angle_bam;
  s->result = POLARITY_PENDING;
}

static polarity_result_t judge(const polarity_t* s) {
  const int32_t threshold = q_max(s->expected_bam / 4, 1);
  if (s->response_bam >= threshold) return POLARITY_RIGHT;
  return (s->response_bam <= -threshold) ? POLARITY_WRONG : POLARITY_AMBIGUOUS;
}

int32_t polarity_step(polarity_t* s, uint32_t angle_bam) {
  if (s->tick >= POLARITY_LENGTH) return 0;
  const int16_t segment = (int16_t)((s->tick / POLARITY_SEGMENT) % POLARITY_SEGMENTS);
  const int16_t sign = (s->tick < POLARITY_LENGTH / 2) ? 1 : -1;
  // Only the second half of a pause counts: the current has died away.
  if (s->tick % POLARITY_SEGMENT >= HALF) {
    const int32_t moved = angle_diff_bam(angle_bam, s->origin_bam) / (2 * HALF);
    s->response_bam = q_add_sat(s->response_bam, sign * angle_weight[segment] * moved);
  }
  const int32_t current = sign * drive_sign[segment] * s->current_q20;
  s->tick++;
  if (s->tick == POLARITY_LENGTH) s->result = judge(s);
  return current;
}
