// What no machine makes, but samples, torques and parameters can: nothing may wrap into the other sign.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/deviation_observer.h"
#include "estimators/inertia_match.h"
#include "estimators/inverse_inductance.h"
#include "estimators/saturation.h"
#include "estimators/stator_flux.h"
#include "estimators/tracking_observer.h"
#include "estimators/zvv.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

// The change of a sensor that jumps from end to end within a short window, seen at a speed that makes as much of its
// own.
TEST(Extremes, AResidualBeyondItsFormatKeepsItsSign) {
  const machine_model_t none = {};
  for (const double sign : {1.0, -1.0}) {
    estimator_window_t w = {};
    w.change_q19 = raw_ab({sign * 400.0, sign * 800.0}, 19);
    w.span_ticks = 40;
    w.middle_tick = 5000;
    const deviation_t d = deviation_evaluate(&none, &w, 0, 0);
    EXPECT_NEAR(real(d.residual_q20.d, 20), sign * 512.0, 1e-3);
    EXPECT_NEAR(real(d.residual_q20.q, 20), sign * 512.0, 1e-3);
  }
}

// A machine whose current follows the voltage within half a period counts as one that takes half a period.
TEST(Extremes, WhatTheModelMakesOfACurrentKeepsItsSign) {
  machine_model_t m = {};
  m.rs_q24 = raw(20.0, 24);
  m.yd_q30 = m.yq_q30 = raw(1.0, 30);
  for (const double sign : {1.0, -1.0}) {
    m.ydq_q30 = raw(sign * 0.5, 30);
    const deviation_model_t at = deviation_model(&m, 0);
    EXPECT_NEAR(real(at.a_dd_q29, 29), 2.0, 1e-6);
    EXPECT_NEAR(real(at.a_dq_q29, 29), sign * 2.0, 1e-6);
    estimator_window_t w = {};
    w.span_ticks = 10000;
    const estimator_frame_t frame = {{0, 1 << 30}, {400 << 18, 0}};
    deviation_change_t c;
    deviation_changes(&at, &w, &frame, 1, 0, &c);
    EXPECT_NEAR(real(c.left_q17.d, 17), 800.0, 0.01);
    EXPECT_NEAR(real(c.left_q17.q, 17), sign * 800.0, 0.01);
  }
}

// A machine with Lq = 2.7 Ld has sensitivities of 470 A at 200 A; with the largest saliency that may be learnt (Lq = 19
// Ld) they are beyond 2048 A, where their format ends.
TEST(Extremes, WhatALearntSaliencyMakesOfALargeCurrentKeepsItsSign) {
  Motor motor;
  motor.ld = 5e-3;
  motor.lq = 13.5e-3;
  machine_model_t model = model_of(motor);
  inverse_inductance_preset(&model, 0, INT32_MAX);
  machine_model_move(&model, 0);
  for (const double sign : {1.0, -1.0}) {
    const deviation_sensitivity_t along_q = deviation_sensitivity(&model, 0, {0, raw(sign * 200.0, 20)});
    EXPECT_NEAR(real(along_q.h_speed_q20.d, 20), sign * 2048.0, 1e-3);
    const deviation_sensitivity_t along_d = deviation_sensitivity(&model, 1 << 30, {raw(sign * 200.0, 20), 0});
    EXPECT_NEAR(real(along_d.rest_q17.d, 17), sign * -2048.0, 1.0);  // less what the resistance takes
  }
}

// Inverse inductances of 3 A per V and period, where 2 is the format's end, while the current along the axis is
// positive; and residuals that make the resistance as far beyond its own.
TEST(Extremes, WhatASaturationTestSeesBeyondItsFormatKeepsItsSign) {
  const machine_model_t model = model_of(Motor{});
  const saturation_slopes_t slopes = {0, raw(0.00139, 30)};
  for (const std::int32_t sign : {1, -1}) {
    saturation_t s;
    saturation_begin(&s, &model, &slopes, raw(1.0, 20));
    for (int n = 0; n < SATURATION_LENGTH; ++n) {
      const int segment = n / SATURATION_SEGMENT;
      regression_t r = {};
      r.spread_q8 = raw(1000.0, 8);
      r.along_q16 = (segment == 0 || segment == 3) ? sign * raw(3000.0, 16) : 0;
      r.information = 1;
      r.mean_q20.d = (segment == 0 || segment == 3) ? sign * raw(500.0, 20) : sign * raw(-500.0, 20);
      (void)saturation_step(&s, &r, &model);
    }
    EXPECT_LT(real(s.change_q30, 30) * sign,
              -1.5);  // Lq is to grow with this current, so the inverse inductance to fall
    EXPECT_LT(real(saturation_resistance_q24(&s, &model), 24) * sign, -127.0);
  }
}

