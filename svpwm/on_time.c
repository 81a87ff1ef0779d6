#include "svpwm/on_time.h"

#include "hal/qmath/qcall.h"

#define ONE_Q30 1073741824L

int32_t svpwm_ticks_per_volt_anew_q20(int32_t volts_q16) {
  return q_limit(qc_over(SVPWM_PERIOD_TICKS, q_invert(volts_q16), 36), SVPWM_TICKS_PER_VOLT_MAX_Q20);
}

int32_t svpwm_shorten_q20(svpwm_on_time_t* t, abc_t legs_q16, int32_t ticks_per_volt_q20) {
  const int32_t most_q16 = q_max(legs_q16.a, q_max(legs_q16.b, legs_q16.c));
  const int32_t least_q16 = q_min(legs_q16.a, q_min(legs_q16.b, legs_q16.c));
  const int32_t spread_q4 = q_mul_hi(most_q16 - least_q16, ticks_per_volt_q20);
  const int32_t share_q30 = q_min(qc_over(SVPWM_SPREAD_MAX_TICKS * 16L, q_invert(spread_q4), 30), ONE_Q30);
  t->realised_q16.alpha = q_mul(t->realised_q16.alpha, share_q30, 30);
  t->realised_q16.beta = q_mul(t->realised_q16.beta, share_q30, 30);
  t->limited = true;
  return q_mul_floor(ticks_per_volt_q20, share_q30, 30);
}
