// AVV: the angle error that the regression finds, without and with what it has to see through.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/slopes.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

const avv_config_t kConfig = {raw(100.0 * kPeriod, 30), raw(200.0 * kPeriod, 30)};

struct Estimate {
  double error;  // true minus observed, as measured, rad
  avv_t state;
};

// One step from an observer that will stand at observed, w when the windows are looked at.
Estimate measure(const std::vector<Window>& windows, double observed, std::int32_t speed_bpp = 0) {
  const machine_model_t model = model_of(Motor{});
  avv_t s = {};
  avv_preset(&s, bam(observed) - static_cast<std::uint32_t>(speed_bpp), speed_bpp, 0);
  const Input in(model, windows);
  (void)avv_step(&s, &kConfig, in.get());
  return {rad(s.error_bam), s};
}

// States of 0 (the zero vector) and 1..6; 7 is 0 again.
std::vector<std::vector<int>> distinct_sets() {
  std::vector<std::vector<int>> sets;
  for (int a = 0; a < 7; ++a) {
    for (int b = a + 1; b < 7; ++b) {
      sets.push_back({a, b});
      for (int c = b + 1; c < 7; ++c) sets.push_back({a, b, c});
    }
  }
  return sets;
}

// Equal currents in all windows at standstill: the differences are L^-1 dv and nothing else, so any error up to a
// quarter turn comes out exactly. What is left: changes of six roundings to 7.6e-6 A, beside a saliency of 0.75 A per
// period and more, seen for 4 us at least.
TEST(Avv, ExactAtStandstillWithAnyDistinctVectorsAndAnyError) {
  Random random(30);
  for (const std::vector<int>& states : distinct_sets()) {
    for (int n = 0; n < 40; ++n) {
      const double theta = random.between(-kPi, kPi);
      const double error = random.between(-80.0, 80.0) * kDegree;
      const Vector current = random.direction(random.between(0.0, 12.0));
      std::vector<Window> windows;
      for (const int state : states) {
        windows.push_back(window_at(Motor{}, theta, 0.0, current, state_vector(state),
                                    1500 + 3000 * static_cast<int>(windows.size()), 400 + random.below(3500)));
      }
      const Estimate e = measure(windows, theta - error);
      ASSERT_NEAR(e.error / kDegree, error / kDegree, 0.5 * 4.6e-5 / 0.04 / 0.75 / kDegree)
          << states.size() << " windows, " << states[0] << states[1];
      ASSERT_GT(e.state.regression.information, 0);
    }
  }
}

// Moving, with the current changing between the windows: the model at the observed angle takes most of it off, so what
// is left is of second order in the angle error: (|wL'i| + |w lambda| + R |di|) against dY dv / 2.
TEST(Avv, SmallErrorsAtSpeedWithResistanceEmfAndRotation) {
  Random random(31);
  double worst = 0.0;
  for (int n = 0; n < 4000; ++n) {
    const std::int32_t speed = bpp(random.between(-1250.0, 1250.0));
    const double w = rad_per_s(speed);
    const double theta = random.between(-kPi, kPi);
    const double error = random.between(-3.0, 3.0) * kDegree;
    const Vector current = random.direction(random.between(0.0, 12.0));
    const std::vector<int> states = distinct_sets()[static_cast<std::size_t>(random.below(56))];
    std::vector<Window> windows;
    for (const int state : states) {
      const Vector at_window = current + random.direction(random.between(0.0, 1.5));  // ripple
      windows.push_back(window_at(Motor{}, theta, w, at_window, state_vector(state),
                                  1500 + 3000 * static_cast<int>(windows.size()), 1500));
    }
    const Estimate e = measure(windows, theta - error, speed);
    // ripple between the windows turned by the error: 1.5 A * 1250 rad/s * (Lq/Ld - Ld/Lq) ~ 1800 A/s, and twice that
    // with two windows apart, beside a saliency of 15 000 A/s (two neighbouring vectors, least): a quarter of the error
    ASSERT_NEAR(e.error, error, 0.25 * std::fabs(error) + 0.002 * kDegree) << n << " at " << w;
    worst = std::max(worst, std::fabs(e.error - error));
  }
  EXPECT_GT(worst, 0.01 * kDegree);  // otherwise the currents did not differ
}

