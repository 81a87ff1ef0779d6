// Drops of the devices near a current's change of sign, for every band, slice by slice: none is more than the whole.

#include "svpwm/dead_time.h"
#include "tests/prove/any.h"
#include "tests/prove/ends.h"

#define SLICES 400L
#define BAND_MIN_Q20 10485L  // 0.01 A
#define BAND_MAX_Q20 (2 * AMPERES_Q20)

static ab_t any_current(void) {
  const ab_t v = {any_from(-CARRIED_MAX_Q20, CARRIED_MAX_Q20), any_from(-CARRIED_MAX_Q20, CARRIED_MAX_Q20)};
  return v;
}

// As dead_time_design has it, rounded.
static void look(int32_t least_q20, int32_t most_q20) {
  dead_time_config_t c;
  c.band_q20 = any_from(least_q20, most_q20);
  const int32_t drop_q16 = any_from(0, 5 * VOLTS_Q16);
  const int32_t per_amp_q21 = (int32_t)((int64_t)drop_q16 * 33554432LL / c.band_q20) + any_from(0, 2);
  c.third_per_amp_q21 = per_amp_q21 / 3;
  c.side_per_amp_q21 = q_mul(per_amp_q21, FRAME_SQRT3_INV_Q30, 30);
  (void)dead_time_drop_q16(&c, any_current());
}

// Each slice is a fiftieth longer than the one before.
void prove_drops(void) {
  int32_t least_q20 = BAND_MIN_Q20;
  //@ loop unroll SLICES;
  while (least_q20 < BAND_MAX_Q20) {
    const int32_t most_q20 = least_q20 + least_q20 / 50;
    look(least_q20, most_q20);
    least_q20 = most_q20;
  }
}
