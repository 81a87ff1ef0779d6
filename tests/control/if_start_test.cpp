// The I-F start on a shaft in double precision: the vector's current is what it asks for, at once.

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/if_start.h"
}

namespace stillspin::test {
namespace {

Motor motor_b() {
  Motor m;
  m.rs = 0.175;
  m.ld = 0.76e-3;
  m.lq = 1.63e-3;
  m.flux = 0.0865;
  m.inertia = 2e-3;
  m.friction = 1e-3;
  return m;
}

// 8 A, 100 ms at rest, 500 rpm/s up to 300 rpm, 2 s of patience.
if_start_parameters_t usual() {
  return {raw(8.0, 20), 1000, bpp(500.0 / 60.0 * kTurn * 4.0) / 10000, bpp(125.7), 20000};
}

if_start_config_t designed(const Motor& m, const if_start_parameters_t& p) {
  const machine_model_t model = model_of(m);
  if_start_config_t c;
  EXPECT_TRUE(if_start_design(&c, &model, &p));
  return c;
}

struct Shaft {
  Motor m = motor_b();
  double angle = 0.0, speed = 0.0, load = 0.0;  // electrical; the load against the motion, N m

  // Voltage in the vector's frame, V.
  Vector step(double frame, double current) {
    const double lag = frame - angle;
    const double torque =
        1.5 * m.pole_pairs * (m.flux + (m.ld - m.lq) * current * std::cos(lag)) * current * std::sin(lag);
    const double against = std::clamp(speed, -1.0, 1.0) * load;
    const double accel = (torque - against - m.friction * speed / m.pole_pairs) * m.pole_pairs / m.inertia;
    speed += accel * kPeriod;
    angle += speed * kPeriod;
    return {m.rs * current + speed * m.flux * std::sin(lag), speed * (m.flux * std::cos(lag) + m.ld * current)};
  }
};

struct Turned {
  if_start_result_t result = IF_START_PENDING;
  int periods = 0;
  double swing = 0.0;  // largest departure of the speed from the vector's over the last 100 ms, of it
  if_start_t state = {};
};

// Runs until it ends. The source sees the shaft `off` rad beside where it is, at its own speed.
Turned turn(Shaft& shaft, const if_start_config_t& c, bool backward, double off = 0.0) {
  Turned t;
  if_start_begin(&t.state, 0, backward);
  Vector voltage = {0.0, 0.0};
  double worst[2] = {0.0, 0.0};
  while (t.result == IF_START_PENDING && t.periods < 100000) {
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
  if_start_config_t c;
  const if_start_parameters_t p = usual();
  Motor heavy = motor_b();
  heavy.inertia = 0.5;
  heavy.flux = 0.002;
  const machine_model_t slow = model_of(heavy);
  EXPECT_FALSE(if_start_design(&c, &slow, &p));
  Motor light = motor_b();
  light.inertia = 1e-4;
  light.flux = 0.9;
  const machine_model_t fast = model_of(light);
  if_start_parameters_t strong = p;
  strong.current_q20 = raw(100.0, 20);
  EXPECT_FALSE(if_start_design(&c, &fast, &strong));
}

// An eighth of the speed's EMF is what the mean counts for near standstill, lambda w / 8; half a raw number of it is
// the most that is lost. The steps of the speed are one at least.
TEST(IfStart, WhatTheDesignMakesOfTheMachine) {
  const Motor m = motor_b();
  if_start_parameters_t p = usual();
  const if_start_config_t c = designed(m, p);
  EXPECT_NEAR(real(c.least_q16, 16), 125.7 * m.flux / 8.0, 1e-4);
  EXPECT_NEAR(real(c.per_emf_q4, 4) / bpp(1.0 / m.flux), 1.0, 3e-6);
  // (w0 T)^2 = 1.5 p^2 lambda I / J T^2
  const double w0 = std::sqrt(1.5 * 16.0 * m.flux * 8.0 / m.inertia);
  EXPECT_NEAR(c.damping_periods, 1.0 / (w0 * kPeriod), 1.0);
  p.step_bpp = 0;
  EXPECT_EQ(designed(m, p).step_bpp, 1);
  p.step_bpp = 7;
  EXPECT_EQ(designed(m, p).step_bpp, 7);
  EXPECT_NE(IF_START_TAKEN_OVER, IF_START_FAILED);
}

// A quarter turn behind first, whichever way it will turn, then where it begins.
TEST(IfStart, ItRisesAQuarterTurnBehind) {
  const if_start_config_t c = designed(motor_b(), usual());
  for (const bool backward : {false, true}) {
    const double way = backward ? -1.0 : 1.0;
    if_start_t s;
    if_start_begin(&s, bam(1.0), backward);
    EXPECT_NEAR(wrapped(rad(s.vector_bam) - (1.0 - way * kPi / 2.0)), 0.0, 1e-6);
    EXPECT_EQ(s.angle_bam, s.vector_bam);
    for (int n = 1; n <= 999; ++n) {
      (void)if_start_step(&s, &c, {0, 0}, 0, 0);
      EXPECT_NEAR(real(s.current_q20, 20), 8.0 * std::min(n / 500.0, 1.0), 1e-3);
      ASSERT_NEAR(wrapped(rad(s.vector_bam) - (n < 500 ? 1.0 - way * kPi / 2.0 : 1.0)), 0.0, 1e-6) << n;
      ASSERT_EQ(s.speed_bpp, 0);
    }
    for (int n = 0; n < 10; ++n) (void)if_start_step(&s, &c, {0, 0}, 0, 0);
    EXPECT_GT(way * s.speed_bpp, 0.0);
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
    if_start_begin(&s, 0, false);
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
