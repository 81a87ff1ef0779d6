// Values of which nothing is known: the drivers in this folder are read by Frama-C, not run.
//
// A volatile that nobody defines has any value of its type at every access.

#ifndef STILLSPIN_TESTS_PROVE_ANY_H
#define STILLSPIN_TESTS_PROVE_ANY_H

#include "hal/qmath/qmath.h"

extern volatile uint16_t any_u16;
extern volatile int16_t any_i16;
extern volatile uint32_t any_u32;
extern volatile int32_t any_i32;
extern volatile uint64_t any_u64;
extern volatile int64_t any_i64;

static inline bool any_bool(void) { return (any_u16 & 1u) != 0u; }

// Any number from lo to hi.
static inline int32_t any_from(int32_t lo, int32_t hi) { return q_clamp(any_i32, lo, hi); }

static inline uint16_t any_up_to(uint16_t most) { return (uint16_t)any_from(0, most); }

#endif
