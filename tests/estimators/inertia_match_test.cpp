// Inertia from run-ups, against a shaft in double precision.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimators/machine.hpp"

extern "C" {
#include "estimators/inertia_match.h"
}

namespace {

using namespace stillspin::test;

constexpr int kPeriods = 10;          // of a millisecond
constexpr double kRpm = 28633.0;      // bpp, four pole pairs
constexpr double kFull = 2.4 * kRpm;  // acceleration of the largest torque as the model has it, bpp per period
constexpr double kOne = 16777216.0;

/// A shaft whose acceleration per torque is `truth` times the model's. The angle is seen with `seen_off` degrees of
/// error that grow with the torque.
class Shaft {
 public:
  explicit Shaft(double truth, double seen_off = 0.0) : truth_(truth), off_(seen_off) { inertia_match_reset(&s); }

  /// A simple speed control that knows the load, limited to the largest torque; load as an acceleration.
  void run(int ms, double reference, double load = 0.0) {
    for (int n = 0; n < ms; ++n) {
      const double ratio = s.ratio_q24 / kOne;
      const double wanted = (reference - speed_) / 70.0 + load;
      const double given = std::fmin(std::fmax(wanted, -limit * truth_), limit * truth_);
      const double told = given / truth_ * ratio;  // as the model in use has it
      for (int k = 0; k < kPeriods; ++k) {
        inertia_match_add(&s, raw(told, 8));
        speed_ += given - load;
        angle_ += speed_;
      }
      inertia_seen_t in = {};
      in.angle_bam = static_cast<std::uint32_t>(static_cast<std::int64_t>(angle_ + off_ * 11930464.7 * given / kFull));
      in.speed_bpp = static_cast<std::int32_t>(speed_);
      in.reference_bpp = static_cast<std::int32_t>(reference);
      in.torque_accel_q8 = raw(told, 8);
      in.least_accel_q8 = raw(0.3 * kFull * ratio, 8);
      in.still_bpp = static_cast<std::int32_t>(20.0 * kRpm);
      (void)inertia_match_step(&s, &in, kPeriods);
    }
  }
  double ratio() const { return s.ratio_q24 / kOne; }
  double speed() const { return speed_; }

  inertia_match_t s{};
  double limit = kFull;  // of the torque, as the model's acceleration

