// What q_shl_sat promises, in ACSL, and what it takes of shifts: two sentences of the numbers, one of q_shr, which WP
// proves beside it (part left).

#ifndef STILLSPIN_TESTS_PROVE_LEFT_SHIFT_H
#define STILLSPIN_TESTS_PROVE_LEFT_SHIFT_H

#include <stdint.h>

/*@ axiomatic Whole {
      axiom least: \forall integer n; 0 <= n <= 31 ==> ((-2147483648) >> n) * (1 << n) == -2147483648;
      axiom small: \forall integer n; 0 <= n <= 30 ==> 1 <= (1 << n) <= 1073741824;
    } */

/*@ requires n <= 31; assigns \nothing; ensures \result * (1 << n) <= x < (\result + 1) * (1 << n); */
static inline int32_t q_shr(int32_t x, unsigned n);

/*@ requires n <= 30; assigns \nothing; ensures \result == sat32(x * (1 << n)); */
static inline int32_t q_shl_sat(int32_t x, unsigned n);

#endif
