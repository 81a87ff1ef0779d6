// A machine with any parameters that the model takes, at any operating point.

#ifndef STILLSPIN_TESTS_PROVE_ANY_MACHINE_H
#define STILLSPIN_TESTS_PROVE_ANY_MACHINE_H

#include "control/machine_model.h"
#include "tests/prove/any.h"
#include "tests/prove/ends.h"

static inline dq_t any_dq(int32_t most) {
  const dq_t v = {any_from(-most, most), any_from(-most, most)};
  return v;
}

static inline ab_t any_ab(int32_t most) {
  const ab_t v = {any_from(-most, most), any_from(-most, most)};
  return v;
}

static inline int32_t any_speed(void) { return any_from(-SPEED_MAX_BPP, SPEED_MAX_BPP); }

static inline bool make_any_machine(machine_model_t* m) {
  const machine_parameters_t p = {any_from(16777L, RS_NOMINAL_MAX_Q24),
                                  any_from(35792L, 536870912L),
                                  any_from(35792L, 536870912L),
                                  any_from(268435L, 268435456L),
                                  any_from(168L, 16777216L),
                                  any_from(1, 30),
                                  any_from(20, 500)};
  machine_map_parameters_t map;
  map.current_q20 = any_i32;
  for (uint16_t k = 0; k < MACHINE_MAP_POINTS; k++) {
    map.ldd_q30[k] = any_from(1, 536870912L);
    map.lqq_q30[k] = any_from(1, 536870912L);
    map.ldq_q30[k] = any_from(-536870912L, 536870912L);
  }
  return machine_model_init(m, &p) && machine_model_saturate(m, &map);
}

#endif
