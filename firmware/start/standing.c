// The start of a shaft that stands: axis, then polarity, by saturation or by a motion. See start.h.

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/start/phases.h"

#define AXIS_SKIP 4u         // periods for the alternating layout to be what is sampled
#define SETTLE_PERIODS 100u  // for the current loop to settle at zero, and the angle
#define CALM_PERIODS 100u    // without current after a test, for the angle and for what is learnt of a standing shaft
#define RESISTANCE_SHARE 16  // less than a sixteenth off is left alone
#define SATURATION_TRIES 3u
#define MOTION_TRIES 3u
#define HELD_TRIES 6u
#define HOLD_BACKS 2u
#define TURNING_RPM_Q16 1310720L  // 20 rpm: slower counts as standing, AVV's speed is noise

static bool is_if_start_next(const drive_t* d) {
  return d->config.values.start_method == 1 && d->flags.behind != DRIVE_COMMISSION;
}

// Only where the listening has found that the shaft stands.
bool start_checks_wiring(void) {
  const config_values_t* const v = &drive.config.values;
  return v->wiring_check != 0 && v->flying_start != 0;
}

void start_find_axis(drive_t* d) {
  d->flags.shorted = false;
  d->control.closed = false;
  position_preset(d, 0, 0);
  axis_begin(&starting.axis);
  if (d->flags.gates_off) start_power(d, true);
  if (d->state != DRIVE_START) return;
  start_enter(d, START_AXIS);
  if (is_if_start_next(d) && !start_checks_wiring()) start_if_ramp(d);
}

static drive_fault_t fault_of(wiring_t wiring) {
  if (wiring == WIRING_GOOD) return FAULT_NONE;
  if (wiring == WIRING_NO_CURRENT) return FAULT_NO_CURRENT;
  if (wiring <= WIRING_OPEN_C) return FAULT_OPEN_PHASE;
  return (wiring <= WIRING_REVERSED_BOTH) ? FAULT_CURRENT_SENSOR : FAULT_SENSOR_ORDER;
}

void start_step_axis(drive_t* d) {
  int32_t axis_bam = 0;
  const bool seen = start_sees_axis(d, starting.tick >= AXIS_SKIP, &axis_bam);
  position_preset_axis(d, (uint32_t)axis_bam, 0);  // the regressions must be made at one and the same angle
  if (!seen) return;
  const drive_fault_t fault = fault_of(d->found.wiring);
  if (fault != FAULT_NONE) {
    drive_trip(d, fault);
  } else if (is_if_start_next(d)) {
    d->model = d->config.nameplate;
    position_preset(d, 0, 0);
    start_if_ramp(d);
  } else {
    d->control.closed = true;
    start_enter(d, START_SETTLE);
  }
}

// AVV's speed where it is more than noise.
static int32_t present_speed(const drive_t* d) {
  const int32_t speed = d->position.avv.observer.speed_bpp;
  const int32_t least = q_mul_sat(TURNING_RPM_Q16, d->config.bpp_per_rpm_q8, 24);
  return (q_abs_sat(speed) > least) ? speed : 0;
}

// The angle is AVV's, or half a turn away.
static void decided(drive_t* d, polarity_result_t result, int32_t sigma_q8) {
  const uint32_t angle = d->position.avv.observer.angle_bam;
  const int32_t speed = present_speed(d);
  d->found.sigma_q8 = sigma_q8;
  start_run(d, (result == POLARITY_WRONG) ? angle + ANGLE_BAM_HALF_TURN : angle, speed);
  if (d->state == DRIVE_RUN && speed == 0) hold_begin(d);
}

static void begin_test(drive_t* d, start_phase_t phase) {
  static const followed_t none = {0, 0};
  starting.followed = none;
  start_enter(d, phase);
}

static drive_fault_t left_open(const drive_start_t* s) { return s->starved ? FAULT_START_VOLTAGE : FAULT_POLARITY; }

// The shaft has been set in motion, or, with a voltage that is too low for the current, the angle may have gone astray,
// too: from the beginning.
static void hold_back(drive_t* d) {
  drive_start_t* const s = &starting;
  s->held_back++;
  s->pulses = 0;
  s->tries = 0;
  if (s->held_back > HOLD_BACKS) {
    drive_trip(d, left_open(s));
  } else {
    start_look(d);
  }
}

// True when the current of a test has followed; else all begins anew, with less.
static bool has_followed(drive_t* d, int32_t amplitude_q20) {
  if (followed_well(&starting.followed, amplitude_q20)) return true;
  starting.starved = true;
  hold_back(d);
  return false;
}

