// The start of a shaft that stands: axis, then polarity, by saturation or by a motion. See start.h.

#include <stddef.h>

#include "estimators/wiring.h"
#include "firmware/api/status.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"
#include "hal/qmath/qcall.h"

#define AXIS_SKIP 4u         // periods for the alternating layout to be what is sampled
#define SETTLE_PERIODS 100u  // for the current loop to settle at zero, and the angle
#define CALM_PERIODS 100u    // without current after a test, for the angle and for what is learnt of a standing shaft
#define RESISTANCE_SHARE 16  // less than a sixteenth off is left alone
#define SATURATION_TRIES 3u
#define MOTION_TRIES 4u
#define HELD_TRIES 6u
#define HOLD_BACKS 2u
#define TURNING_RPM 20  // slower counts as standing, AVV's speed is noise

static void begin_axis(drive_t* d) {
  if (start_begin_standstill(d)) start_enter(START_AXIS);
}

static drive_fault_t fault_of(wiring_t wiring) {
  if (wiring == WIRING_GOOD) return FAULT_NONE;
  if (wiring == WIRING_NO_CURRENT) return FAULT_NO_CURRENT;
  if (wiring <= WIRING_OPEN_C) return FAULT_OPEN_PHASE;
  return (wiring <= WIRING_REVERSED_BOTH) ? FAULT_CURRENT_SENSOR : FAULT_SENSOR_ORDER;
}

static start_phase_t step_axis(drive_t* d) {
  int32_t axis_bam = 0;
  const bool seen = start_sees_axis(d, starting.tick >= AXIS_SKIP, &axis_bam);
  position_preset_axis(&d->estimate, (uint32_t)axis_bam, 0);  // the regressions must be made at one and the same angle
  if (!seen) return START_GOES_ON;
  const drive_fault_t fault = fault_of((wiring_t)feature_status.wiring);
  if (fault != FAULT_NONE) {
    drive_trip(d, fault);
    return START_GOES_ON;
  }
  if (starting.uniform && d->flags.behind == DRIVE_COMMISSION) {
    start_run(d, 0, 0);
    return START_GOES_ON;
  }
  if (!start_is_open_loop(d)) return START_SETTLE;
  d->estimate.model = d->config.nameplate;
  return START_IF_RAMP;
}

// AVV's speed where it is more than noise.
static int32_t present_speed(const drive_t* d) {
  const int32_t speed = d->estimate.avv.observer.speed_bpp;
  const int32_t least = config_slow_bpp(&d->config, TURNING_RPM);
  return (qc_abs_sat(speed) > least) ? speed : 0;
}

// The angle is AVV's, or half a turn away.
static start_phase_t decided(drive_t* d, polarity_result_t result, int32_t sigma_q8) {
  const uint32_t angle = d->estimate.avv.observer.angle_bam;
  const int32_t speed = present_speed(d);
  starting.sigma_q8 = sigma_q8;
  start_run(d, (result == POLARITY_WRONG) ? angle + ANGLE_BAM_HALF_TURN : angle, speed);
  if (d->state == DRIVE_RUN && speed == 0) hold_begin(d);
  return START_GOES_ON;
}

static void begin_test(start_phase_t phase) {
  static const followed_t none = {0, 0};
  starting.followed = none;
  start_enter(phase);
}

static drive_fault_t left_open(const drive_start_t* s) { return s->starved ? FAULT_START_VOLTAGE : FAULT_POLARITY; }

// The shaft has been set in motion, or, with a voltage that is too low for the current, the angle may have gone astray,
// too: from the beginning.
static start_phase_t hold_back(drive_t* d) {
  drive_start_t* const s = &starting;
  s->held_back++;
  s->tries = 0;
  if (s->held_back <= HOLD_BACKS) return start_look(d);
  drive_trip(d, left_open(s));
  return START_GOES_ON;
}

// The current of a test has not followed: all begins anew, with less.
static start_phase_t starve(drive_t* d) {
  starting.starved = true;
  return hold_back(d);
}

// Twice as much with each try, while there is the saliency that the motion is read from; half of the last one where the
// voltage was too low for that.
static int32_t motion_current(const drive_start_t* s) {
  if (s->starved && s->motion.current_q20 > 0) return q_shr(s->motion.current_q20, 1);
  const int32_t most_q20 = q_min(drive.config.salient_q20, drive.config.values.current_limit);
  return q_min(qc_shl_sat(drive.config.values.polarity_current, s->tries), most_q20);
}

