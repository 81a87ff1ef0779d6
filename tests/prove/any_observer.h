// A deviation observer of any tuning.

#ifndef STILLSPIN_TESTS_PROVE_ANY_OBSERVER_H
#define STILLSPIN_TESTS_PROVE_ANY_OBSERVER_H

#include "estimators/deviation_observer.h"
#include "tests/prove/any_model.h"

static inline deviation_observer_config_t any_observer(const machine_model_t* m) {
  deviation_observer_config_t c;
  const int32_t noise_q20 = any_from(INT32_MIN, 1048576L);
  const int32_t crawl_bpp = any_from(INT32_MIN, INT32_MAX / 4);
  const deviation_observer_tuning_t t = {noise_q20, any_i32, any_i32, any_i32, crawl_bpp, any_bool()};
  deviation_observer_design(&c, m, &t);
  c.cogging.order = any_from(0, 60);
  c.cogging.bound_q8 = any_from(0, COGGING_BOUND_END_Q8);
  c.zero_vectors_only = any_bool();
  return c;
}

#endif
