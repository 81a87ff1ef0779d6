// After a start: the first time that the shaft turns fast enough, the back-EMF must confirm the polarity.
//
// The speed it is compared with comes from an observer of its own that follows the axis of the saliency and knows
// nothing of magnet and torque: the deviation observer takes a back-EMF of the wrong sign for a speed, and would turn
// itself the right way round at some hundred rpm in the wrong direction. Once confirmed the watch is over. The check of
// synchronism may be faster; then the sign seen so far tells which fault it is.
//
// Axis and back-EMF are looked at in slots (schedule.c), once in each round of them: the axis a few periods after the
// windows were regressed, and with it what the back-EMF is told by. Without an axis the back-EMF says nothing: what had
// been seen of it until then stays. Between its looks the axis coasts.

#include "firmware/drive/polarity_watch.h"

#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

#define SUM_PERIODS 64                // of up to 4096 V: a round of the slots is shorter
#define WAITED_MAX 32                 // periods: then it is looked behind a renewal, too
#define BANDWIDTH_STEP_Q30 12884902L  // 120 rad/s * T

polarity_watch_t polarity_watch;

static void forget_voltage(polarity_watch_t* w) {
  w->voltage_q12.d = 0;
  w->voltage_q12.q = 0;
  w->periods = 0;
}

static void forget_axis(polarity_watch_t* w) {
  w->axis_periods = 0;
  w->then_periods = 0;
}

void polarity_watch_begin(uint32_t angle_bam, int32_t speed_bpp) {
  polarity_watch_t* const w = &polarity_watch;
  w->open = drive.config.values.polarity_check != 0;
  tracking_observer_preset(&w->axis, angle_bam, speed_bpp, 0);
  forget_axis(w);
  w->samples_invalid = false;
  emf_sign_reset(&w->sign);
  forget_voltage(w);
}

static const regression_t* regression_in_use(const drive_t* d) {
  return drive_source_has(d, SOURCE_READS) ? &d->estimate.observer.regression : &d->estimate.avv.regression;
}

// Several periods at once, at the mean of the speeds before and after.
static void move_axis(tracking_observer_t* s, int32_t periods) {
  const uint32_t angle_bam = s->angle_bam;
  const int32_t before_bpp = s->speed_bpp;
  tracking_observer_predict(s, q_sat64(-q_product(s->load_accel_q8, periods - 1)));
  s->angle_bam = angle_bam + (uint32_t)(before_bpp / 2 + s->speed_bpp / 2) * (uint32_t)periods;
}

// Moves the axis on to now. How far the axis that the windows have shown is ahead of it: AVV's of this period, the
// observer's when it regressed them last. It is known up to half a turn.
static int32_t axis_off(const drive_t* d) {
  const drive_estimate_t* const p = &d->estimate;
  polarity_watch_t* const w = &polarity_watch;
  move_axis(&w->axis, w->then_periods);
  uint32_t own = w->axis.angle_bam;
  move_axis(&w->axis, w->axis_periods - w->then_periods);
  uint32_t from = p->observer.regressed_bam;
  if (!drive_source_has(d, SOURCE_READS)) {
    own = w->axis.angle_bam;
    from = p->avv.observer.angle_bam;
  }
  return angle_diff_bam((from + (uint32_t)p->avv.error_bam) * 2u, own * 2u) / 2;
}

// While the current is large or the windows do not show the axis.
static bool samples_are_invalid(const drive_t* d) {
  return q_abs_sat(d->estimate.measured_q20.q) > d->config.values.current_limit / 2 ||
         (d->samples.count > 0u && regression_in_use(d)->information == 0);
}

// From the frame in use to the watch's own: an angle in use that is off must not look like a magnet that is reversed.
static dq_t on_axis(dq_t x, rotation_t r) {
  const ab_t turned = frame_inverse_park(x, r);
  const dq_t own = {turned.alpha, turned.beta};
  return own;
}

