// What ACSL says of conversions and shifts and the prover has no definition of: a number outside of 32 bits wraps where
// it becomes unsigned, and a shift to the left doubles.

#ifndef STILLSPIN_TESTS_PROVE_BITS_H
#define STILLSPIN_TESTS_PROVE_BITS_H

#include <stdint.h>

/*@ axiomatic Conversion {
      axiom below_zero: \forall integer x; -4294967296 <= x < 0 ==> (uint32_t)x == x + 4294967296;
      axiom above: \forall integer x; 4294967296 <= x < 8589934592 ==> (uint32_t)x == x - 4294967296;
    }
    axiomatic Power {
      axiom bounds: \forall integer n; 0 <= n <= 61 ==> 1 <= (1 << n) <= 2305843009213693952;
      axiom next: \forall integer n; 1 <= n ==> (1 << n) == 2 * (1 << (n - 1));
    } */

#endif