TEST(Avv, NothingIsMeasuredAtTheTrueAngleHoweverFastAndLoaded) {
  Random random(32);
  for (int n = 0; n < 3000; ++n) {
    const std::int32_t speed = bpp(random.between(-1250.0, 1250.0));
    const double theta = random.between(-kPi, kPi);
    std::vector<Window> windows;
    for (const int state : {1 + random.below(6), 0}) {
      windows.push_back(window_at(Motor{}, theta, rad_per_s(speed), random.direction(12.0), state_vector(state),
                                  2500 + 4000 * static_cast<int>(windows.size()), 1800));
    }
    // residuals of 2e-4 A per period (2.4e-4 and the frame's, deviation_test) beside 0.76: 2.6e-4 rad in 2 theta
    ASSERT_NEAR(measure(windows, theta, speed).error / kDegree, 0.0, 0.0075);
  }
}

TEST(Avv, OneVectorTellsNothing) {
  const Window w = window_at(Motor{}, 0.5, 0.0, {3, 1}, state_vector(3), 3000, 2000);
  for (const std::vector<Window>& windows : {std::vector<Window>{}, {w}, {w, w}}) {
    const machine_model_t model = model_of(Motor{});
    avv_t s = {};
    avv_preset(&s, bam(0.3), 0, 0);
    const Input in(model, windows);
    const estimator_output_t out = avv_step(&s, &kConfig, in.get());
    EXPECT_EQ(out.angle_bam, bam(0.3));
    EXPECT_EQ(out.quality_q15, 0);
    EXPECT_EQ(s.regression.information, 0);
  }
}

// Until there are new windows nothing is known of the axis, whatever was seen before.
TEST(Avv, APresetForgetsTheLastWindows) {
  Estimate e = measure(alternating(Motor{}, 0, 0.7, 0.0, {2, 1}), 0.5);
  ASSERT_GT(e.state.regression.information, 0);
  ASSERT_NE(e.state.error_bam, 0);
  avv_preset(&e.state, bam(0.5), 0, 0);
  EXPECT_EQ(e.state.regression.information, 0);
  EXPECT_EQ(e.state.error_bam, 0);
}

// A period without windows leaves nothing of the one before.
TEST(Avv, ARegressionOverNoWindowsIsEmpty) {
  const machine_model_t model = model_of(Motor{});
  const Input none(model, {});
  regression_t r = {1, 2, 3, 4, 5, 6, {7, 8}};
  regression_evaluate(&r, nullptr, none.get());
  for (const std::int32_t part :
       {r.spread_q8, r.along_q16, r.mirror_q16, r.cross_q16, r.curl_q16, r.information, r.mean_q20.d, r.mean_q20.q}) {
    EXPECT_EQ(part, 0);
  }
}

// The half turn is the observer's own: the windows look the same from the other side.
TEST(Avv, HalfATurnIsLeftOpen) {
  const auto windows = alternating(Motor{}, 0, 0.7, 0.0, {2, 1});
  EXPECT_NEAR(measure(windows, 0.7 - 0.1).error, 0.1, 1e-4);
  EXPECT_NEAR(measure(windows, 0.7 - 0.1 + kPi).error, 0.1, 1e-4);
}

constexpr double kAmpsPerCode = 20.0 / 2048.0;

// Codes of a burst around a current: Gaussian noise per conversion, then the converter's rounding.
std::uint16_t burst(Random& random, double amps, int samples, double noise) {
  int sum = 0;
  for (int n = 0; n < samples; ++n) {
    sum += static_cast<int>(std::lround(2048.0 + (amps + noise * random.normal()) / kAmpsPerCode));
  }
  return static_cast<std::uint16_t>(sum);
}

