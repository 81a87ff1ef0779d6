// After a start: the first time that the shaft turns fast enough, the back-EMF must confirm the polarity.
//
// The speed it is compared with comes from an observer of its own that follows the axis of the saliency and knows
// nothing of magnet and torque: the deviation observer takes a back-EMF of the wrong sign for a speed, and would turn
// itself the right way round at some hundred rpm in the wrong direction. Once confirmed the watch is over. The check of
// synchronism may be faster; then the sign seen so far tells which fault it is.

#include "firmware/start/polarity_watch.h"

#include "firmware/drive.h"
#include "firmware/parameters.h"

#define BANDWIDTH_STEP_Q30 21474836L  // 200 rad/s * T

void polarity_watch_begin(drive_t* d, uint32_t angle_bam, int32_t speed_bpp) {
  polarity_watch_t* const w = &d->watch;
  w->open = parameters.polarity_check != 0;
  tracking_observer_preset(&w->axis, angle_bam, speed_bpp, 0);
  emf_sign_reset(&w->sign);
}

static const regression_t* regression_in_use(const drive_t* d) {
  return (parameters.position_source >= POSITION_OBSERVER) ? &d->position.observer.regression
                                                           : &d->position.avv.regression;
}

// The axis that this period's windows have shown.
static uint32_t axis_seen(const drive_t* d) {
  const drive_position_t* const p = &d->position;
  if (parameters.position_source < POSITION_OBSERVER) return p->avv.observer.angle_bam + (uint32_t)p->avv.error_bam;
  return p->observer.angle_bam + (uint32_t)avv_angle_error(&p->observer.regression, &d->model);
}

// While the current is large or the windows do not show the axis.
static bool is_blind(const drive_t* d) {
  return q_abs_sat(d->control.measured_q20.q) > parameters.current_limit / 2 ||
         (d->samples.count > 0u && regression_in_use(d)->information == 0);
}

// From the frame in use to the watch's own: an angle in use that is off must not look like a magnet that is reversed.
static dq_t on_axis(dq_t x, rotation_t r) {
  const ab_t turned = frame_inverse_park(x, r);
  const dq_t own = {turned.alpha, turned.beta};
  return own;
}

bool polarity_watch_is_awake(const drive_t* d) { return d->watch.open && d->state == DRIVE_RUN; }

bool polarity_watch_step(drive_t* d) {
  polarity_watch_t* const w = &d->watch;
  if (!w->open || d->state != DRIVE_RUN) return false;
  if (!polarity_watch_is_awake(d) || is_blind(d)) {
    tracking_observer_preset(&w->axis, d->position.used.angle_bam, d->position.used.speed_bpp, 0);
    w->sign.clear = 0;
    w->sign.against = 0;
    return false;
  }
  tracking_observer_predict(&w->axis, 0);
  // The axis is known up to half a turn.
  const int32_t off = angle_diff_bam(axis_seen(d) * 2u, w->axis.angle_bam * 2u) / 2;
  if (d->samples.count > 0u) tracking_observer_correct(&w->axis, off, BANDWIDTH_STEP_Q30);
  const rotation_t r = frame_rotation(d->position.used.angle_bam - w->axis.angle_bam);
  const emf_sign_result_t sign = emf_sign_step(&w->sign, &d->model, on_axis(d->control.command_q16, r),
                                               on_axis(d->control.measured_q20, r), w->axis.speed_bpp);
  if (sign != EMF_SIGN_OPEN) w->open = false;
  return sign == EMF_SIGN_REVERSED;
}

bool polarity_watch_suspects(const drive_t* d) {
  const emf_sign_t* const sign = &d->watch.sign;
  return d->watch.open && sign->seen_q16 < -sign->expected_q16 / 4;
}
