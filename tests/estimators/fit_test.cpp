// Quotients and fits in integers against the same in double precision.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

extern "C" {
#include "estimators/fit.h"
}

namespace {

TEST(FitRatio, IsTheQuotientRoundedToItsFormat) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> bits(1, 60);
  for (int n = 0; n < 20000; ++n) {
    const auto size = [&] { return static_cast<std::int64_t>(random() >> (64 - bits(random))) + 1; };
    const std::int64_t numerator = (n % 2 == 0 ? 1 : -1) * size();
    const std::int64_t denominator = (n % 3 == 0 ? -1 : 1) * size();
    for (const std::int16_t shift : {-31, -8, 0, 16, 30, 45, 62}) {
      const double exact = std::ldexp(static_cast<double>(numerator) / static_cast<double>(denominator), shift);
      if (std::fabs(exact) > 2147483647.0) continue;
      // half an LSB of rounding, and mantissas of 30 bits at least
      const double tolerance = 0.5 + std::fabs(exact) * std::ldexp(1.0, -29);
      ASSERT_NEAR(fit_ratio(numerator, denominator, shift), exact, tolerance) << numerator << " / " << denominator;
    }
  }
}

TEST(FitRatio, RoundsAHalfAwayFromZero) {
  EXPECT_EQ(fit_ratio(1, 2, 0), 1);
  EXPECT_EQ(fit_ratio(-3, 2, 0), -2);
  EXPECT_EQ(fit_ratio(-1, 2, 0), -1);
  EXPECT_EQ(fit_ratio(49, 100, 0), 0);
  EXPECT_EQ(fit_ratio(100, -3000, 0), 0);
}

TEST(FitRatio, SaturatesWithTheSign) {
  EXPECT_EQ(fit_ratio(1LL << 60, 1, 0), INT32_MAX);
  EXPECT_EQ(fit_ratio(-(1LL << 60), 1, 0), INT32_MIN);
  EXPECT_EQ(fit_ratio(-(1LL << 32), 1, 0), INT32_MIN);
  EXPECT_EQ(fit_ratio(5, 0, 0), INT32_MAX);
  EXPECT_EQ(fit_ratio(0, 0, 0), 0);
  EXPECT_EQ(fit_ratio(1, 1LL << 60, 0), 0);
}

// A line with an offset that follows the sign, as on the staircase: currents and volts in Q20.
struct Points {
  std::int32_t x[14], f[14], y[14];
};

Points staircase(double slope, double offset, double noise) {
  Points p{};
  std::mt19937 random(7);
  std::normal_distribution<double> error(0.0, 1.0);
  for (int k = 0; k < 14; ++k) {
    const double sign = k < 7 ? 1.0 : -1.0;
    const double current = sign * (5.6 + 1.4 * (k % 7));
    p.x[k] = static_cast<std::int32_t>(std::lround(current * 1048576.0));
    p.f[k] = static_cast<std::int32_t>(std::lround(sign * 4.0 / 3.0 * 1048576.0));
    p.y[k] = static_cast<std::int32_t>(
        std::lround((slope * current + offset * sign * 4.0 / 3.0 + noise * error(random)) * 1048576.0));
  }
  return p;
}

TEST(FitPlane, FindsSlopeAndOffset) {
  const Points p = staircase(0.387, 0.05, 0.0);
  fit_plane_t fit;
  ASSERT_TRUE(fit_plane(p.x, p.f, p.y, 14, &fit));
  EXPECT_NEAR(std::ldexp(fit.slope_q24, -24), 0.387, 1e-6);  // LSBs of 1e-6 A and V
  EXPECT_NEAR(std::ldexp(fit.offset_q24, -24), 0.05, 5e-6);
  EXPECT_LT(fit.rms, 8);
}

TEST(FitPlane, TellsWhatItLeavesOver) {
  const Points p = staircase(0.387, 0.05, 0.1);
  fit_plane_t fit;
  ASSERT_TRUE(fit_plane(p.x, p.f, p.y, 14, &fit));
  // 14 points less two parameters of 0.1 V; half as much and half as much again are four sigma and more
  const double rms = std::ldexp(fit.rms, -20);
  EXPECT_GT(rms, 0.05);
  EXPECT_LT(rms, 0.15);
}

// Levels over the upper eighth of a current tell slope and offset apart, over a fiftieth they do not.
TEST(FitPlane, TakesALineOverAnEighthOfTheCurrent) {
  for (const auto& [share, told] : {std::pair{0.125, true}, {0.02, false}}) {
    Points p = staircase(0.387, 0.05, 0.0);
    for (int k = 0; k < 14; ++k) {
      const double current = 20.0 * (1.0 - share * k / 13.0);
      p.x[k] = static_cast<std::int32_t>(std::lround(current * 1048576.0));
      p.f[k] = static_cast<std::int32_t>(std::lround(4.0 / 3.0 * 1048576.0));
      p.y[k] = static_cast<std::int32_t>(std::lround((0.387 * current + 0.05 * 4.0 / 3.0) * 1048576.0));
    }
    fit_plane_t fit;
    ASSERT_EQ(fit_plane(p.x, p.f, p.y, 14, &fit), told) << share;
    if (!told) continue;
    EXPECT_NEAR(std::ldexp(fit.slope_q24, -24), 0.387, 1e-4);
    EXPECT_NEAR(std::ldexp(fit.offset_q24, -24), 0.05, 2e-3);
  }
}

TEST(FitPlane, RefusesRegressorsThatAreOne) {
  Points p = staircase(0.387, 0.05, 0.0);
  for (int k = 0; k < 14; ++k) p.x[k] = p.f[k] * 6;
  fit_plane_t fit;
  EXPECT_FALSE(fit_plane(p.x, p.f, p.y, 14, &fit));
}

TEST(FitPlane, RefusesARegressorOfNothing) {
  Points p = staircase(0.387, 0.05, 0.0);
  for (int k = 0; k < 14; ++k) p.x[k] = 0;
  fit_plane_t fit;
  EXPECT_FALSE(fit_plane(p.x, p.f, p.y, 14, &fit));
}

}  // namespace
