// What a rotation turned on (estimators/deviation.c) gives, in ACSL; it is read by itself, slice by slice (turned.c).

#ifndef STILLSPIN_TESTS_PROVE_ROTATION_RANGES_H
#define STILLSPIN_TESTS_PROVE_ROTATION_RANGES_H

#include "control/frame.h"
#include "tests/prove/qmath_ranges.h"

/*@ requires -1073741856 <= x_q30 <= 1073741856; assigns \result \from r, x_q30;
    ensures -1288490189 <= \result.sin_q30 <= 1288490189; ensures -1288490189 <= \result.cos_q30 <= 1288490189; */
static rotation_t turned(rotation_t r, int32_t x_q30);

#endif
