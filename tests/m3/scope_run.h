// What the scope records in the run that shows its cost: the signals that take longest, and a trigger that never comes.

#ifndef STILLSPIN_TESTS_M3_SCOPE_RUN_H
#define STILLSPIN_TESTS_M3_SCOPE_RUN_H

#include "firmware/scope/scope.h"

enum {
#define SIGNAL(name, unit, q, of, value, meaning) SIGNAL_##name,
#include "firmware/dictionary/all_signals.h"
#undef SIGNAL
};

static inline void scope_run_begin(void) {
  static const scope_setup_t all = {
      1,
      SCOPE_DEPTH / 2u,
      SCOPE_SINGLE,
      SCOPE_RISING,
      SIGNAL_speed,
      SCOPE_CHANNELS,
      INT32_MAX,
      SCOPE_BY_SPAN,
      {{SIGNAL_speed, 8}, {SIGNAL_load_torque, 8}, {SIGNAL_current_a, 8}, {SIGNAL_current_b, 8}}};
  (void)scope_setup(&all);
  (void)scope_arm();
}

#endif
