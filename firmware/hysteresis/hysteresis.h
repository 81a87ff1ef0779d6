// Hysteresis control of the phase currents: each leg goes high when its current is a band below the reference, low when
// it is a band above, and stays as it is between (what the seed paper compares its modulation with, Fig. 12).
//
// Sampled: the decision is made every slice (hal_sampling_timer.h) on fresh currents of two phases, c being what is
// left; the reference moves on with every slice. The band can adapt so that the mean switching frequency is a given
// one. There are no measuring windows, so the position must come from the encoder.
//
// Units of the fast part: ADC codes with 8 fractional bits, so that a slice needs no multiplication.

#ifndef STILLSPIN_FIRMWARE_HYSTERESIS_HYSTERESIS_H
#define STILLSPIN_FIRMWARE_HYSTERESIS_HYSTERESIS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/interfaces/config_part.h"
#include "firmware/interfaces/phase_control.h"

/// Of the slices since the last control interrupt, codes.
typedef struct {
  int32_t a_q8, b_q8, peak_q8;
  uint16_t link_code, slices;
} hysteresis_sums_t;

typedef struct {
  uint16_t state;                     // legs, bit k: leg k high
  int32_t offset_a_q8, offset_b_q8;   // codes at zero current
  int32_t reference_a_q8, step_a_q8;  // phase a, and its change per slice
  int32_t reference_b_q8, step_b_q8;  // phase b
  int32_t band_q8;                    // half width
  hysteresis_sums_t sums;
  uint16_t switched;          // legs that have gone high
  int32_t band_q20;           // A
  uint16_t counted, periods;  // for the adaptation
} hysteresis_t;

extern hysteresis_t hysteresis;
extern const config_part_t hysteresis_part;
extern const phase_control_t hysteresis_control;

#endif
