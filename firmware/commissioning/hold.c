// Holds the shaft in place while currents are measured, and takes it to a favourable place first.
//
// A free shaft would follow cogging, loads and every error of the angle, and with negative i_d the stator's field even
// pushes it away. So the position is controlled by i_q, from AVV's angle and speed: a second-order law of 60 rad/s,
// less where the rotor is heavy, far below the observer's bandwidth, with the observer's load fed forward. The torque
// is known because the polarity is.
//
// The place is the nearest multiple of 60 degrees electrical, at most 7.5 degrees mechanical away with four pole pairs:
// with i_d there, no phase carries less than half of it, so no phase current changes its sign within the ripple.

#include "firmware/commissioning/phases.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/inertia.h"
#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"
#include "hal/qmath/qcall.h"

#define DAMPING_Q30 12884902L     // 2 w T, with 60 rad/s
#define STIFF_ACCEL_Q8 16777216L  // 3/8 of it are what that law asks for at an error of a radian
#define SIXTH_BAM 715827883L
#define QUARTER_BITS 30        // of a turn
#define TURN_STEP_BAM 238609L  // 0.02 degrees electrical per period
#define SETTLE_PERIODS 6000
#define SLOPE_SHIFT 6u  // 64 periods for the current limit

void commissioning_set_d(drive_t* d, int32_t level_q20) {
  const int32_t step = q_shr(d->config.values.current_limit, SLOPE_SHIFT);
  dq_t* const r = &d->control.references.current_q20;
  r->d = q_clamp(level_q20, r->d - step, r->d + step);
}

// The noise of the angle comes back as current, the more of it the less a current moves the rotor: an error of one
// radian asks for 3/8 of what the current limit accelerates with at most, and for that of 60 rad/s.
static void design_hold(const drive_t* d, commissioning_t* c) {
  const int32_t accel_q8 = q_min(drive_accel_q8(d, 0, d->config.values.current_limit), STIFF_ACCEL_Q8);
  c->damping_q30 = qc_mul(DAMPING_Q30, (int32_t)q_sqrt32((uint32_t)accel_q8 * 64u), 15);
}

static int32_t holding_q20(const drive_t* d) {
  const estimator_output_t* const p = &d->estimate.selected;
  const int32_t error_bam = angle_diff_bam(commissioning.target_bam, p->angle_bam);
  const int32_t damping_q30 = commissioning.damping_q30;
  const int32_t stiffness_q30 = qc_mul(damping_q30, damping_q30, 32);
  const int32_t command_q8 =
      qc_sub_sat(qc_mul_sat(error_bam, stiffness_q30, 22), qc_mul_sat(p->speed_bpp, damping_q30, 22));
  const int32_t torque_q20 =
      qc_mul_sat(qc_add_sat(command_q8, p->load_accel_q8), d->estimate.model.torque_per_accel_q24, 20);
  return qc_over(torque_q20, d->control.per_torque_constant, 24);
}

// A rotor that follows the current swings about it, and next to nothing brakes that: the current across goes against
// the EMF that the voltage across shows, as if that axis were closed by 1/16 of L/T.
static int32_t braking_q20(const drive_t* d) {
  return qc_mul_sat(-d->control.command_q16.q, d->estimate.model.yq_q30, 22);
}

// Braking has a low-pass of 64 periods, so that the current controller does not answer to itself.
void commissioning_hold(drive_t* d) {
  const bool uniform = commissioning.uniform;
  const int32_t limit = q_shr(d->config.values.current_limit, 2);
  const int32_t reference = q_limit(uniform ? braking_q20(d) : holding_q20(d), limit);
  int32_t* const current = &d->control.references.current_q20.q;
  *current = uniform ? q_follow_near(*current, reference, 6) : reference;
}

