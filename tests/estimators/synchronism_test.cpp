// Loss of synchronism: what an angle that does not fit leaves over of the voltage equation, and for how long it is
// borne.

#include <gtest/gtest.h>

#include "tests/estimators/synchronism_scene.hpp"

extern "C" {
#include "estimators/deviation.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::frames;

double electrical(double rpm) { return rpm / 60.0 * kMotor.pole_pairs * kTurn; }

TEST(Synchronism, TheTrueAngleLeavesNothing) {
  for (const double rpm : {-3000.0, -60.0, 0.0, 60.0, 1000.0, 3000.0}) {
    Scene scene;
    const double w = electrical(rpm);
    for (int n = 0; n < 200; ++n) ASSERT_FALSE(scene.step(w, 0.0, w, {-2.0, 6.0}));
    // The mean window turns the two by up to 25 us * w from each other: 1.8 degrees of some 100 V at 3000 rpm.
    EXPECT_LT(scene.error().length(), 0.1 + 0.005 * std::fabs(w)) << rpm;
  }
}

// A reversed polarity: the whole EMF comes out against what is expected, and is missed twice, of which one and a half
// limits count. The windows' own saliency is the same from the other side.
TEST(Synchronism, HalfATurnIsTwiceTheEmf) {
  for (const double rpm : {-1000.0, -70.0, 70.0, 600.0}) {
    Scene scene;
    const double w = electrical(rpm);
    for (int n = 0; n < 60; ++n) (void)scene.step(w, kPi, w, {0.0, 0.0});
    const double emf = std::fabs(w) * kMotor.flux;
    const double counts = std::min(2.0 * emf, 1.5 * (kFloor + kShare * emf));
    EXPECT_NEAR(scene.error().y, std::copysign(counts, w), 0.1 + 0.01 * emf) << rpm;
  }
}

TEST(Synchronism, IsLostWhenItIsLost) {
  struct Case {
    double rpm, off, believed_rpm;
  };
  const Case cases[] = {
      {60.0, kPi, 60.0},       {-60.0, kPi, -60.0},           // 8.0 V against 6.4
      {300.0, kPi / 2, 300.0}, {-3000.0, -kPi / 2, -3000.0},  // a quarter turn
      {1000.0, 0.0, 0.0},      {0.0, 0.0, 1000.0},            // one of the two stands
      {600.0, 0.0, -600.0},
  };
  for (const Case& c : cases) {
    Scene scene;
    const int periods = scene.until_lost(electrical(c.rpm), c.off, electrical(c.believed_rpm));
    // 1.5 limits on both axes add 92 a period, the least beyond the limit 8
    EXPECT_GE(periods, 5) << c.rpm;
    // the first-order mean of 4 periods has passed the limit after ln(8.0 / 1.6) of them at the slowest here; what
    // slips makes some periods good
    EXPECT_LE(periods, kBad + 10) << c.rpm << " rpm, " << c.off;
  }
}

// An observer whose polarity is reversed believes in the speed that its EMF says, the opposite one: only that its frame
// turns the other way shows it.
TEST(Synchronism, APolarityThatExplainsItsEmfByTheSpeedIsALoss) {
  for (const double rpm : {60.0, -60.0, 300.0}) {
    Scene scene;
    const double w = electrical(rpm);
    for (int n = 0; n < 20; ++n) (void)scene.step(w, kPi, -w, {0.0, 0.0});
    EXPECT_LT(scene.error().length(), 0.1 + 0.01 * std::fabs(w)) << rpm;
    EXPECT_GT(std::fabs(scene.turned()), kFloor + kShare * std::fabs(w) * kMotor.flux) << rpm;
    EXPECT_LE(scene.until_lost(w, kPi, -w), kBad) << rpm;
  }
}

// What the frame turns besides makes an EMF, and counts as one and a half limits at most as well.
TEST(Synchronism, TheFramesOwnSpeedMakesTheSecondError) {
  for (const double rpm : {-20.0, 20.0, 50.0}) {
    Scene scene;
    const synchronism_seen_t seen = {raw_dq({0.0, 0.0}, 20), 5000, 0, bpp(electrical(rpm)), 5};
    (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
    EXPECT_NEAR(scene.error().length(), 0.0, 1e-4);
    EXPECT_NEAR(scene.turned(), 0.5 * kMotor.flux * electrical(rpm), 0.015) << "2 pi is 25/4";
  }
  for (const std::int32_t far : {1 << 29, INT32_MAX, INT32_MIN}) {
    Scene scene;
    const synchronism_config_t wide = {raw(100.0, 16), 0, kBad};
    const synchronism_seen_t seen = {raw_dq({0.0, 0.0}, 20), 300, 0, far, 5};  // a limit of 500 V
    (void)synchronism_judge(&scene.s, &wide, &scene.model, &seen, 0);
    EXPECT_NEAR(scene.turned(), std::copysign(0.5 * 750.0, far), 0.1) << far;
  }
}

// A load step: the speed in use is 80 rpm late for 4 ms, and the angle is corrected as it follows.
TEST(Synchronism, AFrameThatKeepsUpAddsNoDoubt) {
  Scene late;
  Scene corrected;
  for (int n = 0; n < 8; ++n) {
    const double lag = electrical(n < 2 ? 40.0 : 80.0 - 6.0 * n);
    synchronism_seen_t seen = seen_of({0.0, lag * kMotor.flux}, 0.0, 5000, 5);
    (void)synchronism_judge(&late.s, &kConfig, &late.model, &seen, 0);
    seen.ahead_bpp = bpp(-0.9 * lag);
    (void)synchronism_judge(&corrected.s, &kConfig, &corrected.model, &seen, 0);
  }
  EXPECT_EQ(corrected.s.debounce, late.s.debounce);
  EXPECT_LT(std::fabs(corrected.turned()), 0.3 * corrected.error().length());
}

TEST(Synchronism, AnErrorOfThirtyDegreesIsNoLoss) {
  for (const double rpm : {60.0, 300.0, 1000.0, -3000.0}) {
    Scene scene;
    const double w = electrical(rpm);
    EXPECT_EQ(scene.until_lost(w, 30.0 * kDegree, w), 1000) << rpm;
  }
}

TEST(Synchronism, ReversedPolarityAtRestCannotBeSeen) {
  Scene scene;
  EXPECT_EQ(scene.until_lost(0.0, kPi, 0.0), 1000);
  // w lambda = floor / (2 - share): 2.9 V, 43 rpm
  EXPECT_LT(Scene().until_lost(electrical(50.0), kPi, electrical(50.0)), 100);
}

TEST(Synchronism, EstimatorsAQuarterTurnApartAreALoss) {
  Scene scene;
  for (int n = 0; n < kBad; ++n) ASSERT_FALSE(scene.step(0.0, 0.0, 0.0, {0.0, 0.0}, 91.0 * kDegree)) << n;
  EXPECT_TRUE(scene.step(0.0, 0.0, 0.0, {0.0, 0.0}, 91.0 * kDegree));
  for (int n = 0; n < 500; ++n) ASSERT_FALSE(Scene().step(0.0, 0.0, 0.0, {0.0, 0.0}, -89.0 * kDegree));
}

// Eight good periods make up for a bad one, so that a loss that shows again and again is found.
TEST(Synchronism, GoodPeriodsAreForgivenSlowly) {
  Scene scene;
  const auto bad = [&] { return scene.step(0.0, 0.0, 0.0, {0.0, 0.0}, kPi); };
  const auto good = [&] { return scene.step(0.0, 0.0, 0.0, {0.0, 0.0}, 0.0); };
  for (int n = 0; n < 40; ++n) ASSERT_FALSE(bad());
  for (int n = 0; n < 80; ++n) ASSERT_FALSE(good());
  for (int n = 0; n < 20; ++n) ASSERT_FALSE(bad()) << n;
  EXPECT_TRUE(bad());
}

TEST(Synchronism, WithoutWindowsNothingChanges) {
  Scene scene;
  for (int n = 0; n < 30; ++n) (void)scene.step(electrical(600.0), kPi, electrical(600.0));
  const synchronism_t before = scene.s;
  const Input none(scene.model, {});
  EXPECT_FALSE(step_with(&scene.s, none, 0, {{0, 0}, 0, 0, 0, 1}));
  EXPECT_EQ(scene.s.debounce, before.debounce);
  EXPECT_EQ(scene.s.error_q16.q, before.error_q16.q);
}

// Whatever the windows say, the numbers stay inside their formats.
TEST(Synchronism, BearsAnyWindow) {
  Random random(91);
  const machine_model_t model = model_of(kMotor);
  synchronism_t s;
  synchronism_reset(&s);
  for (int n = 0; n < 20000; ++n) {
    std::vector<Window> windows(static_cast<std::size_t>(random.below(4)));
    for (Window& w : windows) {
      w.slope = random.direction(random.between(0.0, 40.0));
      w.current = random.direction(random.between(0.0, 20.0));
      w.voltage = random.direction(random.between(0.0, 280.0));
      w.middle = random.below(10000);
      w.span = 300 + random.below(3000);
    }
    const Input in(model, windows);
    const synchronism_seen_t now = {{0, 0},
                                    0,
                                    bpp(random.between(-1900.0, 1900.0)),
                                    static_cast<std::int32_t>(bam(random.between(-kPi, kPi))),
                                    1 + random.below(6)};
    (void)step_with(&s, in, bam(random.between(-kPi, kPi)), now,
                    static_cast<std::int32_t>(bam(random.between(-kPi, kPi))));
    ASSERT_GE(s.debounce, 0);
    ASSERT_GE(s.limit_q16, 0);
    // slopes of 40 A a period stand for 3.1 kV
    ASSERT_LT(std::fabs(real(s.error_q16.d, 16)), 5000.0);
    ASSERT_LT(std::fabs(real(s.error_q16.q, 16)), 5000.0);
    ASSERT_LT(std::fabs(real(s.turned_q16, 16)), 5000.0);
  }
}

// Nothing seen is neither good nor bad.
TEST(Synchronism, WithoutASpanNothingIsJudged) {
  const machine_model_t model = model_of(kMotor);
  synchronism_t s;
  synchronism_reset(&s);
  s.debounce = 40;
  const synchronism_seen_t none = {{raw(9.0, 20), 0}, 0, 0, 0, 5};
  EXPECT_FALSE(synchronism_judge(&s, &kConfig, &model, &none, 0));
  EXPECT_EQ(s.debounce, 40);
  EXPECT_EQ(s.error_q16.d, 0);
}

// A quarter of what is new in one period or two, half in more.
TEST(Synchronism, TheErrorFollowsByPeriods) {
  for (const auto& [periods, share] : {std::pair{1, 0.25}, {2, 0.25}, {3, 0.5}, {6, 0.5}}) {
    Scene scene;
    Vector mean = {0.0, 0.0};
    for (const Vector emf : {Vector{3.0, -5.0}, {-2.0, 5.0}, {0.0, 1.0}}) {
      const synchronism_seen_t seen = seen_of(emf, 0.0, 5000, periods);
      (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
      mean = mean + (emf - mean) * share;
      EXPECT_NEAR(scene.error().x, mean.x, 2e-3) << periods;
      EXPECT_NEAR(scene.error().y, mean.y, 2e-3) << periods;
    }
  }
}

// Beyond one and a half limits an error counts as these, on each axis and in either direction.
TEST(Synchronism, AnErrorCountsAsOneAndAHalfLimits) {
  for (const double sign : {1.0, -1.0}) {
    for (const auto& [emf, counts] : {std::pair{5.9, 5.9}, {6.1, 6.0}, {300.0, 6.0}}) {
      Scene scene;
      const synchronism_seen_t seen = seen_of({sign * emf, -sign * emf}, 0.0, 5000, 5);
      (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
      EXPECT_NEAR(scene.error().x, 0.5 * sign * counts, 2e-3) << emf;
      EXPECT_NEAR(scene.error().y, -0.5 * sign * counts, 2e-3) << emf;
    }
  }
}

// A polarity reversed at rest: the shaft runs away, and the error grows by some 0.35 V from one judgement to the next.
// It is a loss 4 ms behind the limit, not the 5.5 that as many judgements beyond it would take.
TEST(Synchronism, AnErrorThatGrowsIsALossSooner) {
  Scene scene;
  int beyond = 0;
  for (double emf = 0.0; emf < 20.0; emf += 0.35) {
    const synchronism_seen_t seen = seen_of({0.0, emf}, 0.0, 5000, 5);
    if (synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0)) break;
    beyond += emf > kFloor;
  }
  EXPECT_GE(beyond, 5);
  EXPECT_LE(beyond, 8);
}

// The current of a speed step on a saturated machine: 30 V for a millisecond.
TEST(Synchronism, AShortErrorIsBorneHoweverLarge) {
  for (const double emf : {10.0, 30.0, 300.0}) {
    Scene scene;
    std::int32_t most = 0;
    for (int n = 0; n < 8; ++n) {
      const synchronism_seen_t seen = seen_of({0.0, n < 2 ? emf : 0.0}, 0.0, 5000, 5);
      EXPECT_FALSE(synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0));
      most = std::max(most, scene.s.debounce);
    }
    EXPECT_GT(most, 0) << emf;
    EXPECT_LE(most, kBad * 8 / 5) << emf;
  }
}

// A load step takes the speed down, and the estimate follows it, 100 rpm behind: such an error is borne, with either
// direction of rotation. An estimate that moves with its error does not follow.
TEST(Synchronism, ASpeedThatFollowsIsBorne) {
  for (const double sign : {1.0, -1.0}) {
    for (const bool follows : {true, false}) {
      Scene scene;
      bool lost = false;
      for (int n = 0; n < 20; ++n) {
        const double believed = sign * electrical(60.0 - 8.5 * n);
        const double emf = (follows ? 1.0 : -1.0) * sign * electrical(n < 2 ? 0.0 : 100.0) * kMotor.flux;
        const synchronism_seen_t seen = seen_of({0.0, emf}, believed, 5000, 5);
        lost = synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0) || lost;
      }
      EXPECT_EQ(lost, !follows) << sign;
    }
  }
}

// 4 ms of what the speed changes, twice what it changes in half a millisecond being the mean's delay.
TEST(Synchronism, TheLimitGrowsWithTheChangeOfTheSpeed) {
  Scene scene;
  const double change = -2.0;  // V in half a millisecond
  double emf = 100.0;
  for (int n = 0; n < 40; ++n) {
    if (n > 20) emf += change;
    const double against = n > 20 ? 1.0 : 0.0;
    const synchronism_seen_t seen = seen_of({0.0, against}, emf / kMotor.flux, 5000, 5);
    (void)synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, 0);
  }
  EXPECT_NEAR(real(scene.s.limit_q16, 16), kFloor + kShare * emf + 4 * 2 * std::fabs(change), 0.05);
}

