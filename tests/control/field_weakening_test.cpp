// Field weakening against the steady-state voltage equation in double precision.

#include <gtest/gtest.h>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/field_weakening.h"
}

namespace {

using namespace stillspin::test;

constexpr double kNoLimit = 1000.0;

double analytic(const Motor& motor, double w, double voltage, double iq) {
  const double flux = voltage / std::fabs(w);
  const double room = flux * flux - motor.lq * iq * motor.lq * iq;
  return std::min(0.0, ((room > 0.0 ? std::sqrt(room) : 0.0) - motor.flux) / motor.ld);
}

std::int32_t stepped(field_weakening_t* s, const field_weakening_input_t* in, const machine_model_t* m) {
  field_weakening_step(s, in, m);
  return s->id_q20;
}

field_weakening_input_t input(double w, double iq, double voltage, double limit, double current, double gain) {
  return {bpp(w), raw(iq, 20), raw(voltage, 16), raw(limit, 16), raw(current, 20), raw(gain, 20)};
}

TEST(FieldWeakening, MotorAAt3000RpmAnd160Volts) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  field_weakening_t s;
  field_weakening_reset(&s);
  const field_weakening_input_t in = input(motor.electrical(3000.0), 1.0, 160.0, 160.0, 12.0, 0.002);
  const double id = real(stepped(&s, &in, &m), 20);
  EXPECT_GT(id, -7.0);
  EXPECT_LT(id, -6.6);
  const field_weakening_input_t low = input(motor.electrical(3000.0), 0.0, 138.0, 138.0, 12.0, 0.002);
  field_weakening_reset(&s);
  EXPECT_NEAR(real(stepped(&s, &low, &m), 20), -10.25, 0.15);  // "-10 A at 138 V", physics
}

TEST(FieldWeakening, FeedForwardOverTheWholeRange) {
  Random random(50);
  const Motor motor;
  const machine_model_t m = model_of(motor);
  for (int n = 0; n < 20000; ++n) {
    const double w = random.between(-1500.0, 1500.0);
    const double iq = random.between(-12.0, 12.0);
    const double limit = random.between(30.0, 250.0);
    field_weakening_t s;
    field_weakening_reset(&s);
    const field_weakening_input_t in = input(w, iq, limit, limit, 30.0, 0.0);
    const double id = real(stepped(&s, &in, &m), 20);
    const double exact = std::max(-30.0, analytic(motor, w, limit, iq));
    // The flux is right to 2^-16/V + 1e-6 of itself; divided by Ld = 4.9 mH, and steep where the root comes to zero
    const double flux = limit / std::fabs(w);
    const double room = flux * flux - motor.lq * iq * motor.lq * iq;
    const double steep = (room > 1e-6) ? flux / std::sqrt(room) : 1000.0;
    ASSERT_NEAR(id, exact, 0.001 + 2e-6 * steep * flux / motor.ld) << w << ", " << iq << ", " << limit;
  }
}

// 80 A through 200 mH make 16 V s, twice what Q28 holds: the whole voltage is gone, and none is left for the magnet.
TEST(FieldWeakening, AVoltageAcrossBeyondItsFormatLeavesNone) {
  Motor motor;
  motor.ld = motor.lq = 0.2;
  const machine_model_t m = model_of(motor);
  field_weakening_t s;
  field_weakening_reset(&s);
  const field_weakening_input_t in = input(motor.electrical(300.0), 80.0, 160.0, 160.0, 12.0, 0.0);
  EXPECT_NEAR(real(stepped(&s, &in, &m), 20), -motor.flux / motor.ld, 1e-3);
}

