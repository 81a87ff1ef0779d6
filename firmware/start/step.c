// What the phases of the start have in common: gates, periods for a decision, the axis, and what may follow.

#include "firmware/start/step.h"

#include <stddef.h>

#include "estimators/wiring.h"
#include "firmware/api/status.h"
#include "firmware/base/clear.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/start/phases.h"
#include "hal/hal_pwm.h"

#define AXIS_TIMEOUT 200u  // periods

drive_start_t starting;
start_ways_t start_ways;

void start_reset(void) {
  clear(&starting, sizeof starting);
  feature_status.wiring = (uint16_t)WIRING_GOOD;
}

void start_enter(start_phase_t phase) {
  starting.phase = phase;
  starting.tick = 0;
}

void start_power(drive_t* d, bool on) {
  d->flags.gates_off = !on;
  d->flags.invalid = 2;  // this period and the next have begun with the gates off
  if (!on) {
    hal_pwm_gates_off();
  } else if (hal_pwm_gates_on()) {
    starting.on_tick = (int32_t)hal_pwm_period_tick();
  } else {
    drive_trip(d, FAULT_OVER_CURRENT);
  }
}

bool start_has_exclusive_slot(drive_t* d) {
  const bool now = d->schedule.exclusive;
  d->flags.wants_exclusive = !now;
  return now;
}

start_phase_t start_look(const drive_t* d) { return start_ways.listens ? START_LISTEN : start_at_standstill(d); }

bool start_is_open_loop(const drive_t* d) { return start_ways.open_loop && d->flags.behind != DRIVE_COMMISSION; }

// Only where the listening has found that the shaft stands.
static bool checks_wiring(void) { return start_ways.checks_wiring && start_ways.listens; }

start_phase_t start_at_standstill(const drive_t* d) {
  return (start_is_open_loop(d) && !checks_wiring()) ? START_IF_RAMP : START_AXIS;
}

bool start_begin_standstill(drive_t* d) {
  d->flags.shorted = false;
  d->control.references.closed = false;
  position_preset(d, &d->estimate, 0, 0);
  axis_begin(&starting.axis);
  if (d->flags.gates_off) start_power(d, true);
  return d->state == DRIVE_START;
}

// A commissioning wants a shaft that stands; one that was caught turning is brought to rest instead.
static drive_state_t state_behind(const drive_t* d) {
  return (d->flags.behind == DRIVE_COMMISSION && d->flags.caught) ? DRIVE_STOP : d->flags.behind;
}

void start_run(drive_t* d, uint32_t angle_bam, int32_t speed_bpp) {
  drive_bumpless_transfer(d, angle_bam, speed_bpp);
  d->control.references.current_q20.q = 0;
  drive_enter(d, state_behind(d));
  if (d->state == DRIVE_STOP) drive_states[DRIVE_COMMISSION]->abandon();
}

static void judge_wiring(const drive_t* d) {
  if (!checks_wiring()) return;
  feature_status.wiring =
      (uint16_t)wiring_judge(&starting.axis, &d->estimate.model, q_shr(d->config.slopes.amps_per_code_q30, 10));
}

bool start_sees_axis(drive_t* d, bool valid, int32_t* axis_bam) {
  drive_start_t* const s = &starting;
  if (valid) axis_add(&s->axis, &d->estimate.avv.regression);
  if (!axis_is_complete(&s->axis)) {
    if (s->tick > AXIS_TIMEOUT) drive_trip(d, (d->samples.count > 0u) ? FAULT_START_VOLTAGE : FAULT_NO_SAMPLES);
    return false;
  }
  if (!start_has_exclusive_slot(d)) return false;
  if (s->phase == START_AXIS) {
    judge_wiring(d);
    if (start_is_open_loop(d)) return true;
  }
  const axis_result_t axis = axis_evaluate(&s->axis, &d->estimate.model);
  inverse_inductance_preset(&d->estimate.model, axis.mean_q30, axis.half_q30);
  s->uniform = axis_is_hidden(axis.mean_q30, axis.half_q30);
  *axis_bam = axis.angle_bam;
  return true;
}
