// Ripple flux against the integral of the pulses, tick by tick in double precision.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/ripple.h"
}

namespace {

using namespace stillspin::test;

/// Integral of (vector - its mean) from the start of the period, V * period, after every tick.
std::vector<Vector> integrated(const svpwm_pulses_t& p, double link) {
  const auto s = states(p);
  const auto vector_of = [&](std::uint16_t state) {
    const double a = state & 1u, b = (state >> 1) & 1u, c = (state >> 2) & 1u;
    return Vector{(2.0 * a - b - c) / 3.0 * link, (b - c) / std::sqrt(3.0) * link};
  };
  Vector mean = {0.0, 0.0};
  for (const std::uint16_t state : s) mean = mean + vector_of(state) * 1e-4;
  std::vector<Vector> flux = {{0.0, 0.0}};
  for (const std::uint16_t state : s) flux.push_back(flux.back() + (vector_of(state) - mean) * 1e-4);
  return flux;
}

TEST(Ripple, IsTheIntegralOfTheVoltageLessItsMean) {
  Random random(110);
  for (int n = 0; n < 60; ++n) {
    const double link = random.between(50.0, 420.0);
    svpwm_pulses_t p;
    for (int leg = 0; leg < 3; ++leg) {
      p.at[leg] = static_cast<std::int16_t>(random.between(260.0, 9600.0));
      p.at[SVPWM_LEGS + leg] = static_cast<std::int16_t>(random.between(p.at[leg] + 1.0, 9960.0));
    }
    const std::vector<Vector> exact = integrated(p, link);
    for (int tick = 0; tick <= 10000; tick += 7) {
      const auto at = static_cast<std::int16_t>(tick);
      const Vector flux = real(svpwm_ripple_q16(&p, &at, 1, raw(link, 16)), 16);
      // Each leg is cut off at two of its units, 1/N of a tick, four of them count; the product at two of 2^-16 V.
      const double tolerance = 8e-4 * link * 1e-4 + 3.1e-5;
      ASSERT_NEAR(flux.x, exact[static_cast<std::size_t>(tick)].x, tolerance) << n << ", " << tick;
      ASSERT_NEAR(flux.y, exact[static_cast<std::size_t>(tick)].y, tolerance) << n << ", " << tick;
    }
    const std::int16_t some[3] = {1400, 5005, 9100};
    const Vector sum = real(svpwm_ripple_q16(&p, some, 3, raw(link, 16)), 16);
    ASSERT_NEAR(sum.x, exact[1400].x + exact[5005].x + exact[9100].x, 8e-4 * link * 1e-4 + 3.1e-5);
    ASSERT_NEAR(sum.y, exact[1400].y + exact[5005].y + exact[9100].y, 8e-4 * link * 1e-4 + 3.1e-5);
    // what lies behind those that are asked for does not count
    const Vector two = real(svpwm_ripple_q16(&p, some, 2, raw(link, 16)), 16);
    ASSERT_NEAR(two.x, exact[1400].x + exact[5005].x, 8e-4 * link * 1e-4 + 3.1e-5);
    ASSERT_NEAR(two.y, exact[1400].y + exact[5005].y, 8e-4 * link * 1e-4 + 3.1e-5);
    const ab_t none = svpwm_ripple_q16(&p, some, 0, raw(link, 16));
    ASSERT_EQ(none.alpha, 0);
    ASSERT_EQ(none.beta, 0);
  }
}

TEST(Ripple, MeanVoltageIsThatOfTheStates) {
  Random random(111);
  for (int n = 0; n < 200; ++n) {
    const double link = random.between(50.0, 420.0);
    svpwm_pulses_t p;
    for (int leg = 0; leg < 3; ++leg) {
      p.at[leg] = static_cast<std::int16_t>(random.between(260.0, 9600.0));
      p.at[SVPWM_LEGS + leg] = static_cast<std::int16_t>(random.between(p.at[leg] + 1.0, 9960.0));
    }
    Vector mean = {0.0, 0.0};
    for (const std::uint16_t state : states(p)) {
      const double a = state & 1u, b = (state >> 1) & 1u, c = (state >> 2) & 1u;
      mean = mean + Vector{(2.0 * a - b - c) / 3.0, (b - c) / std::sqrt(3.0)} * (link * 1e-4);
    }
    const Vector seen = real(svpwm_mean_q16(&p, raw(link, 16)), 16);
    ASSERT_NEAR(seen.x, mean.x, 1e-4) << n;  // Q16 of the link and of the result
    ASSERT_NEAR(seen.y, mean.y, 1e-4) << n;
  }
}

TEST(Ripple, IsZeroAtBothEndsOfThePeriod) {
  const svpwm_pulses_t p = {{260, 5760, 5800, 4500, 9960, 9900}, 0};
  for (const std::int16_t tick : {std::int16_t{0}, std::int16_t{10000}}) {
    const Vector flux = real(svpwm_ripple_q16(&p, &tick, 1, raw(300.0, 16)), 16);
    EXPECT_NEAR(flux.length(), 0.0, 1e-4);
  }
}

}  // namespace
