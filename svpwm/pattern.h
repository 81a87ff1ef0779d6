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
#define SVPWM_WINDOWS 3  // of a period, at most

// Edges stay inside [FIRST, LAST]: room for the shift of the dead-time compensation, and no pulse over the period's
// end.
#define SVPWM_FIRST_TICK 260
#define SVPWM_LAST_TICK 9960
#define SVPWM_ROOM_TICKS (SVPWM_LAST_TICK - SVPWM_FIRST_TICK)

#define SVPWM_EDGES (2u * SVPWM_LEGS)

/// Edges have numbers: leg k rises at edge k and falls at edge SVPWM_LEGS + k.
typedef struct {
  int16_t at[SVPWM_EDGES];
  uint16_t order[SVPWM_EDGES];  // the edges' numbers in the order of time
} svpwm_pulses_t;

static inline uint16_t svpwm_fall_of(uint16_t leg) { return (uint16_t)(SVPWM_LEGS + leg); }

/// A leg is high from a tick on, for so long.
static inline void svpwm_put_pulse(svpwm_pulses_t* p, uint16_t leg, int32_t rise, int32_t on) {
  p->at[leg] = (int16_t)rise;
  p->at[svpwm_fall_of(leg)] = (int16_t)(rise + on);
}

/// How long a leg is high.
static inline int32_t svpwm_on_ticks(const svpwm_pulses_t* p, uint16_t leg) {
  return p->at[SVPWM_LEGS + leg] - p->at[leg];
}

/// Every layout knows in which order its edges come, so nobody has to sort them.
static inline void svpwm_put_order(svpwm_pulses_t* p, uint16_t e1, uint16_t e2, uint16_t e3, uint16_t e4, uint16_t e5,
                                   uint16_t e6) {
  p->order[0] = e1;
  p->order[1] = e2;
  p->order[2] = e3;
  p->order[3] = e4;
  p->order[4] = e5;
  p->order[5] = e6;
}

/// Two bursts of conversions in an interval of constant switching state.
typedef struct {
  int16_t start, end;  // ticks that trigger its two bursts of conversions
  uint16_t state;      // bit k: leg k high; 0 and 7 are the zero vectors
} svpwm_window_t;

typedef struct {
  svpwm_pulses_t pulses;                      // edges commanded at the motor
  svpwm_window_t windows[SVPWM_WINDOWS + 1];  // one more while they are found
  uint16_t window_count;
} svpwm_pattern_t;

/// True for the zero vectors 000 and 111.
static inline bool svpwm_is_zero_vector(uint16_t state) { return ((0x81u >> state) & 1u) != 0u; }

#endif
