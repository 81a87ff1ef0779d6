// Before the first pulse: all lower devices on, which charges the bootstrap capacitors of the upper ones' supplies.
//
// The gates come on when the short circuit is what the modulator gives. A shaft that turns drives a current through it:
// then they rest until it has died away, and only what they were on counts.

#include <stddef.h>

#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"
#include "hal/qmath/qcall.h"

#define REST_PERIODS 20u

static void begin_charge(drive_t* d) {
  d->flags.shorted = true;
  starting.charged = 0;
  start_enter(START_CHARGE);
}

static bool flows(const drive_t* d) {
  if (d->samples.count == 0u || d->flags.invalid > 0u) return false;
  const ab_t i = d->samples.windows[d->samples.count - 1u].current_q20;
  return frame_largest(i.alpha, i.beta) > d->config.values.current_limit / 2;
}

static start_phase_t step_charge(drive_t* d) {
  drive_start_t* const s = &starting;
  if (d->flags.gates_off) {
    if (s->tick >= REST_PERIODS) start_power(d, true);
    return START_GOES_ON;
  }
  s->charged++;
  if ((int32_t)s->charged >= q_shr(d->config.values.bootstrap_time * DRIVE_PERIODS_PER_MS + 65535L, 16))
    return start_look(d);
  if (flows(d)) {
    start_power(d, false);
    s->tick = 0;
  }
  return START_GOES_ON;
}

const phase_t charge_phase = {begin_charge, step_charge, NULL};
