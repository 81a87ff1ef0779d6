#include "svpwm/ripple.h"

#define PER_THIRD_Q58 960767921L  // 2^58 / (3 N^2), N = 10 000 ticks
#define PER_SIDE_Q58 1664098853L  // 2^58 / (sqrt(3) N^2)

// Ripple of a leg, of the DC-link voltage and 1/N of a tick: the sum of N clamp(t - r, 0, f - r) - (f - r) t.
static int32_t leg_at(const svpwm_pulses_t* p, uint16_t leg, const int16_t ticks[], uint16_t count) {
  const int32_t rise = p->at[leg];
  const int32_t on = svpwm_on_ticks(p, leg);
  int32_t passed = 0;
  int32_t sum = 0;
  for (uint16_t k = 0; k < count; k++) {
    passed += q_clamp(ticks[k] - rise, 0, on);
    sum += ticks[k];
  }
  return passed * (int32_t)SVPWM_PERIOD_TICKS - on * sum;
}

ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16) {
  const abc_t legs = {leg_at(p, 0, ticks, count), leg_at(p, 1, ticks, count), leg_at(p, 2, ticks, count)};
  const int32_t per_third = q_mul_floor(link_q16, PER_THIRD_Q58, 28);
  const int32_t per_side = q_mul_floor(link_q16, PER_SIDE_Q58, 28);
  const ab_t flux = {q_mul_floor(2 * legs.a - legs.b - legs.c, per_third, 30),
                     q_mul_floor(legs.b - legs.c, per_side, 30)};
  return flux;
}

ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16) {
  const int32_t a = svpwm_on_ticks(p, 0);
  const int32_t b = svpwm_on_ticks(p, 1);
  const int32_t c = svpwm_on_ticks(p, 2);
  const int32_t ticks = (int32_t)SVPWM_PERIOD_TICKS;
  const ab_t v = {q_mul_floor((2 * a - b - c) * ticks, q_mul_floor(link_q16, PER_THIRD_Q58, 28), 30),
                  q_mul_floor((b - c) * ticks, q_mul_floor(link_q16, PER_SIDE_Q58, 28), 30)};
  return v;
}

svpwm_ripple_walk_t svpwm_ripple_walk(const svpwm_pulses_t* p, int32_t admittance_q30, int32_t link_q16) {
  const int32_t a = svpwm_on_ticks(p, 0);
  const int32_t b = svpwm_on_ticks(p, 1);
  const int32_t c = svpwm_on_ticks(p, 2);
  const svpwm_ripple_walk_t w = {p,
                                 p->order,
                                 {3 * a, 3 * b, 3 * c},
                                 -(a + b + c),
                                 0,
                                 q_mul_floor(q_mul_floor(link_q16, admittance_q30, 26), PER_THIRD_Q58, 30)};
  return w;
}
