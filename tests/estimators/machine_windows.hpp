// Windows of a machine in double precision, for the estimators to look at.
//
// The machine is the stationary-frame equation of docs/physics.md, section 1: L(theta) di/dt = v - R i - w L'(theta) i
// - w lambda q. It has no rotor-frame formula in it, so it shares none with the code under test.

#ifndef STILLSPIN_TESTS_ESTIMATORS_MACHINE_WINDOWS_HPP
#define STILLSPIN_TESTS_ESTIMATORS_MACHINE_WINDOWS_HPP

#include <algorithm>
#include <vector>

#include "tests/control/quantities.hpp"

extern "C" {
#include "estimators/deviation.h"
}

// A namespace of its own: machine.hpp has windows of another make.
namespace stillspin::test::seen {

inline constexpr double kLink = 300.0;  // DC link, V

/// di/dt, A/s; theta and w are the true electrical angle and speed at that instant.
inline Vector current_derivative(const Motor& m, double theta, double w, Vector i, Vector v) {
  const double half = 0.5 * (m.ld - m.lq);
  const double mean = 0.5 * (m.ld + m.lq);
  const double c = std::cos(2.0 * theta), s = std::sin(2.0 * theta);
  // L' = d/dtheta of half S(2 theta)
  const Vector turn = Vector{-s * i.x + c * i.y, c * i.x + s * i.y} * (2.0 * half * w);
  const Vector emf = Vector{-std::sin(theta), std::cos(theta)} * (w * m.flux);
  const Vector u = v - i * m.rs - turn - emf;
  // inverse of the symmetric [laa, lab; lab, lbb]
  const double laa = mean + half * c, lbb = mean - half * c, lab = half * s;
  const double det = laa * lbb - lab * lab;
  return {(lbb * u.x - lab * u.y) / det, (laa * u.y - lab * u.x) / det};
}

/// Vector of a switching state, bit k: leg k high.
inline Vector state_vector(int state, double link = kLink) {
  const double a = state & 1, b = (state >> 1) & 1, c = (state >> 2) & 1;
  return {link * (2.0 * a - b - c) / 3.0, link * (b - c) / std::sqrt(3.0)};
}

/// A window as physics has it, before it is written in the firmware's numbers.
struct Window {
  Vector slope{0, 0};  // A per period
  Vector current{0, 0};
  Vector voltage{0, 0};
  int middle = 5000;
  int span = 2800;

  estimator_window_t raw() const {
    estimator_window_t w;
    w.change_q19 = raw_change(slope, span);
    w.current_q20 = raw_ab(current, 20);
    w.voltage_q19 = raw_ab(voltage, 19);
    w.middle_tick = static_cast<std::int16_t>(middle);
    w.span_ticks = static_cast<std::int16_t>(span);
    w.zero_vector = voltage.length() < 1.0;
    return w;
  }
};

/// Rotor angle in the middle of a window; theta is that at the end of the period in which the window lies.
inline double angle_at(double theta, double w, int middle) { return theta - w * (10000 - middle) * 1e-8; }

inline Window window_at(const Motor& m, double theta, double w, Vector i, Vector v, int middle, int span) {
  Window x;
  x.slope = current_derivative(m, angle_at(theta, w, middle), w, i, v) * m.period;
  x.current = i;
  x.voltage = v;
  x.middle = middle;
  x.span = span;
  return x;
}

/// What the model's saliency makes of a voltage.
inline dq_t mirrored(const machine_model_t& m, dq_t v_q16) {
  return deviation_mirrored_q15((m.yd_q30 - m.yq_q30) / 2, m.ydq_q30, {v_q16.d * 2, v_q16.q * 2});
}

/// The period's windows of the alternating layout: +x and -x, x going round the phases, the order changing.
inline std::vector<Window> alternating(const Motor& m, int period, double theta, double w, Vector i) {
  static constexpr int kLegs[] = {1, 2, 4};
  const int leg = kLegs[period % 3];
  const bool pair_first = (period / 3) % 2 == 1;
  const int first = pair_first ? 7 - leg : leg;
  return {window_at(m, theta, w, i, state_vector(first), 2700, 2800),
          window_at(m, theta, w, i, state_vector(7 - first), 7300, 2800)};
}

/// Keeps the raw windows alive for as long as the estimator is asked.
class Input {
 public:
  Input(const machine_model_t& model, const std::vector<Window>& windows, std::int32_t torque_accel_q8 = 0) {
    for (const Window& w : windows) raw_.push_back(w.raw());
    in_ = {
        &model, raw_.data(), static_cast<std::uint16_t>(raw_.size()), torque_accel_q8, true, true, true, false, nullptr,
        0};
  }
  Input(const Input&) = delete;
  const estimator_input_t* get() const { return &in_; }

 private:
  std::vector<estimator_window_t> raw_;
  estimator_input_t in_{};
};

/// Acceleration, rad per period^2, in the firmware's number.
inline std::int32_t accel_q8(double rad_per_period2) { return raw(rad_per_period2 / kTurn, 40); }
inline double rad_per_period2(std::int32_t raw_q8) { return real(raw_q8, 40) * kTurn; }

}  // namespace stillspin::test::seen

#endif
