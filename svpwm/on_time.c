#include "svpwm/on_time.h"

#define LINK_MIN_Q16 655360L  // 10 V
#define MOST_Q20 1073741824L  // ticks per volt: 1024
#define PERIOD_Q12 40960000L  // ticks
#define ONE_Q30 1073741824L
#define PER_PERIOD_Q44 1759218604L

static int32_t largest(abc_t x) { return q_max(x.a, q_max(x.b, x.c)); }
static int32_t smallest(abc_t x) { return q_min(x.a, q_min(x.b, x.c)); }

static void sort_legs(svpwm_on_time_t* t) {
  const bool b_first = t->leg[1] > t->leg[0];
  const uint16_t longer = b_first ? 1 : 0;
  const uint16_t shorter = b_first ? 0 : 1;
  const bool c_first = t->leg[2] > t->leg[longer];
  const bool c_last = t->leg[2] <= t->leg[shorter];
  t->hi = c_first ? 2 : longer;
  t->lo = c_last ? 2 : shorter;
  t->mid = (uint16_t)(3u - t->hi - t->lo);
}

int32_t svpwm_ticks_per_volt_q20(int32_t link_q16, int32_t last_q20) {
  const int32_t volts_q16 = q_max(link_q16, LINK_MIN_Q16);
  const int32_t off_q12 = q_sat64(PERIOD_Q12 - q_shr64(q_product(volts_q16, last_q20), 24));
  if (!q_in_range(off_q12, -PERIOD_Q12 / 256, PERIOD_Q12 / 256))
    return q_limit(q_over(SVPWM_PERIOD_TICKS, q_invert(volts_q16), 36), MOST_Q20);
  return q_limit(last_q20 + q_mul_floor(last_q20, q_mul_floor(off_q12, PER_PERIOD_Q44, 25), 31), MOST_Q20);
}

// Rounded: an upper word is Q4.
static int16_t ticks_of(int32_t voltage_q16, int32_t ticks_per_volt_q20) {
  return (int16_t)q_shr(q_mul_hi(voltage_q16, ticks_per_volt_q20) + 8, 4);
}

svpwm_on_time_t svpwm_on_time(ab_t voltage_q16, int32_t ticks_per_volt_q20) {
  svpwm_on_time_t t;
  abc_t v = frame_inverse_clarke(voltage_q16);
  t.realised_q16 = voltage_q16;
  const int32_t spread_q4 = q_mul_hi(largest(v) - smallest(v), ticks_per_volt_q20);
  t.limited = spread_q4 > SVPWM_SPREAD_MAX_TICKS * 16L;
  if (t.limited) {
    const int32_t share_q30 = q_min(q_over(SVPWM_SPREAD_MAX_TICKS * 16L, q_invert(spread_q4), 30), ONE_Q30);
    t.realised_q16.alpha = q_mul(voltage_q16.alpha, share_q30, 30);
    t.realised_q16.beta = q_mul(voltage_q16.beta, share_q30, 30);
    v = frame_inverse_clarke(t.realised_q16);
  }
  t.leg[0] = ticks_of(v.a, ticks_per_volt_q20);
  t.leg[1] = ticks_of(v.b, ticks_per_volt_q20);
  t.leg[2] = ticks_of(v.c, ticks_per_volt_q20);
  sort_legs(&t);
  return t;
}
