// Operations of qarith.h as functions. Put in the place of its call each is longer than the call: what runs at the
// background level takes these, and of the interrupt what has its periods to itself, the start and the commissioning.

#ifndef STILLSPIN_HAL_QMATH_QCALL_H
#define STILLSPIN_HAL_QMATH_QCALL_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

int32_t qc_add_sat(int32_t a, int32_t b);
int32_t qc_sub_sat(int32_t a, int32_t b);
int32_t qc_abs_sat(int32_t x);
int32_t qc_shl_sat(int32_t x, unsigned n);
int32_t qc_mul(int32_t a, int32_t b, unsigned shift);
int32_t qc_mul_sat(int32_t a, int32_t b, unsigned shift);

#if defined(__cplusplus)
}
#endif

#endif