// A magnet that is known to be stronger or weaker needs that much more or less current.
TEST(FieldWeakening, TheFeedForwardCountsWhatIsLearntOfTheMagnet) {
  Motor motor;
  machine_model_t m = model_of(motor);
  for (const double share : {0.9, 1.1}) {
    m.trim.psi_q16 = raw((share - 1.0) * motor.flux / kPeriod, 16);
    Motor exact = motor;
    exact.flux *= share;
    field_weakening_t s;
    field_weakening_reset(&s);
    const field_weakening_input_t in = input(motor.electrical(3000.0), 2.0, 150.0, 150.0, 30.0, 0.0);
    EXPECT_NEAR(real(stepped(&s, &in, &m), 20), analytic(exact, motor.electrical(3000.0), 150.0, 2.0), 1e-3);
  }
}

// After a reset the current is that of the feed-forward alone, whatever was integrated before.
TEST(FieldWeakening, AResetForgetsTheTrim) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  field_weakening_t s = {raw(-3.0, 20), raw(-5.0, 20)};
  field_weakening_reset(&s);
  const field_weakening_input_t fits = input(motor.electrical(3000.0), 0.0, 60.0, 60.0, 9.0, 0.01);
  EXPECT_EQ(stepped(&s, &fits, &m), raw(-9.0, 20));
  EXPECT_EQ(s.trim_q20, 0);
}

// What i_d leaves of the limit is i_q's, and here an ampere of it asks for 5 of i_d: they settle, where they meet.
TEST(FieldWeakening, ShareOfTheLimitDoesNotSwing) {
  Motor motor;
  motor.ld = 2.372e-4;
  motor.lq = 4.459e-4;
  motor.flux = 0.035;
  motor.pole_pairs = 3;
  const machine_model_t m = model_of(motor);
  const double most = 150.0, w = motor.electrical(15000.0), limit = 300.0;
  field_weakening_t s;
  field_weakening_reset(&s);
  double iq = most, id = 0.0, least = 0.0, largest = -most;
  for (int n = 0; n < 400; ++n) {
    const field_weakening_input_t in = input(w, iq, limit, limit, 120.0, 0.0);
    id = real(stepped(&s, &in, &m), 20);
    iq = std::sqrt(most * most - id * id);
    if (n < 200) continue;
    least = std::min(least, id);
    largest = std::max(largest, id);
  }
  EXPECT_LT(largest - least, 0.1 * most);
  EXPECT_NEAR((least + largest) / 2.0, analytic(motor, w, limit, iq), 0.1 * most);
}

// All of it is there at once, and gone in 64 steps.
TEST(FieldWeakening, ComesAtOnceAndGoesSlowly) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  const double w = motor.electrical(3000.0);
  const field_weakening_input_t tight = input(w, 0.0, 138.0, 138.0, 12.0, 0.0);
  const field_weakening_input_t wide = input(w, 0.0, 300.0, 300.0, 12.0, 0.0);
  field_weakening_t s;
  field_weakening_reset(&s);
  const double all = real(stepped(&s, &tight, &m), 20);
  EXPECT_NEAR(all, analytic(motor, w, 138.0, 0.0), 1e-2);
  EXPECT_NEAR(real(stepped(&s, &wide, &m), 20), all + 12.0 / 64.0, 1e-3);
  for (int n = 0; n < 64; ++n) (void)stepped(&s, &wide, &m);
  EXPECT_EQ(stepped(&s, &wide, &m), 0);
}

// Nor is what the voltage has left meanwhile integrated: the next time the current is there in full.
TEST(FieldWeakening, WhatIsLeftWhileItGoesIsNotIntegrated) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  const double w = motor.electrical(3000.0);
  const field_weakening_input_t tight = input(w, 0.0, 130.0, 130.0, 12.0, 0.005);
  const field_weakening_input_t wide = input(w, 0.0, 130.0, 156.0, 12.0, 0.005);  // the link has come back
  field_weakening_t s;
  field_weakening_reset(&s);
  const std::int32_t all_q20 = stepped(&s, &tight, &m);
  for (int n = 0; n < 20; ++n) {
    (void)stepped(&s, &wide, &m);
    ASSERT_EQ(s.trim_q20, 0) << n;
  }
  EXPECT_EQ(stepped(&s, &tight, &m), all_q20);
}

