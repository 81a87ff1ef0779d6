// What a period's windows say of the speed where the model has an inductance wrong: nothing.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"
#include "tests/estimators/observer.hpp"

extern "C" {
#include "estimators/deviation_information.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

struct Period {
  double speed;  // that the score asks for, as a share of the true one
  double alone;  // the same by one window, whichever is less off
};

// Two opposite vectors along q fill a period over which the current returns to where it was: v_q = +V for a share of
// (1 + e/V)/2 of it, then -V, with e the EMF. The shaft turns at `w` rad/s and the estimator knows angle and speed.
Period seen(double lq_share, double w, int between_ticks) {
  const Motor model_motor;
  Motor m = model_motor;
  m.lq *= lq_share;
  const machine_model_t model = model_of(model_motor);
  deviation_observer_config_t config = {};
  design_plain(&config, &model, raw(0.1, 20), raw(0.6, 20));
  const double volts = 200.0, emf = w * m.flux;
  const double theta = 0.4;
  const int first = static_cast<int>(5000 * (1.0 + emf / volts));
  information_sums_t sums = {};
  double alone = 1e9;
  const std::int32_t w_q30 = machine_speed_rad_q30(bpp(w));
  const deviation_model_t at = deviation_model(&model, w_q30);
  const deviation_sensitivity_t h = deviation_sensitivity(&model, w_q30, {0, 0});
  for (const bool up : {true, false}) {
    const int begin = up ? 0 : first, end = up ? first : 10000;
    const int middle = (begin + end) / 2;
    const double angle = angle_at(theta, w, middle);
    const Vector v = Vector{0.0, up ? volts : -volts}.turned(angle);
    const estimator_window_t window = window_at(m, theta, w, {0, 0}, v, middle, end - begin - between_ticks).raw();
    estimator_frame_t frame;
    deviation_frames(&window, 1, deviation_middle(bam(theta), bpp(w)), w_q30, &frame);
    deviation_change_t change;
    deviation_changes(&at, &window, &frame, 1, 0, &change);
    information_sums_t own = {};
    for (information_sums_t* const n : {&sums, &own}) {
      information_collect(n, config.limit_q19, &h, &window, &change);
    }
    const information_t said = information_of(&own, &config, h.h_speed_q20);
    alone = std::min(alone, std::fabs(real(said.s, 20) / real(said.ss, 24)));
  }
  const information_t n = information_of(&sums, &config, h.h_speed_q20);
  const double unit = std::ldexp(1.0, -12) / kPeriod;  // rad/s
  return {real(n.s, 20) / real(n.ss, 24) * unit / w, alone * unit / w};
}

TEST(DeviationInformation, AnInductanceThatTheModelLacksIsNoSpeed) {
  for (const double lq : {0.6, 0.8, 1.3}) {
    for (const double w : {100.0, 300.0, 600.0}) {
      const Period whole = seen(lq, w, 0);
      EXPECT_LT(std::fabs(whole.speed), 0.01) << lq << ", " << w;
      EXPECT_GT(whole.alone, 0.15) << "a window by itself takes it for one: " << lq << ", " << w;
    }
  }
}

// What no window looks at behind the edges, a fifth of a period here, is a quarter of the inductance's own error.
TEST(DeviationInformation, WhatIsNotSeenIsLeft) {
  const Period whole = seen(0.8, 300.0, 1000);
  EXPECT_NEAR(whole.speed, -0.25 * (1.0 / 0.8 - 1.0), 0.02);
}

}  // namespace
