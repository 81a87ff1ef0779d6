// What a shift does to a number's size, in ACSL: EVA shows it slice by slice (qmath.c), and WP takes it to show of what
// follows something with a share of the difference that it lies between the two.

#ifndef STILLSPIN_TESTS_PROVE_SHIFT_RANGES_H
#define STILLSPIN_TESTS_PROVE_SHIFT_RANGES_H

#include <stdint.h>

/*@ requires n <= 31; assigns \result \from x, n;
    ensures n > 0 && x >= 0 ==> 0 <= \result <= x; ensures n > 0 && x < 0 ==> x <= \result <= -1; */
static inline int32_t q_shr(int32_t x, unsigned n);

#endif
