// Polarity by saturation, with regressions of the test's own: what is made of them to the digit, and where each of the
// ends lies.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/control/quantities.hpp"

extern "C" {
#include "estimators/saturation.h"
}

namespace {

using namespace stillspin::test;

constexpr double kAmps = 10.0;
constexpr double kSpread = 40000.0;  // V^2 of a period's vectors

struct Of {
  int segment, round, period;  // of the pattern, of the segment, of the round
  int sign;                    // of the current
};

class SaturationExact : public testing::Test {
 protected:
  /// What an inverse inductance changes by from -10 A to 10 A, for slopes per ampere.
  static double expected(int y_q30, double slope) { return -2.0 * kAmps * slope * real(y_q30, 30); }
  /// The mean of both inverse inductances that does not average out.
  double floor() const { return (real(model.yd_q30, 30) + real(model.yq_q30, 30)) / 2.0 / 650.0; }

  void begin(double slope_d, double slope_q) {
    const saturation_slopes_t slopes = {raw(slope_d, 30), raw(slope_q, 30)};
    saturation_begin(&s, &model, &slopes, raw(kAmps, 20));
  }
  /// One pattern; `seen` says what the inverse inductances differ by from the model's in a period.
  template <class Seen>
  void pass(Seen seen) {
    constexpr int kSigns[] = {1, -1, -1, 1};
    for (int n = 0; n < SATURATION_LENGTH; ++n) {
      EXPECT_EQ(s.result, POLARITY_PENDING);
      const int segment = n / SATURATION_SEGMENT, inside = n % SATURATION_SEGMENT - SATURATION_SETTLE;
      regression_t r = {};
      r.information = 1;
      r.spread_q8 = raw(kSpread, 8);
      if (inside >= 0) {
        const Vector y = seen(Of{segment, inside / SATURATION_ROUND, inside % SATURATION_ROUND, kSigns[segment]}, r);
        r.along_q16 = raw(0.5 * (y.x + y.y) * kSpread, 16);
        r.mirror_q16 = raw(0.5 * (y.x - y.y) * kSpread, 16);
      }
      (void)saturation_step(&s, &r, &model);
    }
  }
  /// One in which they change by a share of what these slopes let expect.
  void pass_of(double share, double slope_d, double slope_q) {
    const Vector half = {0.5 * share * expected(model.yd_q30, slope_d), 0.5 * share * expected(model.yq_q30, slope_q)};
    pass([&](const Of& at, regression_t&) { return half * at.sign; });
  }
  double score() const { return real(s.score_q15, 15); }

