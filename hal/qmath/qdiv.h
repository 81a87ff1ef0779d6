// Division and reciprocal without a 64-bit division.
//
// Method: the divisor is normalised to [2^31, 2^32), its reciprocal read from a table of 128 entries (8 bits) and
// refined by two Newton steps R <- R (2 - D R) to 31 bits, always from below; the quotient is then made exact from its
// remainder.
//
// q_div makes its quotient exact; q_invert is for a divisor that several numbers share, or where 2^-28 of the quotient
// do not count.
//
// Error: q_div none beyond correct rounding; q_reciprocal_q31 below by less than 2 LSB (all 2^31 divisors tried);
// q_over below by less than 2^-28 of the quotient, besides its rounding.
// Cost: q_div some 120 instructions, q_reciprocal_q31 25, q_clz32 18, q_invert 50, q_over 12. Table: 128 words.

#ifndef STILLSPIN_HAL_QMATH_QDIV_H
#define STILLSPIN_HAL_QMATH_QDIV_H

#include <stdint.h>

#include "hal/qmath/qarith.h"

#if defined(__cplusplus)
extern "C" {
#endif

// Number of zero bits above the highest one of x; 32 for x = 0.
unsigned q_clz32(uint32_t x);

// Reciprocal of a normalised number: 2^63 / divisor, for divisor in [2^31, 2^32); rounded down, too small by at most
// 2 LSB. In other words: of D = divisor / 2^32 in [0.5, 1) the reciprocal 1/D in Q31. Not valid below 2^31.
uint32_t q_reciprocal_q31(uint32_t divisor);

// round(num * 2^shift / den), halves away from zero, saturated to int32_t; shift = 0..31. Correctly rounded.
// A zero den saturates with the sign of num; 0/0 = 0.
int32_t q_div(int32_t num, int32_t den, unsigned shift);

// 1 / divisor: value * 2^-exponent.
typedef struct {
  int32_t value;      // 2^30..2^31 - 1
  unsigned exponent;  // 31..61
} q_inverse_t;

// The inverse of a positive number; 0 counts as 1.
q_inverse_t q_invert(int32_t divisor);

// num * 2^shift / divisor, rounded, saturated to int32_t; shift = 0..30, for a divisor from 2^n up 0..30 + n.
static inline int32_t q_over(int32_t num, q_inverse_t inverse, unsigned shift) {
  return q_mul_sat(num, inverse.value, inverse.exponent - shift);
}

#if defined(__cplusplus)
}
#endif

#endif
