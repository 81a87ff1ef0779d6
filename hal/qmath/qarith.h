// Saturating and rounding arithmetic on 16- and 32-bit fixed-point numbers.
//
// Rounding is half up: exact halves go towards +infinity, as adding half an LSB before the shift does.
// "Saturating" means that a result which does not fit becomes the nearest number that does, because a wrapped current
// reference reverses a motor.

#ifndef STILLSPIN_HAL_QMATH_QARITH_H
#define STILLSPIN_HAL_QMATH_QARITH_H

#include <stdbool.h>
#include <stdint.h>

// C leaves the right shift of a negative number to the compiler. q_shr and q_shr64 are the only two places that rely on
// it being arithmetic, and this line does not compile where it is not.
typedef char q_right_shift_is_arithmetic[((-3L >> 1) == -2L && (-3LL >> 1) == -2LL) ? 1 : -1];

// floor(x / 2^n), n = 0..31.
static inline int32_t q_shr(int32_t x, unsigned n) { return x >> n; }

// floor(x / 2^n), n = 0..63.
static inline int64_t q_shr64(int64_t x, unsigned n) { return x >> n; }

// round(x / 2^n), halves up, n = 0..31.
static inline int32_t q_shr_round(int32_t x, unsigned n) {
  if (n == 0) {
    return x;
  }
  return q_shr(x, n) + (q_shr(x, n - 1) & 1);
}

static inline int32_t q_max(int32_t a, int32_t b) { return (a > b) ? a : b; }

static inline int32_t q_min(int32_t a, int32_t b) { return (a < b) ? a : b; }

static inline int16_t q_max16(int16_t a, int16_t b) { return (a > b) ? a : b; }

static inline int16_t q_min16(int16_t a, int16_t b) { return (a < b) ? a : b; }

// x limited to lo..hi. Not valid for lo > hi.
static inline int32_t q_clamp(int32_t x, int32_t lo, int32_t hi) {
  if (x < lo) {
    return lo;
  }
  return (x > hi) ? hi : x;
}

// x limited to -limit..limit, limit = 0..2^31 - 1: one comparison where nothing has to be limited.
/// Within -2^bits and 2^bits - 1, for a constant below 31: a single instruction where there is one for that.
static inline int32_t q_within_bits(int32_t x, unsigned bits) {
  return q_clamp(x, -(int32_t)(1uL << bits), (int32_t)(1uL << bits) - 1);
}

static inline int32_t q_limit(int32_t x, int32_t limit) {
  if ((uint32_t)x + (uint32_t)limit <= 2u * (uint32_t)limit) {
    return x;
  }
  return (x < 0) ? -limit : limit;
}

// True for lo <= x <= hi.
static inline bool q_in_range(int32_t x, int32_t lo, int32_t hi) { return x >= lo && x <= hi; }

// x limited to the range of int32_t.
static inline int32_t q_sat64(int64_t x) {
  const int32_t low = (int32_t)(uint32_t)(uint64_t)x;
  if (low == x) {
    return low;  // one comparison where nothing has to be limited
  }
  return (x < 0) ? INT32_MIN : INT32_MAX;
}

// floor(x / 2^n) limited to -2^bits..2^bits - 1: what leaves room for a sum behind it. n = 2..32,
// n + bits = 32..62.
static inline int32_t q_sat_bits(int64_t x, unsigned n, unsigned bits) {
  const int32_t above = (int32_t)q_shr64(x, n + bits);
  if ((uint32_t)above + 1u <= 1u) {
    return (int32_t)(uint32_t)((uint64_t)x >> n);  // one comparison where nothing has to be limited
  }
  const int32_t end = (int32_t)((uint32_t)1 << bits);
  return (above < 0) ? -end : end - 1;
}

static inline int32_t q_add_sat(int32_t a, int32_t b) { return q_sat64((int64_t)a + b); }

static inline int32_t q_sub_sat(int32_t a, int32_t b) { return q_sat64((int64_t)a - b); }

// a + (b - a) / 2^n, n = 1..31: what follows b with a share of the difference lies between the two. A difference that
// is saturated: the share of more than 2^31 is less than that.
static inline int32_t q_follow(int32_t a, int32_t b, unsigned n) { return a + q_shr(q_sub_sat(b, a), n); }

// The same of a and b whose difference fits 32 bits.
static inline int32_t q_follow_near(int32_t a, int32_t b, unsigned n) { return a + q_shr(b - a, n); }

// The same of any two by the difference of their halves: cheaper, where a unit of offset does not count.
static inline int32_t q_follow_halves(int32_t a, int32_t b, unsigned n) {
  return a + q_shr(q_shr(b, 1) - q_shr(a, 1), n - 1u);
}

// q_follow_near with what the shift has left, 0..2^n - 1: nothing of a difference is lost. Both are below 2^30;
// n = 2..24.
static inline int32_t q_follow_remainder(int32_t a, int32_t b, unsigned n, uint32_t* rest) {
  const int32_t difference = b - a;
  const uint32_t mask = ((uint32_t)1 << n) - 1u;
  const uint32_t sum = *rest + ((uint32_t)difference & mask);
  *rest = sum & mask;
  return a + (q_shr(difference, n) + (int32_t)(sum >> n));
}

// -x, and INT32_MAX for INT32_MIN.
static inline int32_t q_neg_sat(int32_t x) { return (x == INT32_MIN) ? INT32_MAX : -x; }

// |x|, and INT32_MAX for INT32_MIN.
static inline int32_t q_abs_sat(int32_t x) { return (x < 0) ? q_neg_sat(x) : x; }

