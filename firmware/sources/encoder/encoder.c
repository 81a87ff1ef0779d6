// The reference encoder: angle from the count and the offset found at the start; a tracking observer makes a speed of
// it.

#include <stddef.h>

#include "estimators/zvv.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/sources.h"

static estimator_output_t source_encoder(drive_t* d, estimator_input_t* in) {
  in->frames = 0;
  const uint32_t angle = position_encoder_now(d) + d->position.encoder_offset_bam;
  tracking_observer_predict(&d->position.encoder, in->torque_accel_q8);
  tracking_observer_correct(&d->position.encoder, angle_diff_bam(angle, d->position.encoder.angle_bam),
                            d->config.avv.bandwidth_long_q30);
  estimator_output_t out = {d->position.encoder.angle_bam, d->position.encoder.speed_bpp,
                            d->position.encoder.load_accel_q8, 32767};
  if (d->config.values.flux_beside > 0) {
    d->position.high = flux_source_look_on(d, in, &out);
  } else {
    source_step_avv(d, in);
  }
  d->position.low = out;
  // Behind the observer: turning the frame is no motion of the shaft.
  out.angle_bam += d->config.encoder_trim_bam;
  (void)zvv_deviation_q20(in, out.angle_bam, out.speed_bpp, &d->position.deviation_q20);
  return out;
}

const position_source_t encoder_source = {source_encoder, NULL, NULL, NULL, NULL, SOURCE_MEASURES | SOURCE_SINGLE};
