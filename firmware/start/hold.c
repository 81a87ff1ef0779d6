// Holding the shaft while a brake opens: position control for a moment after the start.
//
// A speed controller that is quiet at standstill lets a load that falls on the shaft turn it by several degrees before
// it knows the load. For hold_time after the start of a standing shaft the torque therefore comes from a stiff loop,
//   acceleration = wc^2 (theta* - theta^) + 2 wc (w* - w^) + load^
// with theta* running at the speed reference. Angle, speed and load are the deviation observer's, told that the load
// changes fast and that its windows are worth all they measure (drive_config.c, hold_observer). A load step of its own
// it need not look for.
//
// The loop needs a map of the cross-saturation: its angle error of 0.46 degrees per ampere, unknown, would close this
// loop on itself. The resistance is the one seen at the start: at standstill the speed comes from what resistance and
// drops leave of the voltage, and a resistance 30 % off makes the speed seen go against the torque. The current
// reference moves slowly enough for the voltage to leave the windows long.

#include "firmware/start/hold.h"

#include "firmware/drive.h"
#include "firmware/parameters.h"

#define CONTROL_STEP_Q30 22548578L     // 210 rad/s * T
#define CONTROL_SQUARE_Q40 484884628L  // its square
#define FILTER_Q30 751619277L          // 0.7 of the change of the current reference per period
#define SLEW_Q20 367002L               // at most 0.35 A per period: some 25 V, within the alternating layout

// The other sources have no observer that could be fast for a moment.
static bool has_observer(void) { return parameters.position_source >= POSITION_OBSERVER; }

void hold_begin(drive_t* d) {
  hold_t* const h = &d->hold;
  h->left = has_observer() ? (uint32_t)parameters.hold_time * DRIVE_PERIODS_PER_MS : 0u;
  h->reference_bam = d->position.used.angle_bam;
  if (h->left > 0u) deviation_observer_stands(&d->position.observer);
}

bool hold_is_on(const drive_t* d) { return d->hold.left > 0u && d->state == DRIVE_RUN; }

// Electrical acceleration, binary angle per period^2, Q8.
static int32_t wanted_accel_q8(const drive_t* d) {
  const estimator_output_t* const now = &d->position.used;
  const int32_t behind = angle_diff_bam(d->hold.reference_bam, now->angle_bam);
  const int32_t slow = q_sub_sat(d->control.ramp.value, now->speed_bpp);
  const int32_t stiff = q_mul_sat(behind, CONTROL_SQUARE_Q40, 32);
  const int32_t damped = q_mul_sat(slow, 2 * CONTROL_STEP_Q30, 22);
  return q_add_sat(q_add_sat(stiff, damped), now->load_accel_q8);
}

bool hold_step(drive_t* d) {
  hold_t* const h = &d->hold;
  if (!hold_is_on(d)) return false;
  h->left--;
  h->reference_bam += (uint32_t)d->control.ramp.value;
  const int32_t torque_q20 = q_mul_sat(wanted_accel_q8(d), d->model.torque_per_accel_q24, 20);
  drive_control_t* const c = &d->control;
  const int32_t current_q20 = q_over(torque_q20, c->per_torque_constant, 24);
  const int32_t limited_q20 = q_clamp(current_q20, -c->room_q20, c->room_q20);
  const int32_t change_q20 = q_mul(limited_q20 - c->reference_q20.q, FILTER_Q30, 30);
  c->reference_q20.q += q_clamp(change_q20, -SLEW_Q20, SLEW_Q20);
  return true;
}
