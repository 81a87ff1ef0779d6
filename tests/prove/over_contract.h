// What q_over promises, in ACSL: behind its definition, since it takes a type of qdiv.h.

#ifndef STILLSPIN_TESTS_PROVE_OVER_CONTRACT_H
#define STILLSPIN_TESTS_PROVE_OVER_CONTRACT_H

#include "hal/qmath/qdiv.h"

/*@ requires shift + 1 <= inverse.exponent <= shift + 62; assigns \nothing;
    ensures \result == sat32((num * inverse.value + (1 << (inverse.exponent - shift - 1)))
                             >> (inverse.exponent - shift)); */
static inline int32_t q_over(int32_t num, q_inverse_t inverse, unsigned shift);

#endif
