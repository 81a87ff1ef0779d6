// Polarity by saturation on a machine whose inductances change with the current along the magnet.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/saturation.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

const avv_config_t kAvv = {raw(0.01, 30), raw(0.02, 30)};
constexpr double kAmps = 10.0;
constexpr double kNoise = 0.031;  // A per period: 12 mA rms of a conversion on a 27 us window

struct Slopes {
  double d = 0.0, q = 0.00139;  // relative change per ampere; motor A: 0.0108 mH/A of 7.8 mH
};

struct Conditions {
  Slopes truth, told;
  bool wrong_way_round = false;
  double noise = kNoise;
  double inductance = 1.0;  // true over nominal
  double scale = 1.0;       // of the machine as a whole
  double resistance = 1.0;  // true over nominal
};

saturation_slopes_t slopes_of(const Slopes& s) { return {raw(s.d, 30), raw(s.q, 30)}; }

saturation_t run(const Conditions& c, std::uint64_t seed = 1) {
  Random random(seed);
  Motor nominal;
  nominal.ld *= c.scale;
  nominal.lq *= c.scale;
  const machine_model_t model = model_of(nominal);
  const double theta = 1.2;
  const double guess = theta + (c.wrong_way_round ? kPi : 0.0);
  avv_t avv = {};
  avv_preset(&avv, bam(guess), 0, 0);
  saturation_t s;
  const saturation_slopes_t told = slopes_of(c.told);
  saturation_begin(&s, &model, &told, raw(kAmps, 20));
  double id = 0.0;
  for (int n = 0; s.result == POLARITY_PENDING; ++n) {
    if (n > SATURATION_LENGTH) throw "no end";
    Motor m = nominal;
    m.rs *= c.resistance;
    m.ld *= c.inductance * (1.0 + c.truth.d * id * (c.wrong_way_round ? -1.0 : 1.0));
    m.lq *= c.inductance * (1.0 + c.truth.q * id * (c.wrong_way_round ? -1.0 : 1.0));
    const Vector i = Vector{id, 0.0}.turned(guess);
    std::vector<Window> windows = alternating(m, n, theta, 0.0, i);
    for (Window& w : windows) w.slope = w.slope + Vector{c.noise * random.normal(), c.noise * random.normal()};
    const Input in(model, windows);
    (void)avv_step(&avv, &kAvv, in.get());
    id += 0.2 * (real(saturation_step(&s, &avv.regression, &model), 20) - id);  // the current loop
  }
  EXPECT_EQ(s.tick, SATURATION_LENGTH);
  return s;
}

double score(const saturation_t& s) { return real(s.score_q15, 15); }

TEST(Saturation, RightAndWrong) {
  Conditions c;
  c.noise = 0.0;
  const saturation_t right = run(c);
  EXPECT_EQ(right.result, POLARITY_RIGHT);
  EXPECT_NEAR(score(right), 1.0, 0.03);  // the expectation is linear in the current, an inverse inductance is not quite
  c.wrong_way_round = true;
  const saturation_t wrong = run(c);
  EXPECT_EQ(wrong.result, POLARITY_WRONG);
  EXPECT_NEAR(score(wrong), -1.0, 0.03);
}

double resistance_error(const saturation_t& s) {
  const machine_model_t model = model_of(Motor{});
  return real(saturation_resistance_q24(&s, &model), 24) / Motor{}.rs;
}

// A kelvin changes copper's resistance by 0.4 %; noise and the current loop's last swing leave 3 %.
TEST(Saturation, TellsTheResistanceOnTheWay) {
  for (const double true_over_nominal : {0.7, 1.0, 1.3}) {
    for (const bool wrong_way_round : {false, true}) {
      Conditions c;
      c.resistance = true_over_nominal;
      c.wrong_way_round = wrong_way_round;
      EXPECT_NEAR(resistance_error(run(c)), true_over_nominal - 1.0, 0.03);
    }
  }
}

TEST(Saturation, ResistanceStaysWithoutWindows) {
  const machine_model_t model = model_of(Motor{});
  const saturation_slopes_t some = slopes_of({});
  const regression_t nothing = {};
  saturation_t s;
  saturation_begin(&s, &model, &some, raw(kAmps, 20));
  for (int n = 0; n < SATURATION_LENGTH; ++n) (void)saturation_step(&s, &nothing, &model);
  EXPECT_EQ(saturation_resistance_q24(&s, &model), 0);
}

// 0.2 mH: inverse inductances of half an ampere per volt and period, at the end of the format.
TEST(Saturation, WithLittleInductance) {
  Conditions c;
  c.noise = 0.0;
  c.scale = 0.04;
  c.truth = c.told = {-0.005, 0.0};
  EXPECT_EQ(run(c).result, POLARITY_RIGHT);
  c.wrong_way_round = true;
  EXPECT_EQ(run(c).result, POLARITY_WRONG);
}

