// Least squares in integers: quotients of 64-bit sums and a fit with two regressors.
//
// The sums of a measurement run over thousands of periods in the interrupt; the background level makes quotients of
// them. There is no 64-bit division: numerator and denominator are brought to 31 bits each on their own, so a quotient
// has a relative error below 2^-29 and is then rounded to its format. Cost: about 400 instructions a quotient.

#ifndef STILLSPIN_ESTIMATORS_FIT_H
#define STILLSPIN_ESTIMATORS_FIT_H

#include "hal/qmath/qmath.h"

#define FIT_POINTS 16u      // most points of a fit
#define FIT_END 536870911L  // of columns: so much that the squares of FIT_POINTS of them fit 63 bits

/// numerator * 2^shift / denominator, saturated to 32 bits; shift -31..62. A zero denominator saturates.
int32_t fit_ratio(int64_t numerator, int64_t denominator, int16_t shift);

/// Sum of the products of two columns. The caller guarantees that it fits 63 bits.
int64_t fit_dot(const int32_t* a, const int32_t* b, uint16_t n);

/// y = slope * x + offset * f in the least-squares sense; x, f and y in one common Q format.
typedef struct {
  int32_t slope_q24;
  int32_t offset_q24;
  int32_t rms;  // of what the fit leaves over, in the format of y
} fit_plane_t;

/// Fits n points, 3..FIT_POINTS. Columns within +-FIT_END. Returns false when the two regressors cannot be told apart.
bool fit_plane(const int32_t* x, const int32_t* f, const int32_t* y, uint16_t n, fit_plane_t* out);

#endif
