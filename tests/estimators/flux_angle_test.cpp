// The fixed-point equations of the stator-flux family against the paper's in double precision.

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/estimators/flux_paper.hpp"

extern "C" {
#include "estimators/flux_angle.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::flux_paper;

flux_machine_t machine_of(const Motor& m) {
  const machine_model_t model = model_of(m);
  flux_machine_t f = {};
  EXPECT_TRUE(flux_machine_init(&f, &model));
  return f;
}

// T as the model has it, Q30: 1.7e-6 off, and every flux/T with it.
const double kModelPeriod = real(107374, 30);

flux_vectors_t vectors_of(const flux_machine_t& f, Vector flux, Vector i) {
  return flux_vectors(&f, raw_ab(flux * (1.0 / kModelPeriod), 16), raw_ab(i, 20));
}

struct Case {
  const char* name;
  Motor motor;
  double limit;  // A
};
const Case kCases[] = {{"A", Motor{}, 14.0}, {"B", motor_b(), 25.0}, {"B-SPM", motor_b_spm(), 25.0}};

struct Worst {
  double angle = 0.0, current = 0.0, torque = 0.0;
  void print(const char* what, const char* motor) const {
    std::printf("%s, motor %s: worst %.1e rad, %.1e A, %.1e N m\n", what, motor, angle, current, torque);
  }
};

void widen(double* worst, double error) { *worst = std::fmax(*worst, std::fabs(error)); }

// What the flux estimator may be wrong by, on top of a random operating point: the equations must agree anyway.
Vector disturbed(Vector flux, Random& random, double share) { return flux + random.direction(share * flux.length()); }

TEST(FluxAngle, AgreesWithThePaperOverRandomOperatingPoints) {
  Random random(310);
  for (const Case& c : kCases) {
    const flux_machine_t f = machine_of(c.motor);
    Worst w;
    for (int n = 0; n < 50000; ++n) {
      const double theta = random.between(-kPi, kPi);
      const Vector i_dq = random.direction(random.between(0.0, c.limit)), i = i_dq.turned(theta);
      const Vector flux = disturbed(flux_dq(c.motor, i_dq).turned(theta), random, 0.1);
      const flux_vectors_t v = vectors_of(f, flux, i);
      widen(&w.angle, wrapped(rad(flux_stator_angle(&v)) - angle(flux)));
      widen(&w.angle, wrapped(rad(flux_active_angle(&v)) - active_flux_angle(c.motor, flux, i)));
      widen(&w.angle, wrapped(rad(flux_load_angle_ft(&v)) - conv_load_angle(c.motor, flux, i)));
      widen(&w.torque, real(flux_torque_q16(&f, &v), 16) - torque_ab(c.motor, flux, i));
      const double expected = std::pow(reference_flux(c.motor, i_dq) / c.motor.flux, 2);
      ASSERT_NEAR(real(flux_reference_square_q24(&f, raw_dq(i_dq, 20)), 24), expected, 2e-6);
    }
    w.print("(7b), (11)-(15), (33)", c.name);
    EXPECT_LT(w.angle, 2e-6);
    EXPECT_LT(w.torque, 1e-4);
  }
}

// i_d is a root: its slope grows without bound where the argument goes to zero. So the tolerance is what the argument's
// last bits are worth there; elsewhere it is 1e-4 A.
TEST(FluxAngle, ProposedCurrentsAgreeWithThePaper) {
  Random random(311);
  for (const Case& c : kCases) {
    const flux_machine_t f = machine_of(c.motor);
    Worst w;
    for (int n = 0; n < 50000; ++n) {
      const double theta = random.between(-kPi, kPi);
      const Vector i = random.direction(random.between(0.0, c.limit)).turned(theta);
      const Vector flux = disturbed(flux_dq(c.motor, i.turned(-theta)).turned(theta), random, 0.1);
      const flux_vectors_t v = vectors_of(f, flux, i);
      const dq_t yz = flux_currents_q24(&f, &v, flux_square_q24(&v));
      const double id = id_of(c.motor, flux.length(), i.length());
      if (c.motor.lq > c.motor.ld && radicand(c.motor, flux.length(), i.length()) < 1.0) continue;  // the next test
      const double iq = iq_of(c.motor, torque_ab(c.motor, flux, i), id);
      widen(&w.current, real(yz.d, 24) * c.motor.flux / c.motor.ld - id);
      widen(&w.current, real(yz.q, 24) * c.motor.flux / c.motor.lq - iq);
      widen(&w.angle, wrapped(rad(flux_load_angle_dq(yz)) - load_angle(c.motor, id, iq)));
    }
    w.print("(27)-(31)", c.name);
    EXPECT_LT(w.current, 1e-3);
    EXPECT_LT(w.angle, 5e-6);
  }
}

// At and beyond the limit (23) of the flux the guarded root gives i_d = A, from both sides continuously.
TEST(FluxAngle, TheRootAtItsLimit) {
  Random random(312);
  for (const Case& c : {kCases[0], kCases[1]}) {
    const Motor& m = c.motor;
    const flux_machine_t f = machine_of(m);
    const double a = m.lq * m.lq - m.ld * m.ld, apex = m.flux * m.ld / a;
    double worst = 0.0;
    for (int n = 0; n < 20000; ++n) {
      const double theta = random.between(-kPi, kPi), current = random.between(0.0, c.limit);
      const double limit = std::sqrt(m.lq * m.lq * m.flux * m.flux / a + m.lq * m.lq * current * current);  // (23)
      const double beyond = random.between(-1e-4, 1e-4) * ((n % 4 == 0) ? 1000.0 : 1.0);
      const Vector flux = Vector{limit * (1.0 + beyond), 0.0}.turned(theta);
      const Vector i = random.direction(current);
      const flux_vectors_t v = vectors_of(f, flux, i);
      const dq_t yz = flux_currents_q24(&f, &v, flux_square_q24(&v));
      const double id = real(yz.d, 24) * m.flux / m.ld, expected = id_ipm(m, flux.length(), i.length());
      // Q24 of the argument: 2e-7 of (psi_m / L_d)^2 / (s^2 - 1)^2 beside (A - i_d)^2.
      const double slack = 5e-7 * apex * apex / std::fmax(std::fabs(apex - expected), 7e-4 * apex) * 4.0;
      ASSERT_NEAR(id, expected, slack + 1e-3) << beyond;
      ASSERT_LE(id, apex + 1e-4);
      worst = std::fmax(worst, std::fabs(id - expected));
      const double iq = iq_of(m, torque_ab(m, flux, i), expected);
      ASSERT_NEAR(wrapped(rad(flux_load_angle_dq(yz)) - load_angle(m, expected, iq)), 0.0, 1e-3);
    }
    std::printf("(27) at the limit (23), motor %s: worst %.1e A\n", c.name, worst);
  }
}

// As L_q comes near L_d, (27) goes over into (29) without a step; the paper's own form loses its digits there.
TEST(FluxAngle, FromSalientToSurface) {
  Random random(313);
  for (double ratio = 1.2; ratio > 1.0000005; ratio = 1.0 + (ratio - 1.0) / 3.0) {
    Motor m = motor_b_spm();
    m.lq = m.ld * ratio;
    const flux_machine_t f = machine_of(m);
    for (int n = 0; n < 300; ++n) {
      const double theta = random.between(-kPi, kPi);
      const Vector i_dq = random.direction(random.between(0.0, 25.0)), i = i_dq.turned(theta);
      const flux_vectors_t v = vectors_of(f, flux_dq(m, i_dq).turned(theta), i);
      const dq_t yz = flux_currents_q24(&f, &v, flux_square_q24(&v));
      ASSERT_NEAR(real(yz.d, 24) * m.flux / m.ld, i_dq.x, 1e-3) << ratio;
      ASSERT_NEAR(real(yz.q, 24) * m.flux / m.lq, i_dq.y, 1e-3) << ratio;
    }
  }
}

// No flux, no current, both far too large: nothing overflows, nothing is divided by zero, the angles stay angles.
TEST(FluxAngle, ExtremesAreBounded) {
  const flux_machine_t f = machine_of(motor_b());
  const std::int32_t extremes[] = {INT32_MIN, INT32_MIN + 1, -1, 0, 1, INT32_MAX};
  for (const std::int32_t a : extremes) {
    for (const std::int32_t b : extremes) {
      for (const std::int32_t x : extremes) {
        const flux_vectors_t v = flux_vectors(&f, ab_t{a, b}, ab_t{x, b});
        const dq_t yz = flux_currents_q24(&f, &v, flux_square_q24(&v));
        EXPECT_LE(real(yz.d, 24), 1.0 / (std::pow(1.63 / 0.76, 2) - 1.0) + 1e-6);
        (void)flux_load_angle_dq(yz);
        (void)flux_load_angle_ft(&v);
        (void)flux_torque_q16(&f, &v);
        EXPECT_GE(flux_reference_square_q24(&f, dq_t{a, x}), 0);
      }
    }
  }
}

// Machines of all sizes that are in range; currents up to those that make the magnet's flux once more.
TEST(FluxAngle, MachinesOfEverySize) {
  Random random(314);
  int used = 0;
  double worst = 0.0;
  for (int n = 0; n < 4000; ++n) {
    Motor m;
    m.flux = random.log_between(0.003, 0.9);
    m.ld = random.log_between(30e-6, 0.1);
    m.lq = m.ld * random.between(1.0, 5.0);
    m.inertia = 0.05;
    machine_model_t model = {};
    const machine_parameters_t p = parameters_of(m);
    flux_machine_t f = {};
    if (!machine_model_init(&model, &p) || !flux_machine_init(&f, &model)) continue;
    const double limit = std::fmin(m.flux / m.lq, 1000.0);
    const double theta = random.between(-kPi, kPi);
    const Vector i_dq = random.direction(random.between(0.0, limit)), i = i_dq.turned(theta);
    const Vector flux = flux_dq(m, i_dq).turned(theta);
    if (m.lq > m.ld && radicand(m, flux.length(), i.length()) < 1e-3 * std::pow(m.flux / m.ld, 2)) continue;
    if (i_dq.x > m.flux * m.ld / (m.lq * m.lq - m.ld * m.ld)) continue;  // the other root
    const flux_vectors_t v = vectors_of(f, flux, i);
    const double delta = rad(flux_load_angle_dq(flux_currents_q24(&f, &v, flux_square_q24(&v))));
    const double error = wrapped(angle(flux) - delta - theta);
    widen(&worst, error);
    ++used;
  }
  std::printf("(27)-(31), %d machines: worst %.1e rad\n", used, worst);
  EXPECT_GT(used, 1500);
  EXPECT_LT(worst, 5e-5);
}

TEST(FluxMachine, RefusesWhatItsFormatsDoNotHold) {
  Motor m = motor_b();
  flux_machine_t f = {};
  m.lq = m.ld * 6.1;
  machine_model_t model = model_of(m);
  EXPECT_FALSE(flux_machine_init(&f, &model));
  m = motor_b();
  m.flux = 0.002;
  model = model_of(m);
  EXPECT_FALSE(flux_machine_init(&f, &model));
}

TEST(FluxMachine, SharesMoveIt) {
  const Motor m = motor_b();
  const machine_model_t model = model_of(m);
  flux_machine_t f = {};
  const flux_shares_t shares = {raw(0.7, 24), raw(0.8, 24)};
  flux_machine_move(&f, &model, &shares);
  EXPECT_NEAR(real(f.psi_q16, 16) * kModelPeriod, 0.8 * m.flux, 1e-8);
  EXPECT_NEAR(real(f.lq_per_psi_q30, 30), 0.7 * m.lq / (0.8 * m.flux), 1e-7);
  EXPECT_NEAR(real(f.ld_per_psi_q30, 30), m.ld / (0.8 * m.flux), 1e-7);
  EXPECT_NEAR(real(f.saliency_q24, 24), 0.7 * m.lq / m.ld - 1.0, 1e-6);
  EXPECT_NEAR(real(f.torque_q24, 24), 0.8 * m.torque_constant(), 1e-6);
}

}  // namespace
