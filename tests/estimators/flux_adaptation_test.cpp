// What the stator-flux family learns: L_q by the torque (36), the magnet's flux (37), (38).

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/estimators/flux_paper.hpp"

extern "C" {
#include "estimators/flux_adaptation.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::flux_paper;

flux_adaptation_config_t config(double saturation = 0.0) {
  const flux_adaptation_config_t c = {raw(saturation, 24), bpp(200.0), raw(0.03, 24), raw(0.2, 30), raw(0.2, 30)};
  EXPECT_TRUE(flux_adaptation_config_valid(&c));
  return c;
}

// A machine and what is believed of it, held at currents in the true frame.
class Bench {
 public:
  Bench(const Motor& told, const Motor& truth) : truth_(truth), model_(model_of(told)) {
    flux_adaptation_reset(&s_);
    flux_machine_move(&f_, &model_, &s_.shares);
  }
  void run(const flux_adaptation_config_t& c, Vector i_dq, double speed, int steps) {
    for (int n = 0; n < steps; ++n) {
      const double theta = 0.1 + 2.3 * n;
      const Vector flux = flux_dq(truth_, i_dq).turned(theta);
      const flux_vectors_t v = flux_vectors(&f_, raw_ab(flux * (1.0 / kPeriod), 16), raw_ab(i_dq.turned(theta), 20));
      flux_adaptation_step(&s_, &c, &model_, &f_, &v, raw_dq(i_dq, 20), bpp(speed));
    }
  }
  double lq() const { return real(s_.shares.lq_q24, 24); }
  double psi() const { return real(s_.shares.psi_q24, 24); }
  const flux_machine_t& machine() const { return f_; }
  const machine_model_t& model() const { return model_; }

 private:
  Motor truth_;
  machine_model_t model_;
  flux_machine_t f_ = {};
  flux_adaptation_t s_ = {};
};

TEST(FluxAdaptation, ChangeOfTheMagnetAgreesWithThePaper) {
  Random random(330);
  double worst = 0.0;
  for (const Motor& m : {Motor{}, motor_b(), motor_b_spm()}) {
    const Bench b(m, m);
    for (int n = 0; n < 20000; ++n) {
      const Vector i_dq = random.direction(random.between(1.0, 15.0));
      Motor other = m;
      other.flux *= random.between(0.7, 1.15);
      const double theta = random.between(-kPi, kPi), off = random.between(-0.2, 0.2);
      const Vector flux = flux_dq(other, i_dq).turned(theta), i = i_dq.turned(theta);
      const flux_machine_t& f = b.machine();
      const flux_vectors_t v =
          flux_vectors(&f, raw_ab(flux * (1.0 / real(b.model().period_q30, 30)), 16), raw_ab(i, 20));
      std::int32_t change = 0;
      const double across = m.lq * current_ft(flux, i).y / m.flux;
      const bool counts = flux_adaptation_change_q24(&f, &v, raw_dq(i_dq.turned(off), 20), raw(0.03, 24), &change);
      if (std::fabs(std::fabs(across) - 0.03) < 1e-5) continue;
      ASSERT_EQ(counts, std::fabs(across) >= 0.03);
      if (!counts) continue;
      const double error = real(change, 24) - flux_change(m, flux, i, i_dq.turned(off)) / m.flux;
      worst = std::fmax(worst, std::fabs(error));
    }
  }
  std::printf("(37): worst %.1e of psi_m\n", worst);
  EXPECT_LT(worst, 3e-5);  // a quotient by i_t, which counts from 0.03 on
}

TEST(FluxAdaptation, MagnetIsFound) {
  for (const Motor& m : {Motor{}, motor_b(), motor_b_spm()}) {
    for (const double share : {0.8, 0.9, 1.1}) {
      for (const Vector i_dq : {Vector{0.0, 9.0}, Vector{-3.0, -8.0}}) {
        for (const double speed : {800.0, -800.0}) {
          Motor truth = m;
          truth.flux *= share;
          Bench b(m, truth);
          b.run(config(), i_dq, speed, 200);
          EXPECT_NEAR(b.psi(), share, 1e-4) << i_dq.y << ", " << speed;
        }
      }
    }
  }
}

TEST(FluxAdaptation, NothingIsLearntSlowlyNorWithoutTorqueNorBeyondTheBounds) {
  Motor truth = motor_b();
  truth.flux *= 0.8;
  Bench b(motor_b(), truth);
  b.run(config(), {0.0, 9.0}, 190.0, 200);
  EXPECT_EQ(b.psi(), 1.0);
  b.run(config(), {0.0, 1.0}, 800.0, 200);
  EXPECT_EQ(b.psi(), 1.0);
  b.run(config(), {-9.0, 0.0}, 800.0, 200);
  EXPECT_EQ(b.psi(), 1.0);
  flux_adaptation_config_t off = config();
  off.magnet_q30 = 0;
  b.run(off, {0.0, 9.0}, 800.0, 200);
  EXPECT_EQ(b.psi(), 1.0);
  truth.flux *= 0.3;
  Bench weak(motor_b(), truth);
  weak.run(config(), {0.0, 9.0}, 800.0, 400);
  EXPECT_EQ(weak.psi(), 0.5);
}

TEST(FluxAdaptation, InductanceByTheTorque) {
  Random random(331);
  for (int n = 0; n < 5000; ++n) {
    const double k = random.between(0.0, 0.2), torque = random.between(-20.0, 20.0);
    const double share = real(flux_adaptation_lq_q24(raw(k, 24), raw(torque, 16)), 24);
    ASSERT_NEAR(share, updated_lq(1.0, k * 5.0, torque, 5.0), 3e-6);
  }
}

// A machine that saturates as (36) says is followed there, motoring and generating, after a few steps.
TEST(FluxAdaptation, SaturatedInductanceIsFollowed) {
  for (const double torque_current : {12.0, -12.0}) {
    Motor truth = motor_b();
    truth.lq *= 0.7;
    const double torque = torque_dq(truth, {0.0, torque_current});
    Bench b(motor_b(), truth);
    b.run(config((1.0 / 0.7 - 1.0) / std::fabs(torque)), {0.0, torque_current}, 100.0, 100);
    EXPECT_NEAR(b.lq(), 0.7, 1e-3);
    EXPECT_NEAR(real(b.machine().lq_per_psi_q30, 30), 0.7 * 1.63e-3 / 0.0865, 2e-5);
  }
}

// K_t comes from the map: a q-axis that falls by 20 % at 15 A falls by about 10 % in the mean.
TEST(FluxAdaptation, SaturationIsIdentifiedFromTheMap) {
  const Motor m = motor_b();
  machine_model_t model = model_of(m);
  EXPECT_NEAR(real(flux_adaptation_identify_q24(&model), 24), 0.0, 1e-6);
  machine_map_parameters_t map;
  map.current_q20 = raw(15.0, 20);
  for (int k = 0; k < MACHINE_MAP_POINTS; ++k) {
    map.ldd_q30[k] = raw(m.ld, 30);
    map.lqq_q30[k] = raw(m.lq * (1.0 - 0.05 * k), 30);
    map.ldq_q30[k] = 0;
  }
  ASSERT_TRUE(machine_model_saturate(&model, &map));
  double product = 0.0, square = 0.0;
  for (int k = 1; k < MACHINE_MAP_POINTS; ++k) {
    const double secant = 1.0 - 0.025 * k, torque = torque_dq(Motor{m.rs, m.lq, m.lq, m.flux}, {0.0, 3.75 * k});
    product += (1.0 / secant - 1.0) * torque;
    square += torque * torque;
  }
  EXPECT_NEAR(real(flux_adaptation_identify_q24(&model), 24), product / square, 1e-5);
}

TEST(FluxAdaptation, RefusesWhatIsOutOfRange) {
  flux_adaptation_config_t c = config();
  c.current_q24 = 0;
  EXPECT_FALSE(flux_adaptation_config_valid(&c));
  c = config();
  c.lowest_bpp = 0;
  EXPECT_FALSE(flux_adaptation_config_valid(&c));
  c = config();
  c.saturation_q24 = raw(1.1, 24);
  EXPECT_FALSE(flux_adaptation_config_valid(&c));
  for (std::int32_t flux_adaptation_config_t::* const share :
       {&flux_adaptation_config_t::inductance_q30, &flux_adaptation_config_t::magnet_q30}) {
    for (const std::int32_t value : {0, 1 << 30}) {
      c = config();
      c.*share = value;
      EXPECT_TRUE(flux_adaptation_config_valid(&c));
      c.*share = (value == 0) ? -1 : value + 1;
      EXPECT_FALSE(flux_adaptation_config_valid(&c));
    }
  }
}

// A flux of nothing has no direction to look along.
TEST(FluxAdaptation, WithoutFluxNothingIsSaid) {
  const machine_model_t model = model_of(Motor{});
  flux_machine_t f;
  ASSERT_TRUE(flux_machine_init(&f, &model));
  const flux_vectors_t v = {};
  std::int32_t change = 7;
  EXPECT_FALSE(flux_adaptation_change_q24(&f, &v, {0, raw(5.0, 20)}, 0, &change));
  EXPECT_EQ(change, 7);
}

}  // namespace
