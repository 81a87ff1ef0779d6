// What the functions of hal/qmath promise, in ACSL: a declaration with a contract before the definition.
//
// make prove has WP prove them (toolchain/proof/parts.py names the functions). What the reading of the floors above
// takes for granted is in qmath_ranges.h.

#ifndef STILLSPIN_TESTS_PROVE_QMATH_CONTRACTS_H
#define STILLSPIN_TESTS_PROVE_QMATH_CONTRACTS_H

#include <stdbool.h>
#include <stdint.h>

/*@ logic integer sat32(integer x) = x > 2147483647 ? 2147483647 : x < -2147483648 ? -2147483648 : x;
    logic integer sat16(integer x) = x > 32767 ? 32767 : x < -32768 ? -32768 : x; */

/*@ requires n <= 31; assigns \nothing; ensures \result == (x >> n); */
static inline int32_t q_shr(int32_t x, unsigned n);

/*@ requires n <= 63; assigns \nothing; ensures \result == (x >> n); */
static inline int64_t q_shr64(int64_t x, unsigned n);

/*@ requires n <= 31; assigns \nothing; ensures n == 0 ==> \result == x;
    ensures n > 0 ==> (x >> n) <= \result <= (x >> n) + 1; */
static inline int32_t q_shr_round(int32_t x, unsigned n);

/*@ assigns \nothing; ensures \result == (a > b ? a : b); */
static inline int32_t q_max(int32_t a, int32_t b);

/*@ assigns \nothing; ensures \result == (a < b ? a : b); */
static inline int32_t q_min(int32_t a, int32_t b);

/*@ assigns \nothing; ensures \result == (a > b ? a : b); */
static inline int16_t q_max16(int16_t a, int16_t b);

/*@ assigns \nothing; ensures \result == (a < b ? a : b); */
static inline int16_t q_min16(int16_t a, int16_t b);

/*@ requires lo <= hi; assigns \nothing; ensures lo <= \result <= hi; ensures lo <= x <= hi ==> \result == x;
    ensures x < lo ==> \result == lo; ensures x > hi ==> \result == hi; */
static inline int32_t q_clamp(int32_t x, int32_t lo, int32_t hi);

/*@ assigns \nothing; ensures \result != 0 <==> lo <= x <= hi; */
static inline bool q_in_range(int32_t x, int32_t lo, int32_t hi);

/*@ assigns \nothing; ensures \result == sat32(x); */
static inline int32_t q_sat64(int64_t x);

/*@ assigns \nothing; ensures \result == sat32(a + b); */
static inline int32_t q_add_sat(int32_t a, int32_t b);

/*@ assigns \nothing; ensures \result == sat32(a - b); */
static inline int32_t q_sub_sat(int32_t a, int32_t b);

/*@ assigns \nothing; ensures \result == sat32(-x); */
static inline int32_t q_neg_sat(int32_t x);

/*@ assigns \nothing; ensures \result == sat32(x < 0 ? -x : x); */
static inline int32_t q_abs_sat(int32_t x);

/*@ assigns \nothing; ensures \result == (x < 0 ? -x : x); */
static inline uint32_t q_abs_u32(int32_t x);

/*@ requires 1 <= shift <= 62; assigns \nothing; ensures \result == ((a * b + (1 << (shift - 1))) >> shift); */
static inline int64_t q_mul64(int32_t a, int32_t b, unsigned shift);

/*@ requires 1 <= shift <= 62; assigns \nothing;
    ensures \result == (int32_t)((a * b + (1 << (shift - 1))) >> shift); */
static inline int32_t q_mul(int32_t a, int32_t b, unsigned shift);

/*@ requires 1 <= shift <= 62; assigns \nothing; ensures \result == sat32((a * b + (1 << (shift - 1))) >> shift); */
static inline int32_t q_mul_sat(int32_t a, int32_t b, unsigned shift);

/*@ assigns \nothing; ensures \result == a * b;
    ensures -4611686018427387904 <= \result <= 4611686018427387904; */
static inline int64_t q_product(int32_t a, int32_t b);

/*@ requires -9223372036854775808 <= sum + a * b <= 9223372036854775807;
    assigns \nothing; ensures \result == sum + a * b; */
static inline int64_t q_mac(int64_t sum, int32_t a, int32_t b);

/*@ requires 1 <= shift <= 62;
    requires a * b + c * d + (1 << (shift - 1)) <= 9223372036854775807 && a * b + c * d <= 9223372036854775807;
    assigns \nothing; ensures \result == (int32_t)((a * b + c * d + (1 << (shift - 1))) >> shift); */
static inline int32_t q_mul_add(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift);

/*@ requires 1 <= shift <= 62;
    requires a * b - c * d + (1 << (shift - 1)) <= 9223372036854775807 && a * b - c * d <= 9223372036854775807;
    assigns \nothing; ensures \result == (int32_t)((a * b - c * d + (1 << (shift - 1))) >> shift); */
static inline int32_t q_mul_sub(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift);

/*@ requires 1 <= shift <= 62;
    requires a * b + c * d + (1 << (shift - 1)) <= 9223372036854775807 && a * b + c * d <= 9223372036854775807;
    assigns \nothing; ensures \result == sat32((a * b + c * d + (1 << (shift - 1))) >> shift); */
static inline int32_t q_mul_add_sat(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift);

/*@ requires 1 <= shift <= 62;
    requires a * b - c * d + (1 << (shift - 1)) <= 9223372036854775807 && a * b - c * d <= 9223372036854775807;
    assigns \nothing; ensures \result == sat32((a * b - c * d + (1 << (shift - 1))) >> shift); */
static inline int32_t q_mul_sub_sat(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift);

/*@ requires 0 <= part && 0 <= per_total_q30 && part * per_total_q30 <= 2147483647;
    assigns \nothing; ensures \result == part * per_total_q30; */
static inline int32_t q_share_q30(int32_t part, int32_t per_total_q30);

/*@ requires 1 <= shift <= 62; assigns \nothing; ensures \result == (int32_t)((a * b) >> shift); */
static inline int32_t q_mul_floor(int32_t a, int32_t b, unsigned shift);

/*@ requires 1 <= shift <= 62; requires a * b + c * d <= 9223372036854775807;
    assigns \nothing; ensures \result == (int32_t)((a * b + c * d) >> shift); */
static inline int32_t q_mul_add_floor(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift);

/*@ requires 1 <= shift <= 62; requires a * b - c * d <= 9223372036854775807;
    assigns \nothing; ensures \result == (int32_t)((a * b - c * d) >> shift); */
static inline int32_t q_mul_sub_floor(int32_t a, int32_t b, int32_t c, int32_t d, unsigned shift);

/*@ assigns \nothing; ensures \result == (int32_t)((a * b) >> 32); */
static inline int32_t q_mul_hi(int32_t a, int32_t b);

/*@ assigns \nothing; ensures \result == (uint32_t)((uint64_t)(a * b) >> 32); */
static inline uint32_t q_umul_hi(uint32_t a, uint32_t b);

/*@ assigns \nothing; ensures \result == sat16(x); */
static inline int16_t q15_sat(int32_t x);

/*@ assigns \nothing; ensures \result == sat16(a + b); */
static inline int16_t q15_add_sat(int16_t a, int16_t b);

/*@ assigns \nothing; ensures \result == sat16(a - b); */
static inline int16_t q15_sub_sat(int16_t a, int16_t b);

/*@ assigns \nothing; ensures \result == sat16((a * b + 16384) >> 15); */
static inline int16_t q15_mul(int16_t a, int16_t b);

#endif
