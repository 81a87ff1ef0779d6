#include "estimators/tracking_observer.h"

#define SPEED_END_BPP 1230417497L  // 1.8 rad per period: with a correction it stays below MACHINE_SPEED_END_BPP

void tracking_observer_predict(tracking_observer_t* s, int32_t torque_accel_q8) {
  const int32_t before = s->speed_bpp;
  const int32_t change_q8 = q_sat64((int64_t)torque_accel_q8 - s->load_accel_q8 + s->speed_remainder_q8);
  const int32_t change = q_shr(change_q8, 8);
  s->speed_remainder_q8 = (int32_t)((uint32_t)change_q8 & 255u);
  s->speed_bpp = q_clamp(before + change, -SPEED_END_BPP, SPEED_END_BPP);
  s->angle_bam += (uint32_t)before + (uint32_t)(change / 2);
}

void tracking_observer_correct(tracking_observer_t* s, int32_t error_bam, int32_t bandwidth_step_q30) {
  const int32_t x2_q30 = q_mul(bandwidth_step_q30, bandwidth_step_q30, 30);
  const int32_t x3_q36 = q_mul(x2_q30, bandwidth_step_q30, 24);
  s->angle_bam += (uint32_t)q_mul(error_bam, 3 * bandwidth_step_q30, 30);
  s->speed_bpp += q_mul(error_bam, 3 * x2_q30, 30);
  s->load_accel_q8 = q_sub_sat(s->load_accel_q8, q_mul(error_bam, x3_q36, 28));
}
