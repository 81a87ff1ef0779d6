// The polarity test on a shaft that is inertia alone.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/polarity.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr double kAmps = 3.0;
constexpr int kTest = 2 * POLARITY_SEGMENTS * POLARITY_SEGMENT;  // periods

// Electrical acceleration of motor A, rad per period^2, per ampere of i_q.
double accel_per_amp() {
  const Motor m;
  return m.torque_constant() / m.inertia * m.pole_pairs * kPeriod * kPeriod;
}

struct Conditions {
  bool wrong_way_round = false;
  bool blocked = false;
  double inertia = 1.0;    // times motor A's
  double load_amps = 0.0;  // constant load, as the current that would balance it
  double noise = 0.0;      // rad, of every angle measured
  bool bounded = false;
  double expected_inertia = 1.0;  // times motor A's: the test is as long as this wants it
  double speed = 0.0;             // of the shaft at the beginning, rad per period
  double told = 1.0;              // share of it that the test is told
};

// A test of a machine with so many times motor A's inertia.
polarity_t begun(double angle = 0.0, double inertia = 1.0, double speed = 0.0) {
  polarity_t s = {};
  const std::int32_t accel = accel_q8(accel_per_amp() * kAmps / inertia);
  polarity_begin(&s, raw(kAmps, 20), accel, bam(angle), raw(speed / kTurn, 32));
  return s;
}

struct Outcome {
  polarity_t state;
  double travel = 0.0, rest_speed = 0.0;  // rad, rad per period
  double current_sum = 0.0, largest_current = 0.0;
};

Outcome run(const Conditions& c, std::uint64_t seed = 1) {
  Random random(seed);
  Outcome o = {};
  double angle = 2.9, speed = c.speed;  // near half a turn, so that the wrap is part of the test
  const double start = angle;
  const double turned = c.wrong_way_round ? kPi : 0.0;  // what the saliency took for the d-axis
  o.state = begun(angle + turned, c.expected_inertia, c.told * c.speed);
  o.state.bounded = c.bounded;
  const int periods = 2 * POLARITY_SEGMENTS * o.state.length;
  for (int n = 0; n < periods; ++n) {
    EXPECT_EQ(o.state.result, POLARITY_PENDING) << n;
    const double measured = angle + turned + c.noise * random.normal();
    const double iq = real(polarity_step(&o.state, bam(measured)), 20);
    const double torque = (c.wrong_way_round ? -iq : iq) - c.load_amps;
    const double acceleration = c.blocked ? 0.0 : torque * accel_per_amp() / c.inertia;
    angle += speed + 0.5 * acceleration;
    speed += acceleration;
    o.travel = std::max(o.travel, std::fabs(angle - start));
    o.current_sum += iq;
    o.largest_current = std::max(o.largest_current, std::fabs(iq));
  }
  o.rest_speed = speed;
  return o;
}

double response(const Outcome& o) { return static_cast<double>(o.state.response_bam) / o.state.expected_bam; }

TEST(Polarity, RightAndWrong) {
  const Outcome right = run({});
  EXPECT_EQ(right.state.result, POLARITY_RIGHT);
  EXPECT_NEAR(response(right), 1.0, 0.01);  // the expectation is exactly this shaft's: only roundings are left
  Conditions c;
  c.wrong_way_round = true;
  const Outcome wrong = run(c);
  EXPECT_EQ(wrong.state.result, POLARITY_WRONG);
  EXPECT_NEAR(response(wrong), -1.0, 0.01);
}

// A shaft that is lighter than told moves it that much more. Ten times is more than the test can have done where the
// one before has left the shaft moving.
TEST(Polarity, ALightShaftIsBelievedUnlessSomethingElseMayMoveIt) {
  for (const double inertia : {0.25, 0.14, 0.1, 0.05}) {
    for (const bool wrong : {false, true}) {
      Conditions c;
      c.inertia = inertia;
      c.wrong_way_round = wrong;
      const polarity_result_t clear = wrong ? POLARITY_WRONG : POLARITY_RIGHT;
      EXPECT_EQ(run(c).state.result, clear) << inertia;
      c.bounded = true;
      EXPECT_EQ(run(c).state.result, inertia > 0.125 ? clear : POLARITY_AMBIGUOUS) << inertia;
    }
  }
}

