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

#define SVPWM_PER_THIRD_Q58 960767921L  // 2^58 / (3 N^2), N = 10 000 ticks
#define SVPWM_PER_SIDE_Q58 1664098853L  // 2^58 / (sqrt(3) N^2)

/// Ripple flux at some ticks together, up to three, V * period, Q16 (multiply by T/L to have amperes).
ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16);

/// Mean voltage of a period with these pulses, V Q16 (svpwm/mean.c: the flux methods alone want it).
ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16);

/// A walk along the edges that says what the own phase of each carries at that edge: its mean current and the ripple,
/// as shares of a unit of current.
///
/// Three times a leg less the sum of the three. A leg has been high for nothing at its rise and for all of its pulse at
/// its fall; the sum of all legs grows evenly between two edges. Numbers of 1/16 of the DC-link voltage and 1/N of a
/// tick; on the way they may wrap, their sums do not.
typedef struct {
  uint32_t on3[SVPWM_LEGS];      // three times the pulse's length
  int32_t mean_q12[SVPWM_LEGS];  // mean current
  int32_t gain_q44;              // current per ripple
} svpwm_ripple_legs_t;

typedef struct {
  uint32_t slope, sum;  // of the legs together, less: how fast, and at the last edge
  int32_t tick;         // of the last edge
} svpwm_ripple_walk_t;

#define SVPWM_RIPPLE_PER_TICK ((uint32_t)16)
#define SVPWM_RIPPLE_PER_PERIOD (SVPWM_RIPPLE_PER_TICK * (uint32_t)SVPWM_PERIOD_TICKS)
// 4 * 2^32 / (3 N^2 * 16), of amperes in Q20, halved: Q31.
#define SVPWM_RIPPLE_GAIN_Q31 1921535841L

/// inverse_inductance_q30: mean T/L, A per V and period; link_q16: DC link, V; together taken as 1024 A at most.
/// mean_q12: within 7.4e8, 1400 A of the smallest unit and more. per_unit_q24: of the unit of current, up to 100 per A.
static inline svpwm_ripple_walk_t svpwm_ripple_walk(const svpwm_pulses_t* p, abc_t mean_q12,
                                                    int32_t inverse_inductance_q30, int32_t link_q16,
                                                    int32_t per_unit_q24, svpwm_ripple_legs_t* legs) {
  const uint32_t a = SVPWM_RIPPLE_PER_TICK * (uint32_t)svpwm_on_ticks(p, 0);
  const uint32_t b = SVPWM_RIPPLE_PER_TICK * (uint32_t)svpwm_on_ticks(p, 1);
  const uint32_t c = SVPWM_RIPPLE_PER_TICK * (uint32_t)svpwm_on_ticks(p, 2);
  const int32_t amperes_q18 = q_min(q_mul_hi(link_q16 * 16, inverse_inductance_q30), 268435456L);
  const int32_t gain_q52 = 2 * q_mul_hi(amperes_q18 * 4, SVPWM_RIPPLE_GAIN_Q31);  // A
  const svpwm_ripple_walk_t w = {(uint32_t)0 - (a + b + c), 0, 0};
  legs->on3[0] = 3u * a;
  legs->on3[1] = 3u * b;
  legs->on3[2] = 3u * c;
  legs->mean_q12[0] = mean_q12.a;
  legs->mean_q12[1] = mean_q12.b;
  legs->mean_q12[2] = mean_q12.c;
  legs->gain_q44 = q_mul_hi(gain_q52, per_unit_q24);
  return w;
}

/// What blocks the edge that comes next: the current out of a leg that rises, into one that falls.
static inline int32_t svpwm_ripple_blocking(svpwm_ripple_walk_t* w, const svpwm_ripple_legs_t* legs, unsigned edge,
                                            int32_t tick) {
  w->sum += w->slope * (uint32_t)(tick - w->tick);
  w->tick = tick;
  if (edge < SVPWM_LEGS) {
    w->slope += SVPWM_RIPPLE_PER_PERIOD;
    return legs->mean_q12[edge] - q_mul_hi((int32_t)(legs->on3[edge] * (uint32_t)tick + w->sum), legs->gain_q44);
  }
  const unsigned leg = edge - SVPWM_LEGS;
  w->slope -= SVPWM_RIPPLE_PER_PERIOD;
  const uint32_t lacks = legs->on3[leg] * (uint32_t)(tick - SVPWM_PERIOD_TICKS) + w->sum;
  return q_mul_hi((int32_t)lacks, legs->gain_q44) - legs->mean_q12[leg];
}

#endif