TEST(Saturation, ThroughNoiseAndWithItsConfidenceStated) {
  double lowest = 1e9, highest = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Conditions c;
    c.wrong_way_round = seed % 2 == 0;
    const saturation_t s = run(c, seed);
    EXPECT_EQ(s.result, c.wrong_way_round ? POLARITY_WRONG : POLARITY_RIGHT) << seed;
    lowest = std::min(lowest, real(s.sigma_q8, 8));
    highest = std::max(highest, real(s.sigma_q8, 8));
  }
  EXPECT_GT(lowest, SATURATION_SIGMA_MIN);
  EXPECT_LT(highest, 16.0);  // the floor alone leaves 15
}

// Passes counted together: their standard error falls with the root of their number, their floor does not.
TEST(Saturation, ASecondPassAddsToTheFirst) {
  const machine_model_t model = model_of(Motor{});
  const saturation_slopes_t some = slopes_of({});
  regression_t r = {};
  r.spread_q8 = raw(40000.0, 8);
  r.information = 1;
  Random random(5);
  saturation_t s;
  saturation_begin(&s, &model, &some, raw(kAmps, 20));
  double single = 0.0;
  for (int pass = 1; pass <= 4; ++pass) {
    double id = 0.0;
    while (s.result == POLARITY_PENDING) {
      // Lqq up with the current: y_q down, along and mirror by -+ half of it
      const double change = -0.00139 * id * real(model.yq_q30, 30) + 2e-4 * random.normal();
      r.along_q16 = raw(0.5 * change * 40000.0, 16);
      r.mirror_q16 = -r.along_q16;
      id = real(saturation_step(&s, &r, &model), 20);
    }
    EXPECT_EQ(s.result, POLARITY_RIGHT) << pass;
    EXPECT_NEAR(score(s), 1.0, 0.15) << pass;
    if (pass == 1) single = real(s.sigma_q8, 8);
    saturation_again(&s);
    s.result = POLARITY_PENDING;
  }
  EXPECT_GT(real(s.sigma_q8, 8), single);
  EXPECT_LT(real(s.sigma_q8, 8), 16.0);
}

// The direction that a change is looked for in has the length of one, whichever axis saturates.
TEST(Saturation, LooksAlongWhatItExpects) {
  const machine_model_t model = model_of(Motor{});
  for (const Slopes& slopes : {Slopes{-0.004, 0.0}, Slopes{0.0, 0.00139}, Slopes{-0.002, 0.003}}) {
    const saturation_slopes_t told = slopes_of(slopes);
    saturation_t s;
    saturation_begin(&s, &model, &told, raw(kAmps, 20));
    EXPECT_NEAR(std::hypot(real(s.unit_d_q30, 30), real(s.unit_q_q30, 30)), 1.0, 1e-4) << slopes.d;
  }
}

// A machine in which +i_d saturates Ld, with inductances that the model has wrong by 30 %.
TEST(Saturation, TheDirectAxisTellsAsWell) {
  for (const double inductance : {0.7, 1.3}) {
    for (const bool wrong : {false, true}) {
      Conditions c;
      c.truth = c.told = {-0.004, 0.0};
      c.wrong_way_round = wrong;
      c.inductance = inductance;
      EXPECT_EQ(run(c).result, wrong ? POLARITY_WRONG : POLARITY_RIGHT) << inductance;
    }
  }
}

TEST(Saturation, ALinearMachineIsAmbiguous) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Conditions c;
    c.truth = {0.0, 0.0};
    EXPECT_EQ(run(c, seed).result, POLARITY_AMBIGUOUS) << seed;
  }
}

// A change of the right size says nothing where the rounds scatter as much.
TEST(Saturation, AChangeThatNoiseCouldHaveMadeIsAmbiguous) {
  int of_right_size = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Conditions c;
    c.noise = 8.0 * kNoise;
    const saturation_t s = run(c, seed);
    if (real(s.sigma_q8, 8) >= SATURATION_SIGMA_MIN) continue;
    EXPECT_EQ(s.result, POLARITY_AMBIGUOUS) << seed;
    const double size = std::fabs(score(s));
    of_right_size += size > 0.4 && size < 1.9;
  }
  EXPECT_GT(of_right_size, 2);
}

// Four times the change expected is something else than saturation.
TEST(Saturation, AChangeThatDoesNotFitIsAmbiguous) {
  Conditions c;
  c.truth.q = 4.0 * c.told.q;
  EXPECT_EQ(run(c).result, POLARITY_AMBIGUOUS);
}