// A heavy shaft takes long, and turns by more than a whole turn meanwhile where it is not at rest. The speed that the
// test is told is that of an observer, which is off by some.
TEST(Polarity, AShaftThatTurnsAlreadyIsAskedInItsOwnFrame) {
  for (const double hertz : {-25.0, -10.0, -3.0, 3.0, 10.0, 25.0}) {
    for (const double told : {0.95, 1.0, 1.05}) {
      for (const bool wrong : {false, true}) {
        Conditions c;
        c.inertia = c.expected_inertia = 8.0;
        c.speed = hertz * kTurn * kPeriod;
        c.told = told;
        c.wrong_way_round = wrong;
        const Outcome o = run(c);
        EXPECT_EQ(o.state.result, wrong ? POLARITY_WRONG : POLARITY_RIGHT) << hertz << ", " << told;
        EXPECT_NEAR(response(o), wrong ? -1.0 : 1.0, 0.02) << hertz << ", " << told;
      }
    }
  }
}

// Passes are counted together: their mean response, and a standard error that falls with the root of their number.
TEST(Polarity, PassesAddUp) {
  polarity_t s = begun();
  std::int32_t first = 0;
  for (int pass = 1; pass <= 4; ++pass) {
    // Every response is the same, and so is the scatter.
    for (int n = 0; n < kTest; ++n) {
      const int segment = n / POLARITY_SEGMENT % POLARITY_SEGMENTS;
      const double sign = (n < kTest / 2) ? 1.0 : -1.0;
      const double moved = (segment == 3) ? sign * 0.02 : 0.0;
      (void)polarity_step(&s, bam(moved + (n % 2 == 0 ? 0.01 : -0.01)));
    }
    if (pass == 1) first = s.sigma_q8;
    EXPECT_EQ(s.passes, pass);
    EXPECT_NEAR(s.sigma_q8, first * std::sqrt(pass), 0.01 * first) << pass;
    EXPECT_NEAR(static_cast<double>(s.response_bam) / pass, 2.0 * 0.02 / kTurn * 4294967296.0, 1e5) << pass;
    polarity_again(&s, 0, 0);
  }
}

// It must not turn the shaft: accel n^2 electrical is 2.3 degrees, a sixth of a degree... and back to rest.
TEST(Polarity, TheShaftHardlyMovesAndComesToRest) {
  const Outcome o = run({});
  const double excursion = accel_per_amp() * kAmps * POLARITY_SEGMENT * POLARITY_SEGMENT;
  EXPECT_NEAR(o.travel, excursion, 1e-6);
  EXPECT_LT(o.travel / Motor{}.pole_pairs / kDegree, 1.0);
  EXPECT_NEAR(o.rest_speed, 0.0, 1e-12);
  EXPECT_EQ(o.current_sum, 0.0);
  EXPECT_NEAR(o.largest_current, kAmps, 1e-5);
}

TEST(Polarity, BlockedIsAmbiguous) {
  Conditions c;
  c.blocked = true;
  EXPECT_EQ(run(c).state.result, POLARITY_AMBIGUOUS);
  c.noise = 1.0 * kDegree;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    EXPECT_EQ(run(c, seed).state.result, POLARITY_AMBIGUOUS) << seed;
  }
}