 private:
  double truth_, off_;
  double speed_ = 0.0, angle_ = 1e9;
};

TEST(InertiaMatch, OneRunUpTells) {
  for (const double truth : {0.5, 0.7, 1.4, 2.0}) {
    for (const double rpm : {600.0, -600.0, 2000.0}) {
      Shaft shaft(truth);
      shaft.run(50, 0.0);
      shaft.run(400, rpm * kRpm);
      EXPECT_NEAR(shaft.ratio(), truth, 0.04 * truth) << rpm;
    }
  }
}

TEST(InertiaMatch, ItIsKnownBeforeTheSpeedIsReached) {
  Shaft shaft(0.5);
  shaft.run(50, 0.0);
  shaft.run(30, 600.0 * kRpm);  // half of the way
  EXPECT_NEAR(shaft.ratio(), 0.5, 0.03);
}

// Three degrees of a quarter turn; a whole turn tells better.
TEST(InertiaMatch, AnAngleThatIsOffTurnsItByItsShare) {
  Shaft shaft(0.5, -4.0);
  shaft.run(50, 0.0);
  shaft.run(400, 1500.0 * kRpm);
  EXPECT_NEAR(shaft.ratio(), 0.5, 0.5 / 16.0);
}

TEST(InertiaMatch, ARightModelStaysAsItIs) {
  Shaft shaft(1.03);
  shaft.run(50, 0.0);
  for (const double rpm : {600.0, -600.0, 2000.0, 0.0}) shaft.run(400, rpm * kRpm);
  EXPECT_EQ(shaft.s.ratio_q24, INERTIA_SAME_Q24);
}

// 5 N m of 13 with the reference at rest: torque and motion, but no reason known beforehand.
TEST(InertiaMatch, ALoadStepIsNoInertia) {
  Shaft shaft(1.0);
  shaft.run(50, 600.0 * kRpm);
  shaft.run(300, 600.0 * kRpm);
  shaft.run(300, 600.0 * kRpm, 0.4 * kFull);
  shaft.run(300, 600.0 * kRpm, 0.0);
  EXPECT_EQ(shaft.s.ratio_q24, INERTIA_SAME_Q24);
}

TEST(InertiaMatch, ALoadThatComesWithTheRunUpIsTakenBack) {
  Shaft shaft(1.0);
  shaft.run(50, 0.0);
  shaft.run(60, 600.0 * kRpm, 0.4 * kFull);
  EXPECT_LT(shaft.ratio(), 0.75);  // it does look like it
  shaft.run(400, 600.0 * kRpm, 0.4 * kFull);
  EXPECT_NEAR(shaft.ratio(), 1.0, 1e-3);
}

TEST(InertiaMatch, ALoadThatWasThereBeforeDoesNotMatter) {
  Shaft shaft(0.5);
  shaft.run(300, 0.0, 0.2 * kFull);
  shaft.run(500, 600.0 * kRpm, 0.2 * kFull);
  EXPECT_NEAR(shaft.ratio(), 0.5, 0.03);
}

TEST(InertiaMatch, StaysWithinItsBounds) {
  for (const double truth : {0.2, 4.0}) {
    Shaft shaft(truth);
    shaft.run(50, 0.0);
    shaft.run(800, 600.0 * kRpm);
    EXPECT_NEAR(shaft.ratio(), truth < 1.0 ? 0.375 : 2.5, 1e-3);
  }
}

// A shaft that a load holds fast turns not at all: the run-up is given up, and nothing is learnt of it.
TEST(InertiaMatch, ARunUpThatDoesNotEndIsGivenUp) {
  Shaft shaft(1.0);
  shaft.run(50, 0.0);
  shaft.run(1, 3000.0 * kRpm);
  EXPECT_EQ(shaft.s.phase, INERTIA_RUN_UP);
  shaft.run(9000, 3000.0 * kRpm, kFull);
  EXPECT_NE(shaft.s.phase, INERTIA_RUN_UP);
  EXPECT_EQ(shaft.s.ratio_q24, INERTIA_SAME_Q24);
}

// The same with a fifteenth of the torque, whose share of a turn stays small: then a second is enough.
TEST(InertiaMatch, AWeakRunUpIsGivenUpAfterASecond) {
  Shaft shaft(1.0);
  shaft.run(50, 0.0);
  shaft.limit = kFull / 15.0;
  shaft.run(1001, 3000.0 * kRpm, shaft.limit);
  EXPECT_EQ(shaft.s.phase, INERTIA_RUN_UP);
  shaft.run(1, 3000.0 * kRpm, shaft.limit);
  EXPECT_EQ(shaft.s.phase, INERTIA_SETTLE);
  EXPECT_EQ(shaft.s.ratio_q24, INERTIA_SAME_Q24);
}

// After sixteen turns nothing is left to be judged, however far the speed still is.
TEST(InertiaMatch, TheLastJudgementEndsTheRunUp) {
  Shaft shaft(1.0);
  shaft.run(50, 0.0);
  shaft.run(165, 6500.0 * kRpm);
  EXPECT_EQ(shaft.s.phase, INERTIA_SETTLE);
  EXPECT_LT(shaft.speed(), 4500.0 * kRpm);
  EXPECT_LT(shaft.s.turned, 32 * INERTIA_SAME_Q24) << "64 turns would end it as well";
}

// A shaft that turns against the torque is driven by something else.
TEST(InertiaMatch, ATurnAgainstTheTorqueIsNoInertia) {
  Shaft shaft(1.0);
  shaft.run(50, 0.0);
  shaft.run(300, 600.0 * kRpm, 1.5 * kFull);
  EXPECT_EQ(shaft.s.ratio_q24, INERTIA_SAME_Q24);
}

// Driven so hard that it turns 64 times backward while the torque alone would have turned it less.
TEST(InertiaMatch, ATurnAgainstTheTorqueEndsTheRunUp) {
  Shaft shaft(1.0);
  shaft.run(50, 0.0);
  shaft.limit = kFull / 2.0;
  int ms = 0;
  do shaft.run(1, 600.0 * kRpm, 2.5 * shaft.limit);
  while (shaft.s.phase == INERTIA_RUN_UP && ++ms < 1000);
  EXPECT_EQ(shaft.s.phase, INERTIA_SETTLE);
  EXPECT_LT(shaft.s.turned, -64 * INERTIA_SAME_Q24);
  EXPECT_LT(shaft.s.expected, 64 * INERTIA_SAME_Q24);
  EXPECT_EQ(shaft.s.ratio_q24, INERTIA_SAME_Q24);
}

// A run-up counts when the reference had been reached, and at rest, for 20 ms.
TEST(InertiaMatch, ARunUpNeedsARestBefore) {
  for (const int ms : {19, 20}) {
    Shaft shaft(1.0);
    shaft.run(200, 0.0);
    shaft.s.quiet_ms = 0;
    shaft.run(ms, 0.0);
    shaft.run(1, 600.0 * kRpm);
    EXPECT_EQ(shaft.s.phase == INERTIA_RUN_UP, ms >= 20) << ms;
  }
}

}  // namespace
