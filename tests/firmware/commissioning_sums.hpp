// Sums as a commissioning's interrupts would have made them of a machine with known values.

#ifndef STILLSPIN_TESTS_FIRMWARE_COMMISSIONING_SUMS_HPP
#define STILLSPIN_TESTS_FIRMWARE_COMMISSIONING_SUMS_HPP

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/quantities.hpp"

extern "C" {
#include "firmware/commissioning/solve.h"
}

namespace stillspin::test {

/// Motor A with the devices' resistance, as the drive's defaults have it.
inline machine_model_t nameplate() {
  Motor motor;
  motor.rs = 0.355;
  return model_of(motor);
}

/// Incremental inductances, H, seen in a frame that lies `frame` radians ahead of the rotor.
struct Inductances {
  double dd, qq, dq;
};

/// Adds pairs of opposite windows, 200 V along the three phases in turn, with the sensors' mismatch g as slopes see it.
inline void add_pairs(tensor_sums_t* s, const machine_model_t& m, const Inductances& l, double frame, double across,
                      int count) {
  const double det = l.dd * l.qq - l.dq * l.dq;
  const double y_dd = kPeriod * l.qq / det, y_qq = kPeriod * l.dd / det, y_dq = -kPeriod * l.dq / det;
  const double c = std::cos(frame), sn = std::sin(frame);
  for (int k = 0; k < count; ++k) {
    const double angle = k * 2.0 * kPi / 3.0 + 0.3;
    const double v_d = 200.0 * std::cos(angle), v_q = 200.0 * std::sin(angle);
    // into the rotor's frame, the machine, and back
    const double r_d = c * v_d - sn * v_q, r_q = sn * v_d + c * v_q;
    const double i_d = y_dd * r_d + y_dq * r_q, i_q = y_dq * r_d + y_qq * r_q;
    const double s_d = c * i_d + sn * i_q - across * v_q, s_q = -sn * i_d + c * i_q + across * v_d;
    deviation_t w[2] = {};
    for (int n = 0; n < 2; ++n) {
      const double sign = n == 0 ? 1.0 : -1.0;
      w[n].voltage_q16 = {raw(sign * v_d, 16), raw(sign * v_q, 16)};
      w[n].residual_q20 = {raw(sign * (s_d - real(m.yd_q30, 30) * v_d), 20),
                           raw(sign * (s_q - real(m.yq_q30, 30) * v_q), 20)};
    }
    tensor_add(s, &w[0], &w[1]);
  }
}

/// A staircase of 5.6 A to 14 A both ways on such a machine; errors of drop and edges in V.
inline staircase_t climbed(const machine_model_t& m, double resistance, double drop_error, double edge_error) {
  staircase_t s{};
  for (int k = 0; k < 14; ++k) {
    const double sign = k < 7 ? 1.0 : -1.0, f = sign * 4.0 / 3.0;
    const double i = sign * (5.6 + 1.4 * (k % 7));
    staircase_level_t& l = s.level[k];
    l.periods = 4200;
    l.windows = 8400;
    l.current = 4200LL * raw(i, 20);
    l.factor = 4200LL * raw(f, 20);
    l.command = 4200LL * raw(resistance * i + (drop_error + edge_error) * f, 20);
    const double missing = (resistance - real(m.rs_q24, 24)) * i + drop_error * f;
    l.residual = 8400LL * raw(-missing * real(m.yd_q30, 30), 20);
    l.link_q16 = raw(300.0, 16);
  }
  return s;
}

/// Sums of a spin of a machine with these values, between two speeds in rad/s (mechanical).
inline spin_t spun(double flux, double inertia, double friction, double resistance, int pairs = 4) {
  const double bpp = 4294967296.0 * kPeriod * pairs / (2.0 * kPi);  // per rad/s mechanical
  const double kt = 1.5 * pairs * flux, offset = 0.3;
  const double speed[3] = {20.0, 60.0, 20.0};
  spin_t s{};
  for (int k = 0; k < 3; ++k) {
    const double current = friction * speed[k] / kt;
    s.station[k].periods = s.station[k].torque_periods = 5000;
    s.station[k].speed = 5000LL * std::llround(speed[k] * bpp);
    s.station[k].current_q = 5000LL * raw(current, 20);
    s.station[k].voltage_q = 5000LL * raw(flux * pairs * speed[k] + resistance * current + offset, 16);
  }
  for (int k = 0; k < 2; ++k) {
    const double change = speed[k + 1] - speed[k];
    const double current = (inertia * change / (5000 * kPeriod) + friction * 40.0) / kt;
    s.ramp[k].periods = s.ramp[k].torque_periods = 5000;
    s.ramp[k].speed = 5000LL * std::llround(40.0 * bpp);
    s.ramp[k].current_q = 5000LL * raw(current, 20);
  }
  return s;
}

}  // namespace stillspin::test

#endif
