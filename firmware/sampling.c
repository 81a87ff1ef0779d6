// From bursts of conversions to windows with slope, current and voltage.
//
// The window interrupt stores raw sums; the control interrupt, once per period, swaps the two buffers and turns the
// sums of the period before into physical quantities, with the pattern that was running then.

#include "firmware/sampling.h"

#include "firmware/drive.h"
#include "firmware/isr_cycles.h"
#include "hal/hal_adc.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "svpwm/ripple.h"

#define THIRD 357913941L  // Q30
#define SIDE FRAME_SQRT3_INV_Q30

static sampling_buffer_t sampling_buffers[2];
static uint16_t sampling_filling;

void sampling_reset(void) {
  sampling_buffers[0].count = 0;
  sampling_buffers[1].count = 0;
  sampling_filling = 0;
}

void drive_window_interrupt(void) {
  if (drive.hysteresis.running) {
    drive_hysteresis_slice(&drive.hysteresis);
    return;
  }
  sampling_buffer_t* const b = &sampling_buffers[sampling_filling];
  const uint16_t place = b->count;
  hal_adc_window_t spare;
  b->count = (uint16_t)(place + 1u);
  hal_adc_read_window((place < ESTIMATOR_WINDOWS) ? &b->windows[place] : &spare);
  hal_profile_step(CYCLES_WINDOW);
}

const sampling_buffer_t* sampling_swap(void) {
  const uint16_t state = hal_irq_disable();
  const uint16_t full = sampling_filling;
  sampling_filling = (uint16_t)(1u - full);
  sampling_buffers[sampling_filling].count = 0;
  hal_irq_restore(state);
  return &sampling_buffers[full];
}

// Clarke of the eight switching states: thirds and 1/sqrt(3), Q30.
static const ab_t state_vector_q30[8] = {{0, 0},          {2 * THIRD, 0}, {-THIRD, SIDE},  {THIRD, SIDE},
                                         {-THIRD, -SIDE}, {THIRD, -SIDE}, {-2 * THIRD, 0}, {0, 0}};

static ab_t window_voltage(const drive_t* d, const svpwm_window_t* w, ab_t current_q20) {
  const ab_t vector = state_vector_q30[w->state & 7u];
  const ab_t drop = dead_time_drop_q16(&d->config.dead_time, current_q20);
  const ab_t v = {q_mul_floor(d->samples.link_q16, vector.alpha, 30) - drop.alpha,
                  q_mul_floor(d->samples.link_q16, vector.beta, 30) - drop.beta};
  return v;
}

static void evaluate(drive_t* d, const slopes_scale_t* scale, const svpwm_window_t* w, const hal_adc_window_t* raw,
                     estimator_window_t* out) {
  const sampling_config_t* const c = &d->config.modulator.sampling;
  const int16_t begin = (int16_t)(svpwm_burst_start(c, w) + (int16_t)HAL_ADC_START_DELAY_TICKS);
  const int16_t end = (int16_t)(svpwm_burst_end(c, w) + (int16_t)HAL_ADC_END_DELAY_TICKS);
  const slopes_sums_t sums = {raw->start_a, raw->start_b, raw->end_a, raw->end_b};
  out->span_ticks = (int16_t)(end - begin);
  out->middle_tick = (int16_t)q_shr(begin + end, 1);
  out->zero_vector = svpwm_is_zero_vector(w->state);
  slopes_evaluate(scale, &sums, out);
  out->voltage_q16 = window_voltage(d, w, out->current_q20);
}

static void filter_link(drive_t* d, int32_t volts_q16) {
  d->samples.link_q16 += (d->samples.link_q16 == 0) ? volts_q16 : q_shr(volts_q16 - d->samples.link_q16, 3);
}

void drive_read_samples(drive_t* d) {
  if (d->hysteresis.running) {
    drive_hysteresis_samples(d);
    return;
  }
  const sampling_buffer_t* const b = sampling_swap();
  const svpwm_pattern_t* const p = &d->modulation.sampled;
  drive_samples_t* const s = &d->samples;
  s->count = 0;
  const bool complete = b->count == p->window_count;
  d->supervision.missing = (complete && p->window_count > 0u) ? 0u : (uint16_t)(d->supervision.missing + 1u);
  if (!complete) return;
  s->raw_a_q8 = (int32_t)b->windows[0].start_a * (256 / (int32_t)HAL_ADC_START_SAMPLES);
  s->raw_b_q8 = (int32_t)b->windows[0].start_b * (256 / (int32_t)HAL_ADC_START_SAMPLES);
  const slopes_scale_t scale = slopes_scale(&d->config.slopes, &d->trim);
  for (uint16_t k = 0; k < p->window_count; k++) {
    s->link_end_q16[k] = (int32_t)b->windows[k].link * d->config.volts_per_code_q16;
    filter_link(d, s->link_end_q16[k]);
    evaluate(d, &scale, &p->windows[k], &b->windows[k], &s->windows[k]);
    s->ripple_q16[k] = svpwm_ripple_q16(&p->pulses, s->windows[k].middle_tick, s->link_q16);
  }
  s->count = p->window_count;
}
