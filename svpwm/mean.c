#include "svpwm/ripple.h"

ab_t svpwm_mean_q16(const svpwm_pulses_t* p, int32_t link_q16) {
  const int32_t a = svpwm_on_ticks(p, 0);
  const int32_t b = svpwm_on_ticks(p, 1);
  const int32_t c = svpwm_on_ticks(p, 2);
  const int32_t ticks = (int32_t)SVPWM_PERIOD_TICKS;
  const ab_t v = {q_mul_floor((2 * a - b - c) * ticks, q_mul_floor(link_q16, SVPWM_PER_THIRD_Q58, 28), 30),
                  q_mul_floor((b - c) * ticks, q_mul_floor(link_q16, SVPWM_PER_SIDE_Q58, 28), 30)};
  return v;
}
