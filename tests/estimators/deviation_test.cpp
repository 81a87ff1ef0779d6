// The deviation of a window: nothing at the true angle, and its sensitivities against numeric derivatives.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/deviation.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

struct Point {
  double theta;
  std::int32_t speed_bpp;
  Vector current, voltage;
  int middle;
  double w() const { return rad_per_s(speed_bpp); }
};

Point random_point(Random& random) {
  Point p;
  p.theta = random.between(-kPi, kPi);
  p.speed_bpp = bpp(random.between(-1300.0, 1300.0));  // 3100 rpm on four pole pairs
  p.current = random.direction(random.between(0.0, 15.0));
  p.voltage = state_vector(random.below(8)) + random.direction(random.between(0.0, 3.0));  // with device drops
  p.middle = 500 + random.below(9000);
  return p;
}

Motor random_motor(Random& random) {
  Motor m;
  m.ld = random.log_between(2e-3, 20e-3);
  m.lq = m.ld * random.between(1.0, 3.0);
  m.flux = random.log_between(0.02, 0.3);
  m.rs = random.log_between(0.05, 5.0);
  return m;
}

// A window's current in the frame at its middle.
dq_t current_q20(const estimator_window_t& w, const Point& p) {
  estimator_frame_t f;
  deviation_frames(&w, 1, deviation_middle(bam(p.theta), p.speed_bpp), machine_speed_rad_q30(p.speed_bpp), &f);
  return {f.current_q18.d * 4, f.current_q18.q * 4};
}

// T = 100 us is 1.7e-6 off as Q30, and with it every model slope (up to 15 A per period here: 2.6e-5); the change of
// the current, a fifth of the slope here, has some six roundings to 7.6e-6 A. The frame is off by a sixth of the cube
// of what it turns from the period's middle (deviation.h), and with it both the slope and what the model makes of it.
double frame_error(const Point& p) { return std::pow(std::abs(p.w() * (p.middle - 5000) * 1e-8), 3) / 6.0; }
double residual_tolerance(const Point& p, Vector slope) { return 2.4e-4 + frame_error(p) * 2.0 * slope.length(); }

TEST(Deviation, NothingIsLeftAtTheTrueAngleAndSpeed) {
  Random random(1);
  double largest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const Motor motor = random_motor(random);
    const machine_model_t model = model_of(motor);
    const Point p = random_point(random);
    const Window w = window_at(motor, p.theta, p.w(), p.current, p.voltage, p.middle, 2000);
    const estimator_window_t raw_window = w.raw();
    const deviation_t d = deviation_evaluate(&model, &raw_window, bam(p.theta), p.speed_bpp);
    ASSERT_NEAR(real(d.residual_q20.d, 20), 0.0, residual_tolerance(p, w.slope)) << n;
    ASSERT_NEAR(real(d.residual_q20.q, 20), 0.0, residual_tolerance(p, w.slope)) << n;
    largest = std::max(largest, w.slope.length());
  }
  EXPECT_GT(largest, 8.0);  // there was something to leave nothing of
}

TEST(Deviation, VoltageAndCurrentInTheFrameAtTheWindowsMiddle) {
  Random random(2);
  const machine_model_t model = model_of(Motor{});
  for (int n = 0; n < 2000; ++n) {
    const Point p = random_point(random);
    const estimator_window_t w = window_at(Motor{}, p.theta, p.w(), p.current, p.voltage, p.middle, 2000).raw();
    const deviation_t d = deviation_evaluate(&model, &w, bam(p.theta), p.speed_bpp);
    const double middle = angle_at(p.theta, p.w(), p.middle);
    const Vector v = p.voltage.turned(-middle);
    const Vector i = p.current.turned(-middle);
    // 200 V turned by a time that is right to 1.7e-6 of 0.13 rad: 5e-5 V, and the LSB of 1.5e-5; and the frame
    ASSERT_NEAR(real(d.voltage_q16.d, 16), v.x, 1e-4 + frame_error(p) * v.length());
    ASSERT_NEAR(real(d.voltage_q16.q, 16), v.y, 1e-4 + frame_error(p) * v.length());
    // upper words of 3.8e-6 A, and the frame
    ASSERT_NEAR(real(current_q20(w, p).d, 20), i.x, 2e-5 + frame_error(p) * i.length());
    ASSERT_NEAR(real(current_q20(w, p).q, 20), i.y, 2e-5 + frame_error(p) * i.length());
  }
}

