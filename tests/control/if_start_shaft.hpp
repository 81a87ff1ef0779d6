// A shaft in double precision behind a current vector, and the usual I-F start.

#ifndef STILLSPIN_TESTS_CONTROL_IF_START_SHAFT_HPP
#define STILLSPIN_TESTS_CONTROL_IF_START_SHAFT_HPP

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/if_start.h"
}

namespace stillspin::test {

/// 8 A, 100 ms at rest, 500 rpm/s up to 300 rpm, 2 s of patience.
inline if_start_config_t usual() {
  return {raw(8.0, 20), 1000, bpp(500.0 / 60.0 * kTurn * 4.0) / 10000, bpp(125.7), 20000, 0, 0, 0, 0, 0, 0, 0};
}

inline if_start_config_t designed(const Motor& m, if_start_config_t c) {
  const machine_model_t model = model_of(m);
  EXPECT_TRUE(if_start_design(&c, &model));
  return c;
}

struct Shaft {
  Motor m = motor_b();
  double angle = 0.0, speed = 0.0, load = 0.0;  // electrical; the load against the motion, N m
  double pull = 0.0;                            // a load that pulls one way, N m

  /// Voltage in the vector's frame, V.
  Vector step(double frame, double current) {
    const double lag = frame - angle;
    const double torque =
        1.5 * m.pole_pairs * (m.flux + (m.ld - m.lq) * current * std::cos(lag)) * current * std::sin(lag);
    const double against = std::clamp(speed, -1.0, 1.0) * load + pull;
    const double accel = (torque - against - m.friction * speed / m.pole_pairs) * m.pole_pairs / m.inertia;
    speed += accel * kPeriod;
    angle += speed * kPeriod;
    return {m.rs * current + speed * m.flux * std::sin(lag), speed * (m.flux * std::cos(lag) + m.ld * current)};
  }
};

}  // namespace stillspin::test

#endif
