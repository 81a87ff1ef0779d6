// The I-F start of a shaft that stands: see control/if_start.h. The position source runs beside it; when it agrees, the
// drive runs on with what the source says, and with the torque that the vector had.
//
// A flux source that takes over above flux_high has the shaft alone: its integral begins when the vector has reached
// its speed, with the flux that the vector lets expect. Below, and with the other sources, the shaft is seen from the
// end of the vector's rest on.

#include "firmware/start/if_start/if_start.h"

#include <stddef.h>

#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/position.h"
#include "firmware/mode/mode.h"

if_start_t if_ramp;

static void begin_if_ramp(drive_t* d) {
  if (!start_begin_standstill(d)) return;
  position_look_away(&d->estimate);
  if_start_begin(&if_ramp, 0, d->control.target_bpp < 0);
  current_controller_reset(&d->control.current);
  d->control.references.closed = true;
  polarity_watch_end();
  if (drive_source_has(d, SOURCE_HANDS_OVER) && if_ramp_config.speed_bpp > d->config.blend.high_bpp)
    position_bumpless_transfer(&d->estimate);
  d->flags.open_loop = true;
  start_enter(START_IF_RAMP);
}

// Whether the source looks on in this period. At rest the angle is the vector's: a saliency has two.
static bool looks_on(const drive_t* d, drive_estimate_t* e, const if_start_t* ramp) {
  if (position_observer_rests(d) && !if_start_is_up(ramp, &if_ramp_config)) {
    if (d->source->follow != NULL) d->source->follow(d, &e->selected);
    return false;
  }
  if (ramp->tick >= if_ramp_config.align_periods) return true;
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

static start_phase_t step_if_ramp(drive_t* d) {
  const estimator_output_t* const seen = &d->estimate.seen;
  if (d->schedule.task == TASK_FIELD) if_start_renew(&if_ramp, &if_ramp_config);
  const if_start_result_t result =
      if_start_step(&if_ramp, &if_ramp_config, d->control.command_q16, seen->angle_bam, seen->speed_bpp);
  d->control.references.current_q20.d = if_ramp.current_q20;
  d->control.references.current_q20.q = 0;
  if (result == IF_START_TAKEN_OVER && start_has_exclusive_slot(d)) take_over(d);
  if (result == IF_START_FAILED) drive_trip(d, FAULT_DIVERGENCE);
  return START_GOES_ON;
}

const phase_t if_ramp_phase = {begin_if_ramp, step_if_ramp, estimate_if_ramp};
