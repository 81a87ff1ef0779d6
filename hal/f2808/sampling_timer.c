#include "hal/f2808/adc_sequences.h"
#include "hal/f2808/f2808_values.h"
#include "hal/f2808/pie.h"
#include "hal/f2808/pwm_modules.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_replay.h"
#include "hal/hal_sampling_timer.h"

#define CLOCK_MODULE PWM_SLICE_MODULE  // its time base counts the slices
#define TRIGGER_TICK 10u               // of the slice
#define PAIRS_IN_SLICE 2u

// At once and not from the shadow: what was meant for this period must not come any more.
static void write_compare_now(uint16_t module, uint16_t a, uint16_t b) {
  const uint32_t epwm = EPWM_BASE(module);
  target_write16(epwm + EPWM_CMPCTL, REG_FIELD(EPWM_CMPCTL_SHDWAMODE, CMPCTL_IMMEDIATE) |
                                         REG_FIELD(EPWM_CMPCTL_SHDWBMODE, CMPCTL_IMMEDIATE));
  target_write16(epwm + EPWM_CMPA_CMPA, a);
  target_write16(epwm + EPWM_CMPB, b);
  target_write16(epwm + EPWM_CMPCTL, REG_FIELD(EPWM_CMPCTL_SHDWAMODE, CMPCTL_SHADOW) |
                                         REG_FIELD(EPWM_CMPCTL_SHDWBMODE, CMPCTL_SHADOW) |
                                         REG_FIELD(EPWM_CMPCTL_LOADAMODE, CMPCTL_LOAD_ZERO) |
                                         REG_FIELD(EPWM_CMPCTL_LOADBMODE, CMPCTL_LOAD_ZERO));
  target_write16(epwm + EPWM_CMPA_CMPA, a);
  target_write16(epwm + EPWM_CMPB, b);
}

static void stop_bursts(void) {
  for (uint16_t window = 0u; window < HAL_PWM_WINDOWS; window++) {
    write_compare_now((uint16_t)(PWM_FIRST_WINDOW_MODULE + window), HAL_PWM_NONE, HAL_PWM_NONE);
  }
}

// The master's synchronisation puts the counter right at the next period start.
static void set_clock(uint16_t slice_ticks) {
  const uint32_t epwm = EPWM_BASE(CLOCK_MODULE);
  target_write16(epwm + EPWM_TBPRD, (uint16_t)(slice_ticks - 1u));
  target_write16(epwm + EPWM_TBCTR, 0u);
}

static void force(uint16_t leg, uint16_t action) {
  target_write16(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg) + EPWM_AQCSFRC, REG_FIELD(EPWM_AQCSFRC_CSFA, action));
}

static void force_at_once(void) {
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    target_write16(EPWM_BASE(PWM_FIRST_LEG_MODULE + leg) + EPWM_AQSFRC,
                   REG_FIELD(EPWM_AQSFRC_RLDCSF, AQSFRC_IMMEDIATE));
  }
}

static void set_legs(uint16_t state) {
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    force(leg, ((uint16_t)(state >> leg) & 1u) != 0u ? AQCSFRC_HIGH : AQCSFRC_LOW);
  }
}

void adc_sequence_slices(void) {
  adc_set_lengths(PAIRS_IN_SLICE);
  target_write16(REG_ADCCHSELSEQ3,
                 REG_FIELD(ADCCHSELSEQ3_CONV08, BOARD_ADC_CURRENTS) | REG_FIELD(ADCCHSELSEQ3_CONV09, BOARD_ADC_SLOW));
  adc_rearm();
}

static bool begin(uint16_t slice_ticks) {
  if (slice_ticks < HAL_SAMPLING_TIMER_MIN_TICKS || HAL_PWM_PERIOD_TICKS % slice_ticks != 0u) {
    return false;
  }
  const uint16_t state = irq_hold();
  stop_bursts();
  force_at_once();
  set_legs(0u);
  adc_sequence_slices();
  set_clock(slice_ticks);
  write_compare_now(CLOCK_MODULE, HAL_PWM_NONE, TRIGGER_TICK);
  irq_release(state);
  return true;
}

bool hal_sampling_timer_begin(uint16_t slice_ticks) {
  replay_output(REPLAY_SAMPLING_TIMER, &slice_ticks, 1u);
  replay_call();
  return replay_plays() ? replay_take() != 0u : replay_note(begin(slice_ticks) ? 1u : 0u) != 0u;
}

static void end(void) {
  const uint16_t state = irq_hold();
  stop_bursts();
  set_clock(HAL_PWM_PERIOD_TICKS);
  adc_sequence_windows();
  for (uint16_t leg = 0u; leg < HAL_PWM_LEGS; leg++) {
    write_compare_now((uint16_t)(PWM_FIRST_LEG_MODULE + leg), HAL_PWM_NONE, HAL_PWM_NONE);
    force(leg, AQCSFRC_NONE);
  }
  irq_release(state);
}

void hal_sampling_timer_end(void) {
  const uint16_t none = 0u;
  replay_output(REPLAY_SAMPLING_TIMER, &none, 1u);
  replay_call();
  if (!replay_plays()) {
    end();
  }
}

// Of a slice: current a, current b, link.
#define SLICE_RESULTS 3u
static void take_slice(uint16_t results[]) {
  uint32_t currents = adc_pair(ADC_SEQ2_FIRST_RESULT);
  if (adc_has_crosstalk) currents = adc_less_crosstalk(currents);
  results[0] = (uint16_t)(currents & 0xFFFFuL);
  results[1] = (uint16_t)(currents >> 16);
  results[2] = target_read16(ADC_RESULT(ADC_SEQ2_FIRST_RESULT + 2u));
}

static void take_results(uint16_t* results) {
  take_slice(results);
  adc_rearm();
  target_write16(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK | ADCST_INT_SEQ2_CLR_MASK);
  pie_acknowledge(PIE_GROUP(VECTOR_SEQ2INT));
  replay_note_results(results, SLICE_RESULTS);
}

void hal_sampling_timer_read(hal_timed_samples_t* slice) {
  uint16_t results[SLICE_RESULTS];
  if (replay_plays()) {
    replay_take_results(results, SLICE_RESULTS);
  } else {
    take_results(results);
  }
  slice->current_a = results[0];
  slice->current_b = results[1];
  slice->link = results[2];
}

void hal_sampling_timer_set_legs(uint16_t state) {
  replay_output(REPLAY_LEGS, &state, 1u);
  if (!replay_plays()) {
    set_legs(state);
  }
}
