// The axis in one go, on machines that the model does not know.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/axis.h"
#include "estimators/inverse_inductance.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

const avv_config_t kAvv = {raw(0.01, 30), raw(0.02, 30)};

axis_result_t find(const Motor& truth, const machine_model_t& model, double theta, double noise = 0.0,
                   std::uint64_t seed = 1) {
  Random random(seed);
  avv_t avv = {};
  axis_t axis;
  axis_begin(&axis);
  for (int n = 0;; ++n) {
    std::vector<Window> windows = alternating(truth, n, theta, 0.0, Vector{0, 0});
    for (Window& w : windows) w.slope = w.slope + Vector{noise * random.normal(), noise * random.normal()};
    const Input in(model, windows);
    avv_preset(&avv, 0, 0, 0);
    (void)avv_step(&avv, &kAvv, in.get());
    axis_add(&axis, &avv.regression);
    if (axis_is_complete(&axis)) {
      EXPECT_EQ(n, AXIS_PERIODS - 1);
      return axis_evaluate(&axis, &model);
    }
    if (n > 100) throw "no end";
  }
}

double off_axis(const axis_result_t& r, double theta) {
  return std::remainder(rad(r.angle_bam) - theta, kPi) / kDegree;  // half a turn is left open
}

TEST(Axis, AnyAngleWithInductancesThirtyPercentOff) {
  const machine_model_t model = model_of(Motor{});
  for (const double factor : {0.7, 1.0, 1.3}) {
    Motor truth;
    truth.ld *= factor;
    truth.lq *= factor;
    for (int k = 0; k < 48; ++k) {
      const double theta = k * 7.5 * kDegree;
      const axis_result_t r = find(truth, model, theta);
      EXPECT_NEAR(off_axis(r, theta), 0.0, 0.02) << factor << " at " << k * 7.5;  // formats
      EXPECT_NEAR(real(r.mean_q30, 30), 0.5 * kPeriod * (1 / truth.ld + 1 / truth.lq), 2e-6);
      EXPECT_NEAR(real(r.half_q30, 30), 0.5 * kPeriod * (1 / truth.ld - 1 / truth.lq), 2e-6);
    }
  }
}

// 31 mA per period is what 12 mA rms leaves of a 27 us window (docs, "Physics", section 7): 0.3 degrees after two
// rounds.
TEST(Axis, Noise) {
  const machine_model_t model = model_of(Motor{});
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const double off = off_axis(find(Motor{}, model, 1.0, 0.031, seed), 1.0);
    EXPECT_LT(std::fabs(off), 1.5);
    sum += off * off;
  }
  EXPECT_LT(std::sqrt(sum / 50), 0.6);
  EXPECT_GT(std::sqrt(sum / 50), 0.05);
}

TEST(Axis, PeriodsWithoutTwoVectorsDoNotCount) {
  axis_t axis;
  axis_begin(&axis);
  const regression_t nothing = {};
  for (int n = 0; n < 100; ++n) axis_add(&axis, &nothing);
  EXPECT_FALSE(axis_is_complete(&axis));
  EXPECT_EQ(axis.count, 0);
}

// A direction that is seen once more than the others would be a share of the saliency, and of a curl.
TEST(Axis, WhatComesBehindTwoRoundsDoesNotCount) {
  const machine_model_t model = model_of(Motor{});
  Motor truth;
  truth.ld *= 0.7;
  avv_t avv = {};
  axis_t axis;
  axis_begin(&axis);
  axis_result_t found = {};
  for (int n = 0; n < AXIS_PERIODS + 5; ++n) {
    const std::vector<Window> windows = alternating(truth, n, 0.4, 0.0, Vector{0, 0});
    const Input in(model, windows);
    avv_preset(&avv, 0, 0, 0);
    (void)avv_step(&avv, &kAvv, in.get());
    axis_add(&axis, &avv.regression);
    if (n == AXIS_PERIODS - 1) found = axis_evaluate(&axis, &model);
  }
  const axis_result_t later = axis_evaluate(&axis, &model);
  EXPECT_EQ(axis.count, AXIS_PERIODS);
  EXPECT_EQ(later.angle_bam, found.angle_bam);
  EXPECT_EQ(later.half_q30, found.half_q30);
}

TEST(Axis, TheModelTakesItOver) {
  Motor truth;
  truth.ld *= 1.2;
  truth.lq *= 1.2;
  machine_model_t model = model_of(Motor{});
  const axis_result_t r = find(truth, model, 0.4);
  inverse_inductance_preset(&model, r.mean_q30, r.half_q30);
  machine_model_move(&model, 0);
  EXPECT_NEAR(kPeriod / real(model.yd_q30, 30) / truth.ld, 1.0, 1e-3);
  EXPECT_NEAR(kPeriod / real(model.yq_q30, 30) / truth.lq, 1.0, 1e-3);
  inverse_inductance_preset(&model, 1, 1);  // not believed
  machine_model_move(&model, 0);
  EXPECT_GT(model.yq_q30, 0);
  EXPECT_GT(model.yd_q30, model.yq_q30);
}

}  // namespace
