// From a voltage vector to the on-times of the three legs, up to a common part that the layout chooses.

#ifndef STILLSPIN_SVPWM_ON_TIME_H
#define STILLSPIN_SVPWM_ON_TIME_H

#include "svpwm/pattern.h"

// Shortest pulse and shortest gap: with less, the dead band would swallow the edge.
#define SVPWM_PULSE_MIN_TICKS 300
// Largest difference of two on-times that leaves both; rounding the legs may add one tick to it.
#define SVPWM_SPREAD_MAX_TICKS (SVPWM_ROOM_TICKS - SVPWM_PULSE_MIN_TICKS - 1)

typedef struct {
  // On-times minus the common part, ticks, each rounded so that differences are exact to a tick.
  int16_t leg[SVPWM_LEGS];
  uint16_t hi, mid, lo;  // legs by their on-times, longest first
  ab_t realised_q16;     // the voltage vector that these on-times give, V
  bool limited;          // the command was longer than what fits and has been shortened in its direction
} svpwm_on_time_t;

#define SVPWM_LINK_MIN_Q16 655360L                // 10 V
#define SVPWM_TICKS_PER_VOLT_MAX_Q20 1073741824L  // 1024
#define SVPWM_PERIOD_Q9 5120000L                  // ticks
#define SVPWM_PER_PERIOD_Q23 839L

/// Ticks per volt of a link that nothing is known of.
int32_t svpwm_ticks_per_volt_anew_q20(int32_t volts_q16);

/// Shortens what does not fit: of the legs' voltages. Returns the ticks per volt with which it does.
int32_t svpwm_shorten_q20(svpwm_on_time_t* t, abc_t legs_q16, int32_t ticks_per_volt_q20);

/// Ticks per volt, Q20, of a DC-link voltage in V, 10 V to 2000 V (less is taken as 10 V). `last` is the one of the
/// last period, or 0: where the link has moved by less than 0.4 %, one step of Newton's method makes the new one of it,
/// to 2e-5.
static inline int32_t svpwm_ticks_per_volt_q20(int32_t link_q16, int32_t last_q20) {
  const int32_t volts_q16 = q_max(link_q16, SVPWM_LINK_MIN_Q16);
  // A half for what the upper word has lost.
  const int32_t off_q9 = SVPWM_PERIOD_Q9 - 1 - 2 * q_mul_hi(volts_q16 * 16, last_q20);
  if (off_q9 < -SVPWM_PERIOD_Q9 / 256 || off_q9 > SVPWM_PERIOD_Q9 / 256) {
    return svpwm_ticks_per_volt_anew_q20(volts_q16);
  }
  return q_limit(last_q20 + q_mul_hi(last_q20, off_q9 * SVPWM_PER_PERIOD_Q23), SVPWM_TICKS_PER_VOLT_MAX_Q20);
}

/// Puts the on-times of the legs' voltages, rounded (an upper word is Q4), and which leg has how much: between equal
/// ones the first is the longer. Returns the largest difference, ticks.
static inline int32_t svpwm_put_on_times(svpwm_on_time_t* t, abc_t legs_q16, int32_t ticks_per_volt_q20) {
  const int32_t a = q_shr(q_mul_hi(legs_q16.a, ticks_per_volt_q20) + 8, 4);
  const int32_t b = q_shr(q_mul_hi(legs_q16.b, ticks_per_volt_q20) + 8, 4);
  const int32_t c = q_shr(q_mul_hi(legs_q16.c, ticks_per_volt_q20) + 8, 4);
  t->leg[0] = (int16_t)a;
  t->leg[1] = (int16_t)b;
  t->leg[2] = (int16_t)c;
  const bool b_first = b > a;
  int32_t most = b_first ? b : a;
  int32_t least = b_first ? a : b;
  t->hi = b_first ? 1 : 0;
  t->lo = b_first ? 0 : 1;
  if (c > most) {
    most = c;
    t->hi = 2;
  }
  if (c <= least) {
    least = c;
    t->lo = 2;
  }
  t->mid = (uint16_t)(3u - t->hi - t->lo);
  return most - least;
}

/// voltage_q16: wanted vector, V. Inline, as the modulator alone calls it.
static inline svpwm_on_time_t svpwm_on_time(ab_t voltage_q16, int32_t ticks_per_volt_q20) {
  svpwm_on_time_t t;
  const abc_t legs_q16 = frame_inverse_clarke(voltage_q16);
  t.realised_q16 = voltage_q16;
  t.limited = false;
  while (svpwm_put_on_times(&t, legs_q16, ticks_per_volt_q20) > SVPWM_SPREAD_MAX_TICKS && !t.limited) {
    ticks_per_volt_q20 = svpwm_shorten_q20(&t, legs_q16, ticks_per_volt_q20);
  }
  return t;
}

#endif
