#include "hal/f2808/adc_sequences.h"
#include "hal/f2808/f2808_values.h"
#include "hal/f2808/pie.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_adc.h"
#include "hal/hal_board.h"
#include "hal/hal_replay.h"
#include "hal/hal_time.h"

#define POWER_UP_CYCLES (5000uL * HAL_TIME_CYCLES_PER_US)
#define POLL_CYCLES 10u
#define POLLS 100u  // of a sequence, which takes 140 cycles

#define PAIRS_IN_BURST 4u

#define REVISION_C 3u

static uint32_t powered_at;  // cycles
bool adc_has_crosstalk;

void hal_adc_power_up(void) {
  target_write16(REG_ADCTRL1, ADCTRL1_RESET_MASK);
  TARGET_NOP();  // the reset takes two cycles
  TARGET_NOP();
  // Bandgap, reference and converter may come up together on this chip; then the references need 5 ms.
  target_write16(REG_ADCTRL3, REG_FIELD(ADCTRL3_ADCBGRFDN, ADCTRL3_BANDGAP_ON) | ADCTRL3_ADCPWDN_MASK |
                                  REG_FIELD(ADCTRL3_ADCCLKPS, 0u) |
                                  REG_FIELD(ADCTRL3_SMODE_SEL, ADCTRL3_SMODE_SIMULTANEOUS));
  powered_at = hal_time_cycles();
}

bool hal_adc_is_up(void) {
  target_elapse(POLL_CYCLES);
  return hal_time_cycles() - powered_at >= POWER_UP_CYCLES;
}

void hal_adc_set_up(void) {
  adc_has_crosstalk = target_read16(REG_REVID) < REVISION_C;
  // Two sequencers, one run a trigger, no clock divider, shortest sample window: everything 0.
  target_write16(REG_ADCTRL1, 0u);
  target_write16(REG_ADCCHSELSEQ1, REG_FIELD(ADCCHSELSEQ1_CONV00, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ1_CONV01, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ1_CONV02, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ1_CONV03, BOARD_ADC_CURRENTS));
  adc_sequence_windows();
}

void adc_set_lengths(uint16_t pairs2) {
  target_write16(REG_ADCMAXCONV,
                 REG_FIELD(ADCMAXCONV_MAX_CONV1, PAIRS_IN_BURST - 1u) | REG_FIELD(ADCMAXCONV_MAX_CONV2, pairs2 - 1u));
}

void adc_sequence_windows(void) {
  adc_set_lengths(PAIRS_IN_BURST);
  target_write16(REG_ADCCHSELSEQ3, REG_FIELD(ADCCHSELSEQ3_CONV08, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ3_CONV09, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ3_CONV10, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ3_CONV11, BOARD_ADC_SLOW));
  adc_rearm();
}

void hal_adc_choose_slow(bool speed) {
  REG_SET_FIELD(REG_ADCCHSELSEQ3, ADCCHSELSEQ3_CONV11, speed ? BOARD_ADC_SPEED : BOARD_ADC_SLOW);
}

// One pair, twice, for the first conversion after power-up may be wrong.
void hal_adc_measure_reference(uint16_t* ground, uint16_t* reference) {
  *ground = *reference = 0u;
  target_write16(REG_ADCMAXCONV, 0u);
  for (uint16_t time = 0u; time < 2u; time++) {
    REG_SET_FIELD(REG_ADCCHSELSEQ1, ADCCHSELSEQ1_CONV00, BOARD_ADC_REFERENCE);
    adc_rearm();
    target_write16(REG_ADCTRL2, ADCTRL2_SOC_SEQ1_MASK);
    for (uint16_t poll = 0u; poll < POLLS && !reg_any(REG_ADCST, ADCST_INT_SEQ1_MASK); poll++) {
      target_elapse(POLL_CYCLES);
    }
    if (reg_any(REG_ADCST, ADCST_INT_SEQ1_MASK)) {
      *ground = target_read16(ADC_RESULT(0u));
      *reference = target_read16(ADC_RESULT(1u));
    }
    target_write16(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK);
  }
  hal_adc_set_up();
}

// Of pairs up to 16 add up without a carry from one half into the other. Written out, without a loop: this interrupt
// comes up to three times a period.
static inline uint32_t sum_of_end(uint16_t first_result) {
  uint32_t sum = adc_pair(first_result);
  sum += adc_pair((uint16_t)(first_result + 2u));
  return sum + adc_pair((uint16_t)(first_result + 4u));
}

static inline uint32_t sum_of_start(uint16_t first_result) {
  const uint32_t three = sum_of_end(first_result);
  return three + adc_pair((uint16_t)(first_result + 6u));
}

typedef char sums_have_as_many_terms_as_bursts[(HAL_ADC_START_SAMPLES == 4u && HAL_ADC_END_SAMPLES == 3u) ? 1 : -1];

static inline void take_results(hal_adc_window_t* window) {
  uint32_t start = sum_of_start(0u);
  uint32_t end = sum_of_end(ADC_SEQ2_FIRST_RESULT);
  uint32_t slow = adc_pair(ADC_SEQ2_FIRST_RESULT + 2u * HAL_ADC_END_SAMPLES);
  if (adc_has_crosstalk) {
    start = adc_less_crosstalk(start);
    end = adc_less_crosstalk(end);
    slow = adc_less_crosstalk(slow);
  }
  window->start_a = (uint16_t)(start & 0xFFFFuL);
  window->start_b = (uint16_t)(start >> 16);
  window->end_a = (uint16_t)(end & 0xFFFFuL);
  window->end_b = (uint16_t)(end >> 16);
  window->link = (uint16_t)(slow & 0xFFFFuL);
  window->aux = (uint16_t)(slow >> 16);
  adc_rearm();
  target_write16(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK | ADCST_INT_SEQ2_CLR_MASK);
  pie_acknowledge(PIE_GROUP(VECTOR_SEQ2INT));
}

typedef char a_window_is_as_many_words[sizeof(hal_adc_window_t) == REPLAY_RESULTS * sizeof(uint16_t) ? 1 : -1];

TARGET_RAM_CODE void hal_adc_read_window(hal_adc_window_t* window) {
  uint16_t* const words = (uint16_t*)window;
  if (replay_plays()) {
    replay_take_results(words, REPLAY_RESULTS);
    return;
  }
  take_results(window);
  if (!replay_is_off()) replay_note_results(words, REPLAY_RESULTS);
}
