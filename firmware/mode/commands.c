// Commands: what the background level leaves for the control interrupt.

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

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

void drive_command_reset(void) { drive.request.reset = true; }

void drive_command_speed(int32_t rpm_q16) {
  drive.control.command_rpm_q16 = rpm_q16;
  if (drive.flags.spins) return;  // the spin has a speed of its own
  const int32_t limit_q16 = qc_shl_sat(drive.config.values.speed_limit, 8);
  drive.control.target_bpp = qc_mul_sat(q_clamp(rpm_q16, -limit_q16, limit_q16), drive.config.bpp_per_rpm_q8, 24);
}
