#include "estimators/tracking_observer.h"

#define SPEED_END_BPP 1230417497L  // 1.8 rad per period: with a correction it stays below MACHINE_SPEED_END_BPP
#define CHANGE_BITS 29u            // 0.8 rad per period

static void move(tracking_observer_t* s, int64_t change_q8, int32_t periods) {
  const int32_t before = s->speed_bpp;
  const int64_t sum_q8 = change_q8 + s->speed_remainder_q8;
  const int32_t change = q_sat_bits(sum_q8, 8, CHANGE_BITS);
  s->speed_remainder_q8 = (int32_t)((uint32_t)sum_q8 & 255u);
  s->speed_bpp = q_clamp(before + change, -SPEED_END_BPP, SPEED_END_BPP);
  s->angle_bam += ((uint32_t)before + (uint32_t)(change / 2)) * (uint32_t)periods;
}

void tracking_observer_predict(tracking_observer_t* s, int32_t torque_accel_q8) {
  move(s, (int64_t)torque_accel_q8 - s->load_accel_q8, 1);
}

void tracking_observer_coast(tracking_observer_t* s, int32_t periods) {
  move(s, -q_product(s->load_accel_q8, periods), periods);
}

void tracking_observer_correct(tracking_observer_t* s, int32_t error_bam, int32_t bandwidth_step_q30) {
  const int32_t x2_q30 = q_mul(bandwidth_step_q30, bandwidth_step_q30, 30);
  const int32_t x3_q36 = q_mul(x2_q30, bandwidth_step_q30, 24);
  s->angle_bam += (uint32_t)q_mul(error_bam, 3 * bandwidth_step_q30, 30);
  s->speed_bpp += q_mul(error_bam, 3 * x2_q30, 30);
  s->load_accel_q8 = q_sub_sat(s->load_accel_q8, q_mul(error_bam, x3_q36, 28));
}
