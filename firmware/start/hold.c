// Holding the shaft while a brake opens: position control for a moment after the start.
//
// A speed controller that is quiet at standstill lets a load that falls on the shaft turn it by several degrees before
// it knows the load. For hold_time after the start of a standing shaft the torque therefore comes from a stiff loop of
// its own: an AVV observer of angle, speed and load that is fast and noisy, and on top of it
//   acceleration = wc^2 (theta* - theta^) + 2 wc (w* - w^) + load^
// with theta* running at the speed reference. The observer also takes a speed from the windows' mean residual on the
// q-axis, which is the back-EMF that the model has wrong: -y_q lambda/T (w - w^). That speed has an offset from what is
// left of the drops; it is learnt while the shaft still stands, until the start is over.
//
// 5.5 N m from one instant to the next turn motor A's shaft by about 1.3 degrees; the price is a torque noise of some
// 1.5 N m rms. It needs alternating windows, and a map of the cross-saturation: its angle error of 0.46 degrees per
// ampere, unknown, would close this loop on itself. The current reference moves slowly enough for the voltage to leave
// the windows as long as they are: without that limit noise makes voltage, voltage shortens windows, and short windows
// make more noise.

#include "firmware/start/hold.h"

#include "firmware/drive.h"
#include "firmware/parameters.h"

#define CONTROL_STEP_Q30 21474836L     // 200 rad/s * T
#define CONTROL_SQUARE_Q40 439804651L  // its square
#define SPEED_SHARE_Q30 75161928L      // 0.07 of the speed's error per period
#define LOAD_SHARE_Q30 842150450L      // 0.00306 of it off the load's acceleration, Q8
#define FILTER_Q30 429496730L          // 0.4 of the change of the current reference per period
#define SLEW_Q20 367002L               // at most 0.35 A per period: some 25 V, within the alternating layout
#define OFFSET_SHIFT 5                 // 3 ms: longer, an error of the resistance would feed itself through the torque
#define BPP_PER_RAD 683565276L         // 2^32 / 2 pi

// 400 rad/s * T with the windows that the alternating layout has at rest, 50 rad/s with short ones.
static const avv_config_t observer_config = {5368709L, 42949673L};

void hold_begin(drive_t* d) {
  hold_t* const h = &d->hold;
  // The paper's scheme wants other windows at standstill.
  h->left = (parameters.position_source == POSITION_PAPER) ? 0u : (uint32_t)parameters.hold_time * DRIVE_PERIODS_PER_MS;
  h->reference_bam = d->position.used.angle_bam;
  avv_preset(&h->avv, d->position.used.angle_bam, 0, 0);
}

// Speed that the back-EMF tells, less the one at which the regression was made, binary angle per period.
static int32_t emf_speed(const machine_model_t* m, const regression_t* r) {
  const int32_t per_rad_q20 = q_mul_sat(m->yq_q30, m->emf_q16, 26);
  return -q_mul_sat(q_over(r->mean_q20.q, q_invert(per_rad_q20), 30), BPP_PER_RAD, 30);
}

static void observe(drive_t* d) {
  hold_t* const h = &d->hold;
  const int32_t torque_q16 = machine_torque_q16(&d->model, d->control.measured_q20);
  const estimator_input_t in = {
      &d->model, d->samples.windows, d->samples.count, q_mul_sat(torque_q16, d->model.accel_q12, 20), true, false, 0};
  (void)avv_step(&h->avv, &observer_config, &in);
  if (h->avv.regression.information <= 0) return;
  tracking_observer_t* const o = &h->avv.observer;
  const int32_t error_bpp = q_sub_sat(emf_speed(&d->model, &h->avv.regression), h->offset_bpp);
  o->speed_bpp += q_mul(error_bpp, SPEED_SHARE_Q30, 30);
  h->offset_bpp += q_shr_round(error_bpp, OFFSET_SHIFT);
  o->load_accel_q8 = q_sub_sat(o->load_accel_q8, q_mul(error_bpp, LOAD_SHARE_Q30, 30));
}

// Electrical acceleration, binary angle per period^2, Q8.
static int32_t wanted_accel_q8(const drive_t* d) {
  const hold_t* const h = &d->hold;
  const int32_t behind = angle_diff_bam(h->reference_bam, h->avv.observer.angle_bam);
  const int32_t slow = q_sub_sat(d->control.ramp.value, h->avv.observer.speed_bpp);
  const int32_t stiff = q_mul_sat(behind, CONTROL_SQUARE_Q40, 32);
  const int32_t damped = q_mul_sat(slow, 2 * CONTROL_STEP_Q30, 22);
  return q_add_sat(q_add_sat(stiff, damped), h->avv.observer.load_accel_q8);
}

// While the shaft stands, AVV's speed is noise around none.
static void learn_offset(drive_t* d) {
  const regression_t* const r = &d->position.avv.regression;
  if (drive_is_blind(d) || r->information <= 0) return;
  const int32_t seen_bpp = q_add_sat(emf_speed(&d->model, r), d->position.avv.observer.speed_bpp);
  d->hold.offset_bpp += q_shr_round(q_sub_sat(seen_bpp, d->hold.offset_bpp), 5);
}

bool hold_step(drive_t* d) {
  hold_t* const h = &d->hold;
  if (d->state == DRIVE_START) learn_offset(d);
  if (h->left == 0u || d->state != DRIVE_RUN) return false;
  h->left--;
  observe(d);
  h->reference_bam += (uint32_t)d->control.ramp.value;
  const int32_t torque_q20 = q_mul_sat(wanted_accel_q8(d), d->model.torque_per_accel_q24, 20);
  const q_inverse_t per_newton_metre = q_invert(machine_torque_constant_q24(&d->model, d->control.reference_q20.d));
  const int32_t current_q20 = q_over(torque_q20, per_newton_metre, 24);
  const int32_t room_q20 = drive_current_room(d);
  const int32_t limited_q20 = q_clamp(current_q20, -room_q20, room_q20);
  const int32_t change_q20 = q_mul(limited_q20 - d->control.reference_q20.q, FILTER_Q30, 30);
  d->control.reference_q20.q += q_clamp(change_q20, -SLEW_Q20, SLEW_Q20);
  return true;
}
