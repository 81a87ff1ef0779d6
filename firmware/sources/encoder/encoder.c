// The reference encoder: angle from the count and the offset found at the start; a tracking observer makes a speed of
// it.

#include "firmware/sources/encoder/encoder.h"

#include <stddef.h>

#include "estimators/zvv.h"
#include "firmware/base/clear.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/observer/observer.h"
#include "hal/hal_encoder.h"
#include "hal/qmath/qcall.h"

encoder_t encoder;

void encoder_reset(void) {
  clear(&encoder, sizeof encoder);
  source_deviation_q20 = 0;
}

// Whether AVV is there to be compared with the encoder: it needs active vectors that are long enough to sample in.
static bool avv_sees(const parameters_t* p) {
  return p->current_law == CURRENT_LAW_PI && p->flux_beside == 0 && p->excitation != EXCITATION_CENTRED &&
         p->excitation < EXCITATION_LONG_ZERO;
}

static void take(void) {
  encoder.trim_bam = (uint32_t)qc_mul_sat(parameters.encoder_trim, 11930465L, 16);  // 2^32 / 360 per degree
  encoder.per_count_bam = encoder_angle(1, parameters.pole_pairs, parameters.encoder_counts);
  encoder.beside_flux = parameters.flux_beside > 0;
  encoder.beside_avv = avv_sees(&parameters);
}

void encoder_service(void) {
  if (encoder.counts == parameters.encoder_counts) return;
  encoder.counts = parameters.encoder_counts;
  hal_encoder_init((uint32_t)encoder.counts);
}

const config_part_t encoder_part = {NULL, take};

uint32_t encoder_angle(uint32_t count, int32_t pole_pairs, int32_t counts_per_turn) {
  // 2^32 / counts, exact where the counts are a power of two, to 1e-5 of a turn otherwise.
  const uint32_t per_count = 0xFFFFFFFFuL / (uint32_t)counts_per_turn + 1u;
  return count * per_count * (uint32_t)pole_pairs;
}

// What it shows now, without the offset.
static uint32_t angle_now(void) { return hal_encoder_count() * encoder.per_count_bam; }

// The present count means the angle in use. The flux may look on.
static void encoder_begin(const drive_t* d, bool keeps) {
  flux_source_begin(d, keeps);
  if (keeps) return;
  const estimator_output_t* const now = &d->estimate.selected;
  encoder.offset_bam = now->angle_bam - angle_now();
  encoder.aligned_bam = now->angle_bam;
  tracking_observer_preset(&encoder.observer, now->angle_bam, now->speed_bpp, 0);
}

static bool is_reversed(const drive_t* d) {
  const uint32_t encoder_bam = encoder.observer.angle_bam - encoder.aligned_bam;
  const uint32_t windows_bam = d->estimate.high.angle_bam - encoder.aligned_bam;
  return q_abs_sat(angle_diff_bam(windows_bam + encoder_bam, 0)) <
         q_abs_sat(angle_diff_bam(windows_bam, encoder_bam)) / 2;
}

static estimator_output_t source_encoder(const drive_t* d, drive_estimate_t* e, estimator_input_t* in) {
  in->frames = 0;
  tracking_observer_t* const o = &encoder.observer;
  tracking_observer_predict(o, in->torque_accel_q8);
  tracking_observer_correct(o, angle_diff_bam(angle_now() + encoder.offset_bam, o->angle_bam),
                            d->config.avv.bandwidth_long_q30);
  estimator_output_t out = {o->angle_bam, o->speed_bpp, o->load_accel_q8, 32767};
  if (encoder.beside_flux) {
    e->high = flux_source_look_on(d, in, &out);
  } else {
    source_step_avv(d, e, in);
  }
  if (!encoder.beside_avv) e->high.quality_q15 = 0;  // it looks on, and its angle is no reason for a fault
  e->low = out;
  // Behind the observer: turning the frame is no motion of the shaft.
  out.angle_bam += encoder.trim_bam;
  (void)zvv_deviation_q20(in, out.angle_bam, out.speed_bpp, &source_deviation_q20);
  return out;
}

const position_source_t encoder_source = {
    source_encoder, NULL, NULL, NULL, encoder_begin, is_reversed, SOURCE_MEASURES | SOURCE_SINGLE | SOURCE_BESIDE, 3};
