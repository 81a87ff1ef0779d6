// What the phases of the start have in common: gates, periods for a decision, and the axis.

#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"
#include "hal/hal_pwm.h"

#define AXIS_TIMEOUT 200u  // periods

void start_enter(drive_t* d, start_phase_t phase) {
  d->found.phase = phase;
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

static void judge_wiring(drive_t* d) {
  if (!start_checks_wiring()) return;
  d->found.wiring = wiring_judge(&starting.axis, &d->model, q_shr(d->config.slopes.amps_per_code_q30, 10));
}

bool start_sees_axis(drive_t* d, bool valid, int32_t* axis_bam) {
  drive_start_t* const s = &starting;
  if (valid) axis_add(&s->axis, &d->position.avv.regression);
  if (!axis_is_complete(&s->axis)) {
    if (s->tick > AXIS_TIMEOUT) drive_trip(d, (d->samples.count > 0u) ? FAULT_START_VOLTAGE : FAULT_NO_SAMPLES);
    return false;
  }
  if (!start_has_exclusive_slot(d)) return false;
  if (d->found.phase == START_AXIS) judge_wiring(d);
  const axis_result_t axis = axis_evaluate(&s->axis, &d->model);
  inverse_inductance_preset(&d->model, axis.mean_q30, axis.half_q30);
  *axis_bam = axis.angle_bam;
  return true;
}
