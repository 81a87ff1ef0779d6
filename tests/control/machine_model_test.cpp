// The machine's constants against the SI formulas, over random machines and the ends of the ranges.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

namespace {

using stillspin::test::kPeriod;
using stillspin::test::kTurn;
using stillspin::test::Motor;
using stillspin::test::parameters_of;
using stillspin::test::Random;
using stillspin::test::raw;
using stillspin::test::raw_dq;
using stillspin::test::real;

// The error allowed: some LSB of the result plus what the arguments' own rounding does.
void expect_close(double got, double exact, double lsb, double relative, const char* what) {
  ASSERT_NEAR(got, exact, lsb + std::fabs(exact) * relative) << what;
}

bool fits(const Motor& m) {
  const double y_max = m.period / m.ld;
  const double accel = m.pole_pairs * m.period * m.period / (kTurn * m.inertia) * std::ldexp(1.0, 32);
  return y_max < 0.59 && m.flux / m.period < 31900.0 && m.lq / m.ld < 63.0 && accel < 524000.0 &&
         m.flux / m.lq < 990.0 && 1.5 * m.pole_pairs * m.flux < 29.9 && 4.0 * m.lq / m.period < 31900.0;
}

// Inductances and fluxes are rounded to the firmware's format before they are used; the formulas get the same numbers.
Motor as_stored(const Motor& m) {
  const machine_parameters_t p = parameters_of(m);
  Motor s = m;
  s.rs = real(p.rs_q24, 24);
  s.ld = real(p.ld_q30, 30);
  s.lq = real(p.lq_q30, 30);
  s.flux = real(p.flux_q28, 28);
  s.inertia = real(p.inertia_q24, 24);
  s.period = p.period_us * 1e-6;
  return s;
}

void check(const Motor& asked) {
  const machine_parameters_t p = parameters_of(asked);
  const Motor s = as_stored(asked);
  machine_model_t m = {};
  ASSERT_TRUE(machine_model_init(&m, &p));
  // T as Q30 is right to 2^-31 s, 2.4e-5 of 20 us
  const double t_rel = std::ldexp(1.0, -31) / s.period * 1.01;
  expect_close(real(m.yd_q30, 30), s.period / s.ld, std::ldexp(1.0, -30), t_rel, "yd");
  expect_close(real(m.yq_q30, 30), s.period / s.lq, std::ldexp(1.0, -30), t_rel, "yq");
  expect_close(real(m.emf_q16, 16), s.flux / s.period, std::ldexp(1.0, -16), t_rel, "emf");
  // K comes from the rounded inverse inductances: 2^-31 of each, relative to yq
  const double y_rel = std::ldexp(1.0, -30) / real(m.yq_q30, 30);
  // the ratio, its square and the determinant's inverse are rounded one after the other
  const double ratio = s.lq / s.ld;
  expect_close(real(m.k_dq_q24, 24), ratio - 1.0, std::ldexp(2.0, -24) + y_rel * ratio, 1e-9, "K_dq");
  expect_close(real(m.k_qd_q24, 24), 1.0 - 1.0 / ratio, std::ldexp(2.0, -24) + y_rel, 1e-9, "K_qd");
  EXPECT_EQ(m.k_dd_q24, 0);
  EXPECT_EQ(m.k0_q20.d, 0);
  expect_close(real(m.k0_q20.q, 20), -s.flux / s.lq,
               std::ldexp(1.0, -20) + std::ldexp(1.0, -16) * s.period / s.lq + y_rel * s.flux / s.lq, 2.0 * t_rel,
               "k0_q");
  // flux / 16 and (Ld - Lq) / 64 are cut off to whole LSB of Q24
  const double torque_lsb = 1.5 * s.pole_pairs * std::ldexp(1.0, -24) + std::ldexp(1.0, -24);
  expect_close(real(m.torque_q24, 24), 1.5 * s.pole_pairs * s.flux, torque_lsb, 0.0, "torque");
  expect_close(real(m.reluctance_q24, 24), 1.5 * s.pole_pairs * (s.ld - s.lq), torque_lsb, 0.0, "reluctance");
  // 2867 stands for 2867.08 (3e-5); the quotient is rounded once per pole pair
  const double accel = s.pole_pairs * s.period * s.period / (kTurn * s.inertia) * std::ldexp(1.0, 32);
  expect_close(real(m.accel_q12, 12), accel, (0.5 * s.pole_pairs + 0.5) * std::ldexp(1.0, -12), 4e-5, "acceleration");
  // N m as Q16 of an acceleration as Q8; a heavy rotor's ends with the format
  const double torque_per_accel = std::fmin(256.0 / real(m.accel_q12, 12), 128.0);
  expect_close(real(m.torque_per_accel_q24, 24), torque_per_accel, std::ldexp(1.0, -24), 0.0,
               "torque per acceleration");
  EXPECT_EQ(m.periods_per_second, std::lround(1.0 / s.period));
}

TEST(MachineModel, MotorA) { check(Motor{}); }

TEST(MachineModel, RandomMachines) {
  Random random(10);
  int used = 0;
  for (int n = 0; n < 20000; ++n) {
    Motor m;
    m.rs = random.log_between(0.0011, 49.0);
    m.ld = random.log_between(33.5e-6, 0.4);
    m.lq = std::min(m.ld * random.log_between(1.0, 20.0), 0.49);
    m.flux = random.log_between(0.00101, 0.99);
    m.inertia = random.log_between(1.01e-5, 0.99);
    m.pole_pairs = 1 + random.below(30);
    m.period = (20 + random.below(481)) * 1e-6;
    if (!fits(m)) continue;
    used++;
    ASSERT_NO_FATAL_FAILURE(check(m)) << m.ld << " H, " << m.lq << " H, " << m.flux << " Vs, " << m.inertia << " kgm2, "
                                      << m.pole_pairs << ", " << m.period;
  }
  EXPECT_GT(used, 5000);  // otherwise nothing was tested
}

TEST(MachineModel, EndsOfTheRanges) {
  Motor m;
  m.rs = 50.0;
  check(m);
  m.rs = 0.00101;
  check(m);
  m.ld = m.lq = 0.5;
  check(m);
  m.flux = 1.0;
  check(m);
  m.ld = m.lq = 168e-6;
  m.flux = 0.1;
  check(m);
  m.inertia = 1.0;
  check(m);
  m.pole_pairs = 30;
  check(m);
}

// A constant that saturates would be a wrong machine without a word.
TEST(MachineModel, RejectsMachinesWhoseConstantsDoNotFit) {
  machine_model_t m = {};
  Motor light;
  light.inertia = 1.01e-5;
  light.pole_pairs = 20;
  light.period = 500e-6;
  Motor fast;  // y = 5 A per V and period
  fast.ld = fast.lq = 100e-6;
  fast.period = 500e-6;
  Motor strong;  // lambda / T = 50000 V
  strong.flux = 1.0;
  strong.period = 20e-6;
  Motor salient;  // Lq / Ld = 1000
  salient.ld = 0.4e-3;
  salient.lq = 0.4;
  Motor loose;  // lambda / Lq = 3200 A
  loose.ld = loose.lq = 101e-6;
  loose.flux = 0.323;
  Motor torquey;  // 3/2 p lambda = 30.15 N m/A
  torquey.flux = 0.67;
  torquey.pole_pairs = 30;
  for (const Motor& motor : {light, fast, strong, salient, loose, torquey}) {
    const machine_parameters_t p = parameters_of(motor);
    EXPECT_FALSE(machine_model_init(&m, &p)) << motor.ld << ", " << motor.flux << ", " << motor.inertia;
  }
}

TEST(MachineModel, TorqueWithReluctance) {
  Random random(11);
  const Motor motor;
  const machine_model_t m = stillspin::test::model_of(motor);
  for (int n = 0; n < 5000; ++n) {
    const double id = random.between(-20.0, 20.0);
    const double iq = random.between(-20.0, 20.0);
    const double kt = 1.5 * motor.pole_pairs * (motor.flux + (motor.ld - motor.lq) * id);
    // constants cut off at Q24 times 6 (4e-7), times 20 A: 1e-5; the result's own LSB is 1.5e-5
    ASSERT_NEAR(real(machine_torque_constant_q24(&m, raw(id, 20)), 24), kt, 1e-5);
    ASSERT_NEAR(real(machine_torque_q16(&m, raw_dq({id, iq}, 20)), 16), kt * iq, 2e-4);
  }
}

// The torque constant is divided by: it must not come near zero, let alone change its sign.
TEST(MachineModel, TorqueConstantKeepsAQuarterOfTheMagnets) {
  const Motor motor;
  const machine_model_t m = stillspin::test::model_of(motor);
  for (const double id : {45.0, 55.0, 1000.0}) {  // 0.16 / 0.0029 = 55 A cancel the magnet
    EXPECT_NEAR(real(machine_torque_constant_q24(&m, raw(id, 20)), 24), 0.25 * motor.torque_constant(), 1e-6) << id;
  }
  EXPECT_NEAR(real(machine_torque_constant_q24(&m, raw(-50.0, 20)), 24), 6.0 * (0.16 + 0.0029 * 50.0), 1e-4);
}

TEST(MachineModel, SpeedInRadPerPeriod) {
  for (const double w : {-1.8, -0.1257, -1e-6, 0.0, 1e-6, 0.05, 1.8}) {
    const std::int32_t speed_bpp = raw(w / kTurn, 32);
    EXPECT_NEAR(real(machine_speed_rad_q30(speed_bpp), 30), w, 2e-9) << w;
  }
}

// Both ends of each range, in machines that the formats hold.
TEST(MachineModel, TheEndsOfTheRangesAreTaken) {
  const struct {
    std::int32_t machine_parameters_t::* field;
    std::int32_t end, period_us;
  } ends[] = {{&machine_parameters_t::rs_q24, 16777, 500},    {&machine_parameters_t::rs_q24, 838860800, 500},
              {&machine_parameters_t::ld_q30, 35840, 20},     {&machine_parameters_t::ld_q30, 10737418, 500},
              {&machine_parameters_t::lq_q30, 10737418, 500}, {&machine_parameters_t::lq_q30, 536870912, 500},
              {&machine_parameters_t::flux_q28, 268435, 500}, {&machine_parameters_t::flux_q28, 268435456, 500},
              {&machine_parameters_t::inertia_q24, 168, 20},  {&machine_parameters_t::inertia_q24, 16777216, 500},
              {&machine_parameters_t::pole_pairs, 1, 500},    {&machine_parameters_t::pole_pairs, 30, 500},
              {&machine_parameters_t::period_us, 20, 20},     {&machine_parameters_t::period_us, 500, 500}};
  for (const auto& one : ends) {
    machine_parameters_t p = {16777216, 10737418, 10737418, 2684355, 167772, 1, one.period_us};  // 10 mH, 0.01 Vs
    p.*one.field = one.end;
    if (one.field == &machine_parameters_t::ld_q30) p.lq_q30 = p.ld_q30;
    machine_model_t m;
    EXPECT_TRUE(machine_model_init(&m, &p)) << one.end;
  }
}

// Just inside and just outside of what the constants' formats hold.
TEST(MachineModel, FormatsEndWhereTheyAreSaidTo) {
  const auto taken = [](const Motor& motor) {
    const machine_parameters_t p = parameters_of(motor);
    machine_model_t m;
    return machine_model_init(&m, &p);
  };
  Motor salient;  // Lq / Ld
  salient.flux = 0.05;
  salient.ld = 1e-3;
  salient.lq = 63.5e-3;
  EXPECT_TRUE(taken(salient));
  salient.lq = 64.5e-3;
  EXPECT_FALSE(taken(salient));
  Motor loose;  // lambda / L, A
  loose.ld = loose.lq = 200e-6;
  loose.flux = 0.199;
  EXPECT_TRUE(taken(loose));
  loose.flux = 0.201;
  EXPECT_FALSE(taken(loose));
  Motor strong;  // lambda / T, V
  strong.period = 20e-6;
  strong.flux = 0.638;
  EXPECT_TRUE(taken(strong));
  strong.flux = 0.642;
  EXPECT_FALSE(taken(strong));
}

// An inertia that was learnt makes the model that of another rotor, whatever it was scaled to before.
TEST(MachineModel, AScaledInertiaIsThatOfAnotherRotor) {
  const Motor motor;
  const machine_model_t told = model_of(motor);
  machine_model_t m = told;
  for (const double ratio : {0.5, 2.0, 0.7, 1.0}) {
    Motor other = motor;
    other.inertia = motor.inertia / ratio;
    const machine_model_t exact = model_of(other);
    machine_model_scale_inertia(&m, &told, raw(ratio, 24));
    EXPECT_NEAR(static_cast<double>(m.accel_q12) / exact.accel_q12, 1.0, 1e-3) << ratio;
    EXPECT_NEAR(static_cast<double>(m.torque_per_accel_q24) / exact.torque_per_accel_q24, 1.0, 1e-3) << ratio;
  }
}

// A map whose determinant nearly vanishes: K_dd counts twice in what is made of it (estimators/deviation.c).
TEST(MachineModel, AnAxisThatTurnsTooFarEndsWithItsFormat) {
  machine_model_t m = stillspin::test::model_of(Motor{});
  machine_map_parameters_t map = {};
  map.current_q20 = raw(14.0, 20);
  for (int k = 0; k < MACHINE_MAP_POINTS; ++k) {
    map.ldd_q30[k] = map.lqq_q30[k] = raw(50e-3, 30);
    map.ldq_q30[k] = (k == 0) ? 0 : raw(49.75e-3, 30);
  }
  ASSERT_TRUE(machine_model_saturate(&m, &map));
  for (const double iq : {14.0, -14.0}) {
    machine_model_move(&m, raw(iq, 20));
    EXPECT_NEAR(std::fabs(real(m.k_dd_q24, 24)), 32.0, 1e-6);
    EXPECT_EQ(m.k_dd_q24 > 0, iq > 0.0);
  }
}

}  // namespace
