// The modulator with any configuration that the parameters leave it: period after period, any voltage and current below
// half of what their formats hold, any DC link, any excitation.

#include "svpwm/edges.h"
#include "tests/prove/any_modulator.h"

static ab_t any_vector(int32_t most) {
  const ab_t v = {any_from(-most, most), any_from(-most, most)};
  return v;
}

static modulator_config_t config;
static dead_time_config_t dead_time;

static bool configure(void) {
  any_modulator(&config);
  any_dead_time(&dead_time);
  return config.extended.window_min_ticks <= config.extended.window_max_ticks;
}

// Any edges of a period, in one order: that they lie in the period is what layouts.c proves.
static void send(const svpwm_pulses_t* pulses) {
  static svpwm_pattern_t pattern;
  uint16_t sent[SVPWM_EDGES];
  pattern.pulses = *pulses;
  for (uint16_t k = 0; k < SVPWM_EDGES; k++) pattern.pulses.at[k] = any_ticks(-1, SVPWM_PERIOD_TICKS);
  for (uint16_t k = 0; k < SVPWM_WINDOWS; k++) {
    const svpwm_window_t w = {any_ticks(0, 12740), any_ticks(-1000, 9800), any_up_to(7)};
    pattern.windows[k] = w;
  }
  const int32_t link_q16 = any_from(0, VOLTAGE_MAX_Q16);
  const svpwm_carried_t carried = {{any_from(-SHARE_END_Q12, SHARE_END_Q12), any_from(-SHARE_END_Q12, SHARE_END_Q12),
                                    any_from(-SHARE_END_Q12, SHARE_END_Q12)},
                                   any_from(0, Y_END_Q30),
                                   link_q16};
  svpwm_compensate_edges(&dead_time, &config.sampling, &carried, &pattern, sent);
  (void)svpwm_mean_q16(&pattern.pulses, link_q16);
  const int16_t middles[SVPWM_WINDOWS] = {any_ticks(0, SVPWM_PERIOD_TICKS), any_ticks(0, SVPWM_PERIOD_TICKS),
                                          any_ticks(0, SVPWM_PERIOD_TICKS)};
  (void)svpwm_ripple_q16(&pattern.pulses, middles, any_up_to(SVPWM_WINDOWS), link_q16);
}

// What is sent of a period, and its windows, in each of the orders (svpwm_put_order in svpwm/extended.c and
// alternating.c).
void prove_edges(void) {
  if (!configure()) return;
  for (uint16_t first = 0; first < 6u; first++) {
    const uint16_t a = (uint16_t)(first / 2u);
    const uint16_t b = (uint16_t)((a + 1u + first % 2u) % 3u);
    const uint16_t c = (uint16_t)(3u - a - b);
    svpwm_pulses_t p = {{0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}};
    svpwm_put_order(&p, a, b, c, svpwm_fall_of(a), svpwm_fall_of(b), svpwm_fall_of(c));
    send(&p);
    svpwm_put_order(&p, a, b, c, svpwm_fall_of(c), svpwm_fall_of(b), svpwm_fall_of(a));
    send(&p);
    svpwm_put_order(&p, a, b, svpwm_fall_of(b), svpwm_fall_of(a), c, svpwm_fall_of(c));
    send(&p);
    svpwm_put_order(&p, a, svpwm_fall_of(a), b, c, svpwm_fall_of(b), svpwm_fall_of(c));
    send(&p);
  }
}

// The choice among the layouts, period after period.
void prove_svpwm(void) {
  modulator_t state;
  if (!configure()) return;
  modulator_reset(&state);
  while (any_bool()) {
    svpwm_pulses_t pulses;
    (void)dead_time_drop_q16(&dead_time, any_vector(CARRIED_MAX_Q20));
    (void)modulator_step(&state, &config, (excitation_t)(any_u16 % 6u), any_vector(ASKED_MAX_Q16),
                         any_from(0, VOLTAGE_MAX_Q16), &pulses);
  }
}
