// The deviation observer as a plain Kalman filter: nothing quiet, no step looked out for, no cogging.

#ifndef STILLSPIN_TESTS_ESTIMATORS_OBSERVER_HPP
#define STILLSPIN_TESTS_ESTIMATORS_OBSERVER_HPP

#include <cstdint>

extern "C" {
#include "estimators/deviation_observer.h"
}

namespace stillspin::test {

inline void design_plain(deviation_observer_config_t* c, const machine_model_t* m, std::int32_t noise_q20,
                         std::int32_t load_rate_q20) {
  const deviation_observer_tuning_t tuning = {noise_q20, load_rate_q20, load_rate_q20, 0, 1, false};
  deviation_observer_design(c, m, &tuning);
  c->cogging = {0, 1, 0};
}

}  // namespace stillspin::test

#endif