// |x| exactly: 2^31 for INT32_MIN.
static inline uint32_t q_abs_u32(int32_t x) { return (x < 0) ? ((uint32_t)0 - (uint32_t)x) : (uint32_t)x; }

// x * 2^n, saturated, n = 0..30.
static inline int32_t q_shl_sat(int32_t x, unsigned n) {
  if (x > q_shr(INT32_MAX, n)) {
    return INT32_MAX;
  }
  if (x < q_shr(INT32_MIN, n)) {
    return INT32_MIN;
  }
  return x * (int32_t)((uint32_t)1 << n);
}

// x^2.
static inline uint64_t q_square(int32_t x) { return (uint64_t)((int64_t)x * x); }

// x^2 / 2^n, below 2^30, n = 2..32.
static inline int32_t q_square_sat(int32_t x, unsigned n) { return q_sat_bits((int64_t)x * x, n, 30); }

// a * b.
static inline int64_t q_product(int32_t a, int32_t b) { return (int64_t)a * b; }

// sum + a * b: whole products are added up and rounded once. The caller guarantees that the sum fits 64 bits.
static inline int64_t q_mac(int64_t sum, int32_t a, int32_t b) { return sum + (int64_t)a * b; }

// round(a * b / 2^shift) as 64 bits, halves up, shift = 1..62. Never overflows.
static inline int64_t q_mul64(int32_t a, int32_t b, unsigned shift) {
  return q_shr64(q_product(a, b) + ((int64_t)1 << (shift - 1)), shift);
}

// round(a * b / 2^shift), halves up, shift = 1..62. The caller guarantees that the result fits 32 bits.
static inline int32_t q_mul(int32_t a, int32_t b, unsigned shift) { return (int32_t)q_mul64(a, b, shift); }

// round((a * b + c * d) / 2^shift), halves up, shift = 1..62: two products and one rounding. The caller guarantees that
// the result fits 32 bits and the sum, rounding included, 64: a quarter of the range in one of each pair is enough.
static inline int32_t q_mul_add(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift) {
  return (int32_t)q_shr64(q_mac(q_product(a, b), c, d) + ((int64_t)1 << (shift - 1)), shift);
}

// round((a * b - c * d) / 2^shift), the same for a difference.
static inline int32_t q_mul_sub(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift) {
  return (int32_t)q_shr64(q_product(a, b) - q_product(c, d) + ((int64_t)1 << (shift - 1)), shift);
}

// floor of the same: cheaper by a third, where half an LSB of offset does not count. shift = 1..62.
static inline int32_t q_mul_floor(int32_t a, int32_t b, unsigned shift) {
  return (int32_t)q_shr64(q_product(a, b), shift);
}
static inline int32_t q_mul_add_floor(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift) {
  return (int32_t)q_shr64(q_mac(q_product(a, b), c, d), shift);
}
static inline int32_t q_mul_sub_floor(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift) {
  return (int32_t)q_shr64(q_product(a, b) - q_product(c, d), shift);
}

// round(a * b / 2^shift), halves up, saturated, shift = 1..62.
static inline int32_t q_mul_sat(int32_t a, int32_t b, unsigned shift) { return q_sat64(q_mul64(a, b, shift)); }

// a + (b - a) * share / 2^bits, halves up, share = 0..2^bits, bits = 1..30: a mixture of the two lies between them.
// Their difference must fit 32 bits.
static inline int32_t q_mix(int32_t a, int32_t b, int32_t share, unsigned bits) {
  return a + q_mul(b - a, share, bits);
}

// The same with a difference that is saturated: the share of more than 2^31 is less than that.
static inline int32_t q_mix_sat(int32_t a, int32_t b, int32_t share, unsigned bits) {
  return a + q_mul(q_sub_sat(b, a), share, bits);
}

// A part of a total, Q30, of the total's reciprocal: a share below one, and half a part more where that was rounded up.
static inline int32_t q_share_q30(int32_t part, int32_t per_total_q30) {
  return (int32_t)((uint32_t)part * (uint32_t)per_total_q30);
}

// The same two sums of products, saturated.
static inline int32_t q_mul_add_sat(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift) {
  return q_sat64(q_shr64(q_mac(q_product(a, b), c, d) + ((int64_t)1 << (shift - 1)), shift));
}
static inline int32_t q_mul_sub_sat(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift) {
  return q_sat64(q_shr64(q_product(a, b) - q_product(c, d) + ((int64_t)1 << (shift - 1)), shift));
}

// floor(a * b / 2^32): the upper word of the product, one instruction where a function needs no rounding.
static inline int32_t q_mul_hi(int32_t a, int32_t b) { return (int32_t)q_shr64(q_product(a, b), 32); }

// floor(a * b / 2^32) of unsigned numbers.
static inline uint32_t q_umul_hi(uint32_t a, uint32_t b) { return (uint32_t)(((uint64_t)a * b) >> 32); }

// x limited to the range of int16_t.
static inline int16_t q15_sat(int32_t x) { return (int16_t)q_clamp(x, INT16_MIN, INT16_MAX); }

static inline int16_t q15_add_sat(int16_t a, int16_t b) { return q15_sat((int32_t)a + b); }

static inline int16_t q15_sub_sat(int16_t a, int16_t b) { return q15_sat((int32_t)a - b); }

// round(a * b / 2^15), halves up; -1 * -1 saturates to the largest Q15 number.
static inline int16_t q15_mul(int16_t a, int16_t b) { return q15_sat(q_shr((int32_t)a * b + 0x4000L, 15)); }

#endif