Window through_the_converter(Random& random, Window w, double noise) {
  const Vector half = w.slope * (w.span / 20000.0);
  const Vector begin = w.current - half, end = w.current + half;
  const auto phase_b = [](Vector i) { return 0.5 * (std::sqrt(3.0) * i.y - i.x); };
  slopes_config_t c = {raw(kAmpsPerCode, 30), 4, 3, 0};
  const slopes_trim_t trim = {2048 * 256, 2048 * 256, 0};
  const slopes_sums_t sums = {burst(random, begin.x, 4, noise), burst(random, phase_b(begin), 4, noise),
                              burst(random, end.x, 3, noise), burst(random, phase_b(end), 3, noise)};
  estimator_window_t out = w.raw();
  slopes_design(&c);
  const slopes_scale_t scale = slopes_scale(&c, &trim);
  slopes_evaluate(&scale, &sums, &out);
  w.slope = slope_from(out.change_q19, w.span);
  w.current = real(out.current_q20, 20);
  return w;
}

// One pair of 28 us windows at +x and -x, 11.7 mA per conversion and a quantisation of 9.8/sqrt(12) mA: 12 mA in all.
// Difference of the means of 3 and 4: 12 sqrt(1/3 + 1/4) = 9.2 mA a phase; the Clarke of two phases has a mean variance
// of 4/3 over the directions, two windows sqrt2: 15.0 mA across, beside dY/2 400 V 28 us = 0.425 A: 2 theta 0.0353 rad,
// theta 1.01 degrees.
TEST(Avv, NoiseOfAPairOfLongWindows) {
  Random random(33);
  double sum = 0.0;
  constexpr int kTrials = 6000;
  for (int n = 0; n < kTrials; ++n) {
    const double theta = random.between(-kPi, kPi);
    std::vector<Window> windows = alternating(Motor{}, n, theta, 0.0, random.direction(6.0));
    for (Window& w : windows) w = through_the_converter(random, w, 11.7e-3);
    const double error = measure(windows, theta).error / kDegree;
    sum += error * error;
  }
  // the rms of 6000 has a spread of 1 %; less noise than the bound would be as wrong as more
  EXPECT_NEAR(std::sqrt(sum / kTrials), 1.01, 0.04);
}

// The bandwidth follows the information: long windows pull harder.
TEST(Avv, BandwidthBetweenShortAndLongWindows) {
  const auto pulled = [](int span, int state) {
    std::vector<Window> windows = {window_at(Motor{}, 0.5, 0.0, {0, 0}, state_vector(state), 2500, span),
                                   window_at(Motor{}, 0.5, 0.0, {0, 0}, state_vector(7 - state), 7500, span)};
    const double e = 5.0 * kDegree;
    const Estimate m = measure(windows, 0.5 - e);
    return (rad(m.state.observer.angle_bam) - (0.5 - e)) / e / (3.0 * kPeriod);  // rad/s
  };
  EXPECT_NEAR(pulled(300, 1), 100.0, 1.0);
  EXPECT_NEAR(pulled(4000, 1), 200.0, 1.0);
  const double between = pulled(1200, 1);
  EXPECT_GT(between, 110.0);
  EXPECT_LT(between, 195.0);
}

// Between 2^21 and 2^27 of information the bandwidth goes with its logarithm, in quarters of a power of two between
// which it is straight.
TEST(Avv, TheBandwidthGoesWithTheLogarithmOfTheInformation) {
  for (const int span : {250, 400, 700, 1000, 1300, 1700, 2200, 2800, 3500, 4700}) {
    std::vector<Window> windows = {window_at(Motor{}, 0.5, 0.0, {0, 0}, state_vector(1), 2500, span),
                                   window_at(Motor{}, 0.5, 0.0, {0, 0}, state_vector(6), 7500, span)};
    const double e = 5.0 * kDegree;
    const Estimate m = measure(windows, 0.5 - e);
    const double pulled = (rad(m.state.observer.angle_bam) - (0.5 - e)) / e / (3.0 * kPeriod);
    const auto information = static_cast<double>(m.state.regression.information);
    const int power = std::ilogb(information);
    const double log2 = power + std::floor((std::ldexp(information, -power) - 1.0) * 4.0) / 4.0;
    EXPECT_NEAR(pulled, 100.0 + 100.0 * std::clamp((log2 - 21.0) / 6.0, 0.0, 1.0), 0.2) << span;
  }
}

}  // namespace