TEST(Saturation, VisibleOnlyWithSlopesAndCurrent) {
  const machine_model_t model = model_of(Motor{});
  const saturation_slopes_t none = {0, 0};
  const saturation_slopes_t some = slopes_of({});
  EXPECT_FALSE(saturation_is_visible(&model, &none, raw(14.0, 20)));
  EXPECT_TRUE(saturation_is_visible(&model, &some, raw(10.0, 20)));
  EXPECT_FALSE(saturation_is_visible(&model, &some, raw(2.0, 20)));
}

TEST(Saturation, TheCurrentRunsEvenlyAndEndsAtZero) {
  const machine_model_t model = model_of(Motor{});
  const saturation_slopes_t some = slopes_of({});
  const regression_t nothing = {};
  saturation_t s;
  saturation_begin(&s, &model, &some, raw(kAmps, 20));
  double last = 0.0, sum = 0.0, fastest = 0.0;
  for (int n = 0; n < SATURATION_LENGTH; ++n) {
    const double now = real(saturation_step(&s, &nothing, &model), 20);
    fastest = std::max(fastest, std::fabs(now - last));
    EXPECT_LE(std::fabs(now), kAmps + 1e-5);
    sum += now;
    last = now;
  }
  EXPECT_NEAR(fastest, kAmps / 20, 1e-5);
  EXPECT_EQ(s.result, POLARITY_AMBIGUOUS) << "nothing was measured";
  EXPECT_NEAR(sum / SATURATION_LENGTH, 0.0, 0.05 * kAmps);  // but for the way there and back
  EXPECT_EQ(saturation_step(&s, &nothing, &model), 0);
}

// From 0.35 to twice what is expected it is saturation; the score says how much it is.
TEST(Saturation, TheChangeMustFitWhatIsExpected) {
  for (const double factor : {0.31, 0.39, 1.0, 1.9, 2.15}) {
    Conditions c;
    c.noise = 0.0;
    c.truth.q = factor * c.told.q;
    const saturation_t s = run(c);
    EXPECT_NEAR(score(s), factor, 0.05 * factor) << factor;
    EXPECT_EQ(s.result, factor > 0.35 && factor < 2.0 ? POLARITY_RIGHT : POLARITY_AMBIGUOUS) << factor;
  }
}

// What does not average out, 0.15 % of the mean inverse inductance, is all of the error where there is no noise.
TEST(Saturation, WithoutNoiseTheFloorIsTheError) {
  Conditions c;
  c.noise = 0.0;
  const saturation_t s = run(c);
  const machine_model_t model = model_of(Motor{});
  const double floor = (real(model.yd_q30, 30) + real(model.yq_q30, 30)) / 2.0 / 650.0;
  EXPECT_NEAR(real(s.sigma_q8, 8), real(s.change_q30, 30) / floor, 0.03 * real(s.sigma_q8, 8));
}

// A difference of two rounds has twice the variance of one, and 12 rounds a side make a mean: of the change's two means
// and 20 differences, scatter / 20 / 2 * 2 / 12.
TEST(Saturation, TheErrorIsThatOfTheRoundsScatterAndTheFloor) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Conditions c;
    c.noise = 4.0 * kNoise;
    const saturation_t s = run(c, seed);
    const double scatter = std::ldexp(static_cast<double>(s.scatter), -60) / (20.0 * 12.0);
    const double passes = s.passes;
    const double error = std::hypot(std::sqrt(scatter) / passes, real(s.floor_q30, 30));
    const double sigma = std::fabs(real(s.change_q30, 30)) / passes / error;
    EXPECT_NEAR(real(s.sigma_q8, 8), sigma, 0.005 * sigma + 0.005) << seed;
  }
}

// Seven times that floor can be told.
TEST(Saturation, VisibleFromSevenFloorsOn) {
  const machine_model_t model = model_of(Motor{});
  const double floor = (real(model.yd_q30, 30) + real(model.yq_q30, 30)) / 2.0 / 650.0;
  for (const double part : {0.97, 1.03}) {
    const double change = part * 7.0 * floor;
    const double slope = change / real(model.yq_q30, 30) / (2.0 * kAmps);
    const saturation_slopes_t slopes = {0, raw(slope, 30)};
    EXPECT_EQ(saturation_is_visible(&model, &slopes, raw(kAmps, 20)), part > 1.0) << part;
  }
}

// The sums hold eight passes, and more are never counted.
TEST(Saturation, CountsEightPassesAtMost) {
  saturation_t s = {};
  for (int n = 1; n <= 10; ++n) {
    saturation_again(&s);
    EXPECT_EQ(s.passes, std::min(n, 8));
  }
}

}  // namespace
