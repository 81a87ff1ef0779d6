// The library's own elementary functions against libm, and the noise against its distribution.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim_host/plant/noise.hpp"
#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {
namespace {

TEST(PortableMath, RotationIsSineAndCosine) {
  for (int n = -20000; n <= 20000; ++n) {
    const double x = n * 1.37e-3;
    const Rotation e = rotation(x);
    // Twice the unit roundoff for the series, plus what the reduction of |x| <= 27 loses.
    EXPECT_NEAR(e.c, std::cos(x), 4e-16) << x;
    EXPECT_NEAR(e.s, std::sin(x), 4e-16) << x;
  }
}

TEST(PortableMath, TurnedAddsAngles) {
  const Rotation e = rotation(0.7);
  for (double x : {-1.0, -0.0501, -0.0499, -1e-3, 0.0, 1e-9, 0.03, 0.0499, 0.0501, 2.5}) {
    const Rotation r = turned(e, x);
    EXPECT_NEAR(r.c, std::cos(0.7 + x), 1.5e-15) << x;  // neglected terms at 0.05: 1e-15
    EXPECT_NEAR(r.s, std::sin(0.7 + x), 1.5e-15) << x;
  }
}

TEST(PortableMath, SixfoldIsSixTimesTheAngle) {
  for (int n = 0; n < 100; ++n) {
    const double x = n * 0.0631;
    const Rotation six = sixfold(rotation(x));
    EXPECT_NEAR(six.c, std::cos(6.0 * x), 5e-15);  // six times the rounding of the argument
    EXPECT_NEAR(six.s, std::sin(6.0 * x), 5e-15);
  }
}

TEST(PortableMath, ExponentialLogarithmArcTangent) {
  for (int n = -400; n <= 400; ++n) {
    const double x = n * 0.1003;
    EXPECT_NEAR(exponential(x) / std::exp(x), 1.0, 2e-15) << x;
    EXPECT_NEAR(logarithm(std::exp(x)), x, 1e-15 * (1.0 + std::fabs(x))) << x;
    EXPECT_NEAR(arc_tangent(x), std::atan(x), 5e-16) << x;
    EXPECT_NEAR(arc_tangent_near(x, x - 0.04, std::atan(x - 0.04)), std::atan(x), 1e-15) << x;
    EXPECT_NEAR(arc_tangent_near(x, x + 0.5, std::atan(x + 0.5)), std::atan(x), 1e-15) << x;
  }
}

TEST(Noise, IsStandardNormal) {
  Noise noise(1, 0);
  constexpr int kDraws = 1'000'000;
  double sum = 0.0, square = 0.0, fourth = 0.0, product = 0.0, before = 0.0;
  int beyond_one = 0, beyond_three = 0, beyond_tail = 0;
  for (int n = 0; n < kDraws; ++n) {
    const double x = noise.gaussian();
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
    product += x * before;
    before = x;
    beyond_one += std::fabs(x) > 1.0;
    beyond_three += std::fabs(x) > 3.0;
    beyond_tail += std::fabs(x) > 3.6;
  }
  // Five standard errors of each figure for a million draws.
  EXPECT_NEAR(sum / kDraws, 0.0, 0.005);
  EXPECT_NEAR(square / kDraws, 1.0, 0.0071);
  EXPECT_NEAR(fourth / kDraws, 3.0, 0.049);
  EXPECT_NEAR(product / kDraws, 0.0, 0.005);
  EXPECT_NEAR(beyond_one / double{kDraws}, 0.317311, 0.0024);
  EXPECT_NEAR(beyond_three / double{kDraws}, 0.0026998, 0.00026);
  EXPECT_NEAR(beyond_tail / double{kDraws}, 0.00031822, 0.00009);  // beyond the last layer: the tail's own algorithm
}

TEST(Noise, StreamsAndSeedsDiffer) {
  Noise a(1, 0), b(1, 1), c(2, 0), again(1, 0);
  double ab = 0.0, ac = 0.0;
  for (int n = 0; n < 100000; ++n) {
    const double x = a.gaussian();
    ab += x * b.gaussian();
    ac += x * c.gaussian();
    ASSERT_EQ(x, again.gaussian());
  }
  EXPECT_NEAR(ab / 100000, 0.0, 0.016);  // five standard errors of a correlation
  EXPECT_NEAR(ac / 100000, 0.0, 0.016);
}

TEST(Noise, BytesAreThoseOfTheGenerator) {
  // The same on every machine and compiler: these values are part of the contract of a seed.
  Noise raw(1, 0);
  EXPECT_EQ(raw.bits(), 0x309714ec38d33b4cu);
  EXPECT_EQ(raw.bits(), 0x1bc11473d28024a0u);
  Noise noise(1, 0);
  EXPECT_EQ(noise.gaussian(), 0x1.0a9563d87a5c4p-1);
  EXPECT_EQ(noise.gaussian(), 0x1.c18a3a5dfadc9p-2);
  EXPECT_EQ(noise.gaussian(), -0x1.877a08200592ep+0);
}

}  // namespace
}  // namespace stillspin::plant
