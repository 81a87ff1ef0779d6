// Cogging: the least-mean-squares fit against the same in double precision, and what it leaves alone.

#include <gtest/gtest.h>

#include "tests/estimators/machine.hpp"

extern "C" {
#include "estimators/cogging.h"
}

namespace {

using namespace stillspin::test;

constexpr std::int32_t kOrder = 6;
constexpr std::int32_t kFast = 400000;     // bpp
constexpr std::int32_t kBound = 20000000;  // Q8
const cogging_config_t kConfig = {kOrder, kFast, kBound};

// The mean takes over an eighth of what it is off and the two amplitudes a quarter, so that what projects onto a wave
// of half its power on average is taken over alike.
struct Fit {
  double mean = 0.0, cosine = 0.0, sine = 0.0, known = 0.0;
  void step(double load, double wave) {
    const double swing = load - mean;
    mean += swing / 8.0;
    known += (1.0 - known) / 8.0;
    cosine += swing * std::cos(wave) / 4.0;
    sine += swing * std::sin(wave) / 4.0;
  }
};

// The observer takes what the wave has learnt off its load, so the load that is left is what is shown here.
TEST(Cogging, LearnsLikeTheSameInDoublePrecision) {
  cogging_t s = {};
  Fit fit;
  double angle = 0.3;
  for (int n = 0; n < 300; ++n) {
    angle += kTurn / kOrder * 0.0651;  // just above a sixteenth of a wave
    const double load = 3e6 + 1e6 * std::cos(kOrder * angle - 0.7) - fit.cosine * std::cos(kOrder * angle) -
                        fit.sine * std::sin(kOrder * angle);
    (void)cogging_load(&s, &kConfig, bam(angle + 0.05), 1000);
    const cogging_seen_t seen = {bam(angle), 1000, static_cast<std::int32_t>(std::lround(load))};
    const double cosine = fit.cosine, sine = fit.sine;
    fit.step(load, kOrder * angle);
    const std::int32_t taken = cogging_learn(&s, &kConfig, &seen);
    // each step rounds four numbers
    ASSERT_NEAR(s.mean_q8, fit.mean, 8.0) << n;
    ASSERT_NEAR(s.cos_q8, fit.cosine, 8.0) << n;
    ASSERT_NEAR(s.sin_q8, fit.sine, 8.0) << n;
    ASSERT_NEAR(real(s.known_q30, 30), fit.known, 1e-7) << n;
    const double at = kOrder * (angle + 0.05);  // what has gone over is of the present angle, not of the load's
    ASSERT_NEAR(taken, (fit.cosine - cosine) * std::cos(at) + (fit.sine - sine) * std::sin(at), 10.0) << n;
  }
  EXPECT_NEAR(s.cos_q8, 1e6 * std::cos(0.7), 1e4);
  EXPECT_NEAR(s.sin_q8, 1e6 * std::sin(0.7), 1e4);
}

TEST(Cogging, TheWaveIsThatOfThePresentAngle) {
  cogging_t s = {};
  s.cos_q8 = 1000000;
  s.sin_q8 = -400000;
  s.order = kOrder;
  for (const double angle : {0.0, 0.2, 1.7, -2.9}) {
    const double expected = 1e6 * std::cos(kOrder * angle) - 4e5 * std::sin(kOrder * angle);
    EXPECT_NEAR(cogging_load(&s, &kConfig, bam(angle), 0), expected, 2.0) << angle;
    EXPECT_NEAR(s.now_q8, expected, 2.0) << angle;
  }
}

// Known up to three times the speed below which it learns, in both directions, and never without an order.
TEST(Cogging, IsTakenIntoAccountUpToThreeTimesItsSpeed) {
  cogging_t s = {};
  s.cos_q8 = 1000000;
  s.order = kOrder;
  for (const std::int32_t sign : {1, -1}) {
    EXPECT_EQ(cogging_load(&s, &kConfig, 0, sign * (3 * kFast - 1)), 1000000);
    EXPECT_EQ(cogging_load(&s, &kConfig, 0, sign * 3 * kFast), 0);
    EXPECT_EQ(s.now_q8, 0);
    EXPECT_FALSE(s.active);
  }
  const cogging_config_t none = {0, kFast, kBound};
  EXPECT_EQ(cogging_load(&s, &none, 0, 0), 0);
}

// A sixteenth of a wave is a step, in either direction; less is none.
TEST(Cogging, StepsBySixteenthsOfAWave) {
  for (const std::int32_t sign : {1, -1}) {
    cogging_t s = {};
    (void)cogging_load(&s, &kConfig, 0, 0);
    const auto learn = [&](std::int32_t wave_bam) {
      const cogging_seen_t seen = {static_cast<std::uint32_t>(sign * wave_bam), 0, 800000};
      const std::int32_t before = s.mean_q8;
      (void)cogging_learn(&s, &kConfig, &seen);
      return s.mean_q8 != before;
    };
    const std::int32_t step = (1 << 28) / kOrder;  // rounded down: not yet
    EXPECT_FALSE(learn(step));
    EXPECT_TRUE(learn(step + 1));
    EXPECT_FALSE(learn(step + 2));
    EXPECT_FALSE(learn(2 * step + 1));
    EXPECT_TRUE(learn(2 * step + 3));
  }
}

TEST(Cogging, LearnsNothingWhileItIsNotTakenIntoAccount) {
  cogging_t s = {};
  (void)cogging_load(&s, &kConfig, 0, 3 * kFast);
  const cogging_seen_t seen = {bam(0.5), 0, 800000};
  EXPECT_EQ(cogging_learn(&s, &kConfig, &seen), 0);
  EXPECT_EQ(s.mean_q8, 0);
}

// Beyond its speed, or with a load that changes by more than cogging can be, the mean follows and the wave stays.
TEST(Cogging, AFastShaftOrALargeLoadLeavesTheWave) {
  struct Case {
    std::int32_t speed, load;
    bool learns;
  };
  const Case cases[] = {{kFast, 800000, true},  {kFast + 1, 800000, false}, {-kFast - 1, 800000, false},
                        {0, kBound, true},      {0, kBound + 1, false},     {0, -kBound, true},
                        {0, -kBound - 1, false}};
  for (const Case& c : cases) {
    cogging_t s = {};
    (void)cogging_load(&s, &kConfig, 0, 0);
    const cogging_seen_t seen = {bam(0.11), c.speed, c.load};
    (void)cogging_learn(&s, &kConfig, &seen);
    EXPECT_NEAR(s.mean_q8, c.load / 8, 1) << c.speed << ", " << c.load;
    EXPECT_EQ(s.known_q30 > 0, c.learns) << c.speed << ", " << c.load;
    EXPECT_EQ(s.cos_q8 != 0 && s.sin_q8 != 0, c.learns) << c.speed << ", " << c.load;
  }
}

// Amplitudes end at their bound, and only what they have really taken leaves the load.
TEST(Cogging, AmplitudesEndAtTheirBound) {
  const cogging_config_t tight = {kOrder, kFast, 900000};
  for (const std::int32_t sign : {1, -1}) {
    cogging_t s = {};
    s.order = kOrder;
    s.cos_q8 = sign * 800000;
    (void)cogging_load(&s, &tight, 0, 0);
    s.stepped_bam = 1u << 31;
    const cogging_seen_t seen = {0, 0, sign * 800000};
    EXPECT_EQ(cogging_learn(&s, &tight, &seen), sign * 100000);
    EXPECT_EQ(s.cos_q8, sign * 900000);
    EXPECT_EQ(s.sin_q8, 0);
  }
}

TEST(Cogging, AnotherOrderBeginsAnew) {
  cogging_t s = {};
  s.order = 12;
  s.cos_q8 = 5000;
  s.sin_q8 = 6000;
  s.known_q30 = 1 << 29;
  (void)cogging_load(&s, &kConfig, 0, 0);
  const cogging_seen_t seen = {0, 0, 0};
  (void)cogging_learn(&s, &kConfig, &seen);
  EXPECT_EQ(s.order, kOrder);
  EXPECT_EQ(s.cos_q8, 0);
  EXPECT_EQ(s.sin_q8, 0);
  EXPECT_EQ(s.known_q30, 0);
}

}  // namespace