// Twice as much with each try; after one that the voltage was too low for, half of that.
static int32_t motion_current(const drive_start_t* s) {
  if (s->starved && s->motion.current_q20 > 0) return s->motion.current_q20 / 2;
  return q_min(q_shl_sat(drive.config.values.polarity_current, s->tries), drive.config.values.current_limit);
}

static void try_motion(drive_t* d) {
  drive_start_t* const s = &starting;
  if (d->found.phase != START_MOTION) s->tries = 0;
  if (s->starved && s->tries > 0u) {
    polarity_again(&s->motion, d->position.avv.observer.angle_bam);
    begin_test(d, START_MOTION);
    return;
  }
  const int32_t current = motion_current(s);
  const int32_t torque_q16 = q_mul(machine_torque_constant_q24(&d->model, 0), current, 28);
  polarity_begin(&s->motion, d->position.avv.observer.angle_bam, current,
                 q_mul_sat(torque_q16, d->model.accel_q12, 20));
  s->motion.bounded = s->starved;
  begin_test(d, START_MOTION);
}

// Twice with the same current, the second time together with the first; then with half as much again.
static void try_saturation(drive_t* d) {
  drive_start_t* const s = &starting;
  if (d->found.phase != START_SATURATION) s->tries = 0;
  const int32_t more = (s->tries >= 2u) ? d->config.values.start_current / 2 : 0;
  const int32_t current = q_min(d->config.values.start_current + more, d->config.values.current_limit);
  if (s->tries == 1u) {
    saturation_again(&s->saturation);
    begin_test(d, START_SATURATION);
    return;
  }
  if (!saturation_is_visible(&d->model, &d->config.saturation, current)) {
    try_motion(d);
    return;
  }
  saturation_begin(&s->saturation, &d->model, &d->config.saturation, current);
  begin_test(d, START_SATURATION);
}

void start_step_settle(drive_t* d) {
  if (starting.tick < SETTLE_PERIODS || !start_has_exclusive_slot(d)) return;
  if (d->config.values.polarity_check == 0) {
    decided(d, POLARITY_RIGHT, 0);
  } else if (starting.held_back > 0u) {
    try_motion(d);
  } else {
    try_saturation(d);
  }
}

// A winding that is much colder or warmer than when it was measured: what follows may stand under load at once.
static void take_resistance(drive_t* d) {
  const int32_t more_q24 = saturation_resistance_q24(&starting.saturation, &d->model);
  if (q_abs_sat(more_q24) > d->model.nominal_rs_q24 / RESISTANCE_SHARE) voltage_match_resistance(&d->model, more_q24);
}

void start_step_saturation(drive_t* d) {
  drive_start_t* const s = &starting;
  saturation_t* const test = &s->saturation;
  const int32_t reference_q20 = saturation_step(test, &d->position.avv.regression, &d->model);
  d->control.reference_q20.d = reference_q20;
  const int16_t tick = (int16_t)((test->tick - 1) % SATURATION_SEGMENT);
  if (s->tick <= SATURATION_LENGTH)
    followed_step(&s->followed, tick, SATURATION_SEGMENT, reference_q20, d->control.measured_q20.d);
  if (test->result == POLARITY_PENDING || s->tick < SATURATION_LENGTH + CALM_PERIODS || !start_has_exclusive_slot(d))
    return;
  s->tries++;
  if (!has_followed(d, test->current_q20)) return;
  if (test->result != POLARITY_AMBIGUOUS) {
    take_resistance(d);
    decided(d, test->result, test->sigma_q8);
  } else if (s->tries < SATURATION_TRIES) {
    try_saturation(d);
  } else if (present_speed(d) == 0) {
    try_motion(d);
  } else {
    hold_back(d);
  }
}

void start_step_motion(drive_t* d) {
  drive_start_t* const s = &starting;
  const uint32_t raw = d->position.avv.observer.angle_bam + (uint32_t)d->position.avv.error_bam;
  const int32_t reference_q20 = polarity_step(&s->motion, raw);
  d->control.reference_q20.q = reference_q20;
  const int16_t tick = (int16_t)((s->motion.tick - 1) % POLARITY_SEGMENT);
  if (s->tick <= POLARITY_LENGTH)
    followed_step(&s->followed, tick, POLARITY_SEGMENT, reference_q20, d->control.measured_q20.q);
  if (s->motion.result == POLARITY_PENDING || !start_has_exclusive_slot(d)) return;
  s->tries++;
  if (!has_followed(d, s->motion.current_q20)) return;
  if (s->motion.result != POLARITY_AMBIGUOUS) {
    decided(d, s->motion.result, s->motion.sigma_q8);
  } else if (s->tries < (s->starved ? HELD_TRIES : MOTION_TRIES)) {
    try_motion(d);
  } else {
    d->found.sigma_q8 = s->motion.sigma_q8;
    drive_trip(d, left_open(s));
  }
}
