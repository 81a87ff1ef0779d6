// Coefficients of the speed controllers against eqs (47)-(54) in double precision, over random drives.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/speed_controller.h"
}

namespace {

using namespace stillspin::test;

struct Design {
  Motor motor;
  int step_periods = 10;
  double alpha = 200.0, trajectory = 8e-3, bandwidth = 20.0, damping = 0.8;

  double step() const { return step_periods * motor.period; }
  double decay() const { return std::exp(-motor.friction * step() / motor.inertia); }
  /// b of (49), rad/s (mechanical) per A, in its limit for B -> 0 too.
  double response() const {
    const double x = motor.friction * step() / motor.inertia;
    const double mean = (x > 1e-9) ? -std::expm1(-x) / x : 1.0;
    return motor.torque_constant() * step() / motor.inertia * mean;
  }
  /// Binary angle per period and rad/s (mechanical).
  double bpp_per_rad_s() const { return motor.pole_pairs * motor.period / kTurn * std::ldexp(1.0, 32); }

  speed_controller_config_t config() const {
    speed_controller_config_t c;
    c.friction_q24 = raw(motor.friction, 24);
    c.inertia_q24 = raw(motor.inertia, 24);
    c.step_periods = step_periods;
    c.alpha_q8 = raw(alpha, 8);
    c.trajectory_ms_q8 = raw(trajectory * 1e3, 8);
    c.pi_bandwidth_q8 = raw(bandwidth, 8);
    c.pi_damping_q12 = raw(damping, 12);
    return c;
  }
};

void check(const Design& wanted) {
  Design d = wanted;
  d.motor.inertia = real(raw(wanted.motor.inertia, 24), 24);  // what the firmware is told
  d.motor.friction = real(raw(wanted.motor.friction, 24), 24);
  const machine_model_t m = model_of(d.motor);
  const speed_controller_config_t c = d.config();
  speed_controller_t s;
  ASSERT_TRUE(speed_controller_init(&s, &c, &m));
  const double b_bpp = d.response() * d.bpp_per_rad_s();
  const double b = d.response();
  // B/J has 20 fractional bits; at most 1e-6 of the exponent per second of step
  ASSERT_NEAR(real(s.decay_q30, 30), d.decay(), 1e-8);
  // the machine's constants: acceleration to 4e-5 and half an LSB of Q12 per pole pair, torque constant to 1e-6
  const double relative = 6e-5 + 0.6 * d.motor.pole_pairs / m.accel_q12 + real(1, 24) * 20 / real(m.torque_q24, 24);
  ASSERT_NEAR(real(s.response_q8, 8), b_bpp, 0.01 + b_bpp * relative);
  ASSERT_NEAR(real(s.gains.amps_per_bpp, 40) * b_bpp, 1.0, relative + 1e-5 + 0.5 / s.gains.amps_per_bpp);
  // (54): k b = alpha b^2 / (alpha b^2 + 1). The controller takes b without the small factor of (49): B Ts / 2 J of it.
  const double weight = d.alpha * std::min(b * b, 128.0);  // 128: the end of the format, k b is 0.99 there
  const double exact = weight / (weight + 1.0);
  const double x = d.motor.friction * d.step() / d.motor.inertia;
  ASSERT_NEAR(real(s.gains.share_q30, 30), exact, 2e-4 + (x + 2e-3) * exact * (1.0 - exact) + 2e-5 / (weight + 1.0));
  const double approach = -std::expm1(-d.step() / (real(c.trajectory_ms_q8, 8) * 1e-3));
  ASSERT_NEAR(real(s.approach_q30, 30) / approach, 1.0, 6e-5);  // the trajectory in whole periods of 2 ms and more
  ASSERT_EQ(s.current_q20, 0);
  ASSERT_EQ(s.integral_q20, 0);
  // PI: Kp = 2 zeta wn J / Kt, Ki Ts = wn^2 Ts J / Kt, in A per bpp
  const double j_kt = d.motor.inertia / d.motor.torque_constant() / d.bpp_per_rad_s();
  const double kp = 2.0 * d.damping * d.bandwidth * j_kt;
  const double ki = d.bandwidth * d.bandwidth * d.step() * j_kt;
  // the bandwidth has 8 fractional bits, and (wn Ts)^2 24
  const double wn_relative = 1.0 / 512.0 / d.bandwidth + 1e-3;
  const double square = d.bandwidth * d.bandwidth * d.step() * d.step();
  ASSERT_NEAR(real(s.gains.pi_kp, 40), kp, real(2, 40) + kp * (wn_relative + x + relative));
  ASSERT_NEAR(real(s.gains.pi_ki, 40), ki,
              real(2, 40) + ki * (2.0 * wn_relative + x + relative + real(1, 24) / square));
}

TEST(SpeedController, CoefficientsOfMotorA) { check(Design{}); }

// What the gains are scaled to is what they would have been with that inertia from the beginning.
TEST(SpeedController, ScaledGainsAreThoseOfAnotherInertia) {
  for (const double ratio : {0.5, 0.8, 1.0, 2.0}) {
    Design told, other;
    other.motor.inertia = told.motor.inertia / ratio;
    const machine_model_t m = model_of(told.motor), n = model_of(other.motor);
    const speed_controller_config_t c = told.config(), e = other.config();
    speed_controller_t s, exact;
    ASSERT_TRUE(speed_controller_init(&s, &c, &m));
    ASSERT_TRUE(speed_controller_init(&exact, &e, &n));
    speed_controller_scale(&s, raw(0.6, 24));  // no matter what it was before
    speed_controller_scale(&s, raw(ratio, 24));
    EXPECT_NEAR(static_cast<double>(s.gains.amps_per_bpp) / exact.gains.amps_per_bpp, 1.0, 1e-3) << ratio;
    EXPECT_NEAR(real(s.gains.share_q30, 30), real(exact.gains.share_q30, 30), 1e-3) << ratio;
    EXPECT_NEAR(static_cast<double>(s.gains.pi_kp) / exact.gains.pi_kp, 1.0, 2e-3) << ratio;
    EXPECT_NEAR(static_cast<double>(s.gains.pi_ki) / exact.gains.pi_ki, 1.0, 2e-3) << ratio;
  }
}

TEST(SpeedController, CoefficientsOfRandomDrives) {
  Random random(40);
  int used = 0;
  for (int n = 0; n < 3000; ++n) {
    Design d;
    d.motor.inertia = random.log_between(2e-4, 0.1);
    d.motor.friction = d.motor.inertia * random.log_between(1e-3, 50.0);
    if (d.motor.friction > 0.9) d.motor.friction = 0.9;
    d.motor.flux = random.log_between(0.02, 0.5);
    d.motor.pole_pairs = 1 + random.below(8);
    d.alpha = random.log_between(2.0, 90000.0);
    d.trajectory = random.log_between(2.2e-3, 0.19);
    d.bandwidth = random.log_between(2.0, 190.0);
    d.damping = random.between(0.31, 2.9);
    const double gain = std::max(1.0, 2.0 * d.damping * d.bandwidth * d.step());
    if (d.response() * d.bpp_per_rad_s() < 520.0 * gain) continue;  // too heavy for the gains' format
    if (d.response() * d.bpp_per_rad_s() > 8.3e6) continue;         // too light
    used++;
    ASSERT_NO_FATAL_FAILURE(check(d)) << n << ": J " << d.motor.inertia << ", B " << d.motor.friction << ", flux "
                                      << d.motor.flux << ", pp " << d.motor.pole_pairs << ", alpha " << d.alpha;
  }
  EXPECT_GT(used, 1500);
}

// With 1/b at the end of its format the loop would be silently too slow.
TEST(SpeedController, RefusesRotorsThatAreTooHeavyOrTooLight) {
  for (const double inertia : {0.4, 0.6, 0.99}) {
    Design d;
    d.motor.inertia = inertia;
    const machine_model_t m = model_of(d.motor);
    const speed_controller_config_t c = d.config();
    speed_controller_t s;
    EXPECT_EQ(speed_controller_init(&s, &c, &m), inertia < 0.5) << inertia;
  }
  Design light;  // 7 N m per A on 1e-4 kg m2: more than 8 million bpp per A and step
  light.motor.inertia = 1.01e-4;
  light.motor.friction = 0.0;
  light.motor.flux = 0.9;
  light.motor.pole_pairs = 5;
  const machine_model_t m = model_of(light.motor);
  const speed_controller_config_t c = light.config();
  speed_controller_t s;
  EXPECT_FALSE(speed_controller_init(&s, &c, &m));
}

TEST(SpeedController, NoFrictionIsTheLimitOfSmallFriction) {
  Design d;
  d.motor.friction = 0.0;
  check(d);
  d.motor.friction = 1e-7;
  check(d);
}

// Where the rest leaves them room.
TEST(SpeedController, BothEndsOfEachRangeAreTaken) {
  const machine_model_t m = model_of(Motor{});
  using Field = std::int32_t speed_controller_config_t::*;
  const struct {
    Field field;
    std::int32_t low, high;
  } ranges[] = {
      {&speed_controller_config_t::friction_q24, 0, 16777216},
      {&speed_controller_config_t::inertia_q24, 168, 16777216},
      {&speed_controller_config_t::step_periods, 1, 100},
      {&speed_controller_config_t::alpha_q8, 256, 25600000},
      {&speed_controller_config_t::trajectory_ms_q8, 256, 51200},
      {&speed_controller_config_t::pi_bandwidth_q8, 256, 51200},
      {&speed_controller_config_t::pi_damping_q12, 1228, 245760},
  };
  Design slow;
  slow.step_periods = 5;
  slow.trajectory = 50e-3;
  const auto taken = [&](Field field, std::int32_t value) {
    speed_controller_config_t config = slow.config();
    config.*field = value;
    speed_controller_t s;
    return speed_controller_init(&s, &config, &m);
  };
  for (const auto& range : ranges) {
    EXPECT_TRUE(taken(range.field, range.low)) << range.low;
    EXPECT_TRUE(taken(range.field, range.high)) << range.high;
  }
}

TEST(SpeedController, RefusesAFrictionForWhichTheSeriesDoNotHold) {
  for (const double inertia : {6e-4, 1.7e-3}) {  // B Ts / J = 1.5 and 0.53
    Design sticky;
    sticky.motor.friction = 0.9;
    sticky.motor.inertia = inertia;
    const machine_model_t light = model_of(sticky.motor);
    const speed_controller_config_t config = sticky.config();
    speed_controller_t s;
    EXPECT_FALSE(speed_controller_init(&s, &config, &light)) << inertia;
  }
}

// Half of B Ts / J, just below where the series are no longer taken: each of their terms counts.
TEST(SpeedController, TheSeriesAreGoodToTheirEnd) {
  Design d;
  d.motor.friction = 0.98;
  d.motor.inertia = 0.98e-3 / 0.4995;
  const machine_model_t m = model_of(d.motor);
  speed_controller_config_t c = d.config();
  speed_controller_t with, without;
  ASSERT_TRUE(speed_controller_init(&with, &c, &m));
  const double x = 1e-3 * c.friction_q24 / c.inertia_q24;
  // Ts as Q30 is right to 4.7e-7 of 1 ms, so is x
  EXPECT_NEAR(real(with.decay_q30, 30), std::exp(-x), 4e-7);
  c.friction_q24 = 0;
  ASSERT_TRUE(speed_controller_init(&without, &c, &m));
  // both are rounded to one of some 10^8
  EXPECT_NEAR(static_cast<double>(with.response_q8) / without.response_q8, -std::expm1(-x) / x, 4e-7);
}

// (53), one step, from any state.
TEST(SpeedController, OneStepOfThePredictiveLaw) {
  Random random(41);
  const Design d;
  const machine_model_t m = model_of(d.motor);
  const speed_controller_config_t c = d.config();
  speed_controller_t s;
  ASSERT_TRUE(speed_controller_init(&s, &c, &m));
  const double b = d.response();
  const double share = d.alpha * b * b / (d.alpha * b * b + 1.0);
  for (int n = 0; n < 5000; ++n) {
    const double before = random.between(-10.0, 10.0);
    const double w = random.between(-300.0, 300.0);
    const double reference = w + random.between(-30.0, 30.0);
    const double ramp = random.between(-1.0, 1.0);
    const double load = random.between(-8.0, 8.0);
    const double limit = random.between(1.0, 14.0);
    speed_controller_preset(&s, raw(before, 20));
    const auto to_bpp = [&](double mechanical) { return raw(mechanical * d.bpp_per_rad_s(), 0); };
    const speed_controller_input_t in = {to_bpp(reference), to_bpp(ramp),    to_bpp(w),
                                         raw(load, 20),     raw(-limit, 20), raw(limit, 20)};
    const double target = w + ramp + (reference - w) * -std::expm1(-d.step() / d.trajectory);
    const double own = before + share / b * (target - d.decay() * w - b * before);
    const double expected = std::max(-limit, std::min(limit, own + load));
    const double got = real(speed_controller_step(&s, SPEED_PREDICTIVE, &in), 20);
    // share and b are right to 3e-4, the deadbeat current is up to 200 A
    ASSERT_NEAR(got, expected, 0.06) << n;
    ASSERT_NEAR(real(s.current_q20, 20), got - load, 1e-5);  // what flows for the shaft, after the limit
    ASSERT_LE(std::fabs(got), limit + 1e-6);
  }
}

// A trajectory as fast as the controller's own step would be overshot by it; then the command is the target, as
// printed: (53) to (55) with w_r = w*.
TEST(SpeedController, WithoutATrajectoryTheCommandIsTheTarget) {
  Random random(43);
  Design d;
  for (const double trajectory : {2.5e-3, 2.0e-3}) {  // two steps of 1 ms are the shortest that there is
    d.trajectory = trajectory;
    const machine_model_t m = model_of(d.motor);
    const speed_controller_config_t c = d.config();
    speed_controller_t s;
    ASSERT_TRUE(speed_controller_init(&s, &c, &m));
    EXPECT_LT(s.approach_q30, raw(0.64, 30)) << trajectory;
  }
  d.trajectory = 2.5e-3;
  for (const int periods : {10, 20}) {  // 1 ms and 2 ms
    d.step_periods = periods;
    const machine_model_t m = model_of(d.motor);
    const speed_controller_config_t c = d.config();
    speed_controller_t s;
    ASSERT_TRUE(speed_controller_init(&s, &c, &m));
    EXPECT_EQ(s.approach_q30 == raw(1.0, 30), periods == 20);
  }
  const double b = d.response();
  const double k = d.alpha * b / (d.alpha * b * b + 1.0);
  for (int n = 0; n < 2000; ++n) {
    const machine_model_t m = model_of(d.motor);
    const speed_controller_config_t c = d.config();
    speed_controller_t s;
    ASSERT_TRUE(speed_controller_init(&s, &c, &m));
    const double before = random.between(-10.0, 10.0), w = random.between(-300.0, 300.0);
    const double next = w + random.between(-20.0, 20.0);
    speed_controller_preset(&s, raw(before, 20));
    const auto to_bpp = [&](double mechanical) { return raw(mechanical * d.bpp_per_rad_s(), 0); };
    const speed_controller_input_t in = {to_bpp(next), 0, to_bpp(w), 0, raw(-1000.0, 20), raw(1000.0, 20)};
    const double expected = before + k * (next - d.decay() * w - b * before);
    ASSERT_NEAR(real(speed_controller_step(&s, SPEED_PREDICTIVE, &in), 20), expected, 0.06) << n;
  }
}

// The proportional gain is 2 zeta wn Ts times the deadbeat's: its format ends at a lighter rotor when that is above 1.
TEST(SpeedController, RefusesAProportionalGainBeyondItsFormat) {
  for (const double damping : {1.0, 2.9}) {
    Design d;
    d.bandwidth = 199.0;
    d.damping = damping;
    d.motor.inertia = 0.48;  // the deadbeat's gain is just below the end
    const machine_model_t m = model_of(d.motor);
    const speed_controller_config_t c = d.config();
    speed_controller_t s;
    EXPECT_EQ(speed_controller_init(&s, &c, &m), damping < 2.0) << damping;
  }
}

// At the limit the integral may not grow, but must come back when the speed has passed its reference.
TEST(SpeedController, AtTheLimitTheIntegralOnlyComesBack) {
  const Design d;
  const machine_model_t m = model_of(d.motor);
  const speed_controller_config_t c = d.config();
  speed_controller_t s;
  ASSERT_TRUE(speed_controller_init(&s, &c, &m));
  const std::int32_t error = raw(1.0 * d.bpp_per_rad_s(), 0);
  for (const int sign : {1, -1}) {
    const std::int32_t wound = sign * raw(9.0, 20);
    speed_controller_input_t in = {sign * error, 0, 0, 0, raw(-2.0, 20), raw(2.0, 20)};
    speed_controller_preset(&s, wound);
    EXPECT_EQ(speed_controller_step(&s, SPEED_PI, &in), sign * raw(2.0, 20));
    EXPECT_EQ(s.integral_q20, wound) << "grew at the limit";
    in.reference_bpp = -sign * error;
    EXPECT_EQ(speed_controller_step(&s, SPEED_PI, &in), sign * raw(2.0, 20));
    EXPECT_LT(sign * s.integral_q20, sign * wound) << "stays wound up";
    in.lowest_q20 = raw(-20.0, 20);  // within the limits it follows the error
    in.highest_q20 = raw(20.0, 20);
    in.reference_bpp = sign * error;
    const std::int32_t before = s.integral_q20;
    (void)speed_controller_step(&s, SPEED_PI, &in);
    EXPECT_GT(sign * s.integral_q20, sign * before);
  }
}

}  // namespace
