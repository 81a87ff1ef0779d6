#include "svpwm/dead_time.h"

// Delay of an edge, ticks; the current is positive where it blocks the edge.
static int32_t delay_ticks(const dead_time_config_t* c, int32_t blocking_q20) {
  if (blocking_q20 >= c->band_q20) return c->blocked_ticks;
  if (blocking_q20 <= -c->band_q20) return c->released_ticks;
  const int32_t middle = c->blocked_ticks + c->released_ticks;
  const int32_t half_range = c->blocked_ticks - c->released_ticks;
  return q_shr(middle * (int32_t)32768 + half_range * q_mul_floor(blocking_q20, c->per_band_q29, 29) + 32768L, 16);
}

void dead_time_design(dead_time_config_t* c) {
  c->per_band_q29 = q_div(32768L, c->band_q20, 29);
  c->third_drop_q24 = q_div(c->drop_q16, 3, 8);
  c->side_drop_q24 = q_mul(c->drop_q16, FRAME_SQRT3_INV_Q30, 22);
  c->certain_q20 = q_max(c->band_q20, c->edge_band_q20);
}

int32_t dead_time_send_in_doubt(const dead_time_config_t* c, const svpwm_ripple_edge_t* e, svpwm_arrival_t* arrival) {
  const int32_t sent = e->tick - delay_ticks(c, e->blocking_q20);
  if (e->blocking_q20 < c->edge_band_q20 && e->blocking_q20 > -c->edge_band_q20) {
    arrival->earliest = sent + c->released_ticks;
    arrival->latest = sent + c->blocked_ticks;
  }
  return sent;
}