// Four times the inertia expected is the border.
TEST(Polarity, FarTooMuchInertiaIsAmbiguous) {
  for (const bool wrong : {false, true}) {
    Conditions c;
    c.wrong_way_round = wrong;
    c.inertia = 3.8;
    EXPECT_EQ(run(c).state.result, wrong ? POLARITY_WRONG : POLARITY_RIGHT);
    c.inertia = 4.2;
    EXPECT_EQ(run(c).state.result, POLARITY_AMBIGUOUS);
    c.inertia = 0.25;  // bare shaft where a load was expected
    EXPECT_EQ(run(c).state.result, wrong ? POLARITY_WRONG : POLARITY_RIGHT);
  }
}

// A constant load as large as the test's own torque accelerates the shaft all the time; the two patterns' difference
// does not see it.
TEST(Polarity, AConstantLoadChangesNothing) {
  for (const double load : {-1.0, -0.3, 0.3, 1.0}) {
    for (const bool wrong : {false, true}) {
      Conditions c;
      c.wrong_way_round = wrong;
      c.load_amps = load;
      const Outcome o = run(c);
      EXPECT_EQ(o.state.result, wrong ? POLARITY_WRONG : POLARITY_RIGHT) << load;
      EXPECT_NEAR(std::fabs(response(o)), 1.0, 0.02) << load;
    }
  }
}

// One degree of noise per period: the mean of 20 in each third leaves 8 % of the response, the threshold is nine of
// that.
TEST(Polarity, NoiseIsAveraged) {
  Conditions c;
  c.noise = 1.0 * kDegree;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    c.wrong_way_round = seed % 2 == 0;
    EXPECT_EQ(run(c, seed).state.result, c.wrong_way_round ? POLARITY_WRONG : POLARITY_RIGHT) << seed;
  }
}

TEST(Polarity, NothingIsCommandedAfterTheEnd) {
  Outcome o = run({});
  EXPECT_EQ(polarity_step(&o.state, 0), 0);
  EXPECT_EQ(o.state.result, POLARITY_RIGHT);
}

// 2.3 degrees in the usual segment. A lighter shaft has the half, a heavier one twice and four times as much,
// within 1.5 to 10 degrees as far as there are segments for it.
TEST(Polarity, ASegmentIsAsLongAsTheShaftNeeds) {
  struct Of {
    double inertia;
    int length;
    double degrees;
  };
  for (const Of& of : {Of{1.0 / 16, 20, 9.28},
                       {0.23, 20, 2.52},
                       {0.24, 40, 9.67},
                       {1.0, 40, 2.32},
                       {1.5, 40, 1.55},
                       {1.6, 80, 5.80},
                       {6.1, 80, 1.52},
                       {6.3, 160, 5.89},
                       {15.0, 160, 2.48},
                       {60.0, 160, 0.62}}) {
    for (const bool wrong : {false, true}) {
      Conditions c;
      c.inertia = of.inertia;
      c.expected_inertia = of.inertia;
      c.wrong_way_round = wrong;
      const Outcome o = run(c);
      EXPECT_EQ(o.state.length, of.length) << of.inertia;
      EXPECT_NEAR(o.travel / kDegree, of.degrees, 0.01) << of.inertia;
      EXPECT_EQ(o.state.result, wrong ? POLARITY_WRONG : POLARITY_RIGHT) << of.inertia;
      EXPECT_NEAR(o.rest_speed, 0.0, 1e-12);
    }
  }
}

// The standard error is that of as many angles as there were: with one degree of noise it is the scatter of the
// response over many tests, whatever the segment's length.
TEST(Polarity, TheErrorFallsWithTheRootOfTheLength) {
  for (const double inertia : {1.0 / 16, 1.0, 4.0, 16.0}) {
    double squares = 0.0, told = 0.0;
    constexpr int kTests = 200;
    for (std::uint64_t seed = 1; seed <= kTests; ++seed) {
      Conditions c;
      c.inertia = inertia;
      c.expected_inertia = inertia;
      c.noise = 1.0 * kDegree;
      const Outcome o = run(c, seed);
      squares += std::pow(response(o) - 1.0, 2);
      told += std::fabs(response(o)) / real(o.state.sigma_q8, 8);
    }
    EXPECT_NEAR(told / kTests / std::sqrt(squares / kTests), 1.0, 0.15) << inertia;
  }
}

