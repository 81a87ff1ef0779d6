#include "svpwm/ripple.h"

#define PER_THIRD_Q58 960767921L  // 2^58 / (3 N^2), N = 10 000 ticks
#define PER_SIDE_Q58 1664098853L  // 2^58 / (sqrt(3) N^2)

// How long a leg has been high at a tick.
static int32_t passed(const svpwm_pulses_t* p, uint16_t leg, int32_t tick) {
  return q_clamp(tick - p->rise[leg], 0, p->fall[leg] - p->rise[leg]);
}

// Ripple of a leg, of the DC-link voltage and 1/N of a tick: N clamp(t - r, 0, f - r) - (f - r) t.
static int32_t leg_at(const svpwm_pulses_t* p, uint16_t leg, int32_t tick) {
  return passed(p, leg, tick) * (int32_t)SVPWM_PERIOD_TICKS - (p->fall[leg] - p->rise[leg]) * tick;
}

ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, int16_t tick, int32_t link_q16) {
  const abc_t legs = {leg_at(p, 0, tick), leg_at(p, 1, tick), leg_at(p, 2, tick)};
  const int32_t per_third = q_mul_floor(link_q16, PER_THIRD_Q58, 28);
  const int32_t per_side = q_mul_floor(link_q16, PER_SIDE_Q58, 28);
  const ab_t flux = {q_mul_floor(2 * legs.a - legs.b - legs.c, per_third, 30),
                     q_mul_floor(legs.b - legs.c, per_side, 30)};
  return flux;
}

ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16) {
  const int32_t a = p->fall[0] - p->rise[0];
  const int32_t b = p->fall[1] - p->rise[1];
  const int32_t c = p->fall[2] - p->rise[2];
  const int32_t ticks = (int32_t)SVPWM_PERIOD_TICKS;
  const ab_t v = {q_mul_floor((2 * a - b - c) * ticks, q_mul_floor(link_q16, PER_THIRD_Q58, 28), 30),
                  q_mul_floor((b - c) * ticks, q_mul_floor(link_q16, PER_SIDE_Q58, 28), 30)};
  return v;
}

// Three times a leg less the mean of the three; at its own edges the leg has been high for nothing or all of its pulse.
void svpwm_edge_ripple_q20(const svpwm_pulses_t* p, int32_t admittance_q30, int32_t link_q16, svpwm_edges_t* at) {
  static const uint16_t others[SVPWM_LEGS][2] = {{1, 2}, {0, 2}, {0, 1}};
  const int32_t gain_q28 = q_mul_floor(q_mul_floor(link_q16, admittance_q30, 26), PER_THIRD_Q58, 30);
  const int32_t on[SVPWM_LEGS] = {p->fall[0] - p->rise[0], p->fall[1] - p->rise[1], p->fall[2] - p->rise[2]};
  const int32_t sum = on[0] + on[1] + on[2];
  for (uint16_t k = 0; k < SVPWM_LEGS; k++) {
    const uint16_t i = others[k][0];
    const uint16_t j = others[k][1];
    const int32_t need = 3 * on[k] - sum;
    const int32_t rise = -passed(p, i, p->rise[k]) - passed(p, j, p->rise[k]);
    const int32_t fall = 2 * on[k] - passed(p, i, p->fall[k]) - passed(p, j, p->fall[k]);
    at->rise_q20[k] = q_mul_floor(rise * (int32_t)SVPWM_PERIOD_TICKS - need * p->rise[k], gain_q28, 28);
    at->fall_q20[k] = q_mul_floor(fall * (int32_t)SVPWM_PERIOD_TICKS - need * p->fall[k], gain_q28, 28);
  }
}
