#include "estimators/blend.h"

#define ONE_Q15 32767L

bool blend_design(blend_config_t* c, int32_t low_bpp, int32_t high_bpp) {
  if (low_bpp <= 0 || high_bpp <= low_bpp) return false;
  c->low_bpp = low_bpp;
  c->high_bpp = high_bpp;
  c->hysteresis_bpp = (high_bpp - low_bpp) / 8;
  c->rate_q15 = ONE_Q15 / 100;
  c->per_range_q30 = q_div(ONE_Q15, high_bpp - low_bpp, 30);
  return true;
}

void blend_reset(blend_t* s) {
  s->region = BLEND_LOW;
  s->share_q15 = ONE_Q15;
  s->disagreement_bam = 0;
}

bool blend_is_low(const blend_t* s) { return s->region == BLEND_LOW && s->share_q15 == ONE_Q15; }

bool blend_is_high(const blend_t* s) { return s->region == BLEND_HIGH && s->share_q15 == 0; }

static blend_region_t next_region(blend_region_t now, const blend_config_t* c, int32_t speed) {
  const int32_t low = (now == BLEND_LOW) ? c->low_bpp + c->hysteresis_bpp : c->low_bpp;
  const int32_t high = (now == BLEND_HIGH) ? c->high_bpp - c->hysteresis_bpp : c->high_bpp;
  if (speed < low) return BLEND_LOW;
  return (speed > high) ? BLEND_HIGH : BLEND_BOTH;
}

// Eq (44).
static int32_t reference_share_q15(const blend_t* s, const blend_config_t* c, int32_t speed) {
  if (s->region == BLEND_LOW) return ONE_Q15;
  if (s->region == BLEND_HIGH) return 0;
  return q_clamp(q_mul_sat(c->high_bpp - speed, c->per_range_q30, 30), 0, ONE_Q15);
}

void blend_preset(blend_t* s, const blend_config_t* c, int32_t speed_bpp) {
  blend_reset(s);
  s->region = next_region(BLEND_BOTH, c, q_abs_sat(speed_bpp));
  s->share_q15 = reference_share_q15(s, c, q_abs_sat(speed_bpp));
}

static int32_t mix(int32_t low, int32_t high, int32_t share_q15) {
  return q_mix_sat(high, low, share_q15 + (share_q15 >> 14), 15);
}

estimator_output_t blend_step(blend_t* s, const blend_config_t* c, const estimator_output_t* low,
                              const estimator_output_t* high) {
  const bool is_high = s->share_q15 == 0;
  const int32_t speed = q_abs_sat(is_high ? high->speed_bpp : mix(low->speed_bpp, high->speed_bpp, s->share_q15));
  s->region = next_region(s->region, c, speed);
  s->share_q15 = q_clamp(reference_share_q15(s, c, speed), s->share_q15 - c->rate_q15, s->share_q15 + c->rate_q15);
  s->disagreement_bam = angle_diff_bam(low->angle_bam, high->angle_bam);
  if (s->share_q15 == 0) return *high;
  estimator_output_t out;
  out.angle_bam = high->angle_bam + (uint32_t)q_mul(s->disagreement_bam, s->share_q15 + (s->share_q15 >> 14), 15);
  out.speed_bpp = mix(low->speed_bpp, high->speed_bpp, s->share_q15);
  out.load_accel_q8 = mix(low->load_accel_q8, high->load_accel_q8, s->share_q15);
  out.quality_q15 = mix(low->quality_q15, high->quality_q15, s->share_q15);
  return out;
}
