// hal/qmath with every argument that its headers admit. What is normalised by its leading zeros is given in slices of
// one power of two each, so that a reader that knows intervals alone knows them.

#include "tests/prove/any.h"

// Numbers with their highest bit at n - 1; 0 for n = 0.
static uint32_t magnitude(unsigned n) {
  if (n == 0u) return 0u;
  const uint32_t highest = (uint32_t)1 << (n - 1u);
  return highest + (any_u32 & (highest - 1u));
}

// The same as a signed number; the only one with 32 bits is the smallest.
static int32_t positive(unsigned n) { return (n < 32u) ? (int32_t)magnitude(n) : INT32_MIN; }

static int32_t negative(unsigned n) { return (n < 32u) ? -(int32_t)magnitude(n) : INT32_MIN; }

static void arithmetic(void) {
  const int32_t lo = any_i32;
  const int32_t hi = any_i32;
  if (lo <= hi) (void)q_clamp(any_i32, lo, hi);
  (void)q_limit(any_i32, any_from(0, INT32_MAX));
  (void)q_in_range(any_i32, any_i32, any_i32);
  (void)q_max(any_i32, any_i32);
  (void)q_min(any_i32, any_i32);
  (void)q_max16(any_i16, any_i16);
  (void)q_min16(any_i16, any_i16);
  (void)q_sat64(any_i64);
  (void)q_add_sat(any_i32, any_i32);
  (void)q_sub_sat(any_i32, any_i32);
  (void)q_neg_sat(any_i32);
  (void)q_abs_sat(any_i32);
  (void)q_abs_u32(any_i32);
  (void)q_mul_hi(any_i32, any_i32);
  (void)q_square(any_from(0, INT32_MAX));
  (void)q_square(any_from(INT32_MIN, -1));
  (void)q_umul_hi(any_u32, any_u32);
  (void)q15_sat(any_i32);
  (void)q15_add_sat(any_i16, any_i16);
  (void)q15_sub_sat(any_i16, any_i16);
  (void)q15_mul(any_i16, any_i16);
  (void)angle_diff_bam(any_u32, any_u32);
  (void)angle_add_bam(any_u32, any_i32);
  (void)angle_times(any_u32, any_u16);
  (void)angle_from_turn_q15(any_i32);
  (void)angle_from_turn_q30(any_i32);
  (void)angle_from_rad_q28(any_i32);
  (void)angle_bam_to_rad_q28(any_i32);
  (void)angle_to_turn_q15(any_u32);
  (void)angle_to_turn_q30(any_u32);
}

// A quarter of the range in one of each pair is enough (qarith.h).
static int32_t any_quarter(void) { return any_from(INT32_MIN / 4, INT32_MAX / 4); }

// In half of the range, of either sign.
static void follow_with_rest(unsigned n) {
  uint32_t rest = any_u32 & (((uint32_t)1 << n) - 1u);
  (void)q_follow_remainder(any_from(-0x40000000L, 0x3FFFFFFFL), any_from(-0x40000000L, 0x3FFFFFFFL), n, &rest);
}

static void squared_from(int32_t least, int32_t most, unsigned n) {
  const int32_t x = any_from(least, most);
  (void)q_square_sat(x, n);
  (void)q_square_sat(-x, n);
}

// Slices between numbers whose squares are neighbouring powers of two.
static void squared(unsigned n) {
  (void)q_square_sat(0, n);
  (void)q_square_sat(INT32_MIN, n);
  squared_from(1, 1, n);
  for (unsigned k = 1; k <= 30u; k++) {
    const int32_t middle = (int32_t)(1518500249uL >> (30u - k));  // sqrt(2) 2^k
    squared_from((int32_t)1 << k, middle, n);
    squared_from(middle + 1, (int32_t)(((uint32_t)2 << k) - 1u), n);
  }
}

static int64_t any_from_on(int64_t least) {
  const int64_t x = any_i64;
  return (x < least) ? least : x;
}

// Numbers that are not limited and numbers that are, of either sign.
static void limited(unsigned n, unsigned bits) {
  const int64_t end = (int64_t)1 << (n + bits);
  const int64_t within = any_i64 & (end - 1);
  const int64_t outside = any_from_on(end);
  (void)q_sat_bits(within, n, bits);
  (void)q_sat_bits(-1 - within, n, bits);
  (void)q_sat_bits(outside, n, bits);
  (void)q_sat_bits(-1 - outside, n, bits);
}