// Inverse inductances from one end of their format to the other, round after round, are no certainty.
TEST(Extremes, TheScatterOfASaturationTestEndsAndDoesNotBeginAnew) {
  const machine_model_t model = model_of(Motor{});
  const saturation_slopes_t slopes = {0, raw(0.00139, 30)};
  saturation_t s;
  saturation_begin(&s, &model, &slopes, raw(1.0, 20));
  for (int n = 0; n < SATURATION_LENGTH; ++n) {
    const int round = (n % SATURATION_SEGMENT - SATURATION_SETTLE + SATURATION_ROUND) / SATURATION_ROUND;
    regression_t r = {};
    r.spread_q8 = raw(1000.0, 8);
    r.along_q16 = raw((round % 2 == 0) ? 3000.0 : -3000.0, 16);
    r.information = 1;
    (void)saturation_step(&s, &r, &model);
  }
  EXPECT_GT(s.scatter, std::uint64_t{1} << 60);
  EXPECT_EQ(s.result, POLARITY_AMBIGUOUS);
}

// An inertia that was told far too small: all torques are accelerations at their format's end. From braking to driving
// the run-up gains speed, and what is found is taken back when the load has changed.
TEST(Extremes, ARunUpWithAccelerationsAtTheirEndKeepsItsSign) {
  inertia_match_t s;
  inertia_match_reset(&s);
  inertia_seen_t in = {0, 0, 0, INT32_MIN + 1, 1000, 1000};
  for (int ms = 0; ms < 200; ++ms) (void)inertia_match_step(&s, &in, 10);
  EXPECT_LT(s.base_q8, -2000000000);
  in.torque_accel_q8 = INT32_MAX;
  in.reference_bpp = 100000;
  (void)inertia_match_step(&s, &in, 10);
  ASSERT_EQ(s.phase, INERTIA_RUN_UP);
  for (int k = 0; k < 300; ++k) {
    inertia_match_add(&s, in.torque_accel_q8);
    ASSERT_GT(s.gained_bpp, 0) << k;
  }
  in.speed_bpp = in.reference_bpp;
  s.quiet_ms = 1;
  for (int ms = 0; ms < 5; ++ms) (void)inertia_match_step(&s, &in, 10);
  EXPECT_GT(s.base_q8, -2000000000);  // on its way up, and not below its other end
  EXPECT_LT(s.base_q8, 0);
}

// Torque without end and no window: 1.9 rad per period are where the model's formats end.
TEST(Extremes, TheObserversSpeedEndsWhereTheModelDoes) {
  for (const std::int32_t accel : {INT32_MAX, INT32_MIN}) {
    const machine_model_t model = model_of(Motor{});
    deviation_observer_config_t c;
    const deviation_observer_tuning_t t = {raw(0.1, 20), raw(1.0, 20), raw(0.05, 20), raw(2.0, 20), bpp(40.0), true};
    deviation_observer_design(&c, &model, &t);
    c.cogging = {0, c.cogging.crawl_bpp, 0};
    c.zero_vectors_only = false;
    deviation_observer_t s;
    deviation_observer_preset(&s, 0, 0, 0);
    estimator_input_t in = {};
    in.model = &model;
    in.torque_accel_q8 = accel;
    for (int n = 0; n < 1000; ++n) {
      (void)deviation_observer_step(&s, &c, &in);
      ASSERT_LE(std::abs(static_cast<double>(s.speed_bpp)), MACHINE_SPEED_END_BPP) << n;
      ASSERT_GE(accel > 0 ? s.speed_bpp : -s.speed_bpp, 0) << n;
    }
  }
}

TEST(Extremes, TheTrackingObserversSpeedEndsWhereTheModelDoes) {
  for (const std::int32_t accel : {INT32_MAX, INT32_MIN}) {
    tracking_observer_t s;
    tracking_observer_preset(&s, 0, 0, 0);
    for (int n = 0; n < 1000; ++n) {
      tracking_observer_predict(&s, accel);
      tracking_observer_correct(&s, accel, raw(0.0999, 30));
      ASSERT_LE(std::abs(static_cast<double>(s.speed_bpp)), MACHINE_SPEED_END_BPP) << n;
    }
  }
}

// The largest flux that is taken for one, and an EMF that a step cannot add to it any more.
TEST(Extremes, AFluxAtItsEndBeginsAnewAndDoesNotTurnItsSign) {
  const stator_flux_config_t c = {STATOR_FLUX_BARE, 107374, 1 << 29};
  constexpr std::int32_t kBound = 1966080000;
  stator_flux_t s = {};
  s.flux_q16 = {kBound, -kBound};
  stator_flux_step(&s, &c, {INT32_MAX, INT32_MIN}, 0, kBound);
  EXPECT_EQ(s.flux_q16.alpha, 0);
  EXPECT_EQ(s.flux_q16.beta, 0);
}

// A back-EMF of 58000 V, which no format holds, is a large one and not one the other way round.
TEST(Extremes, ZvvsDeviationKeepsItsSign) {
  machine_model_t model = model_of(Motor{});
  model.emf_q16 = 2000000000;
  estimator_window_t w = {};
  w.span_ticks = 3000;
  w.zero_vector = true;
  estimator_input_t in = {};
  in.model = &model;
  in.windows = &w;
  in.window_count = 1;
  std::int32_t deviation_q20 = 0;
  ASSERT_TRUE(zvv_deviation_q20(&in, 0, MACHINE_SPEED_END_BPP, &deviation_q20));
  EXPECT_GT(deviation_q20, 0);
}

}  // namespace
