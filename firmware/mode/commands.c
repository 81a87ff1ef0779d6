// Commands, inspection and the drive's own memory.

#include "firmware/base/clear.h"
#include "firmware/board/functions.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/drive/sampling.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/mode.h"
#include "firmware/scope/scope.h"
#include "firmware/store/store.h"

drive_t drive;

void drive_reset(void) {
  clear(&drive, sizeof drive);
  sampling_reset();
  scope_reset();
  fault_history_reset();
  store_reset();
  parameters_reset();
  board_reset();
  drive.control.current_limit_q20 = board_current_limit();
  drive.rest_a_q8 = drive.rest_b_q8 = DRIVE_MIDDLE_Q8;
  drive.trim.offset_a_q8 = drive.rest_a_q8;
  drive.trim.offset_b_q8 = drive.rest_b_q8;
  drive.config_valid = drive_config_load(&drive.config);
  drive.model = drive.config.nameplate;
  drive.control.per_torque_constant = q_invert(machine_torque_constant_q24(&drive.model, 0));
  drive.samples.scale = slopes_scale(&drive.config.slopes, &drive.trim);
  drive.control.speed_ready = speed_controller_init(&drive.control.speed, &drive.config.speed, &drive.model);
  modulator_reset(&drive.modulation.state);
  position_preset(&drive, 0, 0);
}

bool drive_is_energised(void) {
  const bool commissioning = drive.state == DRIVE_COMMISSION && drive.commissioning.phase != COMMISSIONING_EVALUATE;
  return drive.state == DRIVE_START || drive.state == DRIVE_RUN || drive.state == DRIVE_STOP || commissioning;
}

bool drive_is_turning(const drive_t* d) {
  const bool spinning = d->state == DRIVE_COMMISSION && d->commissioning.turning;
  return d->state == DRIVE_RUN || d->state == DRIVE_STOP || spinning;
}

static bool sees_currents(const volatile drive_t* d) {
  switch (d->state) {
    case DRIVE_START:
      return d->start.powered && d->start.blind == 0u;
    case DRIVE_COMMISSION:
      return d->commissioning.phase != COMMISSIONING_EVALUATE;
    default:
      return d->state == DRIVE_RUN || d->state == DRIVE_STOP;
  }
}

bool drive_knows_speed(const volatile drive_t* d) {
  return sees_currents(d) && (d->state != DRIVE_START || d->start.phase == START_CATCH);
}

uint16_t drive_known(const volatile drive_t* d) {
  return (uint16_t)((drive_knows_speed(d) ? KNOWN_ROTOR : 0) | (sees_currents(d) ? KNOWN_FRAME : 0) |
                    (d->heat_sink_known ? KNOWN_HEAT_SINK : 0));
}

void drive_parameters_changed(void) { drive.request.reload = true; }

void drive_command_start(void) { drive.request.start = true; }

// What was asked for before and not carried out yet is not wanted any more: it must not outlive the stop that follows.
static void forget_starts(void) {
  drive.request.start = false;
  drive.request.commission = false;
  drive.request.look = false;
}

void drive_command_stop(void) {
  forget_starts();
  drive.request.stop = true;
}

void drive_command_coast(void) {
  forget_starts();
  drive.request.coast = true;
}

void drive_command_look(void) {
  drive.look.outcome = LOOK_RUNNING;
  drive.request.look = true;
}

// The end of a look writes its outcome; who breaks it off does not know of it.
look_outcome_t drive_look_outcome(void) {
  const bool goes_on = drive.request.look || (drive.state == DRIVE_START && drive.start.looking);
  const look_outcome_t outcome = drive.look.outcome;
  return (outcome == LOOK_RUNNING && !goes_on) ? LOOK_ENDED : outcome;
}

int32_t drive_look_rpm(void) { return drive.look.rpm_q16; }

void drive_command_reset(void) { drive.request.reset = true; }

void drive_command_speed(int32_t rpm_q16) {
  drive.control.wanted_rpm_q16 = rpm_q16;
  if (drive.state == DRIVE_COMMISSION && drive.commissioning.turning) return;  // the spin has a speed of its own
  const int32_t limit_q16 = q_shl_sat(parameters.speed_limit, 8);
  drive.control.target_bpp = q_mul_sat(q_clamp(rpm_q16, -limit_q16, limit_q16), drive.config.bpp_per_rpm_q8, 24);
}

uint32_t drive_time_ms(void) { return drive.time_ms; }

drive_state_t drive_state(void) { return drive.state; }

int32_t drive_rpm_q16(const drive_t* d, int32_t speed_bpp) {
  return q_mul_sat(speed_bpp, d->config.rpm_per_bpp_q40, 24);
}
