#include "svpwm/ripple.h"

// Of what the legs have, of the DC-link voltage and 1/N of a tick, up to N^2: the vector, V Q16.
static ab_t of_legs(abc_t legs, int32_t link_q16) {
  const ab_t v = {q_mul_floor(2 * legs.a - legs.b - legs.c, q_mul_floor(link_q16, SVPWM_PER_THIRD_Q58, 28), 30),
                  q_mul_floor(legs.b - legs.c, q_mul_floor(link_q16, SVPWM_PER_SIDE_Q58, 28), 30)};
  return v;
}

ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16) {
  const int32_t ticks = (int32_t)SVPWM_PERIOD_TICKS;
  const abc_t legs = {svpwm_on_ticks(p, 0) * ticks, svpwm_on_ticks(p, 1) * ticks, svpwm_on_ticks(p, 2) * ticks};
  return of_legs(legs, link_q16);
}

// A pulse in the middle of the period makes none.
static int32_t mean_of(const svpwm_pulses_t* p, uint16_t leg) {
  const int32_t late = p->at[leg] + p->at[SVPWM_LEGS + leg] - (int32_t)SVPWM_PERIOD_TICKS;
  return -svpwm_on_ticks(p, leg) * late / 2;
}

ab_t svpwm_mean_ripple_q16(const svpwm_pulses_t* p, int32_t link_q16) {
  const abc_t legs = {mean_of(p, 0), mean_of(p, 1), mean_of(p, 2)};
  return of_legs(legs, link_q16);
}
