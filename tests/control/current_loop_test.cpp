// The current loop closed on a machine in double precision, with the drive's timing: the measurement is the mean of the
// last period, the voltage acts in the next period as a constant vector of the stationary frame.

#include <gtest/gtest.h>

#include <vector>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/current_controller.h"
}

namespace {

using namespace stillspin::test;

constexpr current_design_t kEveryPeriod = {1800, 100, 1, CURRENT_CORNER_HIGHER};

class Loop {
 public:
  Loop(double rpm, double voltage_limit, const current_design_t& design = kEveryPeriod, const Motor& motor = Motor{})
      : motor_(motor), w_(motor_.electrical(rpm)), limit_(voltage_limit), divider_(design.divider) {
    current_controller_design(&config_, &model_, &design);
    current_controller_reset(&state_);
    voltage_ = {0.0, w_ * motor_.flux};  // the back-EMF: nothing flows until a reference is given
  }

  /// Multiplies all gains: what the design refuses can be tried.
  void scale(double factor) {
    for (pi_config_t* axis : {&config_.d, &config_.q}) {
      axis->kp_q20 = raw(real(axis->kp_q20, 20) * factor, 20);
    }
  }

  /// One period; returns the mean current measured over it, in the rotor frame.
  Vector step(Vector reference) {
    machine_model_move(&model_, raw(mean_.y, 20));
    if (period_++ % divider_ != 0) {
      run_period();
      return mean_;
    }
    const dq_t v =
        current_controller_step(&state_, &config_, &model_, raw_dq(reference, 20), raw_dq(mean_, 20), bpp(w_));
    Vector asked = real(v, 16);
    const Vector next = (asked.length() > limit_) ? asked * (limit_ / asked.length()) : asked;
    if (asked.length() > limit_) current_controller_limited(&state_, &config_, raw_dq(asked - next, 16));
    run_period();
    voltage_ = next;
    return mean_;
  }

 private:
  Vector slope(Vector i, Vector v) const {
    return {(v.x - motor_.rs * i.x + w_ * motor_.lq * i.y) / motor_.ld,
            (v.y - motor_.rs * i.y - w_ * (motor_.ld * i.x + motor_.flux)) / motor_.lq};
  }

  void run_period() {
    constexpr int kSteps = 20;
    const double h = kPeriod / kSteps;
    Vector sum = {0.0, 0.0};
    for (int k = 0; k < kSteps; ++k) {
      // the vector stands still in the stationary frame and is right in the middle of the period
      const auto at = [&](double step) { return voltage_.turned(-w_ * (step * h - kPeriod / 2)); };
      const Vector a = slope(i_, at(k));
      const Vector b = slope(i_ + a * (h / 2), at(k + 0.5));
      const Vector c = slope(i_ + b * (h / 2), at(k + 0.5));
      const Vector d = slope(i_ + c * h, at(k + 1));
      const Vector before = i_;
      i_ = i_ + (a + b * 2 + c * 2 + d) * (h / 6);
      sum = sum + (before + i_) * 0.5;
    }
    mean_ = sum * (1.0 / kSteps);
  }