static void begin_motion(drive_t* d) {
  drive_start_t* const s = &starting;
  if (s->phase != START_MOTION) s->tries = 0;
  const tracking_observer_t* const seen = &d->estimate.avv.observer;
  const int32_t current = motion_current(s);
  // No more than before: more of the same.
  if (s->tries > 0u && current <= s->motion.current_q20) {
    polarity_again(&s->motion, seen->angle_bam, seen->speed_bpp);
  } else {
    polarity_begin(&s->motion, current, drive_accel_q8(d, 0, current), seen->angle_bam, seen->speed_bpp);
    s->motion.bounded = s->starved;
  }
  begin_test(START_MOTION);
}

// Twice with the same current, the second time together with the first; then with half as much again.
static void begin_saturation(drive_t* d) {
  drive_start_t* const s = &starting;
  if (s->phase != START_SATURATION) s->tries = 0;
  const int32_t more = (s->tries >= 2u) ? q_shr(d->config.values.start_current, 1) : 0;
  const int32_t current = q_min(d->config.values.start_current + more, d->config.values.current_limit);
  if (s->tries == 1u) {
    saturation_again(&s->saturation);
    begin_test(START_SATURATION);
    return;
  }
  if (!saturation_is_visible(&d->estimate.model, &d->config.saturation, current)) {
    begin_motion(d);
    return;
  }
  saturation_begin(&s->saturation, &d->estimate.model, &d->config.saturation, current);
  begin_test(START_SATURATION);
}

static void begin_settle(drive_t* d) {
  d->control.references.closed = true;
  start_enter(START_SETTLE);
}

static start_phase_t step_settle(drive_t* d) {
  if (starting.tick < SETTLE_PERIODS || !start_has_exclusive_slot(d)) return START_GOES_ON;
  if (d->config.values.polarity_check == 0) return decided(d, POLARITY_RIGHT, 0);
  return (starting.held_back > 0u) ? START_MOTION : START_SATURATION;
}

// A winding that is much colder or warmer than when it was measured: what follows may stand under load at once.
static void take_resistance(drive_t* d) {
  const int32_t more_q24 = saturation_resistance_q24(&starting.saturation, &d->estimate.model);
  if (qc_abs_sat(more_q24) > d->estimate.model.nominal_rs_q24 / RESISTANCE_SHARE)
    voltage_match_resistance(&d->estimate.model, more_q24);
}

static start_phase_t step_saturation(drive_t* d) {
  drive_start_t* const s = &starting;
  saturation_t* const test = &s->saturation;
  const int32_t reference_q20 = saturation_step(test, &d->estimate.avv.regression, &d->estimate.model);
  d->control.references.current_q20.d = reference_q20;
  const int16_t tick = (int16_t)((test->tick - 1) % SATURATION_SEGMENT);
  if (s->tick <= SATURATION_LENGTH)
    followed_step(&s->followed, tick, SATURATION_SEGMENT, reference_q20, d->estimate.measured_q20.d);
  if (test->result == POLARITY_PENDING || s->tick < SATURATION_LENGTH + CALM_PERIODS || !start_has_exclusive_slot(d))
    return START_GOES_ON;
  s->tries++;
  if (!followed_well(&s->followed, test->current_q20)) return starve(d);
  if (test->result != POLARITY_AMBIGUOUS) {
    take_resistance(d);
    return decided(d, test->result, test->sigma_q8);
  }
  if (s->tries < SATURATION_TRIES) return START_SATURATION;
  return (present_speed(d) == 0) ? START_MOTION : hold_back(d);
}

static start_phase_t step_motion(drive_t* d) {
  drive_start_t* const s = &starting;
  const uint32_t raw = d->estimate.avv.observer.angle_bam + (uint32_t)d->estimate.avv.error_bam;
  const bool pending = s->motion.result == POLARITY_PENDING;
  const int16_t tick = s->motion.tick;
  const int32_t reference_q20 = polarity_step(&s->motion, raw);
  d->control.references.current_q20.q = reference_q20;
  if (pending) followed_step(&s->followed, tick, s->motion.length, reference_q20, d->estimate.measured_q20.q);
  if (s->motion.result == POLARITY_PENDING || !start_has_exclusive_slot(d)) return START_GOES_ON;
  s->tries++;
  if (!followed_well(&s->followed, s->motion.current_q20)) return starve(d);
  if (s->motion.result != POLARITY_AMBIGUOUS) return decided(d, s->motion.result, s->motion.sigma_q8);
  if (s->tries < (s->starved ? HELD_TRIES : MOTION_TRIES)) return START_MOTION;
  s->sigma_q8 = s->motion.sigma_q8;
  drive_trip(d, left_open(s));
  return START_GOES_ON;
}

const phase_t axis_phase = {begin_axis, step_axis, NULL};
const phase_t settle_phase = {begin_settle, step_settle, NULL};
const phase_t saturation_phase = {begin_saturation, step_saturation, NULL};
const phase_t motion_phase = {begin_motion, step_motion, NULL};
