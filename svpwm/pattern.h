// One PWM period as three pulses, one per leg, and the windows in which the current is sampled.
//
// Every leg is high exactly once, from its rising to its falling edge (set on CMPA, clear on CMPB in up-count mode), so
// the mean voltage depends on the lengths alone and the positions are free: they make the windows. Moving a pulse with
// its length kept is the paper's "extend a vector and compensate with its complement" (section 4.2, Figs 4 and 13).
//
// Times are ticks of 10 ns counted from the start of the period, 10 000 of them.

#ifndef STILLSPIN_SVPWM_PATTERN_H
#define STILLSPIN_SVPWM_PATTERN_H

#include <stdbool.h>

#include "control/frame.h"
#include "hal/qmath/period.h"

#define SVPWM_PERIOD_TICKS PERIOD_TICKS
#define SVPWM_LEGS 3
#define SVPWM_WINDOWS 3

// Edges stay inside [FIRST, LAST]: room for the shift of the dead-time compensation, and no pulse over the period's
// end.
#define SVPWM_FIRST_TICK 260
#define SVPWM_LAST_TICK 9960
#define SVPWM_ROOM_TICKS (SVPWM_LAST_TICK - SVPWM_FIRST_TICK)

#define SVPWM_EDGES (2u * SVPWM_LEGS)

typedef struct {
  int16_t rise[SVPWM_LEGS];
  int16_t fall[SVPWM_LEGS];
  uint16_t order;  // of the six edges in time: their legs, two bits each, the first one lowest; a leg rises, then falls
} svpwm_pulses_t;

/// Every layout knows in which order its edges come, so nobody has to sort them.
static inline uint16_t svpwm_order(uint16_t e1, uint16_t e2, uint16_t e3, uint16_t e4, uint16_t e5, uint16_t e6) {
  const uint32_t first = (uint32_t)e1 | (uint32_t)e2 << 2 | (uint32_t)e3 << 4;
  const uint32_t second = (uint32_t)e4 | (uint32_t)e5 << 2 | (uint32_t)e6 << 4;
  return (uint16_t)(first | second << 6);
}

/// A walk along the edges; begins with {order, 0}.
typedef struct {
  uint32_t rest;   // the order of those to come
  uint32_t state;  // of the legs behind the last one
} svpwm_walk_t;

/// The next edge: its leg, and whether it rises.
static inline uint16_t svpwm_next_edge(svpwm_walk_t* w, bool* rises) {
  const uint32_t leg = w->rest & 3u;
  *rises = (w->state >> leg & 1u) == 0u;
  w->rest >>= 2;
  w->state ^= (uint32_t)1u << leg;
  return (uint16_t)leg;
}

/// An interval of constant switching state that is long enough to sample in.
typedef struct {
  int16_t begin, end;  // its edges
  uint16_t state;      // bit k: leg k high; 0 and 7 are the zero vectors
} svpwm_window_t;

typedef struct {
  svpwm_pulses_t pulses;  // edges wanted at the motor
  svpwm_window_t windows[SVPWM_WINDOWS];
  uint16_t window_count;
} svpwm_pattern_t;

/// True for the zero vectors 000 and 111.
static inline bool svpwm_is_zero_vector(uint16_t state) { return state == 0u || state == 7u; }

#endif
