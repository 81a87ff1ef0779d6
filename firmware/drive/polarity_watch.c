// After a start: the first time that the shaft turns fast enough, the back-EMF must confirm the polarity.
//
// The speed it is compared with comes from an observer of its own that follows the axis of the saliency and knows
// nothing of magnet and torque: the deviation observer takes a back-EMF of the wrong sign for a speed, and would turn
// itself the right way round at some hundred rpm in the wrong direction. Once confirmed the watch is over. The check of
// synchronism may be faster; then the sign seen so far tells which fault it is.
//
// Axis and back-EMF are looked at in slots (schedule.c), once in each round of them: the axis a few periods after the
// windows were regressed. Without an axis the back-EMF says nothing: what had been seen of it until then stays.

#include "firmware/drive/polarity_watch.h"

#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

#define SUM_END_Q12 1073741824L       // of 64 periods of 4096 V
#define VOLTS_END_Q12 16777216L       // 4096 V
#define PERIODS_END 10000L            // a second: a round of the slots is much shorter
#define WAITED_MAX 32                 // periods: then it is looked behind a renewal, too
#define BANDWIDTH_STEP_Q30 12884902L  // 120 rad/s * T

polarity_watch_t polarity_watch;

static void forget_voltage(polarity_watch_t* w) {
  w->voltage_q12.d = 0;
  w->voltage_q12.q = 0;
  w->periods = 0;
}

void polarity_watch_begin(uint32_t angle_bam, int32_t speed_bpp) {
  polarity_watch_t* const w = &polarity_watch;
  w->open = drive.config.values.polarity_check != 0;
  tracking_observer_preset(&w->axis, angle_bam, speed_bpp, 0);
  w->axis_periods = 0;
  w->samples_invalid = false;
  emf_sign_reset(&w->sign);
  forget_voltage(w);
}

static const regression_t* regression_in_use(const drive_t* d) {
  return drive_source_has(d, SOURCE_READS) ? &d->position.observer.regression : &d->position.avv.regression;
}

// How far the axis that the windows have shown is ahead of the watch's: AVV's of this period, the observer's when it
// regressed them last. It is known up to half a turn.
static int32_t axis_off(const drive_t* d) {
  const drive_position_t* const p = &d->position;
  const polarity_watch_t* const w = &polarity_watch;
  const bool observed = drive_source_has(d, SOURCE_READS);
  const uint32_t from = observed ? p->observer.regressed_bam : p->avv.observer.angle_bam;
  const int32_t error = observed ? avv_angle_error(&p->observer.regression, &d->model) : p->avv.error_bam;
  const uint32_t own = observed ? w->axis_then_bam : w->axis.angle_bam;
  return angle_diff_bam((from + (uint32_t)error) * 2u, own * 2u) / 2;
}

// While the current is large or the windows do not show the axis.
static bool samples_are_invalid(const drive_t* d) {
  return q_abs_sat(d->control.measured_q20.q) > d->config.values.current_limit / 2 ||
         (d->samples.count > 0u && regression_in_use(d)->information == 0);
}

// From the frame in use to the watch's own: an angle in use that is off must not look like a magnet that is reversed.
static dq_t on_axis(dq_t x, rotation_t r) {
  const ab_t turned = frame_inverse_park(x, r);
  const dq_t own = {turned.alpha, turned.beta};
  return own;
}

// The axis is the one in use for now, and the change of the current counts from here.
static void begin_anew(drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  tracking_observer_preset(&w->axis, d->position.selected.angle_bam, d->position.selected.speed_bpp, 0);
  w->axis_then_bam = w->axis.angle_bam;
  w->sign.clear = 0;
  w->sign.against = 0;
  w->sign.last_iq_q20 = d->control.measured_q20.q;
  forget_voltage(w);
}

// Takes the error that was seen once for every period since the last time.
static void follow_axis(drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  const int32_t periods = w->axis_periods;
  w->axis_periods = 0;
  w->samples_invalid = samples_are_invalid(d);
  if (w->samples_invalid) {
    begin_anew(d);
  } else if (d->samples.count > 0u) {
    tracking_observer_correct(&w->axis, q_sat64(q_product(axis_off(d), periods)), BANDWIDTH_STEP_Q30);
  }
}

static int32_t mean_volts_q16(int32_t sum_q12, int32_t periods) {
  return q_limit(sum_q12 / periods, VOLTS_END_Q12) * 16;
}

static emf_sign_result_t look(drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  const rotation_t r = frame_rotation(d->position.selected.angle_bam - w->axis.angle_bam);
  const dq_t mean_q16 = {mean_volts_q16(w->voltage_q12.d, w->periods), mean_volts_q16(w->voltage_q12.q, w->periods)};
  // A look that was late counts as one of 32 periods: the sign has to be seen twice.
  const emf_sign_seen_t seen = {on_axis(mean_q16, r), on_axis(d->control.measured_q20, r), w->axis.speed_bpp,
                                q_min(w->periods, WAITED_MAX)};
  return emf_sign_step(&w->sign, &d->model, &seen);
}

void polarity_watch_end(void) { polarity_watch.open = false; }

bool polarity_watch_step(drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  if (!polarity_watch_is_awake(d)) return false;
  tracking_observer_predict(&w->axis, 0);
  w->voltage_q12.d = q_limit(w->voltage_q12.d + q_shr(d->control.command_q16.d, 4), SUM_END_Q12);
  w->voltage_q12.q = q_limit(w->voltage_q12.q + q_shr(d->control.command_q16.q, 4), SUM_END_Q12);
  w->periods = q_min(w->periods + 1, PERIODS_END);
  w->axis_periods = q_min(w->axis_periods + 1, PERIODS_END);
  const schedule_slot_t slot = d->schedule.slot;
  if (slot == SLOT_LOOK) {
    follow_axis(d);
    return false;
  }
  // The back-EMF's slot is one with room: with three windows the match of the voltage, which rests meanwhile
  // (learning.c), with two the regression. Not where the observer has renewed its covariance, unless that goes on.
  const bool full = d->samples.count >= ESTIMATOR_WINDOWS;
  if (slot == SLOT_REGRESSION) {
    w->axis_then_bam = w->axis.angle_bam;
    if (full) return false;
  } else if (slot != SLOT_VOLTAGE || !full) {
    return false;
  }
  const bool renewed = d->position.observer.gathered.periods == 0 && drive_source_has(d, SOURCE_OBSERVES);
  if (w->samples_invalid || (renewed && w->periods < WAITED_MAX)) return false;
  const emf_sign_result_t sign = look(d);
  forget_voltage(w);
  if (sign != EMF_SIGN_OPEN) w->open = false;
  return sign == EMF_SIGN_REVERSED;
}

bool polarity_watch_suspects(void) {
  const emf_sign_t* const sign = &polarity_watch.sign;
  return polarity_watch.open && sign->seen_q16 < -(sign->expected_q16 / 4);
}
