// What the fits of the commissioning promise, in ACSL: the part commissioning reads their code with any argument, the
// part results takes this in the code's place.

#ifndef STILLSPIN_TESTS_PROVE_RESULTS_RANGES_H
#define STILLSPIN_TESTS_PROVE_RESULTS_RANGES_H

#include "estimators/fit.h"
#include "tests/prove/qmath_ranges.h"

/*@ requires -31 <= shift <= 62; assigns \result \from numerator, denominator, shift; */
int32_t fit_ratio(int64_t numerator, int64_t denominator, int16_t shift);

#endif
