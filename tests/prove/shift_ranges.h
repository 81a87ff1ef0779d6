// What a shift does to a number's size, in ACSL: WP proves it of q_shr (part shifts), and takes it to show of what
// follows something with a share of the difference that it lies between the two (part between).

#ifndef STILLSPIN_TESTS_PROVE_SHIFT_RANGES_H
#define STILLSPIN_TESTS_PROVE_SHIFT_RANGES_H

#include <stdint.h>

/*@ requires n <= 31; assigns \result \from x, n;
    ensures n == 0 ==> \result == x; ensures n == 1 ==> 2 * \result <= x <= 2 * \result + 1;
    ensures n > 0 && x >= 0 ==> 0 <= \result <= x / 2;
    ensures n > 0 && x < 0 ==> x <= 2 * \result + 1 && \result <= -1; */
static inline int32_t q_shr(int32_t x, unsigned n);

#endif
