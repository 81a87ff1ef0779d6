// A configuration of the drive with every constant anywhere in the range that the parameters leave it; how it is made
// of them is the business of the part configuration.

#ifndef STILLSPIN_TESTS_PROVE_ANY_CONFIG_H
#define STILLSPIN_TESTS_PROVE_ANY_CONFIG_H

#include "firmware/mode/mode.h"
#include "tests/prove/any_modulator.h"
#include "tests/prove/any_observer.h"

static inline pi_config_t any_gains(void) {
  const pi_config_t c = {any_from(0, INT32_MAX), any_from(0, INT32_MAX), any_from(0, AMPERES_Q20)};
  return c;
}

static inline void any_control(drive_config_t* c) {
  c->current.d = any_gains();
  c->current.q = any_gains();
  c->speed.friction_q24 = any_from(0, 16777216L);
  c->speed.inertia_q24 = any_from(168L, 16777216L);
  c->speed.step_periods = DRIVE_PERIODS_PER_MS;
  c->speed.alpha_q8 = any_from(1, INT32_MAX);
  c->speed.trajectory_ms_q8 = any_from(512, 51200);
  c->speed.pi_bandwidth_q8 = any_from(256, 51200);
  c->speed.pi_damping_q12 = any_from(1228, 245760);
  c->mtpa.pole_q20 = any_from(0, 1048576000L);
  c->friction_per_bpp_q40 = any_from(0, INT32_MAX);
  c->ramp_step_bpp = any_from(0, INT32_MAX);
  c->hold_gain_q30 = any_from(0, 10737418L);
  c->release_step_q30 = any_from(0, 24159191L);
  c->salient_q20 = any_from(0, INT32_MAX);
  c->salient_bpp_q4 = any_i32;
  c->freed_by_q8 = (int16_t)any_from(512, 32767);
}

static inline void any_position(drive_config_t* c) {
  c->avv.bandwidth_short_q30 = any_from(1, 107374182L);
  c->avv.bandwidth_long_q30 = any_from(1, 107374182L);
  c->observer = any_observer(&c->nameplate);
  c->hold_observer = any_observer(&c->nameplate);
  c->blend.low_bpp = any_from(1, SPEED_MAX_BPP);
  c->blend.high_bpp = any_from(1, SPEED_MAX_BPP);
  c->blend.hysteresis_bpp = any_from(1, SPEED_MAX_BPP / 2);
  c->blend.rate_q15 = any_from(1, 32767);
  c->blend.per_range_q30 = any_from(1, 1073741824L);
  c->slopes.amps_per_code_q30 = any_from(524288L, 104857600L);
  c->slopes.start_samples = START_SAMPLES;
  c->slopes.end_samples = END_SAMPLES;
  c->slopes.amps_per_count_q36 = any_from(0, AMPERES_PER_COUNT_MAX_Q36);
  c->synchronism.floor_q16 = any_from(0, 6553600L);
  c->synchronism.share_q15 = any_from(0, 32768L);
  c->synchronism.bad_periods = any_from(0, 10000);
}

static inline void any_config(drive_config_t* c) {
  any_model(&c->nameplate);
  c->nameplate.ld_q16 = any_from(1, 2147418112L);
  any_modulator(&c->modulator);
  any_dead_time(&c->dead_time);
  any_control(c);
  any_position(c);
  c->volts_per_code_q16 = any_from(160, 32000);
  c->codes_per_amp_q16 = any_from(671088L, 134217728L);
  c->bpp_per_rpm_q8 = any_from(1832519L, 36650380L);
  c->rpm_per_bpp_q40 = any_from(7680000L, 153700000L);
  c->adapt_share_q30 = any_from(0, 53687091L);
  c->drift_share_q30 = any_from(0, 53687091L);
  c->sensor_mismatch_q30 = any_from(0, 53687091L);
  c->mapped = any_bool();
  c->saturation.d_q30 = any_i32;
  c->saturation.q_q30 = any_i32;
}

#endif
