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

typedef struct {
  int16_t rise[SVPWM_LEGS];
  int16_t fall[SVPWM_LEGS];
} svpwm_pulses_t;

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
