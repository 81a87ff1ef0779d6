// Square roots and the length of a vector, correctly rounded.
//
// Method: x is normalised by an even shift, 1/sqrt(x) guessed along twelve chords (8 bits) and refined by two
// Newton steps R <- R (3 - x R^2) / 2 to 25 bits, always from below; the root is then made exact from its remainder.
//
// Error: none beyond correct rounding. Cost: q_sqrt64 some 90 instructions, q_hypot some 110. Table: 13 words.

#ifndef STILLSPIN_HAL_QMATH_QSQRT_H
#define STILLSPIN_HAL_QMATH_QSQRT_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

// sqrt(x) to the nearest integer; the root of x > 2^64 - 2^32, which rounds to 2^32, saturates to 2^32 - 1.
// The root of a Qn number in Qn is q_sqrt64((uint64_t)x_qn << n).
uint32_t q_sqrt64(uint64_t x);

// sqrt(x) to the nearest integer, 0..65536.
uint32_t q_sqrt32(uint32_t x);

// sqrt(a^2 + b^2) to the nearest integer, in the Q format of a and b, saturated to INT32_MAX.
int32_t q_hypot(int32_t a, int32_t b);

#if defined(__cplusplus)
}
#endif

#endif
