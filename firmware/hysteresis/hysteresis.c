#include "firmware/hysteresis/hysteresis.h"

#include <stddef.h>

#include "firmware/base/clear.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/sampling.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/mode/mode.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sampling_timer.h"

#define ADAPT_PERIODS 100u       // 10 ms between two corrections of the band
#define BAND_MIN_Q20 20972L      // 20 mA: two codes
#define BAND_MAX_Q20 5242880L    // 5 A
#define CODE_END_Q8 1048576L     // 4096 codes
#define CODES_END_Q8 268435456L  // of a reference or a step: far beyond any sensor
#define SUM_END_Q8 1073741824L   // of a thousand slices
#define ADAPT_SHARE_Q15 4096L    // an eighth of the relative error of the frequency at a time

typedef struct {
  int32_t band_q20;      // A, half width at the beginning
  int32_t rises;         // of the legs between two corrections of the band at the frequency that is wanted; 0: none are
  uint16_t slice_ticks;  // of 10 ns
  bool chosen;           // in the place of the current control
} hysteresis_config_t;

hysteresis_t hysteresis;

static hysteresis_config_t config;

static uint16_t made_slice_ticks;

static packed_text_t make(drive_config_t* c) {
  (void)c;
  made_slice_ticks = (uint16_t)q_shr_round(parameters.slice_time * 100, 16);
  if (parameters.current_law == CURRENT_LAW_HYSTERESIS && !drive_source_selected_has(SOURCE_MEASURES))
    return SAY_current_law_1_needs_position_source_0;
  return (HAL_PWM_PERIOD_TICKS % made_slice_ticks != 0u) ? SAY_100_us_must_be_a_whole_number : PACKED_NONE;
}

static void take(void) {
  config.band_q20 = parameters.hysteresis_band;
  // Three legs, 10 ms: 30 rises per kHz.
  config.rises = q_shr_round(parameters.hysteresis_frequency * 30, 16);
  if (config.rises == 0 && parameters.hysteresis_frequency != 0) config.rises = 1;
  config.slice_ticks = made_slice_ticks;
  config.chosen = parameters.current_law == CURRENT_LAW_HYSTERESIS;
}

const config_part_t hysteresis_part = {make, take};

static uint16_t decide(uint16_t state, uint16_t leg_bit, int32_t lack, int32_t band) {
  if (lack > band) return (uint16_t)(state | leg_bit);
  if (lack < -band) return (uint16_t)(state & (uint16_t)~leg_bit);
  return state;
}

static void gather(hysteresis_sums_t* s, int32_t a, int32_t b, uint16_t link_code) {
  const int32_t largest = q_max(q_max(q_abs_sat(a), q_abs_sat(b)), q_abs_sat(a + b));
  s->a_q8 = q_limit(s->a_q8 + a, SUM_END_Q8);
  s->b_q8 = q_limit(s->b_q8 + b, SUM_END_Q8);
  s->peak_q8 = q_max(s->peak_q8, largest);
  s->link_code = link_code;
  s->slices++;
}

static uint16_t risen(uint16_t before, uint16_t now) {
  const uint16_t up = (uint16_t)(now & (uint16_t)~before);
  return (uint16_t)((up & 1u) + ((up >> 1) & 1u) + ((up >> 2) & 1u));
}

static void hysteresis_slice(void) {
  hysteresis_t* const h = &hysteresis;
  hal_timed_samples_t now;
  hal_sampling_timer_read(&now);
  const int32_t a = (int32_t)now.current_a * 256 - h->offset_a_q8;
  const int32_t b = (int32_t)now.current_b * 256 - h->offset_b_q8;
  const int32_t lack_a = h->reference_a_q8 - a;
  const int32_t lack_b = h->reference_b_q8 - b;
  uint16_t state = decide(h->state, 1u, lack_a, h->band_q8);
  state = decide(state, 2u, lack_b, h->band_q8);
  state = decide(state, 4u, -lack_a - lack_b, h->band_q8);
  if (state != h->state) {
    hal_sampling_timer_set_legs(state);
    h->switched = (uint16_t)(h->switched + risen(h->state, state));
    h->state = state;
  }
  h->reference_a_q8 = q_limit(h->reference_a_q8 + h->step_a_q8, CODES_END_Q8);
  h->reference_b_q8 = q_limit(h->reference_b_q8 + h->step_b_q8, CODES_END_Q8);
  gather(&h->sums, a, b, now.link);
  hal_profile_step(CYCLES_SLICE);
}

static int32_t mean_code_q8(int32_t sum_q8, uint16_t slices) { return q_limit(sum_q8 / (int32_t)slices, CODE_END_Q8); }

