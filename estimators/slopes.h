// From the sums of two bursts of conversions to the slope and the middle current of a window.

#ifndef STILLSPIN_ESTIMATORS_SLOPES_H
#define STILLSPIN_ESTIMATORS_SLOPES_H

#include "estimators/estimator.h"

typedef struct {
  int32_t amps_per_code_q30;           // mean of the two sensors
  int16_t start_samples, end_samples;  // conversions in each sum, 1..4
} slopes_config_t;

/// What is found of the sensors while the drive lives: offsets by the calibration, mismatch by sensor_match.h.
typedef struct {
  int32_t offset_a_q8, offset_b_q8;  // ADC codes at zero current
  int32_t mismatch_q30;              // g: sensor a reads 1 + g, sensor b 1 - g
} slopes_trim_t;

/// Sums of codes of phases a and b in the bursts at the beginning and the end of a window.
typedef struct {
  uint16_t start_a, start_b, end_a, end_b;
} slopes_sums_t;

/// Fills slope_q20 and current_q20 of the window; span_ticks must be set and positive.
void slopes_evaluate(const slopes_config_t* c, const slopes_trim_t* trim, const slopes_sums_t* sums,
                     estimator_window_t* w);

#endif