// Eight for each bad period, one back for each good one, also where several come at once.
TEST(Synchronism, DoubtCountsThePeriods) {
  Scene scene;
  const auto judge = [&](double off, std::int32_t periods) {
    const synchronism_seen_t seen = seen_of({0.0, 0.0}, 0.0, 5000, periods);
    return synchronism_judge(&scene.s, &kConfig, &scene.model, &seen, static_cast<std::int32_t>(bam(off)));
  };
  EXPECT_FALSE(judge(2.0, 6));
  EXPECT_EQ(scene.s.debounce, 48);
  EXPECT_FALSE(judge(0.0, 5));
  EXPECT_EQ(scene.s.debounce, 43);
  EXPECT_FALSE(judge(-2.0, 1));
  EXPECT_EQ(scene.s.debounce, 51);
  for (int n = 0; n < 10; ++n) EXPECT_FALSE(judge(0.0, 8));
  EXPECT_EQ(scene.s.debounce, 0);
  scene.s.debounce = kBad * 8 - 8;
  EXPECT_FALSE(judge(2.0, 1));
  EXPECT_TRUE(judge(2.0, 1));
}

// Unequal windows count by their spans, and as one that lies where they do in the mean.
TEST(Synchronism, WindowsCountByTheirSpans) {
  Scene scene;
  const double theta = 0.3;
  std::vector<Window> windows = {window_at(kMotor, theta, 0.0, {0, 0}, state_vector(1), 2000, 1000),
                                 window_at(kMotor, theta, 0.0, {0, 0}, state_vector(6), 7000, 3000)};
  const Vector left[] = {{0.16, 0.0}, {-0.04, 0.08}};  // A per period along d and q
  for (std::size_t k = 0; k < 2; ++k) windows[k].slope = windows[k].slope + left[k].turned(theta);
  const Input in(scene.model, windows);
  (void)step_with(&scene.s, in, bam(theta), {{0, 0}, 0, 0, 0, 1});
  const Vector mean = left[0] * 0.25 + left[1] * 0.75;
  EXPECT_NEAR(scene.error().x, 0.25 * mean.x * kMotor.ld / kPeriod, 2e-3);
  EXPECT_NEAR(scene.error().y, 0.25 * mean.y * kMotor.lq / kPeriod, 2e-3);
}

