#include "svpwm/ripple.h"

#define TICKS_Q4_PER_PERIOD_Q30 1717987L  // 16 / 10000

// Ripple of one leg in ticks of full DC-link voltage, Q4.
static int32_t leg_ripple_q4(const svpwm_pulses_t* p, uint16_t leg, int16_t tick) {
  const int32_t on = p->fall[leg] - p->rise[leg];
  const int32_t passed = q_clamp(tick - p->rise[leg], 0, on);
  return passed * 16 - q_mul(on * (int32_t)tick, TICKS_Q4_PER_PERIOD_Q30, 30);
}

ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, int16_t tick, int32_t link_q16) {
  const abc_t legs_q4 = {leg_ripple_q4(p, 0, tick), leg_ripple_q4(p, 1, tick), leg_ripple_q4(p, 2, tick)};
  const ab_t ticks_q4 = frame_clarke3(legs_q4);
  // link (Q16) * ticks (Q4) / N: with 1/N as Q30 the product is Q50.
  const int32_t link_per_tick_q24 = q_mul(link_q16, 27487791L, 30);  // * 2^8 / 10000
  const ab_t flux = {q_mul(ticks_q4.alpha, link_per_tick_q24, 12), q_mul(ticks_q4.beta, link_per_tick_q24, 12)};
  return flux;
}
