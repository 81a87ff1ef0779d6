// AVV alone: the start's estimator, and a source.

#include <stddef.h>

#include "firmware/sources/sources.h"

int32_t source_deviation_q20;

void source_step_avv(drive_t* d, const estimator_input_t* in) {
  d->position.high = avv_step(&d->position.avv, &d->config.avv, in);
  if (d->flags.frozen) return;
  if (d->schedule.slot == SLOT_REGRESSION) d->position.is_near = q_abs_sat(d->position.avv.error_bam) <= AVV_NEAR_BAM;
  source_learn(d, &d->position.avv.regression);
}

static estimator_output_t source_avv(drive_t* d, estimator_input_t* in) {
  source_step_avv(d, in);
  return d->position.high;
}

const position_source_t avv_source = {source_avv, NULL, NULL, NULL, NULL, NULL, SOURCE_AVV_FIRST | SOURCE_ACTIVE, 3};
