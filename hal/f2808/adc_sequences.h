// What sequencer 2 converts: the last burst of a window, or the one of a slice.

#ifndef STILLSPIN_HAL_F2808_ADC_SEQUENCES_H
#define STILLSPIN_HAL_F2808_ADC_SEQUENCES_H

#include <stdint.h>

// Four pairs: three of currents, one of link and auxiliary input.
void adc_sequence_windows(void);

// Two pairs: currents, then link and auxiliary input.
void adc_sequence_slices(void);

// Of a slice: current a, current b, link.
#define ADC_SLICE_RESULTS 3u
void adc_take_slice(uint16_t results[]);

// Back to the first slots of both sequences, without losing the triggers.
void adc_rearm(void);

#endif