bool commissioning_align(drive_t* d) {
  commissioning_t* const c = &commissioning;
  if (c->tick == 0) {
    c->uniform = starting.uniform;
    if (c->uniform) d->flags.unseen = KNOWN_ROTOR;
    d->control.references.closed = true;
    design_hold(d, c);
    c->target_bam = d->estimate.selected.angle_bam;
    const uint32_t near_bam = c->target_bam + ((uint32_t)c->uniform << QUARTER_BITS);
    const int32_t sixths = (int32_t)q_div((int32_t)(near_bam / 2u), SIXTH_BAM / 2, 0);
    c->goal_bam = (uint32_t)sixths * (uint32_t)SIXTH_BAM;
  }
  const int32_t left = angle_diff_bam(c->goal_bam, c->target_bam);
  c->target_bam += (uint32_t)q_clamp(left, -TURN_STEP_BAM, TURN_STEP_BAM);
  commissioning_hold(d);
  if (c->uniform) commissioning_set_d(d, d->config.values.current_limit / 2);
  if (c->tick < (c->uniform ? 2 : 1) * SETTLE_PERIODS || !start_has_exclusive_slot(d)) return false;
  c->model = d->estimate.model;
  machine_model_move(&c->model, 0);
  return true;
}

// AVV alone, or no measurement at all and the angle by the torque. A machine without an axis is not measured at rest:
// its rotor turns to where the current points.
estimator_output_t commissioning_estimate(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  if (commissioning.uniform) {
    const estimator_output_t still = {commissioning.target_bam, 0, 0, 0};
    return still;
  }
  if (!commissioning.predicting) return edition_start_source->step(d, e, in);
  if (d->schedule.moves) machine_model_follow(&e->model, e->measured_q20.q);
  tracking_observer_t* const o = &e->avv.observer;
  tracking_observer_predict(o, qc_add_sat(in->torque_accel_q8, o->load_accel_q8));  // the load as of now is left out
  const estimator_output_t out = {o->angle_bam, o->speed_bpp, o->load_accel_q8, 32767};
  return out;
}

// Windows under opposite vectors, as the alternating layout has them: what is common to both is then not the link.
static bool opposite(const estimator_window_t* a, const estimator_window_t* b) {
  const int32_t apart_q19 = 10L * 524288L;
  return qc_abs_sat(a->voltage_q19.alpha + b->voltage_q19.alpha) < apart_q19 &&
         qc_abs_sat(a->voltage_q19.beta + b->voltage_q19.beta) < apart_q19;
}

bool commissioning_has_pair(const drive_t* d) {
  const estimator_window_t* const w = d->samples.windows;
  return d->samples.count == 2u && opposite(&w[0], &w[1]);
}

static void see(const drive_t* d, uint16_t first, uint16_t count, deviation_t slope[]) {
  const estimator_window_t* const w = &d->samples.windows[first];
  const estimator_frame_t* const f = &d->estimate.frames[first];
  const deviation_model_t at =
      deviation_model(&commissioning.model, machine_speed_rad_q30(d->estimate.selected.speed_bpp));
  deviation_change_t seen[2];
  deviation_changes(&at, w, f, count, q_shr(d->estimate.seen_q20.q, 2), seen);
  for (uint16_t k = 0; k < count; k++) slope[k] = deviation_slope(&seen[k], w[k].span_ticks);
}

deviation_t commissioning_window(const drive_t* d, uint16_t k) {
  deviation_t slope;
  see(d, k, 1, &slope);
  return slope;
}

bool commissioning_add_pair(const drive_t* d, tensor_sums_t* sums) {
  if (!commissioning_has_pair(d)) return false;
  deviation_t slope[2];
  see(d, 0, 2, slope);
  tensor_add(sums, &slope[0], &slope[1]);
  return true;
}

void commissioning_add_still(const drive_t* d) {
  if (d->schedule.task == TASK_JUDGE) return;  // has the torque constant to make
  (void)commissioning_add_pair(d, &commissioning.unsaturated);
}
