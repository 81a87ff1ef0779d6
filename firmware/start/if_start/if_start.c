// The I-F start of a shaft that stands: see control/if_start.h. The position source runs beside it; when it agrees, the
// drive runs on with what the source says, and with the torque that the vector had.
//
// A flux source that takes over above flux_high has the shaft alone: its integral begins when the vector has reached
// its speed, with the flux that the vector lets expect. Below, and with the other sources, the shaft is seen from the
// end of the vector's rest on.
//
// A rotor with next to no saliency is seen by its EMF alone. Below if_speed the vector takes it back from RUN, bears
// its load, and turns it as slowly as is commanded, or through standstill.

#include "firmware/start/if_start/if_start.h"

#include <stddef.h>

#include "estimators/voltage_match.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/position.h"
#include "firmware/mode/mode.h"
#include "hal/qmath/qcall.h"
#include "hal/qmath/qtrig.h"

#define PER_FOUR_PERIODS_Q58 720575940L  // 2^58 / 4 N^2, N = 10 000 ticks

if_start_t if_ramp;

// The EMF alone does not show the rotor at this speed.
static bool is_too_slow(int32_t speed_bpp) { return qc_abs_sat(speed_bpp) < if_ramp_config.speed_bpp; }

// The vector has the shaft from here on.
static void enter_if_ramp(drive_t* d) {
  polarity_watch_end();
  d->flags.open_loop = true;
  start_enter(START_IF_RAMP);
}

static void begin_if_ramp(drive_t* d) {
  if (!start_begin_standstill(d)) return;
  position_look_away(&d->estimate);
  if_start_begin(&if_ramp, &if_ramp_config, 0, d->control.target_bpp < 0);
  current_controller_reset(&d->control.current);
  d->control.references.closed = true;
  if (drive_source_has(d, SOURCE_HANDS_OVER) && if_ramp_config.speed_bpp > d->config.blend.high_bpp)
    position_bumpless_transfer(&d->estimate);
  enter_if_ramp(d);
}

// Whether the source has anything to see: not while the vector rests, nor on the way through standstill.
static bool sees(const if_start_t* ramp) {
  const bool slow = ramp->took_over && is_too_slow(2 * ramp->speed_bpp);
  return ramp->tick >= if_ramp_config.align_periods && !slow;
}

// Whether the source looks on in this period. At rest the angle is the vector's: a saliency has two.
static bool looks_on(const drive_t* d, drive_estimate_t* e, const if_start_t* ramp) {
  if (position_observer_rests(d) && !if_start_is_up(ramp, &if_ramp_config)) {
    if (d->source->follow != NULL) d->source->follow(d, &e->selected);
    return false;
  }
  if (sees(ramp)) return true;
  position_preset(d, e, e->selected.angle_bam, e->selected.speed_bpp);
  return false;
}

// The control uses the vector's frame.
static estimator_output_t estimate_if_ramp(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  const if_start_t* const ramp = &if_ramp;
  if (looks_on(d, e, ramp)) {
    position_look_on(d, e, in);
  } else {
    position_look_away(e);
  }
  const estimator_output_t out = {ramp->angle_bam + (uint32_t)ramp->speed_bpp, ramp->speed_bpp, 0, 0};
  return out;
}

// The estimators go on as they are. No watch over the polarity: a source that took the magnet for reversed would have
// been half a turn away from the vector.
static void take_over(drive_t* d) {
  drive_control_t* const c = &d->control;
  const dq_t own_q20 = position_seen(d, c->references.current_q20);
  position_keep(d, &d->estimate);
  hold_end();
  c->ramp.value = d->estimate.selected.speed_bpp;
  c->references.current_q20.d = 0;
  c->references.current_q20.q = own_q20.q;
  speed_controller_preset(&c->speed, 0);
  current_controller_reset(&c->current);
  const drive_state_t behind = d->flags.behind;
  drive_enter(d, behind);
  d->flags.spins = behind == DRIVE_COMMISSION;
}

// The current is controlled at the periods' ends. In the mean of the two periods that take turns it is more, by the
// ripple: that of a leg is its pulse times what lacks to the period's middle, over the period squared.
static int32_t mean_length_q20(const drive_t* d) {
  int32_t leg[SVPWM_LEGS];  // four times that, ticks squared
  for (uint16_t k = 0; k < SVPWM_LEGS; k++) {
    leg[k] = 0;
    for (uint16_t n = 0; n < 2u; n++) {
      const svpwm_pulses_t* const p = &d->modulation.patterns[n].pulses;
      leg[k] += svpwm_on_ticks(p, k) * (SVPWM_PERIOD_TICKS - p->at[k] - p->at[svpwm_fall_of(k)]);
    }
  }
  const abc_t legs = {leg[0], leg[1], leg[2]};
  const int32_t along_q28 = qc_mul(frame_turned(frame_clarke3(legs), if_ramp.angle_bam).d, PER_FOUR_PERIODS_Q58, 30);
  const int32_t swing_q20 = qc_mul_sat(d->samples.link_q16, d->estimate.model.yd_q30, 26);  // of the link over a period
  return q_max(if_ramp.current_q20 + qc_mul(swing_q20, along_q28, 28), if_ramp.current_q20 / 2);
}

