#include "svpwm/dead_time.h"

#include "hal/qmath/qcall.h"

void dead_time_design(dead_time_config_t* c) {
  c->per_band_q24 = q_div(16777216L, c->band_q20, 20);
  c->doubt_q12 = (uint32_t)(qc_mul(c->edge_band_q20, c->per_band_q24, 32) - 1);
  c->middle_q13 = (c->turn_on_ticks + c->turn_off_ticks) * (int32_t)4096 + 4096;
  c->range_ticks = (int16_t)(c->turn_on_ticks - c->turn_off_ticks);
  c->third_q16 = c->drop_q16 / 3;
  c->side_q16 = qc_mul(c->drop_q16, FRAME_SQRT3_INV_Q30, 30);
}
