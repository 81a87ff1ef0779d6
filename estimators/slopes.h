// From the sums of two bursts of conversions to the change of the current and its middle in a window.

#ifndef STILLSPIN_ESTIMATORS_SLOPES_H
#define STILLSPIN_ESTIMATORS_SLOPES_H

#include "estimators/estimator.h"

typedef struct {
  int32_t amps_per_code_q30;           // mean of the two sensors, up to 1/8 with 8 or more of their product
  int16_t start_samples, end_samples;  // conversions in each sum, 1..4
  int32_t amps_per_count_q36;          // of their product, set by slopes_design
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

/// What is the same for all windows of a period: a count is a code times both numbers of conversions, so that nothing
/// is divided.
typedef struct {
  int32_t alpha_a_q36;                 // A of alpha per count of phase a
  int32_t beta_a_q36, beta_b_q36;      // A of beta per count of phases a and b
  int32_t offset_a_q13, offset_b_q13;  // two bursts without current, counts
  int16_t start_samples, end_samples;
} slopes_scale_t;

/// Derives the constant; the other members are set by hand.
void slopes_design(slopes_config_t* c);

slopes_scale_t slopes_scale(const slopes_config_t* c, const slopes_trim_t* trim);

/// Fills change_q19 and current_q20 of the window.
void slopes_evaluate(const slopes_scale_t* c, const slopes_sums_t* sums, estimator_window_t* w);

#endif