// The residual is the true slope less a constant, so its derivatives are those of the true slope.
TEST(Deviation, SensitivitiesAreTheDerivativesOfTheSlope) {
  Random random(3);
  constexpr double kStep = 1e-4;  // rad; central differences: the rest is 1e-8 of the value
  for (int n = 0; n < 10000; ++n) {
    const Motor m = random_motor(random);
    const machine_model_t model = model_of(m);
    const Point p = random_point(random);
    const estimator_window_t w = window_at(m, p.theta, p.w(), p.current, p.voltage, p.middle, 2000).raw();
    const deviation_t d = deviation_evaluate(&model, &w, bam(p.theta), p.speed_bpp);
    const deviation_sensitivity_t h =
        deviation_sensitivity(&model, machine_speed_rad_q30(p.speed_bpp), current_q20(w, p));
    const double at = angle_at(p.theta, p.w(), p.middle);
    const auto slope = [&](double theta, double speed) {
      return (current_derivative(m, theta, speed, p.current, p.voltage) * m.period).turned(-at);
    };
    const Vector by_angle = (slope(at + kStep, p.w()) - slope(at - kStep, p.w())) * (0.5 / kStep);
    const double dw = 10.0;  // the slope is linear in the speed: any step will do
    const Vector by_speed = (slope(at, p.w() + dw) - slope(at, p.w() - dw)) * (0.5 / dw / m.period);
    const Vector h_a = real(deviation_by_angle_q17(&h, mirrored(model, d.voltage_q16)), 17);
    const Vector h_s = real(h.h_speed_q20, 20);
    // 1.7e-6 of T as above in both; K is right to a few 1e-7 and is multiplied by 15 A; what the saliency makes of the
    // voltage and of R i has two upper words of 2^-15 A each, doubled. In a frame that is off, v - R i and i are turned
    // by as much, and what either makes of h_angle with them; K i is up to 2 A of h_speed for one of current.
    const double off = frame_error(p);
    const double saliency = real(model.yd_q30 - model.yq_q30, 30) * (p.voltage - p.current * m.rs).length();
    const double turn = p.w() * m.period * real(model.k_dq_q24 + model.k_qd_q24, 24) * p.current.length();
    const double turned = off * (std::abs(saliency) + std::abs(turn));
    ASSERT_NEAR(h_a.x, by_angle.x, 2.8e-4 + 3e-6 * by_angle.length() + turned) << n;
    ASSERT_NEAR(h_a.y, by_angle.y, 2.8e-4 + 3e-6 * by_angle.length() + turned) << n;
    // The current is right to 2e-5 A.
    ASSERT_NEAR(h_s.x, by_speed.x, 6e-5 + 4e-6 * by_speed.length() + 2.0 * off * p.current.length()) << n;
    ASSERT_NEAR(h_s.y, by_speed.y, 6e-5 + 4e-6 * by_speed.length() + 2.0 * off * p.current.length()) << n;
  }
}

// Frames of several windows, up to a speed of 0.6 rad per period: 9500 rpm on motor A.
TEST(Deviation, FramesTurnEvenlyThroughThePeriod) {
  Random random(4);
  for (int n = 0; n < 20000; ++n) {
    const double w = random.between(-0.6, 0.6) / kPeriod;
    const double end = random.between(-kPi, kPi);
    estimator_window_t windows[ESTIMATOR_WINDOWS] = {};
    for (estimator_window_t& x : windows) x.middle_tick = static_cast<std::int16_t>(random.below(10001));
    estimator_frame_t frames[ESTIMATOR_WINDOWS];
    const std::int32_t speed = bpp(w);
    deviation_frames(windows, ESTIMATOR_WINDOWS, deviation_middle(bam(end), speed), machine_speed_rad_q30(speed),
                     frames);
    for (int k = 0; k < ESTIMATOR_WINDOWS; ++k) {
      const double at = angle_at(end, w, windows[k].middle_tick);
      const double x = w * (windows[k].middle_tick - 5000) * 1e-8;
      const double expected = std::abs(x * x * x) / 6.0 + 2e-6;
      ASSERT_NEAR(real(frames[k].rotation.sin_q30, 30), std::sin(at), expected) << n;
      ASSERT_NEAR(real(frames[k].rotation.cos_q30, 30), std::cos(at), expected) << n;
    }
  }
}

struct Matrix {
  double dd, dq, qd, qq;
  Vector operator*(Vector v) const { return {dd * v.x + dq * v.y, qd * v.x + qq * v.y}; }
};

