// Inertia from run-ups, a millisecond at a time: what is judged when, where each end lies, and what a new ratio moves.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "estimators/inertia_match.h"
}

namespace {

using namespace stillspin::test;

constexpr int kPeriods = 10;  // of a millisecond

std::int32_t turns(double number) { return raw(number, 24); }

class InertiaEnds : public testing::Test {
 protected:
  void SetUp() override {
    inertia_match_reset(&s);
    in = {};
    in.still_bpp = 1000;
  }
  /// In a run-up that has begun from rest.
  void run_up() {
    for (int n = 0; n < 30; ++n) (void)step();
    in.reference_bpp += 1000000;
    (void)step();
    ASSERT_EQ(s.phase, INERTIA_RUN_UP);
    s.ms = 99;  // the next is the hundredth
  }
  double step() { return real(inertia_match_step(&s, &in, kPeriods), 24); }
  /// One millisecond in which the shaft turns this far, and should have by the torque.
  double turn(double turned, double expected) {
    in.angle_bam += static_cast<std::uint32_t>(raw(turned, 32));
    s.last_gained_bpp = s.gained_bpp = raw(expected / kPeriods, 32);
    return step();
  }
  double ratio() const { return real(s.ratio_q24, 24); }

  inertia_match_t s{};
  inertia_seen_t in{};
};

TEST_F(InertiaEnds, AQuarterTurnIsJudged) {
  for (const double turned : {0.2499, 0.2501, -0.2499, -0.2501}) {
    SetUp();
    run_up();
    const double factor = turn(turned, turned / 1.5);
    const bool judged = std::fabs(turned) > 0.25;
    EXPECT_NEAR(factor, judged ? 1.5 : 1.0, 1e-3) << turned;
    EXPECT_NEAR(ratio(), factor, 1e-6);
    EXPECT_EQ(s.next, turns(judged ? 1.0 : 0.25)) << "four times as far the next time";
  }
}

TEST_F(InertiaEnds, ASixteenthIsNoDifference) {
  for (const double share : {1.06, 1.065, 0.94, 0.935}) {
    SetUp();
    run_up();
    const bool differs = std::fabs(share - 1.0) > 1.0 / 16.0;
    EXPECT_NEAR(turn(0.3, 0.3 / share), differs ? share : 1.0, 1e-3) << share;
    EXPECT_EQ(s.next, turns(1.0));
  }
}

// What counts is the mean torque since the run-up began.
TEST_F(InertiaEnds, LittleTorqueSaysNothing) {
  for (const double least : {0.99, 1.01}) {
    SetUp();
    run_up();
    const double mean = std::ldexp(0.2, 32) / kPeriods / (100 * kPeriods);
    in.least_accel_q8 = raw(least * mean, 8);
    EXPECT_NEAR(turn(0.3, 0.2), least < 1.0 ? 1.5 : 1.0, 1e-3) << least;
    EXPECT_EQ(s.next, turns(1.0)) << "nor is it asked again before a whole turn";
  }
}

// The torque's part before the change is what the new ratio makes of it.
TEST_F(InertiaEnds, ANewRatioMovesWhatWasIntegrated) {
  run_up();
  s.base_q8 = 2000;
  s.start_base_q8 = 3000;
  const std::int32_t gained = raw(0.2 / kPeriods, 32);
  EXPECT_NEAR(turn(0.4, 0.2), 2.0, 1e-3);
  EXPECT_NEAR(s.base_q8, 4000, 4);
  EXPECT_NEAR(s.start_base_q8, 6000, 6);
  EXPECT_NEAR(s.gained_bpp, 2.0 * gained, 1e-3 * gained);
  EXPECT_EQ(s.last_gained_bpp, s.gained_bpp);
  EXPECT_NEAR(real(s.expected, 24), 0.4, 1e-3);
  EXPECT_NEAR(real(s.mean_q8, 8), 2.0 * gained / (100 * kPeriods), 1e-6 * gained);
}

// From a shaft that turns already, only what comes on top counts.
TEST_F(InertiaEnds, TheTurnOfTheSpeedBeforeIsTakenOff) {
  in.speed_bpp = in.reference_bpp = raw(0.01, 32);
  run_up();
  EXPECT_NEAR(turn(0.01 * kPeriods + 0.3, 0.2), 1.5, 1e-3);
  EXPECT_NEAR(real(s.turned, 24), 0.3, 1e-5);
}

TEST_F(InertiaEnds, TheRunUpEndsWhereTheReferenceIsReached) {
  for (const std::int32_t left : {1000, 999, -999, -1000}) {
    SetUp();
    run_up();
    in.speed_bpp = in.reference_bpp + left;
    (void)step();
    EXPECT_EQ(s.phase, std::abs(left) < 1000 ? INERTIA_SETTLE : INERTIA_RUN_UP) << left;
    EXPECT_EQ(s.ms, std::abs(left) < 1000 ? 0 : 100);
  }
}

TEST_F(InertiaEnds, TheRunUpGoesOnUntilSixteenTurnsAreJudged) {
  run_up();
  s.next = turns(16.0);
  s.turned = s.expected = turns(15.9);
  (void)step();
  EXPECT_EQ(s.phase, INERTIA_RUN_UP);
  EXPECT_EQ(s.next, turns(16.0));
  s.turned = s.expected = turns(16.1);
  (void)step();
  EXPECT_EQ(s.phase, INERTIA_RUN_UP) << "this one is judged";
  (void)step();
  EXPECT_EQ(s.phase, INERTIA_SETTLE);
}

TEST_F(InertiaEnds, SixtyFourTurnsEndTheRunUpWhicheverWay) {
  for (const double end : {63.9, 64.1}) {
    for (const double sign : {1.0, -1.0}) {
      for (const bool seen : {true, false}) {
        SetUp();
        run_up();
        s.turned = seen ? sign * turns(end) : 0;
        s.expected = seen ? -sign * turns(1.0) : sign * turns(end);
        (void)step();
        EXPECT_EQ(s.phase, end > 64.0 ? INERTIA_SETTLE : INERTIA_RUN_UP) << end * sign << seen;
      }
    }
  }
}

// A tenth of a second in the phase, and as long with the reference at rest and reached.
TEST_F(InertiaEnds, ATenthOfASecondSettles) {
  const struct {
    std::uint16_t ms, quiet_ms;
  } cases[] = {{0, 500}, {500, 0}};
  for (const auto& c : cases) {
    SetUp();
    s.phase = INERTIA_SETTLE;
    s.ms = c.ms;
    s.quiet_ms = c.quiet_ms;
    for (int n = 0; n < 99; ++n) (void)step();
    EXPECT_EQ(s.phase, INERTIA_SETTLE) << c.ms;
    (void)step();
    EXPECT_EQ(s.phase, INERTIA_REST) << c.ms;
  }
}

// The load that is balanced afterwards may differ from the one before by a quarter of the run-up's torque.
TEST_F(InertiaEnds, AQuarterOfTheTorqueMoreIsALoadThatCame) {
  for (const double share : {0.24, 0.26, -0.24, -0.26}) {
    for (const int way : {1, -1}) {
      SetUp();
      s.phase = INERTIA_SETTLE;
      s.ms = s.quiet_ms = 200;
      s.ratio_q24 = raw(1.5, 24);
      s.before_q24 = raw(1.0, 24);
      s.mean_q8 = way * raw(4000.0, 8);
      s.start_base_q8 = raw(500.0, 8);
      s.base_q8 = in.torque_accel_q8 = s.start_base_q8 + raw(share * 4000.0, 8);
      const bool came = std::fabs(share) > 0.25;
      EXPECT_NEAR(step(), came ? 1.0 / 1.5 : 1.0, 1e-4) << share;
      EXPECT_NEAR(ratio(), came ? 1.0 : 1.5, 1e-4) << share;
      EXPECT_EQ(s.phase, INERTIA_REST);
    }
  }
}

// The torque at rest is a mean over sixteen milliseconds, of those in which the reference was reached.
TEST_F(InertiaEnds, TheTorqueAtRestIsAMeanOverSixteenMilliseconds) {
  for (const bool reached : {true, false}) {
    SetUp();
    in.speed_bpp = reached ? 999 : 1000;
    in.torque_accel_q8 = raw(1600.0, 8);
    (void)step();
    EXPECT_EQ(s.base_q8, reached ? raw(100.0, 8) : 0);
  }
}

// A rest of more than the 65 s that sixteen bits hold is a rest.
TEST_F(InertiaEnds, ALongRestIsARest) {
  for (int n = 0; n < 65536 + 5; ++n) (void)step();
  in.reference_bpp += 1000000;
  (void)step();
  EXPECT_EQ(s.phase, INERTIA_RUN_UP);
}

}  // namespace
