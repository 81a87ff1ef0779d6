// MTPA against its definition: no other vector of the same length makes more torque, for every saliency down to none.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/mtpa.h"
}

namespace stillspin::test {
namespace {

double torque(const Motor& m, double id, double iq) { return 1.5 * m.pole_pairs * (m.flux + (m.ld - m.lq) * id) * iq; }

double chosen(const Motor& motor, double iq) {
  const machine_model_t m = model_of(motor);
  mtpa_t s;
  mtpa_design(&s, &m);
  return real(mtpa_current_q20(&s, raw(iq, 20)), 20);
}

Motor any(Random& random) {
  Motor m;
  m.ld = random.log_between(0.3e-3, 30e-3);
  m.lq = m.ld * random.between(1.0, 4.0);
  m.flux = m.ld * random.between(5.0, 150.0);
  return m;
}

TEST(Mtpa, IsTheShortestVectorOfItsTorque) {
  Random random(330);
  for (int k = 0; k < 2000; k++) {
    const Motor m = any(random);
    if (m.flux < 0.002 || m.flux > 0.9) continue;
    const double iq = random.between(-100.0, 100.0);
    if (m.flux > 990.0 * 2.0 * (m.lq - m.ld)) continue;  // a beyond 1000 A
    const double id = chosen(m, iq);
    const double length = std::hypot(id, iq);
    const double angle = std::atan2(iq, id);
    // At the maximum a turn changes the torque in second order only.
    const auto turned = [&](double by) {
      return std::fabs(torque(m, length * std::cos(angle + by), length * std::sin(angle + by)));
    };
    const double best = std::fabs(torque(m, id, iq));
    EXPECT_GE(best * (1.0 + 1e-6) + 1e-6, turned(0.02)) << "iq " << iq << " ld " << m.ld << " lq " << m.lq;
    EXPECT_GE(best * (1.0 + 1e-6) + 1e-6, turned(-0.02));
  }
}

TEST(Mtpa, AgreesWithTheRoot) {
  Random random(331);
  double worst = 0.0;
  for (int k = 0; k < 5000; k++) {
    const Motor m = any(random);
    if (m.flux < 0.002 || m.flux > 0.9) continue;
    const double a = m.flux / (2.0 * (m.lq - m.ld));
    const double iq = random.between(-150.0, 150.0);
    // Beyond 1000 A there is none; next to it the rounding of the inductances decides which side it is.
    if (a > 990.0) continue;
    const double exact = -iq * iq / (a + std::hypot(a, iq));
    // What the inductances' own format leaves of a.
    const double format = std::ldexp(1.0, -30) / (m.lq - m.ld) + std::ldexp(1.0, -28) / m.flux;
    worst = std::max(worst, (std::fabs(chosen(m, iq) - exact) - std::fabs(exact) * format) / (1.0 + std::fabs(exact)));
  }
  EXPECT_LT(worst, 4e-6);
}

TEST(Mtpa, OfMotorB) {
  const Motor b = motor_b();
  EXPECT_NEAR(chosen(b, 15.0), -2.2137, 1e-3);  // a = 49.71 A
  EXPECT_EQ(chosen(b, 15.0), chosen(b, -15.0));
  EXPECT_EQ(chosen(b, 0.0), 0.0);
}

TEST(Mtpa, WithoutSaliencyThereIsNone) {
  Motor spm;
  spm.ld = spm.lq = 1.2e-3;
  for (const double iq : {0.0, 10.0, -100.0, 1e3}) EXPECT_EQ(chosen(spm, iq), 0.0);
  spm.lq = spm.ld + 40e-6;  // a = 2000 A
  EXPECT_EQ(chosen(spm, 100.0), 0.0);
}

// Beyond 1000 A there is no saliency worth it; at 1000 A there still is.
TEST(Mtpa, AThousandAmperesStillCount) {
  for (const std::int32_t more : {0, 1}) {
    machine_model_t m = model_of(Motor{});
    m.lq_q30 = m.ld_q30 + raw(100e-6, 30);
    m.flux_q28 = 500 * (m.lq_q30 - m.ld_q30) + more;  // a = lambda / (2 (Lq - Ld)), of Q28 and Q30
    mtpa_t s;
    mtpa_design(&s, &m);
    EXPECT_EQ(s.pole_q20, more == 0 ? raw(1000.0, 20) : 0);
    EXPECT_EQ(mtpa_current_q20(&s, raw(100.0, 20)) < 0, more == 0);
  }
}

// What was there before is forgotten, also where there is nothing in its place.
TEST(Mtpa, AMachineWithoutSaliencyReplacesOneWithIt) {
  mtpa_t s;
  Motor motor;
  for (const double lq : {7.8e-3, 4.9e-3, 4.94e-3}) {
    motor.lq = lq;
    const machine_model_t m = model_of(motor);
    mtpa_design(&s, &m);
    EXPECT_EQ(mtpa_current_q20(&s, raw(10.0, 20)) < 0, lq > 5e-3);
  }
}

// From 200 A on the current along d stays where it is.
TEST(Mtpa, CurrentsCountUpTo200Amperes) {
  const Motor motor;
  const double a = motor.flux / (2.0 * (motor.lq - motor.ld));
  EXPECT_NEAR(chosen(motor, 199.9), -199.9 * 199.9 / (a + std::hypot(a, 199.9)), 0.002);
  EXPECT_EQ(chosen(motor, 200.0), chosen(motor, 300.0));
  EXPECT_LT(chosen(motor, 200.0), chosen(motor, 199.9));
}

TEST(Mtpa, NeverPositiveAndBoundedWhateverIsAsked) {
  const machine_model_t m = model_of(Motor{});
  mtpa_t s;
  mtpa_design(&s, &m);
  for (const std::int32_t iq : {INT32_MIN, INT32_MAX, raw(200.0, 20), -1, 1}) {
    EXPECT_LE(mtpa_current_q20(&s, iq), 0);
    EXPECT_GE(mtpa_current_q20(&s, iq), -raw(200.0, 20));
  }
}

}  // namespace
}  // namespace stillspin::test
