// What the drivers of windows and of slices have in common: what sequencer 2 converts, the last burst of a window or
// the one of a slice, and pairs of results.

#ifndef STILLSPIN_HAL_F2808_ADC_SEQUENCES_H
#define STILLSPIN_HAL_F2808_ADC_SEQUENCES_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"

extern bool adc_has_crosstalk;  // silicon before revision C

// Pairs of sequencer 2.
void adc_set_lengths(uint16_t pairs2);

// Four pairs: three of currents, one of link and auxiliary input.
void adc_sequence_windows(void);

// Two pairs: currents, then link and auxiliary input.
void adc_sequence_slices(void);

// Back to the first slots of both sequences, without losing the triggers.
static inline void adc_rearm(void) {
  target_write16(REG_ADCTRL2, ADCTRL2_EPWM_SOCA_SEQ1_MASK | ADCTRL2_EPWM_SOCB_SEQ2_MASK | ADCTRL2_INT_ENA_SEQ2_MASK |
                                  ADCTRL2_RST_SEQ1_MASK | ADCTRL2_RST_SEQ2_MASK);
}

// A pair takes one slot of a sequence and two results, A before B. Sequencer 2 has the upper eight results.
#define ADC_RESULT(n) (REG_MIRROR_ADCRESULT0 + (n))
#define ADC_SEQ2_FIRST_RESULT 8u

// A pair is read as one 32-bit word, which peripheral frame 0 allows: A in its lower half, B in its upper one.
static inline uint32_t adc_pair(uint16_t first_result) { return target_read32(ADC_RESULT(first_result)); }

// A pair, or a sum of pairs, of which the second channel has its own alone.
static inline uint32_t adc_less_crosstalk(uint32_t both) {
  const uint32_t share = (both & 0xFF00uL) << 8;
  return (both >= share) ? both - share : both & 0xFFFFuL;
}

#endif