TEST(FieldWeakening, NothingBelowTheBaseSpeed) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  field_weakening_t s;
  field_weakening_reset(&s);
  for (const double rpm : {0.0, 1.0, -300.0, 1500.0}) {
    const field_weakening_input_t in = input(motor.electrical(rpm), 5.0, 30.0, 155.0, 12.0, 0.002);
    for (int n = 0; n < 200; ++n) ASSERT_EQ(stepped(&s, &in, &m), 0) << rpm;
    EXPECT_EQ(s.trim_q20, 0) << "and nothing to begin with when it is needed";
  }
}

TEST(FieldWeakening, IntegratesWhatTheFeedForwardMisses) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  const double w = motor.electrical(3000.0);
  field_weakening_t s;
  field_weakening_reset(&s);
  // The true flux is 5 % larger than the model's: the voltage follows the true one.
  double id = 0.0;
  double voltage = 0.0;
  for (int n = 0; n < 3000; ++n) {
    voltage = std::hypot(w * (1.05 * motor.flux + motor.ld * id), w * motor.lq * 2.0);
    const field_weakening_input_t in = input(w, 2.0, voltage, 160.0, 12.0, 0.002);
    id = real(stepped(&s, &in, &m), 20);
  }
  EXPECT_NEAR(voltage, 160.0, 0.1);  // w Ld gain = 0.012 per step: 3000 steps are 36 time constants
  EXPECT_LT(id, analytic(motor, w, 160.0, 2.0) - 1.0);
}

TEST(FieldWeakening, StaysBetweenItsLimitAndZeroAndDoesNotWindUp) {
  Random random(51);
  const Motor motor;
  const machine_model_t m = model_of(motor);
  field_weakening_t s;
  field_weakening_reset(&s);
  for (int n = 0; n < 5000; ++n) {
    const field_weakening_input_t in = input(random.between(-2000.0, 2000.0), random.between(-14.0, 14.0),
                                             random.between(0.0, kNoLimit), random.between(10.0, 250.0), 9.0, 0.1);
    const double id = real(stepped(&s, &in, &m), 20);
    ASSERT_LE(id, 0.0);
    ASSERT_GE(id, -9.0);
    ASSERT_GE(real(s.trim_q20, 20), -9.0);
  }
  // a voltage far too high for long ...
  const field_weakening_input_t high = input(100.0, 0.0, kNoLimit, 100.0, 9.0, 0.002);
  int32_t current_q20 = 0;
  for (int n = 0; n < 5000; ++n) current_q20 = stepped(&s, &high, &m);
  EXPECT_NEAR(real(current_q20, 20), -9.0, 1e-5);
  // ... is forgotten within limit / (gain * volts left) = 9 / (0.002 * 90) = 50 steps, and gone in 64
  const field_weakening_input_t fine = input(100.0, 0.0, 10.0, 100.0, 9.0, 0.002);
  for (int n = 0; n < 65; ++n) current_q20 = stepped(&s, &fine, &m);
  EXPECT_EQ(current_q20, 0);
}

// Where the feed-forward asks for far more than the limit, the trim must still be able to take the current back at
// once.
TEST(FieldWeakening, TrimActsAtTheLimit) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  field_weakening_t s;
  field_weakening_reset(&s);
  // 60 V at 3000 rpm: the feed-forward is -23 A of 9
  const field_weakening_input_t in = input(motor.electrical(3000.0), 0.0, 50.0, 60.0, 9.0, 0.01);
  EXPECT_NEAR(real(stepped(&s, &in, &m), 20), -9.0 + 0.1, 1e-4);
  EXPECT_NEAR(real(stepped(&s, &in, &m), 20), -9.0 + 0.2, 1e-4);
}

}  // namespace
