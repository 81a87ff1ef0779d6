// The deviation observer: alone at all speeds, or at low speed with AVV above.

#include <stddef.h>

#include "firmware/drive/steps.h"
#include "firmware/sources/sources.h"

static estimator_output_t step_observer(drive_t* d, const estimator_input_t* in) {
  const deviation_observer_config_t* const c = d->schedule.held ? &d->config.hold_observer : &d->config.observer;
  d->position.low = deviation_observer_step(&d->position.observer, c, in);
  return d->position.low;
}

// One estimator for all speeds; the regression is that of its own deviations.
estimator_output_t source_observer(drive_t* d, estimator_input_t* in) {
  const estimator_output_t out = step_observer(d, in);
  deviation_observer_t* const o = &d->position.observer;
  // Whether the windows agree with the angle, so that the regression is linear, is asked in the place behind it.
  if (d->schedule.slot == SLOT_REGRESSION) d->position.is_near = in->regress && in->window_count > 0u;
  if (d->schedule.slot == SLOT_LOOK) {
    const int32_t error_bam = avv_angle_error(&o->regression, &d->model);
    d->position.avv.error_bam = error_bam;
    d->position.is_near = d->position.is_near && q_abs_sat(error_bam) <= AVV_NEAR_BAM;
  }
  source_learn(d, &o->regression);
  d->position.high = out;
  return out;
}

static estimator_output_t source_observer_avv(drive_t* d, estimator_input_t* in) {
  (void)step_observer(d, in);
  in->frames = 0;
  source_step_avv(d, in);
  return blend_step(&d->position.blend, &d->config.blend, &d->position.low, &d->position.high);
}

const position_source_t observer_source = {
    source_observer, NULL, NULL, NULL, NULL, NULL, SOURCE_SINGLE | SOURCE_OBSERVES | SOURCE_READS, 2};
const position_source_t observer_avv_source = {
    source_observer_avv, NULL, NULL, NULL, NULL, NULL, SOURCE_OBSERVES | SOURCE_BESIDE | SOURCE_ACTIVE, 3};
