// The modulator with any configuration that it calls valid: period after period, any voltage and current below half of
// what their formats hold, any DC link, any excitation.

#include "svpwm/dead_time.h"
#include "svpwm/edges.h"
#include "svpwm/modulator.h"
#include "tests/prove/any.h"

#define VOLTS_Q16 65536L
#define AMPERES_Q20 1048576L

static int16_t any_ticks(int16_t lo, int16_t hi) { return (int16_t)any_from(lo, hi); }

static ab_t any_vector(int32_t most) {
  const ab_t v = {any_from(-most, most), any_from(-most, most)};
  return v;
}

static modulator_config_t any_modulator(void) {
  modulator_config_t c;
  c.pulse_ticks = any_ticks(1500, 4700);
  c.extended.window_min_ticks = any_ticks(500, 3000);
  c.extended.window_max_ticks = any_ticks(500, 4000);
  c.extended.zero_ticks = any_ticks(0, 5000);
  c.sampling.settle_ticks = any_ticks(400, 2500);
  c.sampling.burst_ticks = any_ticks(50, 500);
  c.sampling.span_min_ticks = any_ticks(100, 2000);
  c.sampling.last_tick = any_ticks(5000, 9800);
  return c;
}

static dead_time_config_t any_dead_time(void) {
  dead_time_config_t c;
  c.blocked_ticks = any_ticks(0, 240);
  c.released_ticks = any_ticks(0, 240);
  c.edge_band_q20 = any_from(0, 4 * AMPERES_Q20);
  c.band_q20 = any_from(AMPERES_Q20 / 100, 2 * AMPERES_Q20);
  c.drop_q16 = any_from(0, 5 * VOLTS_Q16);
  dead_time_design(&c);
  return c;
}

void prove_svpwm(void) {
  const modulator_config_t config = any_modulator();
  const dead_time_config_t dead_time = any_dead_time();
  modulator_t state;
  if (!modulator_config_valid(&config)) return;
  modulator_reset(&state);
  while (any_bool()) {
    svpwm_pattern_t pattern;
    svpwm_pulses_t command;
    const int32_t link_q16 = any_from(0, 2000 * VOLTS_Q16);
    const ab_t current_q20 = any_vector(512 * AMPERES_Q20);
    (void)dead_time_drop_q16(&dead_time, current_q20);
    (void)modulator_step(&state, &config, (excitation_t)(any_u16 % 6u), any_vector(8192 * VOLTS_Q16), link_q16,
                         &pattern.pulses);
    const svpwm_carried_t carried = {current_q20, any_from(0, 1073741824L), link_q16};
    svpwm_send(&dead_time, &config.sampling, &carried, &pattern, &command);
    (void)svpwm_mean_q16(&pattern.pulses, link_q16);
  }
}