// With a saliency that is tilted against the frame, as saturation makes it, no machine in closed form is there to
// compare with; but an angle error only turns what is measured, so the residual itself can be differentiated.
TEST(Deviation, SensitivitiesOfATiltedSaliency) {
  Random random(5);
  machine_model_t model = model_of(Motor{});
  for (int n = 0; n < 2000; ++n) {
    model.yd_q30 = raw(random.between(0.015, 0.03), 30);
    model.yq_q30 = raw(random.between(0.01, 0.015), 30);
    model.ydq_q30 = raw(random.between(-0.005, 0.005), 30);
    model.k_dd_q24 = raw(random.between(-0.5, 0.5), 24);
    model.k_dq_q24 = raw(random.between(-2.0, 2.0), 24);
    model.k_qd_q24 = raw(random.between(-2.0, 2.0), 24);
    model.k0_q20 = raw_dq(random.direction(20.0), 20);
    const std::int32_t speed = bpp(random.between(-1500.0, 1500.0));
    const std::int32_t w_q30 = machine_speed_rad_q30(speed);
    const double w = real(w_q30, 30);
    const Vector i = random.direction(8.0), v = random.direction(170.0);
    // The slope that leaves nothing over at the angle of zero.
    const Matrix y = {real(model.yd_q30, 30), real(model.ydq_q30, 30), real(model.ydq_q30, 30), real(model.yq_q30, 30)};
    const Matrix k = {real(model.k_dd_q24, 24), real(model.k_dq_q24, 24), real(model.k_qd_q24, 24),
                      -real(model.k_dd_q24, 24)};
    const Vector turn = k * i + real(model.k0_q20, 20);
    estimator_window_t at = {};
    at.span_ticks = 10000;
    at.change_q19 = raw_change(y * (v - i * real(model.rs_q24, 24)) + turn * w, at.span_ticks);
    at.current_q20 = raw_ab(i, 20);
    at.voltage_q19 = raw_ab(v, 19);
    at.middle_tick = ESTIMATOR_PERIOD_TICKS / 2;
    const auto residual = [&](double error, std::int32_t bpp_off) {  // of a frame that lags by the error
      const std::uint32_t angle = bam(-error) + static_cast<std::uint32_t>(q_shr(speed + bpp_off, 1));
      return real(deviation_evaluate(&model, &at, angle, speed + bpp_off).residual_q20, 20);
    };
    // over a whole period five roundings of the slope to 3.1e-5 A, in each axis
    EXPECT_NEAR(residual(0.0, 0).length(), 0.0, 2.2e-4) << n;
    // Central differences: 4 / 6 of the squared step, 6e-4, of what repeats twice a turn, and 1.6e-4 A of roundings
    // over the step, 5e-3; no draw has a third of either.
    constexpr double kStep = 3e-2;
    const Vector by_angle = (residual(kStep, 0) - residual(-kStep, 0)) * (0.5 / kStep);
    const std::int32_t dw = bpp(300.0);  // the slope is linear in the speed
    const Vector by_speed = (residual(0.0, -dw) - residual(0.0, dw)) * (0.5 / rad(dw));
    const deviation_sensitivity_t h = deviation_sensitivity(&model, w_q30, raw_dq(i, 20));
    const Vector h_a = real(deviation_by_angle_q17(&h, mirrored(model, raw_dq(v, 16))), 17);
    const Vector h_s = real(h.h_speed_q20, 20);
    ASSERT_NEAR(h_a.x, by_angle.x, 2e-3 + 2e-4 * by_angle.length()) << n;
    ASSERT_NEAR(h_a.y, by_angle.y, 2e-3 + 2e-4 * by_angle.length()) << n;
    ASSERT_NEAR(h_s.x, by_speed.x, 2e-3) << n;
    ASSERT_NEAR(h_s.y, by_speed.y, 2e-3) << n;
  }
}

// A machine at rest whose inverse inductances go with the torque current: under opposite vectors a ripple is at
// opposite places of it, and what is left unexplained without that is one and the same slope in both. Beyond a segment
// the ripple counts as one.
TEST(Deviation, OppositeWindowsLieAtDifferentCurrents) {
  constexpr double kSegment = 3.5;
  const Vector slope = {4e-3, -3e-3};  // of yqq, ydq
  Random random(6);
  machine_model_t model = model_of(Motor{});
  model.map.per_segment_q26 = raw(1.0 / kSegment, 26);
  model.slope = {raw(slope.x, 30), raw(slope.y, 30)};
  const double r = real(model.rs_q24, 24), yd = real(model.yd_q30, 30), yq = real(model.yq_q30, 30);
  double largest = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const Vector mean = random.direction(random.between(0.0, 12.0)), v = random.direction(170.0);
    const double ripple = random.between(-1.5, 1.5) * kSegment;
    estimator_window_t windows[2] = {};
    for (const int k : {0, 1}) {
      const double sign = (k == 0) ? 1.0 : -1.0;
      const Vector i = mean + Vector{0.0, sign * ripple};
      const Vector more = slope * (sign * std::max(-1.0, std::min(ripple / kSegment, 1.0)));
      const Matrix y = {yd, more.y, more.y, yq + more.x};
      windows[k].span_ticks = 5000;
      windows[k].change_q19 = raw_change(y * v * sign - Matrix{yd, 0.0, 0.0, yq} * i * r, windows[k].span_ticks);
      windows[k].current_q20 = raw_ab(i, 20);
      windows[k].voltage_q19 = raw_ab(v * sign, 19);
      windows[k].middle_tick = ESTIMATOR_PERIOD_TICKS / 2;
      largest = std::max(largest, (Matrix{0.0, more.y, more.y, more.x} * v).length());
    }
    const estimator_input_t in = {&model, windows, 2, 0, false, false, false, false, nullptr, raw(mean.y, 20)};
    deviation_change_t seen[ESTIMATOR_WINDOWS];
    EXPECT_NEAR(real(deviation_see(&in, 0, 0, seen), 18).y, mean.y - ripple, 1e-4) << n;
    for (const int k : {0, 1}) {
      // over half a period: five roundings to 3.1e-5 A, and the share of a segment is right to 1/4096
      EXPECT_NEAR(real(seen[k].left_q17, 17).length(), 0.0, 1e-4 + 0.5 * slope.length() * 170.0 / 4096.0) << n;
    }
  }
  EXPECT_GT(largest, 0.6);  // A per period
}

}  // namespace
