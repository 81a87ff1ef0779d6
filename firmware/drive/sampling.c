// From bursts of conversions to windows with change of current, current and voltage.
//
// The window interrupt stores raw sums; the control interrupt, once per period, swaps the two buffers and turns the
// sums of the period before into physical quantities, with the pattern that was running then.

#include "firmware/drive/sampling.h"

#include "firmware/drive/steps.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/interfaces/phase_control.h"
#include "firmware/mode/mode.h"
#include "hal/hal_adc.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "svpwm/ripple.h"

#define THIRD_Q32 1431655765L

static sampling_buffer_t sampling_buffers[2];
static uint16_t sampling_filling;

void sampling_reset(void) {
  sampling_buffers[0].count = 0;
  sampling_filling = 0;
}

void drive_window_interrupt(void) {
  if (drive.modulation.sliced != 0u) {
    edition_phase_control->slice();
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

// One word: an interrupt in between can do no harm.
uint16_t sampling_auxiliary(void) { return sampling_buffers[1u - sampling_filling].windows[0].aux; }

// Clarke of the eight switching states: thirds of the link, and 1/sqrt(3) of it.
static const int16_t thirds_of_state[8] = {0, 2, -1, 1, -1, 1, -2, 0};
static const int16_t sides_of_state[8] = {0, 0, 1, 1, -1, -1, 0, 0};

// What is the same for all windows of a period.
typedef struct {
  const dead_time_config_t* drops;
  const slopes_scale_t* slopes;
  int32_t third_q19, side_q19;  // of the DC link, V
} scale_t;

static scale_t scale_of(const drive_t* d) {
  const scale_t s = {&d->config.dead_time, &d->samples.scale, q_mul_hi(d->samples.link_q16 * 8, THIRD_Q32),
                     q_mul_hi(d->samples.link_q16 * 8, FRAME_SQRT3_INV_Q30) * 4};
  return s;
}

static void evaluate(const scale_t* s, const svpwm_window_t* w, const hal_adc_window_t* raw, estimator_window_t* out) {
  const int32_t begin = w->start + (int32_t)HAL_ADC_START_DELAY_TICKS;
  const int32_t end = w->end + (int32_t)HAL_ADC_END_DELAY_TICKS;
  const slopes_sums_t sums = {raw->start_a, raw->start_b, raw->end_a, raw->end_b};
  const uint16_t state = w->state & 7u;
  out->span_ticks = (int16_t)q_max(end - begin, 1);
  out->middle_tick = (int16_t)q_shr(begin + end, 1);
  out->zero_vector = svpwm_is_zero_vector(state);
  slopes_evaluate(s->slopes, &sums, out);
  const ab_t drop_q16 = dead_time_drop_q16(s->drops, out->current_q20);
  out->voltage_q19.alpha = thirds_of_state[state] * s->third_q19 - drop_q16.alpha * 8;
  out->voltage_q19.beta = sides_of_state[state] * s->side_q19 - drop_q16.beta * 8;
}

// Takes over an eighth of what each window says; up to 2000 V, so that the sum stays in 31 bits.
static void follow_link(drive_samples_t* s, int32_t volts_per_code_q16, const sampling_buffer_t* b, uint16_t count) {
  if (count == 0u) return;
  int32_t sum_q16 = 0;
  if (s->link_q16 == 0) s->link_q16 = (int32_t)b->windows[0].link * volts_per_code_q16;
  for (uint16_t k = 0; k < count; k++) {
    const int32_t volts_q16 = (int32_t)b->windows[k].link * volts_per_code_q16;
    s->link_end_q16[k] = volts_q16;
    sum_q16 += volts_q16;
  }
  s->link_q16 = q_shr(sum_q16 + (8 - (int32_t)count) * s->link_q16, 3);
}

static void take_raw(drive_samples_t* s, const hal_adc_window_t* w) {
  s->raw_a_q8 = (int32_t)w->start_a * (256 / (int32_t)HAL_ADC_START_SAMPLES);
  s->raw_b_q8 = (int32_t)w->start_b * (256 / (int32_t)HAL_ADC_START_SAMPLES);
}

void drive_read_samples(const drive_t* d, drive_samples_t* s, uint16_t* missing) {
  const sampling_buffer_t* const b = sampling_swap();
  const svpwm_pattern_t* const p = modulation_sampled(&d->modulation);
  s->count = 0;
  const bool complete = b->count == p->window_count;
  *missing = (complete && p->window_count > 0u) ? 0u : (uint16_t)(*missing + 1u);
  if (!complete) return;
  if (d->state == DRIVE_CALIBRATE) take_raw(s, &b->windows[0]);
  follow_link(s, d->config.volts_per_code_q16, b, p->window_count);
  if (d->schedule.slot == SLOT_VOLTAGE) sampling_scale_sensors(d, s);
  const scale_t scale = scale_of(d);
  int16_t middles[ESTIMATOR_WINDOWS];
  for (uint16_t k = 0; k < p->window_count; k++) {
    evaluate(&scale, &p->windows[k], &b->windows[k], &s->windows[k]);
    middles[k] = s->windows[k].middle_tick;
  }
  s->ripple_q16 = svpwm_ripple_q16(&p->pulses, middles, p->window_count, s->link_q16);
  s->count = p->window_count;
}
