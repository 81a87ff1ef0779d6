// Limit of the braking current against the same in double precision, and the energy it lets into a DC link.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/brake_limit.h"
}

namespace {

using namespace stillspin::test;

double limit(double link, double emf, double current = 14.0) {
  const brake_limit_input_t in = {raw(link, 16), raw(405.0, 16), raw(420.0, 16), raw(emf, 16), raw(5.0, 16)};
  return real(brake_limit_q20(&in, raw(current, 20)), 20);
}

TEST(BrakeLimit, FallsLinearlyBetweenTheVoltages) {
  EXPECT_EQ(limit(300.0, 100.0), 14.0);
  EXPECT_EQ(limit(405.0, 100.0), 14.0);
  EXPECT_NEAR(limit(408.0, 100.0), 14.0 * 0.8, 1e-5);
  EXPECT_NEAR(limit(417.0, 100.0), 14.0 * 0.2, 1e-5);
  EXPECT_EQ(limit(420.0, 100.0), 0.0);
  EXPECT_EQ(limit(1900.0, 100.0), 0.0);
}

TEST(BrakeLimit, LeavesAStandingShaftItsTorque) {
  for (const double link : {300.0, 410.0, 420.0, 450.0}) {
    EXPECT_EQ(limit(link, 0.0), 14.0) << link;
    EXPECT_EQ(limit(link, 2.5), 14.0) << link;
  }
  EXPECT_NEAR(limit(450.0, 3.75), 7.0, 1e-3);
  EXPECT_EQ(limit(450.0, 5.0), 0.0);
}

TEST(BrakeLimit, MatchesDoublePrecision) {
  Random random(7);
  for (int n = 0; n < 20000; ++n) {
    const double link = random.between(380.0, 440.0);
    const double emf = random.between(0.0, 8.0);
    const double current = random.between(0.0, 16.0);
    const double full = std::clamp((link - 405.0) / 15.0, 0.0, 1.0);
    const double returns = std::clamp((emf - 2.5) / 2.5, 0.0, 1.0);
    ASSERT_NEAR(limit(link, emf, current), current * (1.0 - full * returns), 1e-3) << link << ", " << emf;
  }
}

// A heavy shaft at 1500 rpm that is to be braked at full current, on a link that nothing discharges.
TEST(BrakeLimit, HoldsTheLinkBelowItsMaximum) {
  const Motor motor;
  double link = 300.0, speed = motor.electrical(1500.0), highest = 0.0, measured = 300.0;
  for (int n = 0; n < 20000; ++n) {
    measured += (link - measured) / 8.0;
    const double i = limit(measured, speed * motor.flux);
    const double power = 1.5 * i * (speed * motor.flux - motor.rs * i);
    link += kPeriod * power / (2e-3 * link);
    highest = std::max(highest, link);
    speed = std::max(0.0, speed - kPeriod * motor.pole_pairs * motor.torque_constant() * i / 0.03);
  }
  EXPECT_GT(highest, 405.0);
  EXPECT_LT(highest, 420.0);
}

}  // namespace
