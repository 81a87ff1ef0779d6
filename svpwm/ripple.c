#include "svpwm/ripple.h"

#define LEG_SHIFT 1u  // a sum of four legs stays in 31 bits

// What of a pulse has passed at a tick.
static inline int32_t passed(int32_t tick, int32_t rise, int32_t on) { return q_min(q_max(tick - rise, 0), on); }

// Ripple of a leg, of the DC-link voltage and 1/N of a tick: the sum of N clamp(t - r, 0, f - r) - (f - r) t. Nothing
// has passed at tick 0: it stands for one that is not asked for.
static inline int32_t leg_at(const svpwm_pulses_t* p, uint16_t leg, const int32_t ticks[3]) {
  const int32_t rise = p->at[leg];
  const int32_t on = svpwm_on_ticks(p, leg);
  const int32_t high = passed(ticks[0], rise, on) + passed(ticks[1], rise, on) + passed(ticks[2], rise, on);
  return q_shr(high * (int32_t)SVPWM_PERIOD_TICKS - on * (ticks[0] + ticks[1] + ticks[2]), LEG_SHIFT);
}

ab_t svpwm_ripple_q16(const svpwm_pulses_t* p, const int16_t ticks[], uint16_t count, int32_t link_q16) {
  const int32_t asked[3] = {(count > 0u) ? ticks[0] : 0, (count > 1u) ? ticks[1] : 0, (count > 2u) ? ticks[2] : 0};
  const abc_t legs = {leg_at(p, 0, asked), leg_at(p, 1, asked), leg_at(p, 2, asked)};
  const int32_t third_q32 = 2 * q_mul_hi(link_q16 * 16, 2 * SVPWM_PER_THIRD_Q58);  // of a unit of a leg
  const int32_t side_q31 = 2 * q_mul_hi(link_q16 * 16, SVPWM_PER_SIDE_Q58);
  const ab_t flux = {2 * q_mul_hi(2 * legs.a - legs.b - legs.c, third_q32),
                     2 * q_mul_hi(2 * (legs.b - legs.c), side_q31)};
  return flux;
}