// A span that is a power of two divides without a rest: what is looked at is that window and nothing else.
TEST(Synchronism, AWindowAloneIsItsOwnMean) {
  const machine_model_t model = model_of(kMotor);
  Random random(3);
  for (int n = 0; n < 2000; ++n) {
    estimator_window_t w = {};
    w.change_q19 = raw_change(random.direction(random.between(0.1, 5.0)), 4096);
    w.current_q20 = raw_ab(random.direction(random.between(0.1, 14.0)), 20);
    w.voltage_q19 = raw_ab(random.direction(random.between(0.1, 200.0)), 19);
    w.middle_tick = static_cast<std::int16_t>(2048 + random.below(5000));
    w.span_ticks = 4096;
    const std::uint32_t angle = bam(random.between(-kPi, kPi));
    synchronism_seen_t seen = {};
    seen.speed_bpp = bpp(random.between(-400.0, 400.0));
    synchronism_look(&seen, &model, &w, 1, angle);
    const dq_t alone = deviation_evaluate(&model, &w, angle, seen.speed_bpp).residual_q20;
    ASSERT_EQ(seen.residual_q20.d, alone.d) << n;
    ASSERT_EQ(seen.residual_q20.q, alone.q) << n;
    ASSERT_EQ(seen.span_ticks, 4096);
  }
}

}  // namespace
