// The I-F start on a shaft in double precision: the vector's current is what it asks for, at once.

#include <utility>

#include "tests/control/if_start_shaft.hpp"

namespace stillspin::test {
namespace {

struct Turned {
  if_start_result_t result = IF_START_PENDING;
  int periods = 0;
  double swing = 0.0;  // largest departure of the speed from the vector's over the last 100 ms, of it
  if_start_t state = {};
};

// Runs until it ends. The source sees the shaft `off` rad beside where it is, at its own speed.
Turned turn(Shaft& shaft, const if_start_config_t& c, bool backward, double off = 0.0) {
  Turned t;
  if_start_begin(&t.state, &c, 0, backward);
  Vector voltage = {0.0, 0.0};
  double worst[2] = {0.0, 0.0};
  while (t.result == IF_START_PENDING && t.periods < 100000) {
    if (t.periods % 10 == 0) if_start_renew(&t.state, &c, raw_dq(voltage, 16));
    t.result = if_start_step(&t.state, &c, raw_dq(voltage, 16), bam(shaft.angle + off), bpp(shaft.speed));
    voltage = shaft.step(rad(t.state.angle_bam), real(t.state.current_q20, 20));
    if (t.periods % 1000 == 0) worst[0] = std::exchange(worst[1], 0.0);
    worst[1] = std::max(worst[1], std::fabs(shaft.speed / rad_per_s(t.state.speed_bpp) - 1.0));
    t.periods++;
  }
  t.swing = std::max(worst[0], worst[1]);
  return t;
}

TEST(IfStart, TurnsTheShaftFromEveryAngleAndEndsQuietly) {
  const if_start_config_t c = designed(motor_b(), usual());
  for (double load : {0.0, 1.0, 3.0}) {
    for (int k = -11; k <= 12; k++) {
      for (bool backward : {false, true}) {
        Shaft shaft;
        shaft.angle = k * kPi / 12.0;
        shaft.load = load;
        const Turned t = turn(shaft, c, backward);
        EXPECT_EQ(t.result, IF_START_TAKEN_OVER) << "angle " << k << " load " << load;
        EXPECT_LT(t.swing, 0.02) << "angle " << k << " load " << load;
        EXPECT_NEAR(shaft.speed, backward ? -125.7 : 125.7, 2.5);
      }
    }
  }
}

TEST(IfStart, TheSwingDiesByItsDampingAlone) {
  if_start_config_t c = designed(motor_b(), usual());
  Shaft damped, bare;
  damped.m.friction = bare.m.friction = 0.0;
  damped.angle = bare.angle = 1.0;
  const Turned with = turn(damped, c, false);
  c.damping_periods = 0;
  const Turned without = turn(bare, c, false);
  EXPECT_LT(with.swing, 0.01);
  EXPECT_GT(without.swing, 0.1);
}

TEST(IfStart, TakesTheTimesThatItIsTold) {
  const if_start_config_t c = designed(motor_b(), usual());
  Shaft shaft;
  const Turned t = turn(shaft, c, false);
  // 1000 at rest, 6000 up the ramp, 3000 of agreement.
  EXPECT_NEAR(t.periods, 10000, 20);
  EXPECT_EQ(t.state.current_q20, raw(8.0, 20));
}

TEST(IfStart, GivesUpWhenTheSourceDoesNotAgree) {
  const if_start_config_t c = designed(motor_b(), usual());
  Shaft half_a_turn_off;
  const Turned reversed = turn(half_a_turn_off, c, false, kPi);
  EXPECT_EQ(reversed.result, IF_START_FAILED);
  EXPECT_NEAR(reversed.periods, 27000, 20);
  // A shaft that the vector does not carry along stands, or is left behind.
  Shaft blocked;
  blocked.load = 6.0;
  EXPECT_EQ(turn(blocked, c, false).result, IF_START_FAILED);
}

TEST(IfStart, RefusesASpringThatIsTooSlowOrTooFast) {
  if_start_config_t c = usual();
  Motor heavy = motor_b();
  heavy.inertia = 0.5;
  heavy.flux = 0.002;
  const machine_model_t slow = model_of(heavy);
  EXPECT_FALSE(if_start_design(&c, &slow));
  Motor light = motor_b();
  light.inertia = 1e-4;
  light.flux = 0.9;
  const machine_model_t fast = model_of(light);
  c = usual();
  c.current_q20 = raw(100.0, 20);
  EXPECT_FALSE(if_start_design(&c, &fast));
}

// 1/w0 in periods: every current from none up to the last, and those next to the ends among them. The heavy shaft's
// acceleration is a few bpp per period.
TEST(IfStart, ASpringFromTenToTenThousandPeriods) {
  Motor heavy = motor_b(), light = motor_b();
  heavy.inertia = 0.5;
  heavy.flux = 0.02;
  light.inertia = 6e-5;
  light.flux = 0.2;
  for (const Motor& motor : {heavy, light}) {
    const machine_model_t m = model_of(motor);
    bool seen[2] = {false, false};
    if_start_config_t p = usual();
    for (double current = 100.0; current >= 0.0; current -= (current > 1.0) ? 0.25 : 1.0 / 1024.0) {
      p.current_q20 = raw(current, 20);
      if_start_config_t c = p;
      const bool taken = if_start_design(&c, &m);
      ASSERT_EQ(taken, c.damping_periods >= 10 && c.damping_periods <= 10000) << current;
      seen[0] = seen[0] || c.damping_periods == ((motor.inertia > 0.1) ? 9882 : 10);
      seen[1] = seen[1] || c.damping_periods == ((motor.inertia > 0.1) ? 10674 : 9);
    }
    EXPECT_TRUE(seen[0] && seen[1]);
  }
}

// An eighth of the speed's EMF is what the mean counts for near standstill, lambda w / 8; half a raw number of it is
// the most that is lost. The steps of the speed are one at least.
TEST(IfStart, WhatTheDesignMakesOfTheMachine) {
  const Motor m = motor_b();
  if_start_config_t p = usual();
  const if_start_config_t c = designed(m, p);
  EXPECT_NEAR(real(c.least_q16, 16), 125.7 * m.flux / 8.0, 1e-4);
  EXPECT_NEAR(real(c.per_emf_q4, 4) / bpp(1.0 / m.flux), 1.0, 3e-6);
  EXPECT_NEAR(real(c.reactance_q47, 47) * bpp(1.0) / m.ld, 1.0, 2e-5);
  // (w0 T)^2 = 1.5 p^2 lambda I / J T^2
  const double w0 = std::sqrt(1.5 * 16.0 * m.flux * 8.0 / m.inertia);
  EXPECT_NEAR(c.damping_periods, 1.0 / (w0 * kPeriod), 1.0);
  // Lq I/(lambda w0) is 1.65 ms, and 32 periods the next power of two.
  EXPECT_EQ(c.filter_shift, 5);
  p.step_bpp = 0;
  EXPECT_EQ(designed(m, p).step_bpp, 1);
  p.step_bpp = 7;
  EXPECT_EQ(designed(m, p).step_bpp, 7);
  EXPECT_NE(IF_START_TAKEN_OVER, IF_START_FAILED);
}

// Lq I/(lambda w0), 3 to 8 as the next power of two.
TEST(IfStart, TheFilterIsAsLongAsTheVectorTakesToTurn) {
  std::array<bool, 10> seen{};
  for (const double stretch : {1.0, 4.0, 16.0}) {
    for (double current = 0.25; current <= 16.0; current *= 1.25) {
      Motor m = motor_b();
      m.lq *= stretch;
      if_start_config_t p = usual();
      p.current_q20 = raw(current, 20);
      const if_start_config_t c = designed(m, p);
      const double periods = m.lq * current / m.flux * c.damping_periods;
      const double power = std::log2(periods);
      if (std::fabs(periods - std::exp2(std::round(power))) < 0.6) continue;  // whole periods are compared
      const int shift = std::clamp(static_cast<int>(std::ceil(power)), 3, 8);
      EXPECT_EQ(c.filter_shift, shift) << stretch << " " << current;
      seen[static_cast<std::size_t>(std::clamp(static_cast<int>(std::ceil(power)), 2, 9))] = true;
    }
  }
  for (std::size_t n = 2; n <= 9; ++n) EXPECT_TRUE(seen[n]) << n;
}

// A quarter turn behind first, whichever way it will turn, then led to where it begins, in a quarter of the rest.
TEST(IfStart, ItRisesAQuarterTurnBehind) {
  const if_start_config_t c = designed(motor_b(), usual());
  for (const bool backward : {false, true}) {
    const double way = backward ? -1.0 : 1.0;
    if_start_t s;
    if_start_begin(&s, &c, bam(1.0), backward);
    EXPECT_NEAR(wrapped(rad(s.vector_bam) - (1.0 - way * kPi / 2.0)), 0.0, 1e-6);
    EXPECT_EQ(s.angle_bam, s.vector_bam);
    for (int n = 1; n <= 999; ++n) {
      (void)if_start_step(&s, &c, {0, 0}, 0, 0);
      EXPECT_NEAR(real(s.current_q20, 20), 8.0 * std::min(n / 500.0, 1.0), 1e-3);
      const double led = std::clamp((n - 499) / 250.0, 0.0, 1.0);
      ASSERT_NEAR(wrapped(rad(s.vector_bam) - (1.0 - way * kPi / 2.0 * (1.0 - led))), 0.0, 1e-6) << n;
      ASSERT_EQ(s.speed_bpp, 0);
    }
    for (int n = 0; n < 10; ++n) (void)if_start_step(&s, &c, {0, 0}, 0, 0);
    EXPECT_GT(way * s.speed_bpp, 0.0);
  }
}

// What it sees follows with a 32nd of the difference in each period, the mean with 1/1024. What the vector takes by
// itself does not count.
TEST(IfStart, ItsFiltersHaveTheirTimes) {
  const if_start_config_t c = designed(motor_b(), usual());
  if_start_t s;
  if_start_begin(&s, &c, 0, false);
  const double emf = 10.0, seen = 10.0 * real(c.per_emf_q4, 4);
  double rotor = 0.0, mean = 0.0;
  for (int n = 1; n <= 3000; ++n) {
    const double drop = motor_b().rs * 8.0 * std::min((n - 1) / 500.0, 1.0);  // of the current that is known then
    const double turning = motor_b().ld * 8.0 * rad_per_s(s.speed_bpp);
    if_start_renew(&s, &c, {0, 0});
    (void)if_start_step(&s, &c, raw_dq({drop, emf + turning}, 16), 0, 0);
    rotor += (seen - rotor) / std::ldexp(1.0, c.filter_shift);
    mean += (rotor - mean) / 1024.0;
    ASSERT_NEAR(s.rotor_bpp, rotor, 2e-4 * seen) << n;
    ASSERT_NEAR(s.mean_bpp, mean, 2e-4 * seen) << n;
    const double shift = std::min((rotor - mean) * c.damping_periods / std::ldexp(1.0, 32), 0.125);
    ASSERT_NEAR(wrapped(rad(s.vector_bam - s.angle_bam)), shift * kTurn, 1e-3) << n;
  }
  // The other way, with 45 degrees as well.
  for (int n = 0; n < 20; ++n) (void)if_start_step(&s, &c, raw_dq({0.0, -200.0}, 16), 0, 0);
  EXPECT_NEAR(wrapped(rad(s.vector_bam - s.angle_bam)), -45.0 * kDegree, 1e-6);
}

// Three thousand periods of agreement in a row, and no more of waiting than it is told.
TEST(IfStart, AgreementAndPatienceAreCountedFromTheLastSpeedOn) {
  const if_start_config_t c = designed(motor_b(), usual());
  for (const bool agrees : {false, true}) {
    if_start_t s;
    if_start_begin(&s, &c, 0, false);
    int up = 0;
    if_start_result_t result = IF_START_PENDING;
    while (result == IF_START_PENDING) {
      const std::int32_t next_bpp = std::min(s.speed_bpp + c.step_bpp, c.speed_bpp);
      const std::uint32_t next = s.vector_bam + static_cast<std::uint32_t>(next_bpp);
      // a quarter of the speed off is one digit too many, and so are 80 degrees
      const std::int32_t off = agrees ? 954437176 : 954437177;
      result = if_start_step(&s, &c, {0, 0}, next - static_cast<std::uint32_t>(off),
                             agrees ? c.speed_bpp - c.speed_bpp / 4 + 1 : c.speed_bpp);
      up += if_start_is_up(&s, &c) ? 1 : 0;
    }
    EXPECT_EQ(result, agrees ? IF_START_TAKEN_OVER : IF_START_FAILED);
    EXPECT_EQ(up, agrees ? 3000 : 20001);
  }
  if_start_t s;
  if_start_begin(&s, &c, 0, false);
  while (!if_start_is_up(&s, &c)) (void)if_start_step(&s, &c, {0, 0}, 0, 0);
  const std::uint32_t next = s.vector_bam + static_cast<std::uint32_t>(s.speed_bpp);
  (void)if_start_step(&s, &c, {0, 0}, next, c.speed_bpp - c.speed_bpp / 4);
  EXPECT_EQ(s.agreed, 0);
}

// The current rises in whole shares and has its length from the middle of the time at rest on.
TEST(IfStart, TheCurrentHasItsLengthFromTheMiddleOfTheRestOn) {
  if_start_config_t p = usual();
  p.current_q20 = raw(8.0, 20) + 499;  // no multiple of the steps
  const if_start_config_t c = designed(motor_b(), p);
  if_start_t s;
  if_start_begin(&s, &c, 0, false);
  for (int n = 1; n <= 2000; ++n) {
    (void)if_start_step(&s, &c, {0, 0}, 0, 0);
    ASSERT_EQ(s.current_q20, (n < 500) ? p.current_q20 / 500 * n : p.current_q20) << n;
  }
}

// A rotor that lags steadily shows its speed in the EMF along its mean direction, whatever the lag; near standstill the
// direction is that of no lag, by what `least` weighs.
TEST(IfStart, TheEmfAlongItsDirectionIsTheRotorsSpeed) {
  const Motor m = motor_b();
  const if_start_config_t c = designed(m, usual());
  for (const bool backward : {false, true}) {
    for (const double lag : {-0.9, 0.0, 0.5, 1.2}) {
      for (const double speed : {20.0, 125.7}) {
        const double way = backward ? -1.0 : 1.0;
        if_start_t s;
        if_start_begin(&s, &c, 0, backward);
        const Vector emf = {way * speed * m.flux * std::sin(lag), way * speed * m.flux * std::cos(lag)};
        for (int n = 0; n < 20000; ++n) {
          const double drop = m.rs * 8.0 * std::min((n + 1) / 500.0, 1.0);
          const double turning = m.ld * 8.0 * rad_per_s(s.speed_bpp);
          if (n % 10 == 0) if_start_renew(&s, &c, {0, 0});
          (void)if_start_step(&s, &c, raw_dq({emf.x + drop, emf.y + turning}, 16), 0, 0);
        }
        const Vector along = {way * emf.x, way * emf.y + real(c.least_q16, 16)};
        const double seen = (along.x * emf.x + along.y * emf.y) / along.length() / m.flux;
        // the means end up to 2^10 LSB before what they follow: 0.016 V, of the smallest EMF of 1.7 V
        EXPECT_NEAR(rad_per_s(s.rotor_bpp), seen, 0.01 * speed) << lag << " " << speed;
        EXPECT_NEAR(rad_per_s(s.mean_bpp), seen, 0.01 * speed) << lag << " " << speed;
      }
    }
  }
}

// Agreement is 80 degrees and a quarter of the speed; 3000 periods of it in a row.
TEST(IfStart, WhatCountsAsAgreement) {
  const if_start_config_t c = designed(motor_b(), usual());
  const struct {
    double degrees, speed;
    bool agrees;
  } cases[] = {{0.0, 1.0, true},    {79.0, 1.0, true},  {-79.0, 1.0, true}, {81.0, 1.0, false},
               {-81.0, 1.0, false}, {0.0, 0.76, true},  {0.0, 1.24, true},  {0.0, 0.74, false},
               {0.0, 1.26, false},  {0.0, -1.0, false}, {180.0, 1.0, false}};
  for (const auto& one : cases) {
    if_start_t s;
    if_start_begin(&s, &c, 0, false);
    while (!if_start_is_up(&s, &c)) (void)if_start_step(&s, &c, {0, 0}, 0, 0);
    const auto see = [&](double degrees, double speed) {
      const std::uint32_t next = s.vector_bam + static_cast<std::uint32_t>(s.speed_bpp);
      return if_start_step(&s, &c, {0, 0}, next - bam(degrees * kDegree),
                           static_cast<std::int32_t>(speed * c.speed_bpp));
    };
    for (int n = 0; n < 5; ++n) ASSERT_EQ(see(0.0, 1.0), IF_START_PENDING);
    const std::int32_t before = s.agreed;
    EXPECT_GE(before, 5);
    (void)see(one.degrees, one.speed);
    EXPECT_EQ(s.agreed, one.agrees ? before + 1 : 0) << one.degrees << " " << one.speed;
  }
}

}  // namespace
}  // namespace stillspin::test
