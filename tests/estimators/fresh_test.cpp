// What an estimator begins with, whatever its state held before.

#include <gtest/gtest.h>

#include <cstring>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/axis.h"
#include "estimators/blend.h"
#include "estimators/deviation_observer.h"
#include "estimators/emf_sign.h"
#include "estimators/flux_observer.h"
#include "estimators/flying.h"
#include "estimators/inertia_match.h"
#include "estimators/inverse_inductance_tensor.h"
#include "estimators/polarity.h"
#include "estimators/saturation.h"
#include "estimators/synchronism.h"
#include "estimators/zvv.h"
}

namespace {

using namespace stillspin::test;

constexpr std::uint32_t kAngle = 0x12345678;
constexpr std::int32_t kSpeed = 1234567, kLoad = -7654321;
constexpr std::int32_t kUsed = 0x5A5A5A5A;

/// A state of another run.
template <class State>
State used() {
  State s;
  std::memset(&s, 0x5A, sizeof s);
  return s;
}

void expect_begun(const tracking_observer_t& s) {
  EXPECT_EQ(s.angle_bam, kAngle);
  EXPECT_EQ(s.speed_bpp, kSpeed);
  EXPECT_EQ(s.load_accel_q8, kLoad);
  EXPECT_EQ(s.speed_remainder_q8, 0);
}

TEST(Fresh, Tensor) {
  auto s = used<tensor_sums_t>();
  tensor_reset(&s);
  EXPECT_EQ(s.vv_dd | s.vv_dq | s.vv_qq, 0);
  EXPECT_EQ(s.sv_dd | s.sv_dq | s.sv_qd | s.sv_qq, 0);
  EXPECT_EQ(s.count, 0);
}

TEST(Fresh, Axis) {
  auto s = used<axis_t>();
  axis_begin(&s);
  EXPECT_EQ(s.spread_q8 | s.along_q16 | s.mirror_q16 | s.cross_q16, 0);
  EXPECT_EQ(s.count, 0);
}

TEST(Fresh, TrackingObserver) {
  auto s = used<tracking_observer_t>();
  tracking_observer_preset(&s, kAngle, kSpeed, kLoad);
  expect_begun(s);
}

TEST(Fresh, Avv) {
  auto s = used<avv_t>();
  avv_preset(&s, kAngle, kSpeed, kLoad);
  expect_begun(s.observer);
  EXPECT_EQ(s.error_bam, 0);
  EXPECT_EQ(s.regression.information, 0) << "and so the rest of it says nothing";
}

TEST(Fresh, Zvv) {
  auto s = used<zvv_t>();
  zvv_preset(&s, kAngle, kSpeed, 0);
  EXPECT_EQ(s.angle_bam, kAngle);
  EXPECT_EQ(s.speed_bpp, kSpeed);
  EXPECT_EQ(s.integral_q8bpp, kSpeed * 256);
  EXPECT_EQ(s.waited, 0);
}

TEST(Fresh, Blend) {
  auto s = used<blend_t>();
  blend_reset(&s);
  EXPECT_TRUE(blend_is_low(&s));
  EXPECT_EQ(s.disagreement_bam, 0);
  blend_config_t c = {};
  ASSERT_TRUE(blend_design(&c, kSpeed, 3 * kSpeed));
  for (const auto& [speed, region] :
       {std::pair{kSpeed / 2, BLEND_LOW}, {-2 * kSpeed, BLEND_BOTH}, {4 * kSpeed, BLEND_HIGH}}) {
    s = used<blend_t>();
    blend_preset(&s, &c, speed);
    EXPECT_EQ(s.region, region);
    EXPECT_NEAR(real(s.share_q15, 15), region == BLEND_LOW ? 1.0 : region == BLEND_BOTH ? 0.5 : 0.0, 1e-4);
    EXPECT_EQ(s.disagreement_bam, 0);
  }
}

TEST(Fresh, DeviationObserver) {
  auto s = used<deviation_observer_t>();
  deviation_observer_preset(&s, kAngle, kSpeed, kLoad);
  EXPECT_EQ(s.angle_bam, kAngle);
  EXPECT_EQ(s.speed_bpp, kSpeed);
  EXPECT_EQ(s.load_accel_q8, kLoad);
  EXPECT_EQ(s.speed_remainder_q8, 0);
  EXPECT_EQ(s.p_aa, raw(128.0, 20));  // (10 degrees)^2 in units of 2^-6 rad
  EXPECT_EQ(s.p_ss, raw(64.0, 20));
  EXPECT_EQ(s.p_ll, raw(64.0, 20));
  EXPECT_EQ(s.p_as | s.p_al | s.p_sl, 0);
  EXPECT_NEAR(real(s.score_power_q23, 23), 0.05, 1e-6) << "nothing is suspected before the power is known";
  EXPECT_EQ(s.mean_score_q20 | s.noise_boost_q30, 0);
  EXPECT_EQ(s.score_remainder, 0u);
  EXPECT_FALSE(s.load_is_new || s.load_step_suspected || s.is_sensitive || s.cogging.active);
  EXPECT_EQ(s.cogging.cos_q8 | s.cogging.sin_q8 | s.cogging.mean_q8 | s.cogging.now_q8, 0);
  EXPECT_EQ(s.cogging.known_q30 | s.cogging.order | s.cogging.wave.cos_q30 | s.cogging.wave.sin_q30, 0);
  EXPECT_EQ(s.cogging.stepped_bam | s.regressed_bam, 0u);
  EXPECT_EQ(s.gathered.aa_q21 | s.gathered.as_q24 | s.gathered.ss_q21 | s.gathered.periods, 0);
  EXPECT_EQ(s.residual.d_q17 | s.residual.q_q17 | s.residual.span_ticks | s.residual.periods, 0);
  const deviation_sensitivity_t& h = s.sensitivity;
  EXPECT_EQ(h.rest_q17.d | h.rest_q17.q | h.h_speed_q20.d | h.h_speed_q20.q, 0);
  const regression_t& r = s.regression;
  EXPECT_EQ(r.spread_q8 | r.along_q16 | r.mirror_q16 | r.cross_q16 | r.curl_q16 | r.information, 0);
  EXPECT_EQ(r.mean_q20.d | r.mean_q20.q, 0);
}

TEST(Fresh, EmfSign) {
  auto s = used<emf_sign_t>();
  emf_sign_reset(&s);
  EXPECT_EQ(s.seen_q16 | s.expected_q16 | s.last_iq_q20 | s.emf_q16, 0);
  EXPECT_EQ(s.agreed | s.periods, 0);
}

TEST(Fresh, Synchronism) {
  auto s = used<synchronism_t>();
  synchronism_reset(&s);
  EXPECT_EQ(s.error_q16.d | s.error_q16.q | s.turned_q16 | s.emf_q16 | s.limit_q16 | s.debounce, 0);
}

TEST(Fresh, InertiaMatch) {
  auto s = used<inertia_match_t>();
  inertia_match_reset(&s);
  EXPECT_EQ(s.ratio_q24, INERTIA_SAME_Q24);
  EXPECT_EQ(s.phase, INERTIA_REST);
  EXPECT_EQ(s.ms | s.quiet_ms, 0);
  EXPECT_EQ(s.reference_bpp | s.base_q8 | s.start_base_q8 | s.before_q24 | s.mean_q8 | s.speed0_bpp, 0);
  EXPECT_EQ(s.gained_bpp | s.last_gained_bpp | s.expected | s.turned | s.next, 0);
  EXPECT_EQ(s.angle_bam, 0u);
}

TEST(Fresh, Polarity) {
  auto s = used<polarity_t>();
  s.length = POLARITY_SEGMENT;  // with the first test of a start
  polarity_begin(&s, raw(3.0, 20), 256, kAngle, 0);
  EXPECT_EQ(s.tick | s.segment | s.response_bam | s.rough_bam | s.sigma_q8, 0);
  EXPECT_EQ(s.current_q20, raw(3.0, 20));
  EXPECT_EQ(s.expected_bam, 2 * POLARITY_SEGMENT * POLARITY_SEGMENT);
  EXPECT_EQ(s.last_bam, kAngle);
  EXPECT_EQ(s.origin_bam, kAngle);
  EXPECT_EQ(s.result, POLARITY_PENDING);
}

TEST(Fresh, Saturation) {
  const machine_model_t m = model_of(Motor{});
  const saturation_slopes_t slopes = {0, raw(0.00139, 30)};
  auto s = used<saturation_t>();
  saturation_begin(&s, &m, &slopes, raw(10.0, 20));
  EXPECT_EQ(s.tick | s.reference_q20 | s.round_q30 | s.last_q30 | s.change_q30, 0);
  EXPECT_EQ(s.missing_q20 | s.missing_count | s.score_q15 | s.sigma_q8, 0);
  EXPECT_EQ(s.scatter, 0u);
  EXPECT_EQ(s.passes, 1);
  EXPECT_EQ(s.current_q20, raw(10.0, 20));
  EXPECT_EQ(s.unit_d_q30, 0);
  EXPECT_NEAR(real(s.unit_q_q30, 30), -1.0, 1e-4) << "less inverse inductance with +i_d";
  EXPECT_NEAR(real(s.expected_q30, 30), 20.0 * 0.00139 * real(m.yq_q30, 30), 1e-7);
  EXPECT_NEAR(real(s.floor_q30, 30), 0.0015 * 0.5 * real(m.yd_q30 + m.yq_q30, 30), 1e-6);
  EXPECT_EQ(s.result, POLARITY_PENDING);
}

// Only the pattern begins again; what the passes have shown stays.
TEST(Fresh, SaturationAgain) {
  auto s = used<saturation_t>();
  s.passes = 2;
  saturation_again(&s);
  EXPECT_EQ(s.tick, 0);
  EXPECT_EQ(s.passes, 3);
  EXPECT_EQ(s.result, POLARITY_PENDING);
  for (const std::int32_t kept : {s.change_q30, s.missing_q20, s.expected_q30, s.unit_d_q30, s.unit_q_q30, s.floor_q30,
                                  s.current_q20, s.reference_q20}) {
    EXPECT_EQ(kept, kUsed);
  }
}

// The first window says where the pulse begins, and its own drive is all of the sum.
TEST(Fresh, Flying) {
  const machine_model_t m = model_of(Motor{});
  auto s = used<flying_pulse_t>();
  flying_begin(&s);
  EXPECT_EQ(s.windows, 0);
  estimator_window_t w = {};
  w.voltage_q19 = {raw(-1.0, 19), raw(1.5, 19)};
  w.change_q19 = raw_change({5.0, -5.0}, 2000);
  w.span_ticks = 2000;
  flying_add(&s, &m, &w, 70000);
  EXPECT_EQ(s.windows, 1);
  EXPECT_EQ(s.drive_q16.alpha, raw(-1.0, 16));
  EXPECT_EQ(s.drive_q16.beta, raw(1.5, 16));
  EXPECT_EQ(s.first_tick, 69000);
  EXPECT_EQ(s.last_tick, 71000);
  EXPECT_NEAR(real(s.first_q20.alpha, 20), -0.5, 1e-5);
  EXPECT_NEAR(real(s.first_q20.beta, 20), 0.5, 1e-5);
  EXPECT_NEAR(real(s.last_q20.alpha, 20), 0.5, 1e-5);
  EXPECT_NEAR(real(s.last_q20.beta, 20), -0.5, 1e-5);
}

TEST(Fresh, StatorFlux) {
  auto s = used<stator_flux_t>();
  stator_flux_preset(&s, {raw(300.0, 16), raw(-400.0, 16)});
  EXPECT_EQ(s.flux_q16.alpha, raw(300.0, 16));
  EXPECT_EQ(s.flux_q16.beta, raw(-400.0, 16));
  EXPECT_NEAR(real(s.length_q16, 16), 500.0, 1e-2);
  EXPECT_EQ(s.compensation_q16, s.length_q16);
  EXPECT_EQ(s.shown_q28.alpha, raw(1.0, 28));
  EXPECT_EQ(s.shown_q28.beta, 0);
}

TEST(Fresh, FluxAdaptation) {
  auto s = used<flux_adaptation_t>();
  flux_adaptation_reset(&s);
  EXPECT_EQ(s.shares.lq_q24, raw(1.0, 24));
  EXPECT_EQ(s.shares.psi_q24, raw(1.0, 24));
}

class FreshFlux : public ::testing::Test {
 protected:
  void SetUp() override {
    config.method = FLUX_ACTIVE;
    config.cutoff_q30 = raw(2.0 * kPeriod, 30);
    config.adaptation_periods = 77;
    flux_observer_reset(&s, &config, &model);
  }
  const Motor motor;
  const machine_model_t model = model_of(motor);
  flux_observer_config_t config = {};
  flux_observer_t s = used<flux_observer_t>();
};

TEST_F(FreshFlux, ForgetsWhatWasLearnt) {
  EXPECT_NEAR(real(s.machine.psi_q16, 16), motor.flux / kPeriod, 1e-2);
  EXPECT_NEAR(real(s.machine.lq_per_psi_q30, 30), motor.lq / motor.flux, 1e-6);
  EXPECT_EQ(s.adaptation.shares.lq_q24, raw(1.0, 24));
  EXPECT_EQ(s.adaptation.shares.psi_q24, raw(1.0, 24));
  EXPECT_EQ(s.form.form, STATOR_FLUX_COMPENSATED);
  EXPECT_EQ(s.form.cutoff_q30, config.cutoff_q30);
  EXPECT_NEAR(real(s.form.follow_q30, 30), 0.25, 1e-9);
  EXPECT_EQ(s.flux.flux_q16.alpha | s.flux.flux_q16.beta | s.flux.length_q16 | s.flux.compensation_q16, 0);
  EXPECT_EQ(s.flux.shown_q28.alpha | s.flux.shown_q28.beta, 0);
  EXPECT_EQ(s.observer.angle_bam, 0u);
  EXPECT_EQ(s.observer.speed_bpp | s.observer.load_accel_q8 | s.observer.speed_remainder_q8, 0);
  EXPECT_EQ(s.flux_q16.alpha | s.flux_q16.beta | s.current_q20.alpha | s.current_q20.beta, 0);
  EXPECT_EQ(s.vectors.flux_q24.alpha | s.vectors.flux_q24.beta, 0);
  EXPECT_EQ(s.vectors.current_q24.alpha | s.vectors.current_q24.beta, 0);
  EXPECT_EQ(s.error_bam | s.load_angle_bam, 0);
  EXPECT_EQ(s.pause, 77);
  EXPECT_EQ(s.place, 0);
}

// The flux of an angle and a current that are known; what was learnt of the machine stays.
TEST_F(FreshFlux, BeginsAtAKnownAngle) {
  const flux_adaptation_t learnt = {{raw(0.8, 24), raw(0.9, 24)}};
  s.adaptation = learnt;
  const Vector current = {-2.0, 6.0};
  const estimator_output_t now = {kAngle, kSpeed, kLoad, 32767};
  flux_observer_preset(&s, &now, raw_dq(current, 20));
  expect_begun(s.observer);
  const Vector flux = Vector{motor.flux + motor.ld * current.x, motor.lq * current.y}.turned(rad(kAngle));
  for (const ab_t& set : {s.flux_q16, s.flux.flux_q16}) {
    EXPECT_NEAR(real(set.alpha, 16), flux.x / kPeriod, 0.02);
    EXPECT_NEAR(real(set.beta, 16), flux.y / kPeriod, 0.02);
  }
  EXPECT_NEAR(real(s.flux.compensation_q16, 16), flux.length() / kPeriod, 0.02);
  EXPECT_EQ(s.flux.shown_q28.alpha, raw(1.0, 28));
  EXPECT_EQ(s.flux.shown_q28.beta, 0);
  EXPECT_NEAR((real(s.current_q20, 20) - current.turned(rad(kAngle))).length(), 0.0, 1e-5);
  EXPECT_EQ(s.form.cutoff_q30, 0) << "little is forgotten at first";
  EXPECT_EQ(s.adaptation.shares.lq_q24, learnt.shares.lq_q24);
  EXPECT_EQ(s.adaptation.shares.psi_q24, learnt.shares.psi_q24);
}

}  // namespace
