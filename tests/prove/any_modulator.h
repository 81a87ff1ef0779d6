// A modulator with every constant anywhere in the range that the parameters leave it.

#ifndef STILLSPIN_TESTS_PROVE_ANY_MODULATOR_H
#define STILLSPIN_TESTS_PROVE_ANY_MODULATOR_H

#include "svpwm/dead_time.h"
#include "svpwm/modulator.h"
#include "tests/prove/any.h"
#include "tests/prove/ends.h"

static inline int16_t any_ticks(int16_t lo, int16_t hi) { return (int16_t)any_from(lo, hi); }

static inline void any_modulator(modulator_config_t* c) {
  c->pulse_ticks = any_ticks(1500, 4700);
  c->extended.window_min_ticks = any_ticks(500, 3000);
  c->extended.window_max_ticks = any_ticks(500, 4000);
  c->extended.zero_ticks = any_ticks(0, 5000);
  c->sampling.settle_ticks = any_ticks(400, 2500);
  c->sampling.burst_ticks = any_ticks(50, 500);
  c->sampling.span_min_ticks = any_ticks(100, 2000);
  c->sampling.last_tick = any_ticks(5000, 9800);
  c->sampling.windows = (uint16_t)any_ticks(1, SVPWM_WINDOWS);
}

static inline void any_dead_time(dead_time_config_t* c) {
  c->turn_on_ticks = any_ticks(0, 240);
  c->turn_off_ticks = any_ticks(0, 240);
  c->edge_band_q20 = any_from(AMPERES_Q20 / 100, 4 * AMPERES_Q20);
  c->band_q20 = any_from(AMPERES_Q20 / 100, 2 * AMPERES_Q20);
  c->drop_q16 = any_from(0, 5 * VOLTS_Q16);
  dead_time_design(c);
}

#endif