  Motor motor_;
  machine_model_t model_ = model_of(motor_);
  double w_, limit_;
  int divider_, period_ = 0;
  current_controller_config_t config_;
  current_controller_t state_;
  Vector voltage_, i_ = {0.0, 0.0}, mean_ = {0.0, 0.0};
};

struct Response {
  double rise_ms = 0.0;  // to 63 %
  double overshoot = 0.0, other_axis = 0.0, end_error = 0.0;
};

Response step_response(double rpm, bool q_axis, double amps, const current_design_t& design = kEveryPeriod,
                       double scale = 1.0, const Motor& motor = Motor{}) {
  Loop loop(rpm, 1e4, design, motor);
  loop.scale(scale);
  for (int n = 0; n < 200; ++n) loop.step({0.0, 0.0});
  const Vector reference = q_axis ? Vector{0.0, amps} : Vector{amps, 0.0};
  Response r;
  for (int n = 1; n <= 400; ++n) {
    const Vector i = loop.step(reference);
    const double own = (q_axis ? i.y : i.x) / amps;
    const double other = (q_axis ? i.x : i.y) / amps;
    if (r.rise_ms == 0.0 && own > 0.632) r.rise_ms = n * 0.1;
    r.overshoot = std::max(r.overshoot, own - 1.0);
    r.other_axis = std::max(r.other_axis, std::fabs(other));
    r.end_error = own - 1.0;
  }
  return r;
}

// a (1 + a / 4 s) / s without delay has a double pole at a / 2 and overshoots by e^-2 = 13.5 %; the 200 us of delay
// make some 17 % of it. 63 % are reached after about 0.7 / a and the delay.
void expect_designed(const Response& r) {
  EXPECT_GE(r.rise_ms, 0.5);
  EXPECT_LE(r.rise_ms, 0.8);
  EXPECT_GT(r.overshoot, 0.135);
  EXPECT_LT(r.overshoot, 0.20);
  EXPECT_NEAR(r.end_error, 0.0, 1e-4);
}

// A small motor's winding is more resistance than inductance: with the corner at a/4 its current would take 8 ms, with
// that at R/L it takes what any other does, and does not overshoot by more than the delay makes it.
TEST(CurrentLoop, FollowsAsSoonOnAWindingOfMuchResistance) {
  Motor gimbal;
  gimbal.rs = 5.2;
  gimbal.ld = gimbal.lq = 0.92e-3;
  gimbal.flux = 3.8e-3;
  gimbal.pole_pairs = 7;
  for (const double rpm : {0.0, 500.0}) {
    const Response r = step_response(rpm, true, 0.5, kEveryPeriod, 1.0, gimbal);
    EXPECT_LE(r.rise_ms, 0.8);
    EXPECT_LT(r.overshoot, 0.1);
    EXPECT_NEAR(r.end_error, 0.0, 1e-3);
  }
}

// At half the rate: 1440 rad/s have with 250 us of delay the phase that 1800 have with 200.
TEST(CurrentLoop, StepsEverySecondPeriod) {
  for (const double rpm : {0.0, 1500.0}) {
    const Response r = step_response(rpm, true, 5.0, {1440, 100, 2, CURRENT_CORNER_HIGHER});
    EXPECT_LT(r.overshoot, 0.22);
    EXPECT_NEAR(r.end_error, 0.0, 1e-3);
  }
}

// Paper B: a = 2 pi 1000 rad/s with the corner at R/L. At its 5 kHz and the delay of this drive z^2 - (1 - g/2) z +
// 3g/2 with g = a 100 us: stable up to g = 2/3, and it is 0.628. An inductance 10 % lower is too much. At 10 kHz it
// rings. At a bandwidth that 5 kHz allow, the paper's corner does not overshoot.
TEST(CurrentLoop, PrintedBandwidthOfPaperB) {
  const double up = kTurn * 1000.0 / 1500.0;
  constexpr current_design_t kPaper = {1500, 100, 2, CURRENT_CORNER_MACHINE};
  EXPECT_GT(step_response(0.0, true, 1.0, kPaper, up).overshoot, 0.9);
  EXPECT_GT(step_response(0.0, true, 1.0, kPaper, up * 1.1).overshoot, 10.0);
  const Response fast = step_response(0.0, true, 1.0, {1500, 100, 1, CURRENT_CORNER_MACHINE}, up);
  EXPECT_GT(fast.overshoot, 0.3);
  EXPECT_NEAR(fast.end_error, 0.0, 1e-2);
  const Response slow = step_response(0.0, true, 1.0, kPaper);
  EXPECT_LT(slow.overshoot, 0.02);
  EXPECT_NEAR(slow.end_error, 0.0, 1e-2);
}

TEST(CurrentLoop, StepsAtStandstill) {
  for (const bool q_axis : {false, true}) {
    const Response r = step_response(0.0, q_axis, 5.0);
    expect_designed(r);
    EXPECT_LT(r.other_axis, 1e-4);  // nothing couples the axes at rest but rounding
  }
}

TEST(CurrentLoop, AxesAreDecoupledAt3000Rpm) {
  for (const double rpm : {3000.0, -3000.0}) {
    for (const bool q_axis : {false, true}) {
      const Response r = step_response(rpm, q_axis, 5.0);
      EXPECT_LE(r.rise_ms, 0.9);
      EXPECT_LT(r.overshoot, 0.23);
      // The rotational voltage of the measured current comes two periods late: w T 2 = 0.25 of the change. Without
      // decoupling the other axis would move by about w / a = 70 % of the step.
      EXPECT_LT(r.other_axis, 0.30) << rpm << ", " << q_axis;
      EXPECT_NEAR(r.end_error, 0.0, 2e-3);
    }
  }
}

// A reference that the voltage cannot give for 50 ms, then one that it can.
TEST(CurrentLoop, RecoversFromTheVoltageLimit) {
  for (const double beyond : {3.0, 10.0}) {
    Loop loop(1500.0, 140.0);
    for (int n = 0; n < 200; ++n) loop.step({0.0, 0.0});
    double reached = 0.0;
    for (int n = 0; n < 500; ++n) reached = loop.step({0.0, 16.0 + beyond}).y;
    EXPECT_LT(reached, 16.0 + beyond - 1.0);  // the limit was really in force
    EXPECT_GT(reached, 10.0);
    std::vector<double> after;
    for (int n = 0; n < 300; ++n) after.push_back(loop.step({0.0, 2.0}).y);
    double under = 0.0;
    for (const double i : after) under = std::min(under, i - 2.0);
    std::printf("  beyond %g A: reached %.2f A, undershoot %.2f A\n", beyond, reached, under);
    // The integrator has been let down by Kp times the error that the limit left, so that error is undershot, beside
    // the loop's own 20 % of the step. Without back-calculation the integrator would hold kilovolts.
    EXPECT_GT(under, -(16.0 + beyond - reached) - 0.3 * (reached - 2.0)) << reached;
    // back on the reference within 15 ms, 13 times 2 / a
    for (std::size_t n = 150; n < after.size(); ++n) ASSERT_NEAR(after[n], 2.0, 0.05) << n;
  }
}

}  // namespace
