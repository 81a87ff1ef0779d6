// Layout for small voltages: two long windows of opposite active vectors in every period.
//
// First one leg alone is high, then the other two, so the vectors are +x and -x; the pulse lengths are adjusted by the
// command. Angle information grows with the square of a window's length, and the pair +x, -x has twice the difference
// of an active and a zero vector: at standstill this is worth some fifty times the information of three windows of 20
// us for about the same ripple. x goes round the three phases and the order of the pulses changes, which turns an error
// of the mean inductance into something that averages out (docs, "Physics").

#ifndef STILLSPIN_SVPWM_ALTERNATING_H
#define STILLSPIN_SVPWM_ALTERNATING_H

#include "svpwm/on_time.h"

typedef struct {
  uint16_t leg;     // x, 0..2
  bool pair_first;  // -x before +x
} alternating_state_t;

/// Places the pulses and moves on to the next x. pulse_ticks: mean length of the two pulses, 1500..4700.
void svpwm_alternating(alternating_state_t* s, const svpwm_on_time_t* t, int16_t pulse_ticks, svpwm_pulses_t* pulses);

/// True when the command is small enough for this layout: below 0.7 of the pulse both opposite vectors stay sampleable,
/// up to some 50 V with any x.
static inline bool svpwm_alternating_fits(const svpwm_on_time_t* t, int16_t pulse_ticks) {
  return 10L * (t->leg[t->hi] - t->leg[t->lo]) < 7L * pulse_ticks;
}

#endif
