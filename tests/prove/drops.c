// Drops and delays of the devices near a current's change of sign, for every band, slice by slice: between the two
// signs nothing is beyond them.

#include "svpwm/dead_time.h"
#include "tests/prove/any.h"
#include "tests/prove/ends.h"

#define SLICES 400L
#define BAND_MIN_Q20 10485L  // 0.01 A
#define BAND_MAX_Q20 (2 * AMPERES_Q20)

static void look(int32_t least_q20, int32_t most_q20) {
  dead_time_config_t c;
  c.turn_on_ticks = (int16_t)any_from(0, 240);
  c.turn_off_ticks = (int16_t)any_from(0, 240);
  c.edge_band_q20 = any_from(0, 4 * AMPERES_Q20);
  c.band_q20 = any_from(least_q20, most_q20);
  c.per_band_q29 = (int32_t)(17592186044416LL / c.band_q20) + any_from(0, 1);  // as dead_time_design has it, rounded
  (void)dead_time_sign_q21(&c, any_i32);
  (void)dead_time_delay_ticks(&c, any_i32);
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
