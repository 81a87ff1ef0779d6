#include "estimators/cogging.h"

#define SLOWER 2u  // learns with a quarter of the correction: a wave that stays has time, noise does not get in

int32_t cogging_load(cogging_t* s, const cogging_config_t* c, uint32_t angle_bam, int32_t speed_bpp) {
  s->active = c->order != 0 && q_abs_sat(speed_bpp) / 3 < c->fast_bpp;
  s->now_q8 = 0;
  if (!s->active) return 0;
  s->wave = frame_rotation((uint32_t)c->order * angle_bam);
  s->now_q8 = q_mul_add(s->cos_q8, s->wave.cos_q30, s->sin_q8, s->wave.sin_q30, 30);
  return s->now_q8;
}

void cogging_learn(cogging_t* s, const cogging_config_t* c, int32_t speed_bpp, int32_t correction_q8) {
  const int32_t speed = q_abs_sat(speed_bpp);
  if (!s->active || speed < c->slow_bpp || speed > c->fast_bpp) return;
  s->cos_q8 = q_clamp(s->cos_q8 + q_mul(correction_q8, s->wave.cos_q30, 30 + SLOWER), -c->bound_q8, c->bound_q8);
  s->sin_q8 = q_clamp(s->sin_q8 + q_mul(correction_q8, s->wave.sin_q30, 30 + SLOWER), -c->bound_q8, c->bound_q8);
}
