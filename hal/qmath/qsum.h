// Sums over as many periods as it takes.

#ifndef STILLSPIN_HAL_QMATH_QSUM_H
#define STILLSPIN_HAL_QMATH_QSUM_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

// Adds x, within 2^62, to a sum; one that is beyond 2^62 counts as 2^62 of its sign, so that it ends near there and
// never wraps: 2^31 terms of 32 bits stay below.
void q_gather(int64_t* sum, int64_t x);

#if defined(__cplusplus)
}
#endif

#endif