// A response of a quarter of what is expected is enough, either way, and the least that is.
TEST(Polarity, AQuarterOfTheResponseIsEnough) {
  for (const bool wrong : {false, true}) {
    for (const double inertia : {3.7, 4.3}) {
      Conditions c;
      c.inertia = inertia;
      c.wrong_way_round = wrong;
      const polarity_result_t clear = wrong ? POLARITY_WRONG : POLARITY_RIGHT;
      EXPECT_EQ(run(c).state.result, inertia < 4.0 ? clear : POLARITY_AMBIGUOUS) << inertia;
    }
  }
}

// How sure the response is comes from the scatter of the angles in the pauses, whatever they do while current flows.
TEST(Polarity, ItsErrorIsTheScatterInThePauses) {
  constexpr int kHalf = POLARITY_SEGMENT / 2;
  const auto sigma = [](double pauses, double between) {
    polarity_t s = begun();
    double way = 0.0;
    for (int n = 0; n < kTest; ++n) {
      const int segment = n / POLARITY_SEGMENT % POLARITY_SEGMENTS;
      const bool pause = (segment == 0 || segment == 3 || segment == 6) && n % POLARITY_SEGMENT >= kHalf;
      // the middle pause is off by a degree, in the first pattern one way and in the second the other
      way = segment == 3 ? (n < kTest / 2 ? 1.0 : -1.0) * kDegree : 0.0;
      (void)polarity_step(&s, bam(way + (n % 2 == 0 ? 0.5 : -0.5) * (pause ? pauses : between)));
    }
    return real(s.sigma_q8, 8);
  };
  const double step = 0.01 * kDegree;
  // weights 1, 2, 1 of both patterns over means, halved: two degrees; its error 0.34 of the mean step
  EXPECT_NEAR(sigma(step, 0.0), 2.0 * kDegree / (0.34 * step), 0.1 * 2.0 * kDegree / (0.34 * step));
  EXPECT_NEAR(sigma(step, 10.0 * step), sigma(step, 0.0), 1e-6 * sigma(step, 0.0));
  EXPECT_NEAR(sigma(2.0 * step, 0.0), 0.5 * sigma(step, 0.0), 0.02 * sigma(step, 0.0));
}

// 0.34 times the mean difference of neighbouring angles with twenty of them, and less with the root of their number, by
// tens; from 120 on it stays.
TEST(Polarity, TheErrorFallsWithTheRootOfTheTens) {
  for (int tens = 1; tens <= 14; ++tens) {
    polarity_t s = {};
    s.length = static_cast<std::int16_t>(20 * tens);
    s.passes = 1;
    s.segment = POLARITY_SEGMENTS - 1;  // of the second pattern, its last period
    s.tick = static_cast<std::int16_t>(s.length - 1);
    s.current_q20 = -raw(3.0, 20);
    s.expected_bam = s.response_bam = 100000000;
    const double difference = 10000000.0;  // 0.8 degrees
    const int differences = 6 * (10 * tens - 1);
    s.rough_bam = static_cast<std::int32_t>(difference * differences / 256.0);
    (void)polarity_step(&s, 0);
    EXPECT_NE(s.result, POLARITY_PENDING);
    const double error = 0.34 * difference * std::sqrt(2.0 / std::min(tens, 12));
    EXPECT_NEAR(real(s.sigma_q8, 8) / (100000000.0 / error), 1.0, 0.01) << tens;
  }
}

// The sums hold six passes, and more are never counted.
TEST(Polarity, CountsSixPassesAtMost) {
  polarity_t s = {};
  for (int n = 1; n <= 8; ++n) {
    polarity_again(&s, 0, 0);
    EXPECT_EQ(s.passes, std::min(n, 6));
  }
}

}  // namespace
