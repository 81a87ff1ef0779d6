// The PI block and the ramp against the same recursions in double precision.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/pi.h"
#include "control/ramp.h"
}

namespace {

using stillspin::test::Random;
using stillspin::test::raw;
using stillspin::test::real;

// Current error Q20 in, voltage Q16 out; gains of the law u = Kp e + I, I += Ki e.
constexpr pi_config_t config(double kp, double ki, double release) {
  return {static_cast<std::int32_t>(kp * 1048576.0), static_cast<std::int32_t>(ki / kp * 4294967296.0),
          static_cast<std::int32_t>(release * 1048576.0)};
}

TEST(Pi, FollowsTheDoublePrecisionRecursion) {
  Random random(20);
  const pi_config_t c = config(8.82, 0.0576, 0.026);
  const double kp = real(c.kp_q20, 20), ki = kp * real(c.corner_q32, 32), release = real(c.release_q20, 20);
  pi_state_t s;
  pi_reset(&s);
  double integral = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const double error = random.between(-5.0, 5.0);
    const double fed = random.between(-300.0, 300.0);
    const std::int32_t out = pi_step(&s, &c, raw(error, 20), raw(fed, 16), 30u);
    integral += ki * error;
    // The integral has 20 fractional bits: a step loses half of one, what is taken off every third time gains one half.
    // The output loses half a bit of Q16.
    ASSERT_NEAR(real(out, 16), kp * error + integral + fed, n * 0.5 / 1048576 + 3.0 / 65536) << n;
    const double excess = (n % 3 == 0) ? random.between(-20.0, 20.0) : 0.0;
    pi_limited(&s, &c, raw(excess, 16));
    integral -= release * excess;
  }
}

TEST(Pi, SaturatesInsteadOfWrapping) {
  const pi_config_t c = config(2000.0, 900.0, 1.0);
  pi_state_t s;
  pi_reset(&s);
  for (int n = 0; n < 1000; ++n) ASSERT_GT(pi_step(&s, &c, raw(1900.0, 20), 0, 30u), 0);
  EXPECT_NEAR(real(s.integral_q20, 20), 1024.0, 1e-5);
  EXPECT_NEAR(real(pi_step(&s, &c, raw(1900.0, 20), INT32_MAX, 28u), 16), 4096.0, 2e-5);
  for (int n = 0; n < 1000; ++n) pi_limited(&s, &c, INT32_MIN);
  ASSERT_GT(s.integral_q20, 0);
  for (int n = 0; n < 1000; ++n) ASSERT_LT(pi_step(&s, &c, raw(-1900.0, 20), 0, 30u), 0);
  EXPECT_NEAR(real(s.integral_q20, 20), -1024.0, 1e-5);
}

// What a step rounds down is made up for by an error that stays: 0.5e-6 V / (c Kp), of either sign of what flows beside
// it. Gains of 0.05 mH at 1800 rad/s.
TEST(Pi, WhatTheIntegratorLosesIsHardlyACurrent) {
  const double kp = 0.09, c = 0.045, lost = 0.5 / 1048576 / (c * kp);
  EXPECT_LT(lost, 0.12e-3);
  const pi_config_t gains = config(kp, c * kp, 0.18);
  for (const double more : {0.5, 1.5}) {
    Random random(21);
    pi_state_t s;
    pi_reset(&s);
    for (int n = 0; n < 400000; ++n)
      (void)pi_step(&s, &gains, raw(more * lost + random.between(-0.01, 0.01), 20), 0, 30u);
    EXPECT_EQ(s.integral_q20 > 0, more > 1.0) << more << ": " << s.integral_q20;
  }
}

// The integrator must move towards the value with which the output would have been the realised one.
TEST(Pi, ReleasesTowardsTheRealisedOutput) {
  const pi_config_t c = config(10.0, 0.05, 0.02);
  pi_state_t s;
  pi_reset(&s);
  const double limit = 50.0;
  double largest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const double out = real(pi_step(&s, &c, raw(2.0, 20), 0, 30u), 16);
    if (out > limit) pi_limited(&s, &c, raw(out - limit, 16));
    largest = std::max(largest, out);
  }
  // settles where ki e = release (out - limit): 5 V over the limit. Without release it would have reached 2000 V.
  EXPECT_NEAR(largest, limit + 0.05 * 2.0 / 0.02, 0.2);
}

TEST(Ramp, MovesAtItsRateStopsAtTheTargetAndTellsItsStep) {
  ramp_t r = {0, 0, 0};
  std::int32_t expected = 0;
  for (const std::int32_t target : {1000, -700, 123}) {
    for (int n = 0; n < 100; ++n) {
      const std::int32_t before = expected;
      expected += std::max(-37, std::min(37, target - expected));
      ASSERT_EQ(ramp_step(&r, target, 37), expected);
      ASSERT_EQ(r.step, expected - before);
    }
    ASSERT_EQ(expected, target);
  }
}

TEST(Ramp, RateZeroJumps) {
  ramp_t r = {5, 5, 0};
  EXPECT_EQ(ramp_step(&r, -400, 0), -400);
  EXPECT_EQ(r.step, 0);
}

TEST(Ramp, TargetsThatMoveByThemselvesHaveASlope) {
  ramp_t r = {0, 0, 0};
  const struct {
    std::int32_t target, step;
  } calls[] = {{0, 0},     {300, 0}, {300, 0},  {290, 0}, {270, -10}, {255, -15},
               {240, -15}, {250, 0}, {270, 10}, {270, 0}, {280, 0},   {-290, 0}};
  for (const auto& [target, step] : calls) {
    EXPECT_EQ(ramp_step(&r, target, 0), target);
    EXPECT_EQ(r.step, step) << target;
  }
}

TEST(Ramp, CrossesTheWholeRangeWithoutWrapping) {
  ramp_t r = {INT32_MIN, 0, 0};
  std::int64_t last = INT32_MIN;
  for (int n = 0; n < 50; ++n) {
    const std::int32_t now = ramp_step(&r, INT32_MAX, 100000000);
    ASSERT_GE(now, last);
    last = now;
  }
  EXPECT_EQ(last, INT32_MAX);
}

}  // namespace
