// The drive's memory, what state it is in, and the ways into a state: entered, or by a fault.

#include "firmware/mode/mode.h"

#include "firmware/mode/fault_history.h"
#include "hal/hal_pwm.h"
#include "hal/hal_safety.h"
#include "hal/qmath/qcall.h"

drive_t drive;
uint16_t known_beside;

// All states behind READY but FAULT, until the state itself says that it is over.
static bool is_energised(const volatile drive_t* d) {
  return d->state >= DRIVE_START && d->state != DRIVE_FAULT && !d->flags.over;
}

bool drive_is_energised(void) { return is_energised(&drive); }

static bool sees_currents(const volatile drive_t* d) { return is_energised(d) && d->flags.invalid == 0u; }

uint16_t drive_known(const volatile drive_t* d) {
  const uint16_t beside = known_beside;
  if (!sees_currents(d)) return beside;
  return ((KNOWN_ROTOR | KNOWN_FRAME) ^ d->flags.unseen) | beside;
}

uint32_t drive_time_ms(void) { return drive.time_ms; }

drive_state_t drive_state(void) { return drive.state; }

int32_t drive_rpm_q16(const drive_t* d, int32_t speed_bpp) {
  return qc_mul_sat(speed_bpp, d->config.rpm_per_bpp_q40, 24);
}

static void begin(drive_t* d, drive_state_t state) {
  static const state_flags_t none = {DRIVE_BOOT, 0, 0, false, false, false, false, false, false, false, false};
  d->state = state;
  d->flags = none;
  d->periods = 0;
}

void drive_enter(drive_t* d, drive_state_t state) {
  d->settled_at = 0;
  begin(d, state);
}

void drive_begin_spin(drive_t* d) {
  d->periods = 0;
  d->flags.spins = true;
}

static void note(const drive_t* d, drive_fault_t fault) {
  fault_record_t r;
  r.time_ms = d->time_ms;
  r.fault = fault;
  r.state = d->state;
  r.known = drive_known(d);
  r.speed_q16 = ((r.known & KNOWN_ROTOR) != 0u) ? drive_rpm_q16(d, d->estimate.selected.speed_bpp) : 0;
  r.link_q16 = d->samples.link_q16;
  const dq_t none = {0, 0};
  const dq_t seen_q20 = ((r.known & KNOWN_FRAME) != 0u) ? d->estimate.measured_q20 : none;
  r.current_d_q20 = seen_q20.d;
  r.current_q_q20 = seen_q20.q;
  fault_history_add(&r);
}

void drive_open_power_stage(drive_t* d) {
  hal_pwm_gates_off();
  d->control.references.closed = false;
}

void drive_trip(drive_t* d, drive_fault_t fault) {
  drive_open_power_stage(d);
  if (d->state == DRIVE_FAULT) return;
  note(d, fault);
  d->fault = fault;
  begin(d, DRIVE_FAULT);
  d->request.speed = false;  // asked for before the fault
  d->control.command_rpm_q16 = 0;
  d->control.target_bpp = 0;
  hal_safety_fault_lamp(true);
}