// A winding at rest has no EMF: the vector's voltage is that of the resistance, cold or warm. Where the rotor is seen
// by its EMF alone, its speed is known by that. It has to be known what devices and dead time take: sensors that are
// matched say that a commissioning has measured them all.
static void take_resistance(drive_t* d) {
  const int32_t left = if_ramp_config.align_periods - if_ramp.tick;
  const bool measures = if_is_blind && d->config.sensor_mismatch_q30 != 0;
  if (!measures || left <= 0 || left > (int32_t)DRIVE_PERIODS_PER_MS) return;
  const int32_t voltage_q16 = qc_add_sat(if_ramp.mean_q16.d, if_ramp.own_q16.d);
  machine_model_t* const m = &d->estimate.model;
  voltage_match_resistance(m, q_div(voltage_q16, mean_length_q20(d), 28) - m->rs_q24);
}

static start_phase_t step_if_ramp(drive_t* d) {
  const estimator_output_t* const seen = &d->estimate.seen;
  if (d->schedule.task == TASK_FIELD) {
    if (if_ramp.took_over) if_start_turn_to(&if_ramp, &if_ramp_config, d->control.target_bpp);
    take_resistance(d);
    if_start_renew(&if_ramp, &if_ramp_config, d->control.command_q16);
  }
  const if_start_result_t result =
      if_start_step(&if_ramp, &if_ramp_config, d->control.command_q16, seen->angle_bam, seen->speed_bpp);
  d->control.references.current_q20.d = if_ramp.current_q20;
  d->control.references.current_q20.q = 0;
  if (result == IF_START_TAKEN_OVER && start_has_exclusive_slot(d)) take_over(d);
  if (result == IF_START_FAILED) drive_trip(d, FAULT_DIVERGENCE);
  return START_GOES_ON;
}

const phase_t if_ramp_phase = {begin_if_ramp, step_if_ramp, estimate_if_ramp};

// The frame that is controlled in moves ahead: what the controllers have summed up stays where it is.
static void turn_controllers(current_controller_t* c, uint32_t ahead_bam) {
  const dq_t until_now_q20 = {c->d.integral_q20, c->q.integral_q20};
  const dq_t then_q20 = frame_moved(until_now_q20, ahead_bam);
  c->d.integral_q20 = then_q20.d;
  c->q.integral_q20 = then_q20.q;
}

// The vector is so long that it bears twice the load, and so far ahead of the rotor that it bears just this.
static void take_rotor(drive_t* d) {
  const estimator_output_t* const now = &d->estimate.selected;
  const int32_t load_q20 = qc_mul_sat(now->load_accel_q8, d->estimate.model.torque_per_accel_q24, 20);
  const int32_t limit_q20 = d->config.values.current_limit;
  const int32_t q_q20 = q_limit(qc_over(load_q20, d->control.per_torque_constant, 24), limit_q20);
  const int32_t length_q20 = q_clamp(2 * qc_abs_sat(q_q20), if_ramp_config.current_q20, limit_q20);
  // The sine for its angle: at a half, the most, 29 degrees for 30.
  const uint32_t ahead_bam = (uint32_t)qc_mul_sat(q_div(q_q20, length_q20, 24), ANGLE_BAM_PER_RAD, 24);
  turn_controllers(&d->control.current, ahead_bam);
  if_start_begin_turning(&if_ramp, &if_ramp_config, now->angle_bam + ahead_bam, length_q20, now->speed_bpp);
  if_start_turn_to(&if_ramp, &if_ramp_config, d->control.target_bpp);
  position_turn(&d->estimate, ahead_bam);
  d->control.references.current_q20.d = length_q20;
  d->control.references.current_q20.q = 0;
}

// Without saliency a rotor is lost near standstill: the vector takes it there, and through.
static void step_run(drive_t* d) {
  const int32_t now_bpp = d->control.ramp.value;
  const int32_t target_bpp = d->control.target_bpp;
  if (!if_is_blind || !is_too_slow(now_bpp)) return;
  if (!is_too_slow(target_bpp) && (target_bpp ^ now_bpp) >= 0) return;
  take_rotor(d);
  start_return(d);
  enter_if_ramp(d);
}

const state_t if_run_state = {NULL, step_run, NULL, NULL};
