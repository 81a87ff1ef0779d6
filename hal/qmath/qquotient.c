// The exact quotient: no interrupt wants one in every period, so it is by itself and as short as it can be.

#include <stdbool.h>

#include "hal/qmath/qdiv.h"

// floor(num * 2^31 / den) for num and den in [2^31, 2^32); *rest is the remainder, 0..den-1.
static uint32_t divide_normalised(uint32_t num, uint32_t den, uint32_t* rest) {
  uint32_t quotient = q_umul_hi(num, q_reciprocal_q31(den));
  uint64_t left = ((uint64_t)num << 31) - (uint64_t)quotient * den;
  while (left >= den) {  // at most twice, because the reciprocal is too small by at most 2 LSB
    left -= den;
    quotient++;
  }
  *rest = (uint32_t)left;
  return quotient;
}

// round(num * 2^shift / den), halves up, for den > 0; everything from 2^31 up is returned as 2^31.
static uint32_t divide_magnitudes(uint32_t num, uint32_t den, unsigned shift) {
  const uint32_t limit = (uint32_t)1 << 31;
  const unsigned num_zeros = q_clz32(num);
  const unsigned den_zeros = q_clz32(den);
  // With both numbers normalised the quotient is in (2^30, 2^32); it is 2^down times the result.
  const int down = 31 + (int)num_zeros - (int)den_zeros - (int)shift;
  uint32_t rest;
  uint32_t quotient;
  if (num == 0 || down > 32) {
    return 0;
  }
  if (down < 0) {
    return limit;
  }
  den <<= den_zeros;
  quotient = divide_normalised(num << num_zeros, den, &rest);
  if (down > 0) {
    return (uint32_t)((quotient + ((uint64_t)1 << (down - 1))) >> down);
  }
  if (quotient >= limit) {
    return limit;
  }
  return quotient + ((rest >= den - rest) ? 1 : 0);
}

int32_t q_div(int32_t num, int32_t den, unsigned shift) {
  const bool negative = (num < 0) != (den < 0);
  uint32_t magnitude;
  if (den == 0) {
    return (num == 0) ? 0 : ((num < 0) ? INT32_MIN : INT32_MAX);
  }
  magnitude = divide_magnitudes(q_abs_u32(num), q_abs_u32(den), shift);
  if (magnitude > INT32_MAX) {
    return negative ? INT32_MIN : INT32_MAX;
  }
  return negative ? -(int32_t)magnitude : (int32_t)magnitude;
}
