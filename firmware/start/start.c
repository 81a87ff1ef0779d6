// The state START: how it begins, its phases in their order, and what it leads to. See start.h.

#include "firmware/start/start.h"

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"

static void reset_control(drive_t* d) {
  static const references_t none = {{0, 0}, 0, 0, false};
  d->control.references = none;
  modulator_reset(&d->modulation.state);
  d->modulation.overrun = 0;
  d->control.ramp.value = 0;
  position_hold_release(&d->control.position_hold);
}

static void enter(drive_t* d, drive_state_t behind) {
  clear(&d->supervision, sizeof d->supervision);
  start_reset();
  field_weakening_reset(&d->control.weakening);
  drive_enter(d, DRIVE_START);
  d->flags.behind = behind;
  d->flags.unseen = KNOWN_ROTOR;
}

void start_return(drive_t* d) { enter(d, DRIVE_RUN); }

// False when it was refused, with a fault.
static bool prepare(drive_t* d, drive_state_t behind) {
  if (!d->config_valid || !d->control.speed_ready) {
    drive_trip(d, FAULT_PARAMETER);
    return false;
  }
  d->estimate.model = d->config.nameplate;
  inertia_match_reset(&inertia_match);
  speed_controller_scale(&d->control.speed, INERTIA_SAME_Q24);
  d->estimate.trim.mismatch_q30 = d->config.sensor_mismatch_q30;
  position_preset(d, &d->estimate, 0, 0);
  reset_control(d);
  enter(d, behind);
  d->flags.gates_off = true;
  d->flags.invalid = 2;
  const drive_fault_t refusal = interlock_refusal();
  if (refusal != FAULT_NONE) drive_trip(d, refusal);
  return refusal == FAULT_NONE;
}

static start_phase_t first(const drive_t* d) {
  return (d->config.values.bootstrap_time != 0) ? START_CHARGE : start_look(d);
}

// For a look at the shaft the lower devices are enough: they need no bootstrap capacitors.
static void start_begin(drive_t* d, drive_state_t behind) {
  if (!prepare(d, behind)) return;
  start_phases[(behind == DRIVE_READY) ? START_LISTEN : first(d)]->begin(d);
}

static void start_step(drive_t* d) {
  starting.tick++;
  const start_phase_t next = start_phases[starting.phase]->step(d);
  if (next != START_GOES_ON) start_phases[next]->begin(d);
  if (d->flags.invalid > 0u && !d->flags.gates_off) d->flags.invalid--;
}

static estimator_output_t start_estimate(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  return start_phases[starting.phase]->estimate(d, e, in);
}

const state_t start_state = {start_begin, start_step, start_estimate, NULL};
