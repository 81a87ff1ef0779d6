#include "estimators/polarity.h"

#include "hal/qmath/qcall.h"

#define PAUSES 6
#define PASSES_MAX 6
#define TENS_MAX 12
#define SIGMA_MIN_Q8 (4L * 256L)
#define RESPONSE_MAX 32          // quarters of what was expected
#define ACCEL_MOST_Q8 19088743L  // 10 degrees in 40 periods; beyond that the current is visibly off the true q-axis
#define ACCEL_LEAST_Q8 2863311L  // 1.5 degrees in 40 periods

// Sign of the current and weight of the angle in the segments of a pattern.
static const int16_t drive_sign[POLARITY_SEGMENTS] = {0, 1, -1, 0, -1, 1, 0};
static const int16_t angle_weight[POLARITY_SEGMENTS] = {-1, 0, 0, 2, 0, 0, -1};

// Accelerated for n periods and braked for n more the shaft turns by accel n^2.
static int16_t length_for(int32_t accel_q8) {
  if (accel_q8 > ACCEL_MOST_Q8) return POLARITY_SEGMENT / 2;
  if (accel_q8 > ACCEL_LEAST_Q8) return POLARITY_SEGMENT;
  return (accel_q8 > ACCEL_LEAST_Q8 / 4) ? 2 * POLARITY_SEGMENT : 4 * POLARITY_SEGMENT;
}

void polarity_begin(polarity_t* s, int32_t current_q20, int32_t accel_q8, uint32_t angle_bam, int32_t speed_bpp) {
  if (s->current_q20 == 0) s->length = length_for(accel_q8);
  s->passes = 0;
  s->current_q20 = current_q20;
  s->expected_bam = qc_mul_sat(accel_q8, (int32_t)s->length * s->length * 2, 8);  // two patterns
  s->response_bam = 0;
  s->rough_bam = 0;
  s->sigma_q8 = 0;
  s->bounded = false;
  polarity_again(s, angle_bam, speed_bpp);
}

void polarity_again(polarity_t* s, uint32_t angle_bam, int32_t speed_bpp) {
  s->tick = 0;
  s->segment = 0;
  s->passes = q_min16((int16_t)(s->passes + 1), PASSES_MAX);
  s->last_bam = angle_bam;
  s->origin_bam = angle_bam;
  s->speed_bpp = speed_bpp;
  s->result = POLARITY_PENDING;
}

// Standard error of the response, the mean of all passes. Neighbouring angles differ by 1.13 sigma in the mean; the
// weights 1, 2, 1 of two patterns over means of 20 angles, halved, leave 0.39 sigma of it: 0.34 times the mean
// difference. It falls with the root of the number of angles, by tens; beyond 120 it is taken for larger than it is.
static int32_t error_bam(const polarity_t* s) {
  static const int16_t per_root_q14[TENS_MAX] = {23170, 16384, 13377, 11585, 10362, 9459,
                                                 8757,  8192,  7723,  7327,  6986,  6689};
  const int32_t rough = s->rough_bam / (PAUSES * (s->length / 2 - 1) * s->passes);
  const int16_t tens = q_min16((int16_t)(s->passes * s->length / 20), TENS_MAX);
  return qc_mul_sat(qc_mul_sat(rough, 89129L, 10), per_root_q14[tens - 1], 14);  // 2^-8 back to one, times 0.34
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

// The second pattern is the first one with the opposite sign.
static void begin_segment(polarity_t* s) {
  s->tick = 0;
  s->segment++;
  if (s->segment < POLARITY_SEGMENTS) return;
  s->segment = 0;
  if (s->current_q20 < 0) s->result = judge(s);
  s->current_q20 = -s->current_q20;
}

int32_t polarity_step(polarity_t* s, uint32_t angle_bam) {
  if (s->result != POLARITY_PENDING) return 0;
  s->origin_bam += (uint32_t)s->speed_bpp;
  s->last_bam += (uint32_t)s->speed_bpp;
  const int16_t weight = angle_weight[s->segment];
  // Only the second half of a pause counts: the current has died away.
  const int16_t inside = (int16_t)(s->tick - s->length / 2);
  if (weight != 0 && inside >= 0) {
    const int32_t share = weight * (angle_diff_bam(angle_bam, s->origin_bam) / s->length);
    const int32_t moved = (s->current_q20 < 0) ? -share : share;
    s->response_bam = qc_add_sat(s->response_bam, moved);
    const int32_t step = (inside > 0) ? qc_abs_sat(angle_diff_bam(angle_bam, s->last_bam)) : 0;
    s->rough_bam = qc_add_sat(s->rough_bam, q_shr(step, 8));
  }
  s->last_bam = angle_bam;
  const int32_t current_q20 = drive_sign[s->segment] * s->current_q20;
  s->tick++;
  if (s->tick >= s->length) begin_segment(s);
  return current_q20;
}
