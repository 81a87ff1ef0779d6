// The deviation observer: alone at all speeds, or at low speed with AVV above.

#include "firmware/sources/observer/observer.h"

#include <stddef.h>

#include "firmware/drive/steps.h"

static estimator_output_t step_observer(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in) {
  const deviation_observer_config_t* const c = d->schedule.held ? &d->config.hold_observer : &d->config.observer;
  e->low = deviation_observer_step(&e->observer, c, in);
  return e->low;
}

// One estimator for all speeds; the regression is that of its own deviations.
estimator_output_t source_observer(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  const estimator_output_t out = step_observer(d, e, in);
  deviation_observer_t* const o = &e->observer;
  // Whether the windows agree with the angle, so that the regression is linear, is asked in the place behind it.
  if (d->schedule.slot == SLOT_REGRESSION) e->avv.is_near = (in->regress && in->window_count > 0u) ? 1u : 0u;
  if (d->schedule.slot == SLOT_LOOK) {
    const int32_t error_bam = avv_angle_error(&o->regression, &e->model);
    e->avv.error_bam = error_bam;
    // An axis that hardly shows says nothing of the angle; a start at rest is refused there, and the EMF tells it.
    if (q_abs_sat(error_bam) > AVV_NEAR_BAM && !inverse_inductance_is_weak(&e->model)) e->avv.is_near = 0;
  }
  source_learn(d, e, &o->regression);
  e->high = out;
  return out;
}

static estimator_output_t source_observer_avv(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  (void)step_observer(d, e, in);
  in->frames = 0;
  source_step_avv(d, e, in);
  return blend_step(&e->blend, &d->config.blend, &e->low, &e->high);
}

const position_source_t observer_source = {
    source_observer, NULL, NULL, NULL, NULL, NULL, SOURCE_SINGLE | SOURCE_OBSERVES | SOURCE_READS, 2};
const position_source_t observer_avv_source = {
    source_observer_avv, NULL, NULL, NULL, NULL, NULL, SOURCE_OBSERVES | SOURCE_BESIDE | SOURCE_ACTIVE, 3};