static void shifted(unsigned n) {
  if (n <= 31u) {
    (void)q_shr(any_i32, n);
    (void)q_shr_round(any_i32, n);
    if (n <= 30u) (void)q_shl_sat(any_i32, n);
  }
  (void)q_shr64(any_i64, n);
  if (n >= 2u && n <= 32u) squared(n);
  if (n >= 2u && n <= 24u) follow_with_rest(n);
  if (n < 1u || n > 62u) return;
  (void)q_mul64(any_i32, any_i32, n);
  (void)q_mul(any_i32, any_i32, n);
  (void)q_mul_sat(any_i32, any_i32, n);
  (void)q_mul_floor(any_i32, any_i32, n);
  (void)q_mul_add(any_i32, any_quarter(), any_i32, any_quarter(), n);
  (void)q_mul_sub(any_i32, any_quarter(), any_i32, any_quarter(), n);
  (void)q_mul_add_floor(any_i32, any_quarter(), any_i32, any_quarter(), n);
  (void)q_mul_sub_floor(any_i32, any_quarter(), any_i32, any_quarter(), n);
  (void)q_mul_add_sat(any_i32, any_quarter(), any_i32, any_quarter(), n);
  (void)q_mul_sub_sat(any_i32, any_quarter(), any_i32, any_quarter(), n);
}

// A number in slices of its distance to the nearer end of the format, and what it follows, of either sign.
static void follow(int32_t a, unsigned n) {
  (void)q_follow(a, any_from(INT32_MIN, -1), n);
  (void)q_follow(a, any_from(0, INT32_MAX), n);
  (void)q_follow_halves(a, any_from(INT32_MIN, -1), n);
  (void)q_follow_halves(a, any_from(0, INT32_MAX), n);
}

static void followed(unsigned n) {
  for (unsigned distance = 0; distance <= 31u; distance++) {
    follow(INT32_MAX - (int32_t)magnitude(distance), n);
    follow(INT32_MIN + (int32_t)magnitude(distance), n);
  }
}

// Both in half of the range, whose differences fit, and in a slice of it.
static int32_t any_in_slice(int32_t k) { return INT32_MIN / 2 + k * 0x10000000L + (int32_t)(any_u32 & 0xFFFFFFFuL); }

static void mixed(unsigned n) {
  for (int32_t a = 0; a < 8; a++) {
    for (int32_t b = 0; b < 8; b++) {
      (void)q_mix(any_in_slice(a), any_in_slice(b), any_from(0, (int32_t)((uint32_t)1 << n)), n);
    }
  }
}

// The shorter side of a vector is any that is not longer.
static void of_vectors(unsigned n) {
  const int32_t most = (n < 32u) ? (int32_t)(((uint32_t)1 << n) - 1u) : INT32_MAX;
  const int32_t other = (n < 32u) ? any_from(-most, most) : any_i32;
  (void)q_atan2(other, positive(n));
  (void)q_atan2(other, negative(n));
  (void)q_atan2(positive(n), other);
  (void)q_atan2(negative(n), other);
}

static void divide(int32_t num, unsigned n) {
  (void)q_div(num, positive(n), any_u16 & 31u);
  (void)q_div(num, negative(n), any_u16 & 31u);
}

static void divided(unsigned n) {
  (void)q_clz32(magnitude(n));
  divide(0, n);
  divide(any_from(1, INT32_MAX), n);
  divide(any_from(INT32_MIN, -1), n);
  if (n == 32u) (void)q_reciprocal_q31(magnitude(n));
  if (n == 0u || n == 32u) {
    (void)q_invert(any_from(INT32_MIN, 0));
    return;
  }
  const q_inverse_t inverse = q_invert(positive(n));
  (void)q_over(any_i32, inverse, any_u16 % 31u);
}

static void of_squares(unsigned n) {
  (void)q_sqrt64((n == 0u) ? 0u : (uint64_t)magnitude(n) << 32 | any_u32);
  (void)q_sqrt64(magnitude(n));
  int64_t sum = any_i64;
  q_gather(&sum, q_product(any_i32, any_i32));
}

// Interval by interval of the sine's table, in every quadrant.
static void of_angles(uint32_t interval) {
  int32_t sine;
  int32_t cosine;
  q_sincos((interval << 23) + (any_u32 & 0x7FFFFFuL), &sine, &cosine);
}

// Each is read by itself: what stops one does not hide the others.
void prove_arithmetic(void) {
  arithmetic();
  for (unsigned n = 0; n <= 63u; n++) shifted(n);
  for (unsigned n = 1; n <= 31u; n++) followed(n);
  for (unsigned n = 1; n <= 30u; n++) mixed(n);
}

// Every number, every shift, every width.
void prove_limits(void) {
  for (unsigned bits = 0; bits <= 30u; bits++) {
    for (unsigned n = 32u - bits; n <= 32u; n++) limited(n, bits);
  }
}

void prove_quotients(void) {
  for (unsigned n = 0; n <= 32u; n++) divided(n);
}

void prove_roots(void) {
  for (unsigned n = 0; n <= 32u; n++) of_squares(n);
}

void prove_vectors(void) {
  for (unsigned n = 0; n <= 32u; n++) of_vectors(n);
}

void prove_angles(void) {
  for (uint32_t interval = 0; interval < 512u; interval++) of_angles(interval);
}

// With the root's contract for its code.
void prove_lengths(void) {
  (void)q_sqrt32(any_u32);
  (void)q_hypot(any_i32, any_i32);
}
