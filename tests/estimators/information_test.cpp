// How much one window tells: the spread of angle and speed from noisy codes, against the table of docs, "Physics",
// section 4 (motor A, 12-bit converter of +-20 A, 12 mA rms per sample, 4 conversions averaged).

#include "tests/estimators/machine.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/slopes.h"
}

namespace {

using namespace stillspin::test;

constexpr double kAmpsPerCode = 20.0 / 2048.0;
constexpr double kNoiseCodes = 0.012 / kAmpsPerCode;

int code(double amps, Random& random) {
  return static_cast<int>(std::lround(amps / kAmpsPerCode + 2048.0 + kNoiseCodes * random.normal()));
}

/// A window seen through the converter.
estimator_window_t sampled(const Motor& motor, const Window& w, double theta, double speed, Vector current,
                           Random& random) {
  const double at = theta - speed * kPeriod * (1.0 - w.middle / 10000.0);
  const Vector v = state_voltage(w.state);
  const Vector half = slope_of(motor, at, speed, current, v) * (0.5 * w.span * 1e-8);
  const auto sum = [&](Vector i, int phase) {
    const double amps = (phase == 0) ? i.x : -0.5 * i.x + std::sqrt(3.0) / 2.0 * i.y;
    int s = 0;
    for (int k = 0; k < 4; ++k) s += code(amps, random);
    return static_cast<std::uint16_t>(s);
  };
  slopes_config_t c = {raw(kAmpsPerCode, 30), 4, 4, 0};
  slopes_design(&c);
  const slopes_trim_t trim = {2048 * 256, 2048 * 256, 0};
  slopes_sums_t sums;
  sums.start_a = sum(current - half, 0);
  sums.start_b = sum(current - half, 1);
  sums.end_a = sum(current + half, 0);
  sums.end_b = sum(current + half, 1);
  estimator_window_t e = {};
  e.voltage_q19 = raw_ab(v, 19);
  e.middle_tick = static_cast<std::int16_t>(w.middle);
  e.span_ticks = static_cast<std::int16_t>(w.span);
  e.zero_vector = w.state == 0 || w.state == 7;
  const slopes_scale_t scale = slopes_scale(&c, &trim);
  slopes_evaluate(&scale, &sums, &e);
  return e;
}

/// 1 sigma of the angle (rad) or the speed (rad/s) that one window gives by least squares, over all directions.
double sigma(unsigned state, int span, double amps, bool of_speed, std::uint64_t seed) {
  Random random(seed);
  const Motor motor;
  const machine_model_t m = model_of(motor);
  double squares = 0.0;
  const int trials = 4000;
  for (int n = 0; n < trials; ++n) {
    const double theta = random.between(-kPi, kPi);
    const Vector current = Vector{0.0, amps}.turned(theta);
    const estimator_window_t w = sampled(motor, {state, 5000, span}, theta, 0.0, current, random);
    const deviation_t d = deviation_evaluate(&m, &w, bam(theta), 0);
    const Vector e = real(d.residual_q20, 20);
    const deviation_sensitivity_t s = deviation_sensitivity(&m, 0, {0, raw(amps, 20)});
    const dq_t mirrored_q15 =
        deviation_mirrored_q15((m.yd_q30 - m.yq_q30) / 2, m.ydq_q30, {2 * d.voltage_q16.d, 2 * d.voltage_q16.q});
    const Vector h = of_speed ? real(s.h_speed_q20, 20) : real(deviation_by_angle_q17(&s, mirrored_q15), 17);
    const double error = (e.x * h.x + e.y * h.y) / (h.x * h.x + h.y * h.y);
    squares += error * error;
  }
  return std::sqrt(squares / trials) / (of_speed ? kPeriod : 1.0);
}

// The table takes the same noise on both axes. With sensors in phases a and b the other axis is (a + 2 b) / sqrt 3: its
// variance is 5/3 of alpha's, which over all directions makes sqrt(4/3) of the table. The table says what the physics
// allow, so better than it would be wrong, too; 6 % for 4000 trials and the converter's quantisation.
void expect_sigma(double got, double table) {
  const double expected = table * std::sqrt(4.0 / 3.0);
  EXPECT_GT(got, expected * 0.94);
  EXPECT_LT(got, expected * 1.06);
}

TEST(Information, ActiveWindows) {
  expect_sigma(sigma(1, 500, 0.0, false, 1) / kDegree, 6.7);
  expect_sigma(sigma(1, 1000, 0.0, false, 2) / kDegree, 3.3);
  expect_sigma(sigma(1, 3500, 0.0, false, 3) / kDegree, 0.95);
}

TEST(Information, ZeroWindows) {
  expect_sigma(sigma(0, 7000, 3.0, false, 4) / kDegree, 99.0);
  expect_sigma(sigma(0, 7000, 11.5, false, 5) / kDegree, 26.0);
}

TEST(Information, SpeedThroughTheEmf) { expect_sigma(sigma(0, 7000, 0.0, true, 6), 6.2); }

// Two opposite windows of 35 us through AVV itself: twice the information of one, less nothing but the unknown mean.
TEST(Information, AvvUsesWhatTwoWindowsTell) {
  Random random(7);
  const Motor motor;
  const machine_model_t m = model_of(motor);
  double squares = 0.0;
  const int trials = 4000;
  const avv_config_t c = {raw(0.01, 30), raw(0.01, 30)};
  for (int n = 0; n < trials; ++n) {
    const double theta = random.between(-kPi, kPi);
    std::vector<estimator_window_t> windows;
    for (const Window& w : alternating_windows(n, 3500)) {
      windows.push_back(sampled(motor, w, theta, 0.0, {0.0, 0.0}, random));
    }
    avv_t s = {};
    avv_preset(&s, bam(theta), 0, 0);
    const estimator_input_t in = input_of(m, windows);
    avv_step(&s, &c, &in);
    squares += rad(s.error_bam) * rad(s.error_bam);
  }
  expect_sigma(std::sqrt(squares / trials) / kDegree, 0.95 / std::sqrt(2.0));
}

}  // namespace
