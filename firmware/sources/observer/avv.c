// AVV alone: the start's estimator, and a source.

#include <stddef.h>

#include "firmware/sources/observer/observer.h"

int32_t source_deviation_q20;

void source_step_avv(const drive_t* d, drive_estimate_t* e, const estimator_input_t* in) {
  e->high = avv_step(&e->avv, &d->config.avv, in);
  if (d->flags.frozen) return;
  if (d->schedule.slot == SLOT_REGRESSION) e->avv.is_near = (q_abs_sat(e->avv.error_bam) <= AVV_NEAR_BAM) ? 1u : 0u;
  source_learn(d, e, &e->avv.regression);
}

static estimator_output_t source_avv(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  source_step_avv(d, e, in);
  return e->high;
}

const position_source_t avv_source = {source_avv, NULL, NULL, NULL, NULL, NULL, SOURCE_AVV_FIRST | SOURCE_ACTIVE, 3};
