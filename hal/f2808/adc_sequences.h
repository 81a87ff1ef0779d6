// What sequencer 2 converts: the last burst of a window, or the one of a slice.

#ifndef STILLSPIN_HAL_F2808_ADC_SEQUENCES_H
#define STILLSPIN_HAL_F2808_ADC_SEQUENCES_H

#include <stdint.h>

// Four pairs: three of currents, one of link and auxiliary input.
void adc_sequence_windows(void);

// Two pairs: currents, then link and auxiliary input.
void adc_sequence_slices(void);

// Result n of a slice: current a, current b, link, auxiliary input.
uint16_t adc_slice_result(uint16_t n);

// Back to the first slots of both sequences, without losing the triggers.
void adc_rearm(void);

#endif
