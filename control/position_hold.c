#include "control/position_hold.h"

#define HALF_TURN_Q28 134217728L

int32_t position_hold_step(position_hold_t* h, uint32_t angle_bam, int32_t gain_q30) {
  if (!h->holding) {
    h->holding = true;
    h->to_turn_q28 = 0;
    h->angle_bam = angle_bam;
  }
  // The difference of two angles to sixteenths, so that nothing is lost from step to step.
  const int32_t turned_q28 = q_shr((int32_t)(angle_bam - h->angle_bam), 4);
  h->angle_bam += (uint32_t)turned_q28 << 4;
  h->to_turn_q28 = q_clamp(h->to_turn_q28 - turned_q28, -HALF_TURN_Q28, HALF_TURN_Q28);
  return q_mul(h->to_turn_q28, gain_q30, 26);
}
