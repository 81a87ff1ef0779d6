// The drive's memory, what state it is in, and the ways into a state: entered, or by a fault.

#include "firmware/mode/mode.h"

#include "firmware/commissioning/outcome.h"
#include "firmware/mode/fault_history.h"
#include "hal/hal_pwm.h"
#include "hal/hal_safety.h"

drive_t drive;

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

uint32_t drive_time_ms(void) { return drive.time_ms; }

drive_state_t drive_state(void) { return drive.state; }

int32_t drive_rpm_q16(const drive_t* d, int32_t speed_bpp) {
  return q_mul_sat(speed_bpp, d->config.rpm_per_bpp_q40, 24);
}

void drive_enter(drive_t* d, drive_state_t state) {
  d->calm_at = 0;
  d->state = state;
  d->periods = 0;
}

static void note(const drive_t* d, drive_fault_t fault) {
  fault_record_t r;
  r.time_ms = d->time_ms;
  r.fault = fault;
  r.state = d->state;
  r.known = drive_known(d);
  r.speed_q16 = ((r.known & KNOWN_ROTOR) != 0u) ? drive_rpm_q16(d, d->position.used.speed_bpp) : 0;
  r.link_q16 = d->samples.link_q16;
  const dq_t none = {0, 0};
  const dq_t seen_q20 = ((r.known & KNOWN_FRAME) != 0u) ? d->control.measured_q20 : none;
  r.current_d_q20 = seen_q20.d;
  r.current_q_q20 = seen_q20.q;
  fault_history_add(&r);
}

void drive_raise(drive_t* d, drive_fault_t fault) {
  hal_pwm_gates_off();
  if (d->state == DRIVE_FAULT) return;
  note(d, fault);
  d->fault = fault;
  d->state = DRIVE_FAULT;
  d->periods = 0;
  d->control.closed = false;
  d->control.wanted_rpm_q16 = 0;
  d->control.target_bpp = 0;
  hal_safety_fault_lamp(true);
}
