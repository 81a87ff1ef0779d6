// Slopes from sums of ADC codes.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/slopes.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr double kAmpsPerCode = 20.0 / 2048.0;

slopes_trim_t trim(double mismatch = 0.0) { return {2048 * 256, 2048 * 256, raw(mismatch, 30)}; }

struct Result {
  Vector slope, current;
};

Result evaluate(const slopes_trim_t& t, const slopes_sums_t& sums, int span) {
  slopes_config_t c = {raw(kAmpsPerCode, 30), 4, 3, 0};
  slopes_design(&c);
  const slopes_scale_t scale = slopes_scale(&c, &t);
  estimator_window_t w = {};
  w.span_ticks = static_cast<std::int16_t>(span);
  slopes_evaluate(&scale, &sums, &w);
  return {slope_from(w.change_q19, span), real(w.current_q20, 20)};
}

Vector clarke(double a, double b) { return {a, (a + 2.0 * b) / std::sqrt(3.0)}; }

// What the sums mean, in double precision.
Result reference(const slopes_trim_t& t, const slopes_sums_t& s, int span, double mismatch) {
  const double gain_a = kAmpsPerCode * (1.0 - mismatch);
  const double gain_b = kAmpsPerCode * (1.0 + mismatch);
  const double sa = s.start_a / 4.0, sb = s.start_b / 4.0, ea = s.end_a / 3.0, eb = s.end_b / 3.0;
  const Vector change = clarke((ea - sa) * gain_a, (eb - sb) * gain_b);
  return {change * (10000.0 / span),
          clarke(((sa + ea) / 2 - real(t.offset_a_q8, 8)) * gain_a, ((sb + eb) / 2 - real(t.offset_b_q8, 8)) * gain_b)};
}

// A mean is cut off to 1/256 code, 3.8e-5 A: the end mean is (a third of a code is not a whole number of 256ths), and
// half of the sum once more. Beta carries (1 + 2)/sqrt3 of it. A slope multiplies by the period over the span.
constexpr double kCodeError = kAmpsPerCode / 256.0;
constexpr double kBeta = 1.7321;

TEST(Slopes, RandomSumsAgainstDoublePrecision) {
  Random random(20);
  for (int n = 0; n < 20000; ++n) {
    const double mismatch = random.between(-0.05, 0.05);
    slopes_trim_t t = trim(mismatch);
    t.offset_a_q8 += random.below(20000) - 10000;
    t.offset_b_q8 += random.below(20000) - 10000;
    slopes_sums_t s;
    s.start_a = static_cast<std::uint16_t>(random.below(4 * 4095 + 1));
    s.start_b = static_cast<std::uint16_t>(random.below(4 * 4095 + 1));
    // a window changes the current by up to 8 A: the ends are near the starts
    const auto end_of = [&](int start) {
      return static_cast<std::uint16_t>(std::clamp(start * 3 / 4 + random.below(4800) - 2400, 0, 3 * 4095));
    };
    s.end_a = end_of(s.start_a);
    s.end_b = end_of(s.start_b);
    const int span = 300 + random.below(4000);
    const Result got = evaluate(t, s, span);
    const Result exact = reference(t, s, span, mismatch);
    const double slope_error = kBeta * 1.06 * kCodeError * 10000.0 / span + 1e-6 * exact.slope.length();
    ASSERT_NEAR(got.slope.x, exact.slope.x, slope_error);
    ASSERT_NEAR(got.slope.y, exact.slope.y, slope_error);
    ASSERT_NEAR(got.current.x, exact.current.x, 2.0 * kBeta * kCodeError);
    ASSERT_NEAR(got.current.y, exact.current.y, 2.0 * kBeta * kCodeError);
  }
}

TEST(Slopes, KnownRise) {
  // phase a from 100 codes to 400 codes above zero within a quarter of a period, phase b still at -50
  const slopes_sums_t s = {4 * 2148, 4 * 1998, 3 * 2448, 3 * 1998};
  const Result got = evaluate(trim(), s, 2500);
  const double rise = 300 * kAmpsPerCode * 4.0;
  EXPECT_NEAR(got.slope.x, rise, 1e-5);  // whole codes: only the rounding of the gain is left
  EXPECT_NEAR(got.slope.y, rise / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(got.current.x, 250 * kAmpsPerCode, 1e-5);
  EXPECT_NEAR(got.current.y, (250 - 100) * kAmpsPerCode / std::sqrt(3.0), 1e-5);
}

TEST(Slopes, OffsetsCancelInASlope) {
  const slopes_sums_t s = {4 * 2148, 4 * 1998, 3 * 2448, 3 * 1898};
  const Result plain = evaluate(trim(), s, 2500);
  slopes_trim_t t = trim();
  t.offset_a_q8 += 30 * 256;
  const Result shifted = evaluate(t, s, 2500);
  EXPECT_EQ(plain.slope.x, shifted.slope.x);
  EXPECT_EQ(plain.slope.y, shifted.slope.y);
  EXPECT_NEAR(plain.current.x - shifted.current.x, 30 * kAmpsPerCode, 1e-5);
}

// Sensors that read 1 + g and 1 - g, and a configuration that knows it: the true current comes out, to second order in
// g.
TEST(Slopes, KnownMismatchIsTakenOff) {
  for (const double g : {-0.02, -0.005, 0.005, 0.02}) {
    const double a0 = 3.0, a1 = 7.0, b0 = -2.0, b1 = -4.5;
    const auto sum = [&](double amps, double gain, int count) {
      return static_cast<std::uint16_t>(std::lround(count * (2048.0 + amps * gain / kAmpsPerCode)));
    };
    const slopes_sums_t s = {sum(a0, 1 + g, 4), sum(b0, 1 - g, 4), sum(a1, 1 + g, 3), sum(b1, 1 - g, 3)};
    const Vector change = clarke(a1 - a0, b1 - b0) * 2.5;
    const Result with = evaluate(trim(g), s, 4000);
    const Result without = evaluate(trim(), s, 4000);
    // rounded sums: (1/8 + 1/6) code at most in each phase, times 1.73 and 2.5; and g^2 of 10 A per period
    const double tolerance = 0.292 * kAmpsPerCode * kBeta * 2.5 + g * g * change.length();
    EXPECT_LT((with.slope - change).length(), 1.2 * tolerance) << g;
    // alpha is phase a alone, so an untrimmed one is off by g itself
    EXPECT_NEAR(without.slope.x / change.x, 1 + g, 0.292 * kAmpsPerCode / 4.0) << g;
  }
}

// Sensors of 200 A, from one end to the other with as many conversions as there may be.
TEST(Slopes, AChangeFromEndToEndFits) {
  slopes_config_t c = {raw(0.125, 30), 4, 4, 0};
  slopes_design(&c);
  const slopes_trim_t t = trim();
  const slopes_scale_t scale = slopes_scale(&c, &t);
  const slopes_sums_t s = {0, 0, 4 * 4095, 4 * 4095};
  estimator_window_t w = {};
  slopes_evaluate(&scale, &s, &w);
  EXPECT_NEAR(real(w.change_q19.alpha, 19), 4095 * 0.125, 1e-3);
  EXPECT_NEAR(real(w.change_q19.beta, 19), 4095 * 0.125 * std::sqrt(3.0), 1e-3);
}

}  // namespace
