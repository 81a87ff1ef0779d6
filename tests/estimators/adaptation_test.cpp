// What is learnt while running: the machine's inverse inductances and the mismatch of the two current sensors.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/inverse_inductance.h"
#include "estimators/sensor_match.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

const avv_config_t kAvv = {raw(100.0 * kPeriod, 30), raw(200.0 * kPeriod, 30)};
const std::int32_t kShare = raw(0.02, 30);       // 5 ms, the fastest allowed
const std::int32_t kSlowShare = raw(0.002, 30);  // 50 ms, the default

q_inverse_t per_spread(const regression_t& r) { return q_invert(r.spread_q8); }

// Sensors that read 1 + g and 1 - g, and firmware that takes off what it believes g to be (slopes.c).
Vector through_sensors(Vector slope, double g, double believed) {
  const double a = slope.x * (1 + g) * (1 - believed);
  const double b = 0.5 * (std::sqrt(3.0) * slope.y - slope.x) * (1 - g) * (1 + believed);
  return {a, (a + 2.0 * b) / std::sqrt(3.0)};
}

// The machine at standstill with rotating difference vectors, seen by a model of another one.
class Bench {
 public:
  Bench(const Motor& truth, double theta, double initial_error)
      : truth_(truth), theta_(theta), model_(model_of(Motor{})) {
    start_ = bam(theta - initial_error);
    avv_preset(&avv_, start_, 0, 0);
  }
  void sensor_error(double g) { g_ = g; }
  void hold_the_angle() { held_ = true; }
  void run(int periods, bool adapt, bool match, std::int32_t match_share = kShare) {
    double sum = 0.0;
    for (int n = 0; n < periods; ++n) {
      std::vector<Window> windows = alternating(truth_, n, theta_, 0.0, Vector{2.0, 1.0});
      for (Window& w : windows) w.slope = through_sensors(w.slope, g_, mismatch());
      const Input in(model_, windows);
      if (held_) avv_preset(&avv_, start_, 0, 0);
      (void)avv_step(&avv_, &kAvv, in.get());
      if (adapt) inverse_inductance_step(&model_, &avv_.regression, per_spread(avv_.regression), kShare);
      if (match)
        sensor_match_step(&mismatch_q30_, &avv_.regression, per_spread(avv_.regression), q_invert(mean_q30()),
                          match_share);
      machine_model_move(&model_, 0);
      largest_mismatch_ = std::max(largest_mismatch_, std::fabs(mismatch()));
      if (n >= periods - 600) sum += mismatch();
    }
    mean_mismatch_ = sum / 600.0;
  }
  double mean_mismatch() const { return mean_mismatch_; }  // over the last 600 periods, whole rounds of dv
  double mismatch() const { return real(mismatch_q30_, 30); }
  double largest_mismatch() const { return largest_mismatch_; }
  double angle_error() const { return wrapped(theta_ - rad(avv_.observer.angle_bam)); }
  double ld() const { return kPeriod / real(model_.yd_q30, 30); }
  double lq() const { return kPeriod / real(model_.yq_q30, 30); }
  std::int32_t mean_q30() const { return model_.yd_q30 / 2 + model_.yq_q30 / 2; }
  std::int32_t half_q30() const { return (model_.yd_q30 - model_.yq_q30) / 2; }

 private:
  Motor truth_;
  double theta_;
  double g_ = 0.0, largest_mismatch_ = 0.0, mean_mismatch_ = 0.0;
  std::uint32_t start_ = 0;
  bool held_ = false;
  machine_model_t model_;
  avv_t avv_ = {};
  std::int32_t mismatch_q30_ = 0;
};

Motor scaled(double d, double q) {
  Motor m;
  m.ld *= d;
  m.lq *= q;
  return m;
}

TEST(InverseInductance, ErrorsOfBothInductancesAreFound) {
  const std::pair<double, double> factors[] = {{1.2, 1.0}, {0.8, 1.0}, {1.0, 1.2}, {1.0, 0.8},
                                               {1.2, 1.2}, {0.8, 0.8}, {0.8, 1.2}};
  for (const auto& [d, q] : factors) {
    const Motor truth = scaled(d, q);
    for (const double theta : {0.0, 1.1, -2.3}) {
      Bench b(truth, theta, 3.0 * kDegree);
      b.run(1500, true, false);  // 30 time constants of the adaptation, and 10 or more of the observer
      // residuals to 2e-6 A per period beside 3 A per period and more, slightly amplified by the saliency: 1e-5
      EXPECT_NEAR(b.ld() / truth.ld, 1.0, 1e-4) << d << ", " << q << " at " << theta;
      EXPECT_NEAR(b.lq() / truth.lq, 1.0, 1e-4) << d << ", " << q << " at " << theta;
      EXPECT_NEAR(b.angle_error() / kDegree, 0.0, 0.01) << d << ", " << q << " at " << theta;
    }
  }
}

// Ld up and Lq down by a fifth leaves an eighth of the saliency: that is not believed.
TEST(InverseInductance, StaysWithinItsBounds) {
  const machine_model_t nominal = model_of(Motor{});
  const std::int32_t mean = nominal.yd_q30 / 2 + nominal.yq_q30 / 2;
  const std::int32_t half = (nominal.yd_q30 - nominal.yq_q30) / 2;
  Bench b(scaled(1.2, 0.8), 0.4, 0.0);
  b.run(1500, true, false);
  EXPECT_NEAR(b.half_q30(), half / 3, 2);
  Bench c(scaled(0.4, 0.4), 0.4, 0.0);  // 2.5 times the inverse inductance
  c.run(1500, true, false);
  EXPECT_NEAR(c.mean_q30(), mean / 2 * 3, 2);
  // the held error of the mean makes a ripple in the saliency, which its bound cuts: near it, never beyond
  EXPECT_LE(c.half_q30(), half * 2 + 2);
  EXPECT_GT(c.half_q30(), half);
}