  const machine_model_t model = model_of(Motor{});
  saturation_t s{};
};

// Whichever axis saturates, the score is the change over what was expected of it.
TEST_F(SaturationExact, TheScoreIsTheShareOfTheExpectation) {
  for (const Vector slope : {Vector{-0.004, 0.0}, Vector{0.0, 0.004}, Vector{-0.003, 0.005}, Vector{0.002, -0.002}}) {
    for (const double share : {1.0, -1.0, 0.5, -1.9}) {
      begin(slope.x, slope.y);
      EXPECT_NEAR(real(s.expected_q30, 30),
                  std::hypot(expected(model.yd_q30, slope.x), expected(model.yq_q30, slope.y)), 1e-7);
      pass_of(share, slope.x, slope.y);
      EXPECT_NEAR(score(), share, 1e-3) << slope.x << ", " << slope.y;
      EXPECT_EQ(s.result, share > 0.0 ? POLARITY_RIGHT : POLARITY_WRONG);
    }
  }
}

// What changes across the direction that is looked along does not count.
TEST_F(SaturationExact, AChangeAcrossTheExpectationIsNone) {
  begin(-0.004, 0.0);
  pass_of(1.0, 0.0, 0.004);
  EXPECT_NEAR(score(), 0.0, 1e-3);
  EXPECT_EQ(s.result, POLARITY_AMBIGUOUS);
}

TEST_F(SaturationExact, ItsScoreIsFromThirtyFivePercentToTwo) {
  for (const double share : {0.345, 0.355, 1.97, 2.03}) {
    for (const double sign : {1.0, -1.0}) {
      begin(-0.004, 0.003);
      pass_of(sign * share, -0.004, 0.003);
      const bool fits = share > 0.35 && share < 2.0;
      const polarity_result_t told = sign > 0.0 ? POLARITY_RIGHT : POLARITY_WRONG;
      EXPECT_EQ(s.result, fits ? told : POLARITY_AMBIGUOUS) << sign * share;
    }
  }
}

// Without any scatter the floor is all of the error, and five times that is enough.
TEST_F(SaturationExact, FiveErrorsAreClear) {
  const double slope = 8.0 * floor() / (2.0 * kAmps * real(model.yq_q30, 30));
  for (const double errors : {4.985, 5.01}) {
    begin(0.0, slope);
    EXPECT_NEAR(real(s.floor_q30, 30) / floor(), 1.0, 5e-4);
    pass_of(errors / 8.0, 0.0, slope);
    EXPECT_NEAR(real(s.sigma_q8, 8), errors, 0.01);
    EXPECT_EQ(s.result, errors > 5.0 ? POLARITY_RIGHT : POLARITY_AMBIGUOUS) << errors;
  }
}

// No inductance is taken to change by more than half.
TEST_F(SaturationExact, HalfOfAnInductanceIsTheMostThatIsExpected) {
  for (const double share : {0.48, 0.52, -0.48, -0.52}) {
    const double most = std::fmin(std::fabs(share), 0.5);
    begin(share / (2.0 * kAmps), 0.0);
    EXPECT_NEAR(real(s.expected_q30, 30) / real(model.yd_q30, 30), most, 1e-4);
    EXPECT_NEAR(real(s.unit_d_q30, 30), share > 0.0 ? -1.0 : 1.0, 1e-4);
    begin(0.0, share / (2.0 * kAmps));
    EXPECT_NEAR(real(s.expected_q30, 30) / real(model.yq_q30, 30), most, 1e-4);
    EXPECT_NEAR(real(s.unit_q_q30, 30), share > 0.0 ? -1.0 : 1.0, 1e-4);
  }
}

// Rounds that differ by turns: five differences in each of the four segments, none between segments. One beyond a
// quarter of an ampere per volt counts as that.
TEST_F(SaturationExact, TheScatterIsThatOfNeighbouringRounds) {
  for (const double apart : {0.001, 0.23, 0.24, 0.3}) {
    begin(0.0, 0.004);
    pass([&](const Of& at, regression_t&) { return Vector{0.0, at.round % 2 == 0 ? 0.5 * apart : -0.5 * apart}; });
    const double counts = std::fmin(apart, 0.25);
    EXPECT_NEAR(std::ldexp(static_cast<double>(s.scatter), -60) / (20.0 * counts * counts), 1.0, 1e-3) << apart;
    EXPECT_NEAR(real(s.change_q30, 30), 0.0, 1e-6);
  }
}

// A period without information takes the round before for granted, and tells nothing of the resistance.
TEST_F(SaturationExact, APeriodThatSaysNothingChangesNothing) {
  begin(0.0, 0.004);
  const double half = 0.5 * expected(model.yq_q30, 0.004), missing = 0.01;
  pass([&](const Of& at, regression_t& r) {
    r.mean_q20.d = raw(at.sign * missing, 20);
    if (at.round == 0 || at.period == at.round) return Vector{0.0, half * at.sign};
    r.information = 0;
    r.mean_q20.d = raw(1.0, 20);
    return Vector{0.1, 0.1};
  });
  EXPECT_NEAR(score(), 1.0, 1e-3);
  EXPECT_NEAR(real(saturation_resistance_q24(&s, &model), 24), -missing / real(model.yd_q30, 30) / kAmps, 1e-4);
}

// Another pass has the pattern from its beginning, and no answer until its end.
TEST_F(SaturationExact, AnotherPassBeginsAnew) {
  begin(0.0, 0.004);
  pass_of(1.0, 0.0, 0.004);
  EXPECT_EQ(s.result, POLARITY_RIGHT);
  EXPECT_EQ(s.passes, 1);
  saturation_again(&s);
  EXPECT_EQ(s.result, POLARITY_PENDING);
  EXPECT_EQ(s.tick, 0);
  pass_of(0.5, 0.0, 0.004);
  EXPECT_EQ(s.passes, 2);
  EXPECT_NEAR(score(), 0.75, 1e-3) << "the mean of both";
}

}  // namespace
