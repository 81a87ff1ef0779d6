// From a voltage vector to the on-times of the three legs, up to a common part that the layout chooses.

#ifndef STILLSPIN_SVPWM_ON_TIME_H
#define STILLSPIN_SVPWM_ON_TIME_H

#include "svpwm/pattern.h"

// Shortest pulse and shortest gap: with less, the dead band would swallow the edge.
#define SVPWM_PULSE_MIN_TICKS 300
// Largest difference of two on-times that leaves both; rounding the legs may add one tick to it.
#define SVPWM_SPREAD_MAX_TICKS (SVPWM_ROOM_TICKS - SVPWM_PULSE_MIN_TICKS - 1)

typedef struct {
  // On-times minus the common part, ticks, each rounded so that differences are exact to a tick.
  int16_t leg[SVPWM_LEGS];
  uint16_t hi, mid, lo;  // legs by their on-times, longest first
  ab_t realised_q16;     // the voltage vector that these on-times give, V
  bool limited;          // the command was longer than what fits and has been shortened in its direction
} svpwm_on_time_t;

/// Ticks per volt, Q20, of a DC-link voltage in V, at least 10 V (less is taken as 10 V). `last` is the one of the last
/// period, or 0: where the link has moved by less than 0.4 %, one step of Newton's method makes the new one of it, to
/// 2e-5.
int32_t svpwm_ticks_per_volt_q20(int32_t link_q16, int32_t last_q20);

/// voltage_q16: wanted vector, V.
svpwm_on_time_t svpwm_on_time(ab_t voltage_q16, int32_t ticks_per_volt_q20);

#endif
