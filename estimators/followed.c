#include "estimators/followed.h"

#include "hal/qmath/qmath.h"

void followed_step(followed_t* f, int16_t tick, int16_t length, int32_t reference_q20, int32_t flows_q20) {
  const int16_t quarter = length / 4;
  if (tick < length - quarter) {
    f->error_q20 = 0;
    return;
  }
  f->error_q20 = q_add_sat(f->error_q20, q_abs_sat(q_sub_sat(reference_q20, flows_q20)) / quarter);
  f->worst_q20 = q_max(f->worst_q20, f->error_q20);
}

bool followed_well(const followed_t* f, int32_t amplitude_q20) { return f->worst_q20 <= amplitude_q20 / 8 * 3; }
