#include "svpwm/dead_time.h"

void dead_time_design(dead_time_config_t* c) {
  c->per_band_q29 = q_div(32768L, c->band_q20, 29);
  c->third_drop_q27 = q_div(c->drop_q16, 3, 11);
  c->side_drop_q27 = q_mul(c->drop_q16, FRAME_SQRT3_INV_Q30, 19);
  c->certain_q20 = q_max(c->band_q20, c->edge_band_q20);
}