// One inductance is told, and the iron makes two of it: the difference is learnt, of either sign, up to an eighth.
TEST(InverseInductance, NextToNoSaliencyMayTurnOver) {
  Motor round;
  round.lq = round.ld;
  const machine_model_t nominal = model_of(round);
  for (const double turned : {-1.0, 1.0}) {
    machine_model_t m = nominal;
    const regression_t seen = {10000000, 0, static_cast<std::int32_t>(turned * 1000000), 0, 0, 1000000, {0, 0}};
    inverse_inductance_step(&m, &seen, per_spread(seen), kShare);
    EXPECT_GT(turned * m.trim.half_q30, 0);
    for (int n = 0; n < 2000; ++n) inverse_inductance_step(&m, &seen, per_spread(seen), kShare);
    EXPECT_EQ(m.trim.half_q30, static_cast<std::int32_t>(turned) * (nominal.yd_q30 >> 3));
  }
}

TEST(InverseInductance, NothingIsLearntFromOneVectorOrWithoutAShare) {
  machine_model_t m = model_of(Motor{});
  const regression_t blind = {1000, 1000000, 1000000, 0, 0, 0, {0, 0}};
  inverse_inductance_step(&m, &blind, per_spread(blind), kShare);
  EXPECT_EQ(m.trim.mean_q30, 0);
  const regression_t seen = {10000000, 1000000, 1000000, 0, 0, 1000000, {0, 0}};
  inverse_inductance_step(&m, &seen, per_spread(seen), 0);
  EXPECT_EQ(m.trim.mean_q30, 0);
  EXPECT_EQ(m.trim.half_q30, 0);
  inverse_inductance_step(&m, &seen, per_spread(seen), kShare);
  EXPECT_GT(m.trim.mean_q30, 0);
  EXPECT_GT(m.trim.half_q30, 0);
}

TEST(SensorMatch, FindsTheMismatchAtStandstill) {
  for (const double g : {-0.02, -0.005, 0.005, 0.02}) {
    for (const double theta : {0.2, 1.4, -2.0}) {
      Bench b(Motor{}, theta, 0.0);
      b.sensor_error(g);
      b.run(2000, true, true);
      // the saliency's own share across dv has a mean of zero over the three directions, but a ripple of
      // share * dY/2 / Y0 * sqrt3 = 0.8 % of what is left of the other errors
      EXPECT_NEAR(b.mismatch(), g, 2e-4) << theta;
      EXPECT_NEAR(b.angle_error() / kDegree, 0.0, 0.05) << g << " at " << theta;
    }
  }
}

// What it is for: without it the angle is bent by up to Y0 g / (sqrt3 dY/2), 0.7 degrees at 0.5 %.
TEST(SensorMatch, WithoutItTheAngleIsBent) {
  double worst = 0.0;
  for (int n = 0; n < 24; ++n) {
    Bench b(Motor{}, n * kPi / 24.0, 0.0);
    b.sensor_error(0.005);
    b.run(1500, true, false);
    worst = std::max(worst, std::fabs(b.angle_error()) / kDegree);
  }
  EXPECT_NEAR(worst, 0.72, 0.1);
}

// Errors of the inductances and of the angle are symmetric matrices: over the three directions nothing of them is
// across dv. That is so for one angle; here the observer is put back to its wrong angle in every period.
TEST(SensorMatch, AMatchedPairStaysMatchedWhateverTheSaliency) {
  Random random(60);
  for (int n = 0; n < 40; ++n) {
    Bench b(scaled(random.between(0.8, 1.2), random.between(0.8, 1.2)), random.between(-kPi, kPi),
            random.between(-20.0, 20.0) * kDegree);
    b.hold_the_angle();
    b.run(6000, false, true, kSlowShare);
    // the ripple within a round is the share of sqrt3 dY/2 / Y0, up to 0.002 * 0.8; a mean comes only from that ripple
    // times the saliency, which makes the reading of g depend on the direction: less than half of it
    EXPECT_NEAR(b.mean_mismatch(), 0.0, 6e-4) << n;
    EXPECT_NEAR(b.mismatch(), 0.0, 1.6e-3) << n;
  }
}

// As the drive runs it, the observer tracking and the inverse inductances adapting. While Y0 is wrong the observed
// angle wobbles with dv, which does leave something across it; it goes when Y0 is found.
TEST(SensorMatch, AMatchedPairStaysMatchedInTheDrive) {
  Random random(61);
  for (int n = 0; n < 40; ++n) {
    const double factor = random.between(0.8, 1.2);
    Bench b(scaled(factor, factor), random.between(-kPi, kPi), random.between(-10.0, 10.0) * kDegree);
    b.run(6000, true, true, kSlowShare);
    EXPECT_NEAR(b.mismatch(), 0.0, 1e-4) << n;
    EXPECT_LT(b.largest_mismatch(), 5e-3) << n;
  }
}

TEST(SensorMatch, StaysWithinFivePercent) {
  for (const double g : {-0.2, 0.2}) {
    Bench b(Motor{}, 0.3, 0.0);
    b.sensor_error(g);
    b.run(1000, false, true);
    EXPECT_NEAR(b.mismatch(), g > 0 ? 0.05 : -0.05, 1e-9);
    EXPECT_LE(b.largest_mismatch(), 0.0500001);
  }
}

}  // namespace