// The change of the current counts from here, too.
static void begin_sums(polarity_watch_t* w, int32_t iq_q20) {
  w->sign.last_iq_q20 = iq_q20;
  forget_voltage(w);
}

// The axis is the one in use for now.
static void begin_anew(const drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  tracking_observer_preset(&w->axis, d->estimate.selected.angle_bam, d->estimate.selected.speed_bpp, 0);
  w->sign.agreed = 0;
  w->sign.periods = 0;
  begin_sums(w, d->estimate.measured_q20.q);
}

// Takes the error that was seen once for every period since the last time.
static void follow_axis(const drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  w->samples_invalid = samples_are_invalid(d);
  if (w->samples_invalid) {
    begin_anew(d);
  } else {
    const int32_t off = axis_off(d);
    if (d->samples.count > 0u) {
      tracking_observer_correct(&w->axis, q_sat64(q_product(off, w->axis_periods)), BANDWIDTH_STEP_Q30);
    }
  }
  forget_axis(w);
}

static int32_t mean_volts_q16(int32_t sum_q12, int32_t periods) { return sum_q12 / periods * 16; }

static void look(const drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  const uint32_t axis_bam = w->axis.angle_bam + (uint32_t)w->axis.speed_bpp * w->axis_periods;
  const rotation_t r = frame_rotation(d->estimate.selected.angle_bam - axis_bam);
  const dq_t mean_q16 = {mean_volts_q16(w->voltage_q12.d, w->periods), mean_volts_q16(w->voltage_q12.q, w->periods)};
  const emf_sign_seen_t seen = {on_axis(mean_q16, r).q, on_axis(d->estimate.measured_q20, r), w->axis.speed_bpp,
                                w->periods};
  emf_sign_look(&w->sign, &d->estimate.model, &seen);
  forget_voltage(w);
}

static bool says_reversed(const drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  const emf_sign_result_t sign = emf_sign_judge(&w->sign, &d->estimate.model, w->axis.speed_bpp);
  if (sign != EMF_SIGN_OPEN) w->open = false;
  return sign == EMF_SIGN_REVERSED;
}

void polarity_watch_end(void) { polarity_watch.open = false; }

// Commands are within 4096 V (CURRENT_COMMAND_END_Q16).
static void gather(const drive_t* d, polarity_watch_t* w) {
  if (w->periods >= SUM_PERIODS) begin_sums(w, d->estimate.measured_q20.q);
  w->voltage_q12.d += q_shr(d->control.command_q16.d, 4);
  w->voltage_q12.q += q_shr(d->control.command_q16.q, 4);
  w->periods++;
  w->axis_periods++;
}

// The back-EMF's slot is one with room: with three windows the match of the voltage, which rests meanwhile
// (learning.c), with two the regression, where what was seen waits for the next look at the axis. Not where the
// observer has renewed its covariance, unless that goes on.
static bool looks_now(const drive_t* d, polarity_watch_t* w, bool full) {
  if (d->schedule.slot == SLOT_REGRESSION) w->then_periods = w->axis_periods;
  if (d->schedule.slot != (full ? SLOT_VOLTAGE : SLOT_REGRESSION)) return false;
  const bool renewed = d->estimate.observer.gathered.periods == 0 && drive_source_has(d, SOURCE_OBSERVES);
  return !(w->samples_invalid || (renewed && w->periods < WAITED_MAX));
}

bool polarity_watch_step(const drive_t* d) {
  polarity_watch_t* const w = &polarity_watch;
  if (!polarity_watch_is_awake(d)) return false;
  gather(d, w);
  if (d->schedule.slot == SLOT_LOOK) {
    follow_axis(d);
  } else {
    const bool full = d->samples.count >= ESTIMATOR_WINDOWS;
    if (!looks_now(d, w, full)) return false;
    look(d);
    if (!full) return false;
  }
  return says_reversed(d);
}

bool polarity_watch_suspects(void) {
  const emf_sign_t* const sign = &polarity_watch.sign;
  return polarity_watch.open && sign->seen_q16 < -(sign->expected_q16 / 4);
}
