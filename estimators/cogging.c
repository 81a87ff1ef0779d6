#include "estimators/cogging.h"

#define ONE_Q30 1073741824L
#define STEP_BAM 268435456L  // sixteen steps a wave
#define MEAN_SHIFT 3u        // mean and wave follow within eight of them;
#define WAVE_SHIFT 2u        // the mean of a squared wave is a half

int32_t cogging_load(cogging_t* s, const cogging_config_t* c, uint32_t angle_bam, int32_t speed_bpp) {
  s->active = c->order != 0 && q_abs_sat(speed_bpp) / 3 < c->crawl_bpp;
  s->now_q8 = 0;
  if (!s->active) return 0;
  s->wave = frame_rotation((uint32_t)c->order * angle_bam);
  s->now_q8 = q_mul_add(s->cos_q8, s->wave.cos_q30, s->sin_q8, s->wave.sin_q30, 30);
  return s->now_q8;
}

static int32_t moved(int32_t* amplitude_q8, int32_t step_q8, int32_t bound_q8) {
  const int32_t before_q8 = *amplitude_q8;
  *amplitude_q8 = q_limit(before_q8 + step_q8, bound_q8);
  return *amplitude_q8 - before_q8;
}

static void forget(cogging_t* s, int32_t order) {
  s->order = order;
  s->cos_q8 = 0;
  s->sin_q8 = 0;
  s->known_q30 = 0;
}

int32_t cogging_learn(cogging_t* s, const cogging_config_t* c, const cogging_seen_t* in) {
  if (s->order != c->order) forget(s, c->order);
  const uint32_t wave_bam = (uint32_t)c->order * in->angle_bam;
  if (!s->active || q_abs_sat((int32_t)(wave_bam - s->stepped_bam)) < STEP_BAM) return 0;
  s->stepped_bam = wave_bam;
  const int32_t swing_q8 = q_sub_sat(in->load_q8, s->mean_q8);
  s->mean_q8 = q_follow(s->mean_q8, in->load_q8, MEAN_SHIFT);
  // A load that changes by more than cogging can be is something else.
  if (q_abs_sat(in->speed_bpp) > c->crawl_bpp || q_abs_sat(swing_q8) > c->bound_q8) return 0;
  s->known_q30 = q_follow_near(s->known_q30, ONE_Q30, MEAN_SHIFT);
  const rotation_t seen = frame_rotation(wave_bam);
  const int32_t cos_q8 = moved(&s->cos_q8, q_mul(swing_q8, seen.cos_q30, 30 + WAVE_SHIFT), c->bound_q8);
  const int32_t sin_q8 = moved(&s->sin_q8, q_mul(swing_q8, seen.sin_q30, 30 + WAVE_SHIFT), c->bound_q8);
  return q_mul_add(cos_q8, s->wave.cos_q30, sin_q8, s->wave.sin_q30, 30);
}
