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

// A pair takes one slot of a sequence and two results, A before B. Sequencer 2 has the upper eight results.
#define RESULT(n) (REG_MIRROR_ADCRESULT0 + (n))
#define SEQ2_FIRST_RESULT 8u
#define PAIRS_IN_BURST 4u
#define PAIRS_IN_SLICE 2u

#define CONTROL2 ((uint16_t)(ADCTRL2_EPWM_SOCA_SEQ1_MASK | ADCTRL2_EPWM_SOCB_SEQ2_MASK | ADCTRL2_INT_ENA_SEQ2_MASK))

#define REVISION_C 3u

static uint32_t powered_at;  // cycles
static bool has_crosstalk;   // silicon before revision C

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

static inline void rearm(void) {
  target_write16(REG_ADCTRL2, CONTROL2 | ADCTRL2_RST_SEQ1_MASK | ADCTRL2_RST_SEQ2_MASK);
}

void adc_rearm(void) { rearm(); }

void hal_adc_set_up(void) {
  has_crosstalk = target_read16(REG_REVID) < REVISION_C;
  // Two sequencers, one run a trigger, no clock divider, shortest sample window: everything 0.
  target_write16(REG_ADCTRL1, 0u);
  target_write16(REG_ADCCHSELSEQ1, REG_FIELD(ADCCHSELSEQ1_CONV00, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ1_CONV01, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ1_CONV02, BOARD_ADC_CURRENTS) |
                                       REG_FIELD(ADCCHSELSEQ1_CONV03, BOARD_ADC_CURRENTS));
  adc_sequence_windows();
}

static void set_lengths(uint16_t pairs2) {
  target_write16(REG_ADCMAXCONV,
                 REG_FIELD(ADCMAXCONV_MAX_CONV1, PAIRS_IN_BURST - 1u) | REG_FIELD(ADCMAXCONV_MAX_CONV2, pairs2 - 1u));
}

void adc_sequence_windows(void) {
  set_lengths(PAIRS_IN_BURST);
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
    rearm();
    target_write16(REG_ADCTRL2, ADCTRL2_SOC_SEQ1_MASK);
    for (uint16_t poll = 0u; poll < POLLS && !reg_any(REG_ADCST, ADCST_INT_SEQ1_MASK); poll++) {
      target_elapse(POLL_CYCLES);
    }
    if (reg_any(REG_ADCST, ADCST_INT_SEQ1_MASK)) {
      *ground = target_read16(RESULT(0u));
      *reference = target_read16(RESULT(1u));
    }
    target_write16(REG_ADCST, ADCST_INT_SEQ1_CLR_MASK);
  }
  hal_adc_set_up();
}

void adc_sequence_slices(void) {
  set_lengths(PAIRS_IN_SLICE);
  target_write16(REG_ADCCHSELSEQ3,
                 REG_FIELD(ADCCHSELSEQ3_CONV08, BOARD_ADC_CURRENTS) | REG_FIELD(ADCCHSELSEQ3_CONV09, BOARD_ADC_SLOW));
  adc_rearm();
}

// A pair is read as one 32-bit word, which peripheral frame 0 allows: A in its lower half, B in its upper one. Up to 16
// pairs add up without a carry from one half into the other. Written out, without a loop: this interrupt comes up to
// three times a period.
static inline uint32_t pair(uint16_t first_result) { return target_read32(RESULT(first_result)); }

// A pair, or a sum of pairs, of which the second channel has its own alone.
static uint32_t less_crosstalk(uint32_t both) {
  const uint32_t share = (both & 0xFF00uL) << 8;
  return (both >= share) ? both - share : both & 0xFFFFuL;
}

static inline uint32_t sum_of_end(uint16_t first_result) {
  uint32_t sum = pair(first_result);
  sum += pair((uint16_t)(first_result + 2u));
  return sum + pair((uint16_t)(first_result + 4u));
}

static inline uint32_t sum_of_start(uint16_t first_result) {
  const uint32_t three = sum_of_end(first_result);
  return three + pair((uint16_t)(first_result + 6u));
}

TARGET_RAM_CODE void adc_take_slice(uint16_t results[]) {
  uint32_t currents = pair(SEQ2_FIRST_RESULT);
  if (has_crosstalk) currents = less_crosstalk(currents);
  results[0] = (uint16_t)(currents & 0xFFFFuL);
  results[1] = (uint16_t)(currents >> 16);
  results[2] = target_read16(RESULT(SEQ2_FIRST_RESULT + 2u));
}

typedef char sums_have_as_many_terms_as_bursts[(HAL_ADC_START_SAMPLES == 4u && HAL_ADC_END_SAMPLES == 3u) ? 1 : -1];

static inline void take_results(hal_adc_window_t* window) {
  uint32_t start = sum_of_start(0u);
  uint32_t end = sum_of_end(SEQ2_FIRST_RESULT);
  uint32_t slow = pair(SEQ2_FIRST_RESULT + 2u * HAL_ADC_END_SAMPLES);
  if (has_crosstalk) {
    start = less_crosstalk(start);
    end = less_crosstalk(end);
    slow = less_crosstalk(slow);
  }
  window->start_a = (uint16_t)(start & 0xFFFFuL);
  window->start_b = (uint16_t)(start >> 16);
  window->end_a = (uint16_t)(end & 0xFFFFuL);
  window->end_b = (uint16_t)(end >> 16);
  window->link = (uint16_t)(slow & 0xFFFFuL);
  window->aux = (uint16_t)(slow >> 16);
  rearm();
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
