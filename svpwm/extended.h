// Layout with two neighbouring active vectors extended to a wanted length, and a zero vector (seed paper, section 4.2).
//
// With the legs sorted by on-time (hi, mid, lo; T1 = hi - mid, T2 = mid - lo), the rising edges are spread so that the
// first vector lasts A = max(T1, W) and the second B = max(T2, W); the falling edges then come in the same order and
// produce the complements that give the surplus back. The layout occupies m + A + B, m being the on-time of `lo`; what
// is left of the period is 000. W is the longest that fits, between the two limits given, with a zero window if
// possible and without it near the voltage limit.

#ifndef STILLSPIN_SVPWM_EXTENDED_H
#define STILLSPIN_SVPWM_EXTENDED_H

#include "svpwm/on_time.h"

typedef struct {
  int16_t window_min_ticks;  // T_min, shortest extended vector worth having, 500..3000
  int16_t window_max_ticks;  // longest, bounds the ripple, window_min_ticks..4000
  int16_t zero_ticks;        // zero vector wanted, 0 for none, up to 5000
} extended_config_t;

void svpwm_extended(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/// The pair of vectors that costs least: two of the three (both active ones and 000) are sampled, and the difference of
/// any two has the same size. So 000, which is there for nothing, and the longer active one, extended where it is
/// shorter than window_max_ticks; where 000 is shorter than window_min_ticks, both active ones.
void svpwm_cheapest_pair(const extended_config_t* c, const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/// Plain space-vector modulation, pulses centred, no extension.
void svpwm_centred(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

/// The shortest pulses that give the voltage, at the beginning of the period: all of the zero vector in one piece.
void svpwm_long_zero(const svpwm_on_time_t* t, svpwm_pulses_t* pulses);

#endif
