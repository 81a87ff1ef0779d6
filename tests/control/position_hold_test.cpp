// Position hold closed on a shaft that follows the speed it is asked for, plus an error of the estimated speed.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/position_hold.h"
}

namespace stillspin::test {
namespace {

constexpr double kGain = 5.0;   // 1/s
constexpr double kStep = 1e-3;  // s between steps

std::int32_t gain_q30(double k) { return raw(k * kPeriod, 30); }

struct Shaft {
  position_hold_t hold = {};
  double angle = 0.0;  // rad, electrical

  /// Steps with an error of the speed, rad/s; returns the speed that was asked for last.
  double run(double seconds, double error, double k = kGain) {
    double asked = 0.0;
    for (int n = 0; n < std::lround(seconds / kStep); n++) {
      asked = rad_per_s(position_hold_step(&hold, bam(angle), gain_q30(k)));
      angle += (asked + error) * kStep;
    }
    return asked;
  }
};

TEST(PositionHold, AConstantErrorOfTheSpeedTurnsTheShaftByTheErrorOverTheGain) {
  for (const double start : {0.0, 3.1, -3.1}) {
    for (const double error : {0.4, -0.4}) {
      Shaft s;
      s.angle = start;
      s.run(4.0, error);
      EXPECT_NEAR(s.angle - start, error / kGain, 2e-3);
      s.run(4.0, 0.0);
      EXPECT_NEAR(s.angle, start, 1e-3);
    }
  }
}

TEST(PositionHold, ADisplacementGoesBackWithTheTimeConstant) {
  Shaft s;
  s.run(0.01, 0.0);
  s.angle = 1.5;
  s.run(1.0 / kGain, 0.0);
  EXPECT_NEAR(s.angle, 1.5 * std::exp(-1.0), 0.01);
}

TEST(PositionHold, WithoutGainNothingIsAsked) {
  Shaft s;
  EXPECT_EQ(s.run(0.5, 1.0, 0.0), 0.0);
  EXPECT_NEAR(s.angle, 0.5, 1e-9);
}

TEST(PositionHold, BeyondHalfATurnThePlaceIsDraggedAlong) {
  Shaft s;
  s.run(0.01, 0.0);
  for (int n = 0; n < 300; n++) {  // dragged by three turns, whatever is asked
    s.angle += kTurn / 100.0;
    const double asked = rad_per_s(position_hold_step(&s.hold, bam(s.angle), gain_q30(kGain)));
    EXPECT_LE(std::abs(asked), kGain * kTurn / 2.0 * 1.001);
  }
  s.run(4.0, 0.0);
  EXPECT_NEAR(s.angle, 2.5 * kTurn, 0.01);
}

TEST(PositionHold, ANewPlaceIsTakenAfterARelease) {
  Shaft s;
  s.run(0.01, 0.0);
  position_hold_release(&s.hold);
  s.angle = 2.0;
  EXPECT_EQ(s.run(0.1, 0.0), 0.0);
  EXPECT_EQ(s.angle, 2.0);
}

TEST(PositionHold, ADisplacementIsForgottenWithTheRelease) {
  Shaft s;
  s.run(0.01, 0.0);
  s.angle = 1.0;
  EXPECT_LT(s.run(0.001, 0.0), -1.0);
  position_hold_release(&s.hold);
  EXPECT_EQ(s.run(0.001, 0.0), 0.0);
}

TEST(PositionHold, NothingIsLostOfASlowCreepFromStepToStep) {
  Shaft s;
  s.run(0.01, 0.0);
  const double slow = 0.3 * kTurn / 4294967296.0 * 16.0;  // rad: a third of the format's last place
  for (int n = 0; n < 100000; n++) {
    s.angle += slow;
    position_hold_step(&s.hold, bam(s.angle), 0);
  }
  EXPECT_NEAR(-real(s.hold.to_turn_q28, 28) * kTurn, 1e5 * slow, 2.0 * slow / 0.3);
}

}  // namespace
}  // namespace stillspin::test
