// Operations of qarith.h and qdiv.h by calls. Put in the place of its call each is longer than the call: what runs at
// the background level takes these, and of the interrupt the start, the commissioning, and a quotient by an inverse in
// what has its turn in some period.

#ifndef STILLSPIN_HAL_QMATH_QCALL_H
#define STILLSPIN_HAL_QMATH_QCALL_H

#include <stdint.h>

#include "hal/qmath/qdiv.h"

#if defined(__cplusplus)
extern "C" {
#endif

int32_t qc_add_sat(int32_t a, int32_t b);
int32_t qc_sub_sat(int32_t a, int32_t b);
int32_t qc_abs_sat(int32_t x);
int32_t qc_shl_sat(int32_t x, unsigned n);
int32_t qc_follow(int32_t a, int32_t b, unsigned n);
int32_t qc_mul(int32_t a, int32_t b, unsigned shift);
int32_t qc_mul_sat(int32_t a, int32_t b, unsigned shift);

/// As q_over, a saturated product; the inverse is taken apart where it is called, which costs least there.
static inline int32_t qc_over(int32_t num, q_inverse_t inverse, unsigned shift) {
  return qc_mul_sat(num, inverse.value, inverse.exponent - shift);
}

#if defined(__cplusplus)
}
#endif

#endif
