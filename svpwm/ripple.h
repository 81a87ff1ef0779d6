// The switching ripple that a pattern makes, as the flux by which the machine departs from its course without ripple.
//
// For a leg with pulse [r, f] of a period N, the integral of (leg voltage - its mean) from the start of the period is
//   Vdc [ clamp(t - r, 0, f - r) - (f - r) t / N ],
// zero at both ends of every period whatever the pattern. Divided by the inductance it is the ripple current: it turns
// a sample taken anywhere into the current without ripple, and that into the current at an edge. The reference is the
// current at the period's ends and not its mean over the period, because patterns change from period to period: the
// ends are continuous, while the mean jumps when the order of the pulses is turned round.

#ifndef STILLSPIN_SVPWM_RIPPLE_H
#define STILLSPIN_SVPWM_RIPPLE_H

#include "svpwm/pattern.h"

/// Ripple flux at some ticks together, up to three, V * period, Q16 (multiply by T/L to have amperes).
ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16);

/// Mean voltage of a period with these pulses, V Q16.
ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16);

/// A walk along the edges that says what the own phase of each carries at that edge: its mean current and the ripple.
///
/// Three times a leg less the sum of the three. A leg has been high for nothing at its rise and for all of its pulse at
/// its fall, and the sum of all legs is a line t slope + offset between two edges.
typedef struct {
  int32_t on3;       // three times the pulse's length, ticks
  int32_t mean_q20;  // mean current, A
} svpwm_ripple_leg_t;

typedef struct {
  const svpwm_pulses_t* pulses;
  uint32_t order;  // of the edges that are left
  svpwm_ripple_leg_t legs[SVPWM_LEGS];
  int32_t slope, offset;  // of the sum of the legs, of the DC-link voltage and 1/N of a tick
  int32_t gain_q28;       // A per ripple
} svpwm_ripple_walk_t;

typedef struct {
  uint32_t edge, leg;
  int32_t tick;
  int32_t blocking_q20;  // current that keeps the edge from coming with its command: out of a leg that rises, A
} svpwm_ripple_edge_t;

/// inverse_inductance_q30: mean T/L, A per V and period; link_q16: DC link, V; together taken as 1024 A at most. Mean
/// currents up to 1400 A.
svpwm_ripple_walk_t svpwm_ripple_walk(const svpwm_pulses_t* p, abc_t mean_q20, int32_t inverse_inductance_q30,
                                      int32_t link_q16);

/// The next edge; there is one while `order` is not 0, as the last edge is a falling one.
static inline svpwm_ripple_edge_t svpwm_ripple_next(svpwm_ripple_walk_t* w) {
  svpwm_ripple_edge_t e;
  e.edge = svpwm_next_edge(&w->order);
  e.tick = w->pulses->at[e.edge];
  const bool falls = e.edge >= SVPWM_LEGS;
  e.leg = falls ? e.edge - SVPWM_LEGS : e.edge;
  const svpwm_ripple_leg_t* const own = &w->legs[e.leg];
  const int32_t change = falls ? -SVPWM_PERIOD_TICKS : SVPWM_PERIOD_TICKS;
  const int32_t high = falls ? own->on3 * (int32_t)SVPWM_PERIOD_TICKS : 0;
  const int32_t ripple = high - (own->on3 + w->slope) * e.tick - w->offset;
  w->slope += change;
  w->offset -= change * e.tick;
  // At most N^2, and times 16 for the upper word to be that of a shift by 28; of edges that are none's it would wrap.
  const int32_t current_q20 = own->mean_q20 + q_mul_hi((int32_t)((uint32_t)ripple * 16u), w->gain_q28);
  e.blocking_q20 = falls ? -current_q20 : current_q20;
  return e;
}

#endif