static bool hysteresis_samples(const drive_t* d, drive_samples_t* s, dq_t* measured_q20, uint16_t* missing) {
  hysteresis_t* const h = &hysteresis;
  const uint16_t state = hal_irq_disable();
  const hysteresis_sums_t taken = h->sums;
  h->sums.a_q8 = 0;
  h->sums.b_q8 = 0;
  h->sums.peak_q8 = 0;
  h->sums.slices = 0;
  hal_irq_restore(state);
  s->count = 0;
  *missing = (taken.slices > 0u) ? 0u : (uint16_t)(*missing + 1u);
  if (taken.slices == 0u) return true;
  const int32_t per_code_q30 = d->config.slopes.amps_per_code_q30;
  const int32_t a_q20 = q_mul(mean_code_q8(taken.a_q8, taken.slices), per_code_q30, 18);
  const int32_t b_q20 = q_mul(mean_code_q8(taken.b_q8, taken.slices), per_code_q30, 18);
  // The mean of the period before, whose middle lies half a period behind the angle of its start.
  const uint32_t middle_bam = d->estimate.selected.angle_bam + (uint32_t)(d->estimate.selected.speed_bpp / 2);
  const dq_t mean_q20 = frame_turned(frame_clarke2(a_q20, b_q20), middle_bam);
  measured_q20->d = q_limit(mean_q20.d, DRIVE_CURRENT_END_Q20);
  measured_q20->q = q_limit(mean_q20.q, DRIVE_CURRENT_END_Q20);
  s->link_q16 = q_follow_near(s->link_q16, (int32_t)taken.link_code * d->config.volts_per_code_q16, 3);
  return q_mul(taken.peak_q8, per_code_q30, 18) <= d->config.values.trip_current;
}

// The band follows the switching frequency: seldom enough to average over the modulation by the angle.
static void adapt(hysteresis_t* h) {
  if (++h->periods < ADAPT_PERIODS || config.rises == 0) return;
  const uint16_t rises = (uint16_t)(h->switched - h->counted);
  h->counted = h->switched;
  h->periods = 0;
  const int32_t error_q15 = q_clamp(q_div((int32_t)rises - config.rises, config.rises, 15), -32767L, 32767L);
  h->band_q20 =
      q_clamp(h->band_q20 + q_mul(q_mul(h->band_q20, error_q15, 15), ADAPT_SHARE_Q15, 15), BAND_MIN_Q20, BAND_MAX_Q20);
}

static int32_t to_codes_q8(const drive_t* d, int32_t amps_q20) {
  return q_limit(q_mul_sat(amps_q20, d->config.codes_per_amp_q16, 28), CODES_END_Q8);
}

typedef struct {
  int32_t a, b;
} codes_t;

static codes_t reference_codes_q8(const drive_t* d, uint32_t angle_bam) {
  const abc_t i = frame_inverse_clarke(frame_fixed(d->control.references.current_q20, angle_bam));
  const codes_t codes = {to_codes_q8(d, i.a), to_codes_q8(d, i.b)};
  return codes;
}

// From now on the references go where they will be in a period.
static void refer(const drive_t* d) {
  hysteresis_t* const h = &hysteresis;
  const int32_t slices = (int32_t)(HAL_PWM_PERIOD_TICKS / config.slice_ticks);
  const int32_t speed = d->estimate.selected.speed_bpp;
  const int32_t passed_q30 = q_min((int32_t)hal_pwm_period_tick(), HAL_PWM_PERIOD_TICKS) * 107374L;
  const uint32_t angle = d->estimate.selected.angle_bam + (uint32_t)q_mul(speed, passed_q30, 30);
  const codes_t now = reference_codes_q8(d, angle);
  const codes_t then = reference_codes_q8(d, angle + (uint32_t)speed);
  const int32_t band_q8 = to_codes_q8(d, h->band_q20);
  const uint16_t state = hal_irq_disable();
  h->reference_a_q8 = now.a;
  h->reference_b_q8 = now.b;
  h->step_a_q8 = (then.a - now.a) / slices;
  h->step_b_q8 = (then.b - now.b) / slices;
  h->band_q8 = band_q8;
  hal_irq_restore(state);
}

static void begin(const drive_t* d, drive_modulation_t* m) {
  hysteresis_t* const h = &hysteresis;
  clear(h, sizeof *h);
  h->offset_a_q8 = d->estimate.trim.offset_a_q8;
  h->offset_b_q8 = d->estimate.trim.offset_b_q8;
  h->band_q20 = config.band_q20;
  refer(d);
  m->sliced = (uint16_t)hal_sampling_timer_begin(config.slice_ticks);
}

static bool hysteresis_step(const drive_t* d, drive_modulation_t* m) {
  const bool wanted = config.chosen && (d->state == DRIVE_RUN || d->state == DRIVE_STOP);
  if (wanted && m->sliced == 0u) begin(d, m);
  if (!wanted && m->sliced != 0u) {
    hal_sampling_timer_end();
    m->sliced = 0;
    sampling_reset();
  }
  if (m->sliced == 0u) return false;
  adapt(&hysteresis);
  refer(d);
  hal_profile_step(CYCLES_REFER);
  return true;
}

const phase_control_t hysteresis_control = {hysteresis_step, hysteresis_samples, hysteresis_slice};
