// What is learnt of the machine while it runs moves its constants: saliency, share of the flux, resistance and magnet.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/control/quantities.hpp"

namespace {

using stillspin::test::kPeriod;
using stillspin::test::model_of;
using stillspin::test::Motor;
using stillspin::test::parameters_of;
using stillspin::test::raw;
using stillspin::test::real;

// A new model has learnt nothing, whatever was there before.
TEST(MachineTrim, NothingIsLearntAtFirst) {
  machine_model_t m = model_of(Motor{});
  m.trim = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  const machine_parameters_t p = parameters_of(Motor{});
  ASSERT_TRUE(machine_model_init(&m, &p));
  const machine_trim_t& t = m.trim;
  for (const std::int32_t learnt : {t.mean_q30, t.half_q30, t.ydd_q24, t.yqq_q24, t.ydq_q24, t.rs_q24, t.psi_q16}) {
    EXPECT_EQ(learnt, 0);
  }
  EXPECT_EQ(real(t.psi_share_q24, 24), 1.0);
  EXPECT_NEAR(real(t.psi_variance_q32, 32), 0.09, 1e-9);
}

TEST(MachineTrim, TheTrimMovesTheSaliency) {
  machine_model_t m = model_of(Motor{});
  const double yd = 0.025, yq = 0.011;
  const std::int32_t mean = raw(0.5 * (yd + yq), 30) - m.yd_q30 / 2 - m.yq_q30 / 2;
  const std::int32_t half = raw(0.5 * (yd - yq), 30) - m.yd_q30 / 2 + m.yq_q30 / 2;
  machine_model_trim(&m, mean, half);
  machine_model_settle(&m);
  machine_model_move(&m, raw(3.0, 20));
  EXPECT_EQ(m.trim.mean_q30, mean) << "what is learnt next is added to it";
  EXPECT_EQ(m.trim.half_q30, half);
  EXPECT_NEAR(real(m.yd_q30, 30), yd, 4e-9);
  EXPECT_NEAR(real(m.yq_q30, 30), yq, 4e-9);
  EXPECT_NEAR(real(m.k_dq_q24, 24), yd / yq - 1.0, 2e-6);
  EXPECT_NEAR(real(m.k_qd_q24, 24), 1.0 - yq / yd, 2e-6);
  // with the inductance the flux of i_q differs: psi_q = Lq i_q still, so nothing is left in k0
  EXPECT_NEAR(real(m.psi_q_q16, 16), 3.0 / yq, 1e-3);
  EXPECT_NEAR(real(m.k0_q20.d, 20), 0.0, 2e-5);
}

// Inductances learnt without regard to the flux's share.
void learn(machine_model_t* m, double rest) {
  const double less = (rest - 1.0) * real(m->map.points[0].yqq_q30, 30);
  machine_model_trim(m, raw(0.5 * less, 30), raw(-0.5 * less, 30));
  machine_model_settle(m);
}

// What is learnt changes by little, and one step is enough for that: it squares what is missing.
TEST(MachineTrim, TheShareOfTheFluxFollowsWhatIsLearnt) {
  machine_model_t m = model_of(Motor{});
  for (double left = 1.0; left > 0.1; left *= 0.99) {
    const double less = (left - 1.0) * real(m.map.points[0].yqq_q30, 30);
    machine_model_trim(&m, raw(0.5 * less, 30), raw(-0.5 * less, 30));
    EXPECT_NEAR(real(m.trim.psi_share_q24, 24) * left, 1.0, 1.2e-4) << left;
  }
}

// From one to a half, or to sixteen. What is learnt is at most as much again, and leaves a sixteenth.
TEST(MachineTrim, TheShareOfTheFluxIsFoundFromAfar) {
  for (const double rest : {50.0, 3.0, 2.0, 1.0, 0.5, 0.1, 0.0625, 0.01, 0.001}) {
    machine_model_t m = model_of(Motor{});
    learn(&m, rest);
    const double left = std::clamp(rest, 1.0 / 16.0, 2.0);
    EXPECT_NEAR(1.0 + real(m.trim.yqq_q24, 24), left, 1e-6) << rest;
    EXPECT_NEAR(real(m.trim.psi_share_q24, 24) * left, 1.0, 1e-4) << rest;
  }
}

// A regression that has gone wrong takes what is learnt to its end at once: half or twice is found in one call.
TEST(MachineTrim, TheShareOfTheFluxFollowsAJumpByTwo) {
  machine_model_t m = model_of(Motor{});
  for (const double left : {1.5, 0.75, 1.5, 0.8, 0.45, 0.9}) {
    const double less = (left - 1.0) * real(m.map.points[0].yqq_q30, 30);
    machine_model_trim(&m, raw(0.5 * less, 30), raw(-0.5 * less, 30));
    EXPECT_NEAR(real(m.trim.psi_share_q24, 24) * left, 1.0, 1e-4) << left;
  }
}

// Between the two ends, the farthest way that there is.
TEST(MachineTrim, TheShareOfTheFluxIsFoundFromOneEndToTheOther) {
  machine_model_t m = model_of(Motor{});
  for (int n = 0; n < 40; ++n) {
    for (const double left : {2.0 - 0.005 * n, 1.0 / 16.0 + 0.0001 * n}) {
      learn(&m, left);
      EXPECT_NEAR(real(m.trim.psi_share_q24, 24) * left, 1.0, 1e-4) << left;
    }
  }
}

// What is learnt of resistance and magnet is part of the operating point.
TEST(MachineTrim, TheTrimMovesResistanceAndMagnet) {
  const Motor motor;
  machine_model_t m = model_of(motor);
  m.trim.rs_q24 = raw(0.07, 24);
  m.trim.psi_q16 = raw(-50.0, 16);
  machine_model_move(&m, raw(5.0, 20));
  EXPECT_NEAR(real(m.rs_q24, 24), motor.rs + 0.07, 1e-6);
  EXPECT_NEAR(real(m.psi_d_q16, 16), motor.flux / kPeriod - 50.0, 0.01);
  EXPECT_NEAR(real(m.k0_q20.q, 20), -(motor.flux - 50.0 * kPeriod) / motor.lq, 1e-3);
}

}  // namespace
