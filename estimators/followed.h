// Whether a current follows what a test asks of it. A test of the polarity is a pattern of steps that last long enough
// for the current loop; where the voltage is too low for them the current lags more and more behind, shaft and iron see
// another pattern, and the answer may come out reversed, well above its scatter.
//
// The measure is the mean error in the last quarter of each step, the worst of the pattern. Three eighths of the
// amplitude are borne: the current has made four fifths of a reversal then. A 300 V motor shows a tenth of it from 90 V
// up; at 32 V and 0.45 of it the first answers are wrong.

#ifndef STILLSPIN_ESTIMATORS_FOLLOWED_H
#define STILLSPIN_ESTIMATORS_FOLLOWED_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
  int32_t error_q20;  // mean of the present step, in the making, A
  int32_t worst_q20;  // of the steps so far
} followed_t;

/// One period: its tick in a step of `length` periods.
void followed_step(followed_t* f, int16_t tick, int16_t length, int32_t reference_q20, int32_t flows_q20);

/// True when the current has followed a pattern of this amplitude.
bool followed_well(const followed_t* f, int32_t amplitude_q20);

#endif
