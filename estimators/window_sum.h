// Weighted sum of a vector over a period's windows: whole products, rounded off once, downwards.

#ifndef STILLSPIN_ESTIMATORS_WINDOW_SUM_H
#define STILLSPIN_ESTIMATORS_WINDOW_SUM_H

#include "hal/qmath/qmath.h"

/// Q30 more than what is summed.
typedef struct {
  int64_t x, y;
} window_sum_t;

static inline void window_sum_add(window_sum_t* sum, int32_t x, int32_t y, int32_t share_q30) {
  sum->x = q_mac(sum->x, x, share_q30);
  sum->y = q_mac(sum->y, y, share_q30);
}

/// A component of the mean, within 2^bits; bits = 2..30.
static inline int32_t window_sum_mean(int64_t sum, unsigned bits) { return q_sat_bits(sum, 30, bits); }

#endif
