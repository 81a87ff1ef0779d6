// The machine in double precision, in the stationary frame, and the windows that an inverter would let one see of it:
//   L(theta) di/dt = v - R i - w L'(theta) i - w lambda q(theta)      (docs, "Physics", section 1)
// Written from that equation alone, with none of the firmware's rotor-frame constants.

#ifndef STILLSPIN_TESTS_ESTIMATORS_MACHINE_HPP
#define STILLSPIN_TESTS_ESTIMATORS_MACHINE_HPP

#include <gtest/gtest.h>

#include <vector>

#include "tests/control/quantities.hpp"

extern "C" {
#include "estimators/deviation.h"
}

namespace stillspin::test {

inline constexpr double kLinkVolts = 300.0;

/// di/dt in the stationary frame, A/s.
inline Vector slope_of(const Motor& m, double theta, double w, Vector i, Vector v) {
  const double mean = 0.5 * (m.ld + m.lq);
  const double half = 0.5 * (m.ld - m.lq);
  const double c = std::cos(2.0 * theta), s = std::sin(2.0 * theta);
  const auto mirror = [&](Vector x) { return Vector{c * x.x + s * x.y, s * x.x - c * x.y}; };        // S(2 theta)
  const auto mirror_rate = [&](Vector x) { return Vector{-s * x.x + c * x.y, c * x.x + s * x.y}; };  // dS / d(2 theta)
  const Vector turn = mirror_rate(i) * (w * 2.0 * half);
  const Vector emf = Vector{-std::sin(theta), std::cos(theta)} * (w * m.flux);
  const Vector u = v - i * m.rs - turn - emf;
  const double det = mean * mean - half * half;
  return (u * mean - mirror(u) * half) * (1.0 / det);  // L^-1 = (mean I - half S) / det
}

/// Voltage of a switching state, bit k: leg k high.
inline Vector state_voltage(unsigned state, double link = kLinkVolts) {
  const double a = state & 1u, b = (state >> 1) & 1u, c = (state >> 2) & 1u;
  return {(2.0 * a - b - c) / 3.0 * link, (b - c) / std::sqrt(3.0) * link};
}

struct Window {
  unsigned state;
  int middle;  // tick
  int span;    // ticks
};

/// What the drive sees of a window: theta is the angle at the end of the period that the window lies in.
inline estimator_window_t observed(const Motor& m, const Window& w, double theta, double speed, Vector current,
                                   Vector slope_noise = {0.0, 0.0}) {
  const double at = theta - speed * m.period * (1.0 - w.middle / 10000.0);
  const Vector v = state_voltage(w.state);
  estimator_window_t e = {};
  e.change_q19 = raw_change(slope_of(m, at, speed, current, v) * m.period + slope_noise, w.span);
  e.current_q20 = raw_ab(current, 20);
  e.voltage_q19 = raw_ab(v, 19);
  e.middle_tick = static_cast<std::int16_t>(w.middle);
  e.span_ticks = static_cast<std::int16_t>(w.span);
  e.zero_vector = w.state == 0 || w.state == 7;
  return e;
}

inline estimator_input_t input_of(const machine_model_t& m, const std::vector<estimator_window_t>& windows,
                                  std::int32_t torque_accel_q8 = 0) {
  return {
      &m, windows.data(), static_cast<std::uint16_t>(windows.size()), torque_accel_q8, true, true, true, false, nullptr,
      0};
}

/// Electrical acceleration, rad/s^2, as the estimators have it: binary angle per period^2, Q8.
inline std::int32_t accel_q8(double rad_per_s2) { return raw(rad_per_s2 * kPeriod * kPeriod / kTurn, 40); }
inline double accel_of(std::int32_t q8) { return real(q8, 40) * kTurn / (kPeriod * kPeriod); }

/// The windows of the alternating layout in period n: one leg high, then the other two, going round.
inline std::vector<Window> alternating_windows(int n, int span = 3000) {
  const unsigned single = 1u << (n % 3);
  const bool pair_first = (n / 3) % 2 != 0;
  return {{pair_first ? 7u ^ single : single, 2900, span}, {pair_first ? single : 7u ^ single, 7600, span}};
}

}  // namespace stillspin::test

#endif
