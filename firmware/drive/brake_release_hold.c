// Holding the shaft while a brake opens: position control for a moment after the start.
//
// A speed controller that is quiet at standstill lets a load that falls on the shaft turn it by several degrees before
// it knows the load. For hold_time after the start of a standing shaft the torque therefore comes from a stiff loop,
//   acceleration = wc^2 (theta* - theta^) + 2 wc (w* - w^) + load^
// with theta* running at the speed reference and wc by the machine (config/config.c). Angle, speed and load are the
// deviation observer's, told that the load changes fast and that its windows are worth all they measure, less where the
// hold is softer (config/config.c, hold_observer). A load step of its own it need not look for.
//
// The current reference moves slowly enough for the voltage to leave the windows long.
//
// The loop needs a map of the cross-saturation: its angle error of 0.46 degrees per ampere, unknown, closes this loop
// on itself, with a gain of 0.8 on motor A and of 1 from wc = 250 rad/s on. The resistance is the one seen at the
// start: at standstill the speed comes from what resistance and drops leave of the voltage, and a resistance 30 % off
// makes the speed seen go against the torque.

#include "firmware/drive/brake_release_hold.h"

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"

#define SLEW_Q20 734003L  // 0.7 A in a period: some 50 V, within the alternating layout

hold_t brake_release_hold;

void hold_begin(drive_t* d) {
  hold_t* const h = &brake_release_hold;
  // The other sources have no observer that could be fast for a moment.
  h->left = drive_source_has(d, SOURCE_READS) ? (uint32_t)d->config.values.hold_time * DRIVE_PERIODS_PER_MS : 0u;
  h->reference_bam = d->estimate.selected.angle_bam;
  h->current_per_accel = qc_over(d->estimate.model.torque_per_accel_q24, d->control.per_torque_constant, 24);
  if (h->left > 0u) deviation_observer_stands(&d->estimate.observer);
}

void hold_end(void) { brake_release_hold.left = 0; }

// Electrical acceleration, binary angle per period^2, Q8, without the load's.
static int32_t restoring_accel_q8(const drive_t* d) {
  const estimator_output_t* const now = &d->estimate.selected;
  const int32_t behind = angle_diff_bam(brake_release_hold.reference_bam, now->angle_bam);
  const int32_t slow = qc_sub_sat(d->control.ramp.value, now->speed_bpp);
  const int32_t step_q30 = d->config.release_step_q30;
  return qc_mul_sat(qc_add_sat(qc_mul(behind, step_q30, 31), slow), step_q30, 21);
}

int32_t hold_step_q20(const drive_t* d) {
  hold_t* const h = &brake_release_hold;
  h->left--;
  h->reference_bam += (uint32_t)d->control.ramp.value;
  const drive_control_t* const c = &d->control;
  const int32_t load_q20 = qc_mul_sat(d->estimate.selected.load_accel_q8, h->current_per_accel, 20);
  const int32_t restoring_q20 = qc_mul_sat(restoring_accel_q8(d), h->current_per_accel, 20);
  const int32_t current_q20 = qc_add_sat(load_q20, restoring_q20);
  const int32_t limited_q20 = q_limit(current_q20, c->headroom_q20);
  return q_clamp(limited_q20, c->references.current_q20.q - SLEW_Q20, c->references.current_q20.q + SLEW_Q20);
}
