// Resistance and flux learnt from the mean residual, against machines that differ from the parameters.

#include <gtest/gtest.h>

#include "tests/estimators/machine.hpp"

extern "C" {
#include "estimators/voltage_match.h"
}

namespace {

using namespace stillspin::test;

const std::int32_t kShare = raw(0.002, 30);  // 50 ms: fifty times faster than the drive, for short tests

// Angle and speed known, current held: what remains is the voltage.
class Bench {
 public:
  Bench(const Motor& truth, double rpm, double iq) : truth_(truth), model_(model_of(Motor{})), iq_(iq) {
    speed_ = truth_.electrical(rpm);
  }
  void current(double iq) { iq_ = iq; }
  void speed(double rpm) { speed_ = truth_.electrical(rpm); }
  void run(int periods) {
    for (int n = 0; n < periods; ++n) {
      theta_ += speed_ * kPeriod;
      machine_model_move(&model_, raw(iq_, 20));
      std::vector<estimator_window_t> windows;
      for (const Window& w : alternating_windows(n)) {
        windows.push_back(observed(truth_, w, theta_, speed_, Vector{0.0, iq_}.turned(theta_ - speed_ * kPeriod / 2)));
      }
      const estimator_input_t in = input_of(model_, windows);
      const std::int32_t w_q30 = machine_speed_rad_q30(bpp(speed_));
      deviation_change_t seen[ESTIMATOR_WINDOWS];
      (void)deviation_see(&in, bam(theta_), bpp(speed_), seen);
      regression_t r;
      regression_evaluate(&r, seen, &in);
      voltage_match_step(&model_, &r, w_q30, kShare);
    }
    machine_model_move(&model_, raw(iq_, 20));
  }
  double resistance() const { return real(model_.rs_q24, 24); }
  double flux() const { return real(model_.psi_d_q16, 16) * kPeriod; }

 private:
  Motor truth_;
  machine_model_t model_;
  double iq_, speed_, theta_ = 0.4;
};

TEST(VoltageMatch, ResistanceUnderLoadAtStandstill) {
  for (const double factor : {0.7, 1.3, 1.6}) {
    Motor truth;
    truth.rs *= factor;
    Bench b(truth, 0.0, 8.0);
    b.run(4000);
    EXPECT_NEAR(b.resistance(), truth.rs, 0.003) << factor;
    EXPECT_NEAR(b.flux(), 0.16, 1e-4) << factor;  // nothing turns: nothing is learnt of it
  }
}

TEST(VoltageMatch, ResistanceSeenBeforehandIsTakenWithinBounds) {
  machine_model_t m = model_of(Motor{});
  const double nominal = real(m.rs_q24, 24);
  voltage_match_resistance(&m, raw(0.05, 24));
  voltage_match_resistance(&m, raw(0.03, 24));
  machine_model_move(&m, 0);
  EXPECT_NEAR(real(m.rs_q24, 24), nominal + 0.08, 1e-6);
  voltage_match_resistance(&m, raw(50.0, 24));
  machine_model_move(&m, 0);
  EXPECT_NEAR(real(m.rs_q24, 24), 2.0 * nominal, 1e-6);
  voltage_match_resistance(&m, raw(-50.0, 24));
  machine_model_move(&m, 0);
  EXPECT_NEAR(real(m.rs_q24, 24), 0.5 * nominal, 1e-6);
}

TEST(VoltageMatch, FluxAtSpeed) {
  for (const double factor : {0.85, 1.1}) {
    Motor truth;
    truth.flux *= factor;
    Bench b(truth, 1000.0, 1.0);
    b.run(6000);
    EXPECT_NEAR(b.flux(), truth.flux, 0.002 * truth.flux) << factor;
    EXPECT_NEAR(b.resistance(), 0.32, 0.05) << factor;  // does not take the blame
  }
}

TEST(VoltageMatch, BothFromAChangingDrive) {
  Motor truth;
  truth.rs *= 1.3;
  truth.flux *= 0.9;
  Bench b(truth, 0.0, 8.0);
  for (int round = 0; round < 6; ++round) {
    b.speed(0.0);
    b.current(8.0);
    b.run(2000);
    b.speed(-600.0);
    b.current(-2.0);
    b.run(2000);
  }
  EXPECT_NEAR(b.resistance(), truth.rs, 0.02 * truth.rs);
  EXPECT_NEAR(b.flux(), truth.flux, 0.01 * truth.flux);
}

TEST(VoltageMatch, NothingWithoutAShare) {
  machine_model_t m = model_of(Motor{});
  m.trim.rs_q24 = 12345;
  regression_t r = {};
  machine_model_follow(&m, raw(8.0, 20));
  r.mean_q20.q = raw(0.5, 20);
  voltage_match_step(&m, &r, raw(0.02, 30), 0);
  EXPECT_EQ(m.trim.rs_q24, 12345);
  EXPECT_EQ(m.trim.psi_q16, 0);
  voltage_match_step(&m, &r, raw(0.02, 30), raw(0.001, 30));
  EXPECT_NE(m.trim.psi_q16, 0);
}

TEST(VoltageMatch, NothingWithoutCurrentOrSpeed) {
  Motor truth;
  truth.rs *= 2.0;
  truth.flux *= 0.5;
  Bench b(truth, 0.0, 0.0);
  b.run(2000);
  EXPECT_NEAR(b.resistance(), 0.32, 1e-3);
  EXPECT_NEAR(b.flux(), 0.16, 1e-5);
}

TEST(VoltageMatch, StaysWithinItsBounds) {
  Motor truth;
  truth.rs *= 5.0;
  Bench b(truth, 0.0, 8.0);
  b.run(6000);
  EXPECT_NEAR(b.resistance(), 0.64, 1e-6);
  Motor weak;
  weak.flux *= 0.4;
  Bench c(weak, 1000.0, 0.0);
  c.run(6000);
  EXPECT_NEAR(c.flux(), 0.1, 1e-4);
  Motor strong;
  strong.flux *= 1.6;
  Bench d(strong, 1000.0, 0.0);
  d.run(6000);
  EXPECT_NEAR(d.flux(), 0.22, 1e-4);
}

}  // namespace
