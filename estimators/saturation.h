// Polarity of the magnet by saturation: which half turn is the right one, on a shaft that does not move.
//
// A current along the found axis makes no torque. Along the magnet it adds to its flux, against it it takes away, and
// the incremental inductances differ between the two: in most machines Ldd falls with +i_d; where the flux map is
// cross-coupled, energy conservation asks for dLqq/di_d = dLdq/di_q. Both slopes are parameters of the machine. The
// test commands + - - + and reads both inverse inductances in every period from AVV's regression. What it compares is
// the projection of (y_d, y_q) on the expected change: score = change seen / change expected, near +1 when the axis is
// the right way round and near -1 when it is not.
//
// The confidence is the change over its standard error: the scatter within the four segments, and a floor for what does
// not average out (bent ADC, ringing, drops). Below SATURATION_SIGMA_MIN, or with a score that fits neither answer, the
// result is ambiguous. 324 periods, 32 ms at 10 kHz. Not usable when the machine is linear or its slopes are not known:
// saturation_is_visible says so beforehand.
//
// The same currents of both signs, once steady, also tell the resistance: what is left of the mean residual along them.

#ifndef STILLSPIN_ESTIMATORS_SATURATION_H
#define STILLSPIN_ESTIMATORS_SATURATION_H

#include "estimators/polarity.h"
#include "estimators/regression.h"

#define SATURATION_SEGMENTS 4
#define SATURATION_SETTLE 45  // periods of a segment for the current to get there
#define SATURATION_ROUNDS 6   // rounds of the alternating layout measured in a segment
#define SATURATION_ROUND 6    // periods of a round
#define SATURATION_SEGMENT (SATURATION_SETTLE + SATURATION_ROUNDS * SATURATION_ROUND)
#define SATURATION_LENGTH (SATURATION_SEGMENTS * SATURATION_SEGMENT)
#define SATURATION_SIGMA_MIN 5

/// Relative change of the incremental inductances per ampere of i_d, Q30, signed.
typedef struct {
  int32_t d_q30, q_q30;
} saturation_slopes_t;

typedef struct {
  int16_t tick;
  int16_t passes;         // of the pattern, counted together
  int32_t current_q20;    // amplitude, A
  int32_t reference_q20;  // now commanded, A
  int32_t unit_d_q30;     // direction of the expected change of (y_d, y_q)
  int32_t unit_q_q30;     //
  int32_t expected_q30;   // its size, A per V and period
  int32_t floor_q30;      // error that does not average out
  int32_t round_q30;      // mean over the present round, in the making
  int32_t last_q30;       // mean of the round before
  int32_t change_q30;     // change of the means, summed over the passes
  int32_t missing_q20;    // mean residuals in the sense of the current, summed, A per period
  int16_t missing_count;  //
  uint64_t scatter;       // sum of squared differences between neighbouring rounds of a segment
  int32_t score_q15;      // change seen over change expected
  int32_t sigma_q8;       // change seen over its standard error
  polarity_result_t result;
} saturation_t;

/// True when a current of +-current_q20 A changes the inverse inductances by enough to tell.
bool saturation_is_visible(const machine_model_t* m, const saturation_slopes_t* slopes, int32_t current_q20);

void saturation_begin(saturation_t* s, const machine_model_t* m, const saturation_slopes_t* slopes,
                      int32_t current_q20);

/// Repeats the pattern and adds to what the passes before have shown; at most 8 passes.
void saturation_again(saturation_t* s);

/// What the windows say that the resistance is more than the model has it, ohm Q24; 0 when they said nothing.
int32_t saturation_resistance_q24(const saturation_t* s, const machine_model_t* m);

/// One period: takes the regression made with model m, returns the d-axis current to command, A Q20.
int32_t saturation_step(saturation_t* s, const regression_t* r, const machine_model_t* m);

#endif
