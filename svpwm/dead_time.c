#include "svpwm/dead_time.h"

// Sign of a current as -1..1, Q15, linear inside the band.
static int32_t sign_q15(const dead_time_config_t* c, int32_t current_q20) {
  if (current_q20 >= c->band_q20) return 32767L;
  if (current_q20 <= -c->band_q20) return -32767L;
  return q_mul_floor(current_q20, c->per_band_q29, 29);
}

// Delay of an edge, ticks; the sign is positive where the current blocks the edge: a rising one with i > 0.
static int16_t delay_ticks(const dead_time_config_t* c, int32_t blocking_q15) {
  const int32_t middle = c->blocked_ticks + c->released_ticks;
  const int32_t half_range = c->blocked_ticks - c->released_ticks;
  return (int16_t)q_shr_round(middle * (int32_t)32768 + half_range * blocking_q15, 16);
}

void dead_time_design(dead_time_config_t* c) {
  c->per_band_q29 = q_div(32768L, c->band_q20, 29);
  c->third_drop_q24 = q_div(c->drop_q16, 3, 8);
  c->side_drop_q24 = q_mul(c->drop_q16, FRAME_SQRT3_INV_Q30, 22);
  c->blocked_delay_ticks = delay_ticks(c, 32767L);
  c->released_delay_ticks = delay_ticks(c, -32767L);
  c->certain_q20 = q_max(c->band_q20, c->edge_band_q20);
}

int32_t dead_time_send_in_doubt(const dead_time_config_t* c, const svpwm_ripple_edge_t* e, int32_t current_q20,
                                svpwm_arrival_t* arrival) {
  const int32_t sign = sign_q15(c, current_q20);
  const int32_t sent = e->tick - delay_ticks(c, e->falls ? -sign : sign);
  if (q_abs_sat(current_q20) < c->edge_band_q20) {
    arrival->earliest = sent + c->released_ticks;
    arrival->latest = sent + c->blocked_ticks;
  }
  return sent;
}

ab_t dead_time_drop_q16(const dead_time_config_t* c, ab_t current_q20) {
  const abc_t i = frame_inverse_clarke(current_q20);
  const int32_t a = sign_q15(c, i.a);
  const int32_t b = sign_q15(c, i.b);
  const int32_t s = sign_q15(c, i.c);
  const ab_t drop = {q_mul_floor(2 * a - b - s, c->third_drop_q24, 23), q_mul_floor(b - s, c->side_drop_q24, 23)};
  return drop;
}
