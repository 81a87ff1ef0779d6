// What the functions of hal/qmath with tables and normalisation need and give, in ACSL: their code is read by itself
// with any argument (qmath.c), and what calls them is read with these lines in its place.

#ifndef STILLSPIN_TESTS_PROVE_QMATH_RANGES_H
#define STILLSPIN_TESTS_PROVE_QMATH_RANGES_H

#include <stdint.h>

/*@ assigns \result \from x; ensures \result <= 32; ensures x != 0 ==> \result <= 31;
    ensures x >= 4 ==> \result <= 29; */
unsigned q_clz32(uint32_t x);

/*@ assigns \result \from x; ensures -2147483648 <= x <= 2147483647 ==> \result == x;
    ensures x < 0 ==> \result <= 0; ensures x >= 0 ==> \result >= 0; */
static inline int32_t q_sat64(int64_t x);

/*@ requires n <= 30; assigns \result \from x, n; */
static inline int32_t q_shl_sat(int32_t x, unsigned n);

/*@ requires 0 <= limit; assigns \result \from x, limit; ensures -limit <= \result <= limit;
    ensures \result <= -1 || 0 <= \result;  // always: has its signs read apart
*/
static inline int32_t q_limit(int32_t x, int32_t limit);

/*@ requires 1 <= n <= 31; assigns \result \from a, b, n;
    ensures a <= \result || b <= \result; ensures \result <= a || \result <= b; */
static inline int32_t q_follow(int32_t a, int32_t b, unsigned n);

/*@ requires 1 <= n <= 31; assigns \result \from a, b, n;
    ensures a <= \result || b <= \result; ensures \result <= a || \result <= b; */
static inline int32_t q_follow_halves(int32_t a, int32_t b, unsigned n);

/*@ requires -2147483648 <= b - a <= 2147483647 && 1 <= n <= 31; assigns \result \from a, b, n;
    ensures a <= \result || b <= \result; ensures \result <= a || \result <= b; */
static inline int32_t q_follow_near(int32_t a, int32_t b, unsigned n);

/*@ requires 1 <= bits <= 30 && 0 <= share <= (1 << bits);
    assigns \result \from a, b, share, bits; ensures a <= \result || b <= \result;
    ensures \result <= a || \result <= b; */
static inline int32_t q_mix_sat(int32_t a, int32_t b, int32_t share, unsigned bits);

/*@ requires -1073741824 <= a < 1073741824 && -1073741824 <= b < 1073741824 && 2 <= n <= 24;
    requires \valid(rest) && \initialized(rest) && *rest < (1 << n);
    assigns *rest, \result \from a, b, n, *rest; ensures \initialized(rest); ensures *rest < (1 << n);
    ensures a <= \result || b <= \result; ensures \result <= a || \result <= b; */
static inline int32_t q_follow_remainder(int32_t a, int32_t b, unsigned n, uint32_t* rest);

/*@ assigns \result \from x; ensures \result <= 4611686018427387904; */
static inline uint64_t q_square(int32_t x);

/*@ requires 2 <= n <= 32; assigns \result \from x, n; ensures 0 <= \result < 1073741824; */
static inline int32_t q_square_sat(int32_t x, unsigned n);

/*@ requires -2147483648 <= b - a <= 2147483647 && 1 <= bits <= 30 && 0 <= share <= (1 << bits);
    assigns \result \from a, b, share, bits; ensures a <= \result || b <= \result;
    ensures \result <= a || \result <= b; */
static inline int32_t q_mix(int32_t a, int32_t b, int32_t share, unsigned bits);

/*@ requires bits <= 30 && 2 <= n <= 32 && 32 <= n + bits <= 62; assigns \result \from x, n, bits;
    ensures -(1 << bits) <= \result < (1 << bits); */
static inline int32_t q_sat_bits(int64_t x, unsigned n, unsigned bits);

/*@ requires divisor >= 2147483648; assigns \result \from divisor; */
uint32_t q_reciprocal_q31(uint32_t divisor);

/*@ requires shift <= 31; assigns \result \from num, den, shift;
    ensures num >= 0 && den >= 0 ==> \result >= 0; ensures num <= 0 && den >= 0 ==> \result <= 0; */
int32_t q_div(int32_t num, int32_t den, unsigned shift);

#include "hal/qmath/qdiv.h"  // the type, behind what its inline functions promise

/*@ assigns \result \from divisor;
    ensures 0 <= \result.value && 31 <= \result.exponent <= 61;
    ensures divisor >= 524288 ==> \result.exponent >= 50; */
q_inverse_t q_invert(int32_t divisor);

/*@ requires \valid(sum) && -4611686018427387904 <= x <= 4611686018427387904; assigns *sum \from *sum, x; */
void q_gather(int64_t* sum, int64_t x);

/*@ assigns \result \from x; ensures x <= 4611686014132420609 ==> \result <= 2147483647; */
uint32_t q_sqrt64(uint64_t x);

/*@ assigns \result \from x; */
uint32_t q_sqrt32(uint32_t x);

/*@ assigns \result \from a, b; ensures 0 <= \result; */
int32_t q_hypot(int32_t a, int32_t b);

/*@ assigns \result \from y, x; */
uint32_t q_atan2(int32_t y, int32_t x);

/*@ requires \valid(sin_q30) && \valid(cos_q30);
    assigns *sin_q30 \from angle_bam; assigns *cos_q30 \from angle_bam;
    ensures \initialized(sin_q30) && \initialized(cos_q30);
    ensures -1073741824 <= *sin_q30 <= 1073741824; ensures -1073741824 <= *cos_q30 <= 1073741824; */
void q_sincos(uint32_t angle_bam, int32_t* sin_q30, int32_t* cos_q30);

#endif
