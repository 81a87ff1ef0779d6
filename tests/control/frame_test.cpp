// Clarke and Park against their definitions in double precision.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/frame.h"
}

namespace {

using stillspin::test::bam;
using stillspin::test::kPi;
using stillspin::test::Random;
using stillspin::test::raw_ab;
using stillspin::test::real;
using stillspin::test::Vector;

constexpr double kSqrt3 = 1.7320508075688772;
constexpr int kTrials = 20000;
constexpr double kLargest = 536870912.0;  // a quarter of the range: sums of two stay inside

std::int32_t any(Random& random) { return static_cast<std::int32_t>(random.between(-kLargest, kLargest)); }

// One product is rounded (1/2 LSB); the constant's own rounding is 2^-31 of 1.6e9, at most 0.8 LSB.
constexpr double kProduct = 1.3;

TEST(Frame, ClarkeOfTwoPhases) {
  Random random(1);
  for (int n = 0; n < kTrials; ++n) {
    const std::int32_t a = any(random);
    const std::int32_t b = any(random);
    const ab_t v = frame_clarke2(a, b);
    ASSERT_EQ(v.alpha, a);
    ASSERT_NEAR(v.beta, (a + 2.0 * b) / kSqrt3, kProduct);
  }
}

TEST(Frame, ClarkeOfThreePhasesIgnoresTheCommonPart) {
  Random random(2);
  for (int n = 0; n < kTrials; ++n) {
    const abc_t x = {any(random), any(random), any(random)};
    const ab_t v = frame_clarke3(x);
    // the division by three cuts off: less than one LSB
    ASSERT_NEAR(v.alpha, (2.0 * x.a - x.b - x.c) / 3.0, 1.0);
    ASSERT_NEAR(v.beta, (static_cast<double>(x.b) - x.c) / kSqrt3, kProduct);
    const std::int32_t common = any(random) / 4;
    const ab_t same = frame_clarke3({x.a / 2 + common, x.b / 2 + common, x.c / 2 + common});
    const ab_t half = frame_clarke3({x.a / 2, x.b / 2, x.c / 2});
    ASSERT_EQ(same.alpha, half.alpha);
    ASSERT_EQ(same.beta, half.beta);
  }
}

TEST(Frame, ClarkeIsAmplitudeInvariant) {
  const double peak = 1e6;
  for (int degree = 0; degree < 360; ++degree) {
    const double angle = degree * kPi / 180.0;
    const auto phase = [&](double lag) { return static_cast<std::int32_t>(std::lround(peak * std::cos(angle - lag))); };
    const ab_t v = frame_clarke3({phase(0.0), phase(2.0 * kPi / 3.0), phase(-2.0 * kPi / 3.0)});
    EXPECT_NEAR(v.alpha, peak * std::cos(angle), 2.0) << degree;
    EXPECT_NEAR(v.beta, peak * std::sin(angle), 2.0) << degree;
  }
}

TEST(Frame, InverseClarke) {
  Random random(3);
  for (int n = 0; n < kTrials; ++n) {
    const ab_t v = {any(random), any(random)};
    const abc_t x = frame_inverse_clarke(v);
    ASSERT_EQ(x.a, v.alpha);
    // alpha / 2 is cut off (1/2 LSB), and so is half the product; sqrt(3)/2 is right to 2^-32 of beta
    ASSERT_NEAR(x.b, -0.5 * v.alpha + 0.5 * kSqrt3 * v.beta, 2.75);
    ASSERT_NEAR(x.c, -0.5 * v.alpha - 0.5 * kSqrt3 * v.beta, 2.75);
    ASSERT_LE(std::abs(x.a + x.b + x.c), 1);
    const ab_t back = frame_clarke3(x);
    ASSERT_LE(std::abs(back.alpha - v.alpha), 1);
    ASSERT_LE(std::abs(back.beta - v.beta), 4);
  }
}

// q_sincos is right to 2e-9, which is one LSB of 5e8; two products are rounded.
constexpr double kTurned = 1.0 + 2 * 1.1;

TEST(Frame, ParkTurnsByTheAngle) {
  Random random(4);
  for (int n = 0; n < kTrials; ++n) {
    const double angle = random.between(-kPi, kPi);
    const ab_t v = {any(random) / 2, any(random) / 2};
    const rotation_t r = frame_rotation(bam(angle));
    const dq_t w = frame_park(v, r);
    const Vector expected = real(v, 0).turned(-angle);
    ASSERT_NEAR(w.d, expected.x, kTurned + 0.5) << angle;  // and 2^-33 of a turn by rounding the angle
    ASSERT_NEAR(w.q, expected.y, kTurned + 0.5) << angle;
    const ab_t back = frame_inverse_park(w, r);
    ASSERT_NEAR(back.alpha, v.alpha, 2 * kTurned);
    ASSERT_NEAR(back.beta, v.beta, 2 * kTurned);
  }
}

TEST(Frame, DirectAxisIsAheadOfNothingAndQuadratureLeads) {
  const rotation_t r = frame_rotation(bam(kPi / 6.0));
  const dq_t along = frame_park(raw_ab(Vector{10.0, 0.0}.turned(kPi / 6.0), 20), r);
  EXPECT_NEAR(real(along.d, 20), 10.0, 1e-5);
  EXPECT_NEAR(real(along.q, 20), 0.0, 1e-5);
  const dq_t ahead = frame_park(raw_ab(Vector{10.0, 0.0}.turned(kPi / 6.0 + kPi / 2.0), 20), r);
  EXPECT_NEAR(real(ahead.q, 20), 10.0, 1e-5);
}

}  // namespace
