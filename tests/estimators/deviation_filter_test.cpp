// The fixed-point Kalman filter against the same filter in double precision over a long random run: same estimates, a
// covariance that stays positive, no overflow.

#include "tests/estimators/machine.hpp"
#include "tests/estimators/observer.hpp"

extern "C" {
#include "estimators/deviation_observer.h"
}

namespace {

using namespace stillspin::test;

/// Textbook extended Kalman filter; states: angle (rad), speed (rad per period), minus load (rad per period^2).
/// Sensitivities are numeric derivatives of the stationary-frame machine.
class Reference {
 public:
  Reference(const Motor& motor, double noise, double load_variance, double angle, double speed)
      : motor_(motor), noise_(noise), load_variance_(load_variance), x_{angle, speed, 0.0} {
    p_[0][0] = 128.0 * std::ldexp(1.0, -12);  // the firmware's start, in its units squared
    p_[1][1] = 64.0 * std::ldexp(1.0, -24);
    p_[2][2] = 64.0 * std::ldexp(1.0, -36);
  }

  void step(const std::vector<estimator_window_t>& windows, double torque) {
    predict(torque);
    double information[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    double score[2] = {0.0, 0.0};
    for (const estimator_window_t& w : windows) {
      const Vector e = residual(w, x_[0], x_[1]);
      const double d = 1e-5;
      const Vector ha = (residual(w, x_[0] - d, x_[1]) - residual(w, x_[0] + d, x_[1])) * (0.5 / d);
      const double back = 1.0 - w.middle_tick / 10000.0;
      const Vector hs =
          (residual(w, x_[0] - d * back, x_[1] - d) - residual(w, x_[0] + d * back, x_[1] + d)) * (0.5 / d);
      for (const double axis : {0.0, 1.0}) {
        const double scale = std::sqrt(w.span_ticks / 30000.0) / noise_;  // of a third of the period
        const auto of = [&](Vector v) { return (axis == 0.0 ? v.x : v.y) * scale; };
        const double h[2] = {of(ha), of(hs)};
        for (int i = 0; i < 2; ++i) {
          score[i] += h[i] * of(e);
          for (int k = 0; k < 2; ++k) information[i][k] += h[i] * h[k];
        }
      }
    }
    update(information, score);
  }

  double state(int i) const { return x_[i]; }
  double covariance(int i, int k) const { return p_[i][k]; }

 private:
  // What the stationary-frame slope is short of, at an estimate; turning it makes no difference to a sum of squares, so
  // the stationary frame of the estimate's own angle is used throughout.
  Vector residual(const estimator_window_t& w, double angle, double speed) const {
    const double at = angle - speed * (1.0 - w.middle_tick / 10000.0);
    const Vector model = slope_of(motor_, at, speed / kPeriod, real(w.current_q20, 20), real(w.voltage_q19, 19));
    return slope_from(w.change_q19, w.span_ticks) - model * kPeriod;
  }

  void predict(double torque) {
    const double change = torque + x_[2];
    x_[0] += x_[1] + 0.5 * change;
    x_[1] += change;
    const double f[3][3] = {{1.0, 1.0, 0.5}, {0.0, 1.0, 1.0}, {0.0, 0.0, 1.0}};
    double fp[3][3] = {}, n[3][3] = {};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) fp[i][k] += f[i][j] * p_[j][k];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) n[i][k] += fp[i][j] * f[k][j];
    n[2][2] += load_variance_;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) p_[i][k] = n[i][k];
  }

  // P+ = P - P' I (1 + P22 I)^-1 P'^T with the 3 x 2 part P' and the 2 x 2 part P22 of the measured states.
  void update(const double info[2][2], const double score[2]) {
    double m[2][2];  // (1 + I P22)
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) m[i][k] = (i == k ? 1.0 : 0.0) + info[i][0] * p_[0][k] + info[i][1] * p_[1][k];
    const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    const double inverse[2][2] = {{m[1][1] / det, -m[0][1] / det}, {-m[1][0] / det, m[0][0] / det}};
    double k_gain[3][2];  // rows of P' (1 + I P22)^-1: P+ seen by the measured states
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 2; ++k) k_gain[i][k] = p_[i][0] * inverse[0][k] + p_[i][1] * inverse[1][k];
    double n[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        n[i][k] = p_[i][k];
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b) n[i][k] -= k_gain[i][a] * info[a][b] * p_[b][k];
      }
    }
    for (int i = 0; i < 3; ++i) x_[i] += k_gain[i][0] * score[0] + k_gain[i][1] * score[1];
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) p_[i][k] = n[i][k];
  }

  Motor motor_;
  double noise_, load_variance_;
  double x_[3];
  double p_[3][3] = {};
};

double determinant(const deviation_observer_t& s) {
  const double aa = real(s.p_aa, 20), as = real(s.p_as, 20), al = real(s.p_al, 20);
  const double ss = real(s.p_ss, 20), sl = real(s.p_sl, 20), ll = real(s.p_ll, 20);
  return aa * (ss * ll - sl * sl) - as * (as * ll - sl * al) + al * (as * sl - ss * al);
}

TEST(DeviationFilter, AgreesWithDoublePrecisionOverALongRandomRun) {
  Random random(230);
  const Motor motor;
  const machine_model_t m = model_of(motor);
  const double noise = 0.05, load_rate = 0.6;
  deviation_observer_config_t c;
  design_plain(&c, &m, raw(noise, 20), raw(load_rate, 20));
  c.zero_vectors_only = false;
  deviation_observer_t s;
  deviation_observer_preset(&s, 0, 0, 0);
  Reference reference(motor, noise, real(c.load_noise_q20, 20) * std::ldexp(1.0, -36), 0.0, 0.0);
  double theta = 5.0 * kDegree, speed = 0.0, accel = 0.0, torque = 0.0;  // rad, rad/s, rad/s^2
  double angle_apart = 0.0, speed_apart = 0.0, ratio_low = 1e9, ratio_high = 0.0, smallest = 1e9;
  const double per_nm = motor.pole_pairs / motor.inertia;
  for (int n = 0; n < 100000; ++n) {
    if (n % 500 == 0) {
      torque = random.between(-2.0, 2.0) * per_nm;  // and a load that steps, too
      accel = random.between(-2.0, 2.0) * per_nm - 2.0 * speed;
    }
    theta += speed * kPeriod + 0.5 * accel * kPeriod * kPeriod;
    speed += accel * kPeriod;
    const Vector current = Vector{random.between(-6.0, 6.0), random.between(-10.0, 10.0)}.turned(theta);
    std::vector<estimator_window_t> windows;
    const int kind = (n / 1000) % 4;  // all, active only, zero with rare active ones, all but rarely
    const int span = 400 + random.below(3000);
    const auto add = [&](const Window& w) {
      const Vector error = Vector{random.normal(), random.normal()} * (noise * 10000.0 / w.span);
      windows.push_back(observed(motor, w, theta, speed, current, error));
    };
    if (kind != 1) add({0, 5000, span});
    const bool active = kind != 2 || n % 5 == 0;
    if (active) add({1u << (n % 3), 2000, span});
    if (active) add({7u ^ (1u << (n % 3)), 8000, span});
    if (kind == 3 && n % 10 != 0) windows.clear();
    const estimator_input_t in = input_of(m, windows, accel_q8(torque));
    deviation_observer_step(&s, &c, &in);
    reference.step(windows, torque * kPeriod * kPeriod);
    ASSERT_GT(s.p_aa, 0);
    ASSERT_GT(s.p_ss, 0);
    ASSERT_GT(s.p_ll, 0);
    // Correlations stay below one: no more than rounding (2^-20 a step) may break the minors.
    ASSERT_GT(real(s.p_aa, 20) * real(s.p_ss, 20) - real(s.p_as, 20) * real(s.p_as, 20), -1e-3) << n;
    ASSERT_GT(real(s.p_ss, 20) * real(s.p_ll, 20) - real(s.p_sl, 20) * real(s.p_sl, 20), -1e-2) << n;
    smallest = std::min(smallest, determinant(s));
    if (n < 2000) continue;
    angle_apart = std::max(angle_apart, std::fabs(wrapped(rad(s.angle_bam) - reference.state(0))));
    speed_apart = std::max(speed_apart, std::fabs(rad(s.speed_bpp) - reference.state(1)) / kPeriod);
    const double ratio = real(s.p_aa, 20) * std::ldexp(1.0, -12) / reference.covariance(0, 0);
    ratio_low = std::min(ratio_low, ratio);
    ratio_high = std::max(ratio_high, ratio);
  }
  std::printf("  apart: %.3f deg, %.3f rad/s; angle variance over reference %.3f .. %.3f; least determinant %.3g\n",
              angle_apart / kDegree, speed_apart, ratio_low, ratio_high, smallest);
  // One sigma of the angle is some 0.5 degrees here; fixed point must not add to it, nor change the filter itself.
  EXPECT_LT(angle_apart / kDegree, 0.15);
  EXPECT_LT(speed_apart, 0.6);
  EXPECT_GT(smallest, 0.0);
  EXPECT_GT(ratio_low, 0.99);
  EXPECT_LT(ratio_high, 1.01);
}

/// Mean of the angle's variance just after the covariance was renewed, own units, at a speed, renewed every so often;
/// and of what a period tells of the angle then.
struct Renewed {
  double variance, information;
};

Renewed renewed_every(int periods, double amps, double speed) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  deviation_observer_config_t c;
  design_plain(&c, &m, raw(0.005, 20), raw(0.6, 20));
  c.zero_vectors_only = false;
  deviation_observer_t s;
  double theta = 0.0;
  deviation_observer_preset(&s, bam(theta), bpp(speed), 0);
  Renewed seen = {0.0, 0.0};
  const int begin = 2100, end = 4200;
  for (int n = 0; n < end; ++n) {
    theta += speed * kPeriod;
    std::vector<estimator_window_t> windows;
    for (const Window& w : alternating_windows(n)) {
      windows.push_back(observed(motor, w, theta, speed, Vector{0.0, amps}.turned(theta)));
    }
    estimator_input_t in = input_of(m, windows);
    in.renew = n % periods == 0;
    deviation_observer_step(&s, &c, &in);
    if (n < begin) continue;
    if (n % periods == 0) seen.variance += real(s.p_aa, 20) * periods / (end - begin);
    if (n % periods != 0) seen.information += real(s.gathered.aa_q21, 21) / s.gathered.periods / (end - begin);
  }
  return seen;
}

// What is gathered over a turn is all of it, also where each period tells as much as a period may. It counts as told
// at its end, so that the variance then is the bottom of a sawtooth, up to a quarter below what it is with small steps.
TEST(DeviationFilter, ARareRenewalKnowsWhatAllPeriodsTold) {
  for (const double speed : {100.0, 400.0, 1250.0}) {
    const double each = renewed_every(1, 3.0, speed).variance;
    const Renewed rare = renewed_every(7, 3.0, speed);
    std::printf("  %.0f rad/s: %.2f a period, variance %.4f, renewed rarely %.4f\n", speed,
                rare.information * 7.0 / 6.0, each, rare.variance);
    EXPECT_GT(rare.variance / each, 0.75) << speed;
    EXPECT_LT(rare.variance / each, 1.0) << speed;
  }
}

// No window at all, then zero vectors without current, each for seconds: the uncertainty must stop growing before it
// overflows, and the filter must come back at once.
TEST(DeviationFilter, WaitsWithoutInformation) {
  const Motor motor;
  const machine_model_t m = model_of(motor);
  deviation_observer_config_t c;
  design_plain(&c, &m, raw(0.05, 20), raw(5.0, 20));
  for (const bool zero_windows : {false, true}) {
    c.zero_vectors_only = true;
    deviation_observer_t s;
    deviation_observer_preset(&s, bam(0.1), 0, 0);
    for (int n = 0; n < 50000; ++n) {
      std::vector<estimator_window_t> windows;
      if (zero_windows) windows.push_back(observed(motor, {0, 5000, 7000}, 0.0, 0.0, {0.0, 0.0}));
      const estimator_input_t in = input_of(m, windows);
      deviation_observer_step(&s, &c, &in);
      ASSERT_GE(determinant(s), 0.0) << n;
      for (const std::int32_t variance : {s.p_aa, s.p_ss, s.p_ll}) {
        ASSERT_GT(variance, 0);
        ASSERT_LE(real(variance, 20), 512.0);
      }
    }
    c.zero_vectors_only = false;
    for (int n = 0; n < 300; ++n) {
      std::vector<estimator_window_t> windows;
      for (const Window& w : alternating_windows(n)) windows.push_back(observed(motor, w, 0.0, 0.0, {0.0, 0.0}));
      const estimator_input_t in = input_of(m, windows);
      deviation_observer_step(&s, &c, &in);
    }
    EXPECT_NEAR(rad(s.angle_bam) / kDegree, 0.0, 0.1) << zero_windows;
  }
}

// Garbage from the converter must neither wrap nor break the filter for good.
class AnyWindow : public testing::TestWithParam<int> {};

TEST_P(AnyWindow, IsSurvived) {
  Random random(231);
  const Motor motor;
  const machine_model_t m = model_of(motor);
  deviation_observer_config_t c;
  design_plain(&c, &m, raw(0.001, 20), raw(5.0, 20));
  c.zero_vectors_only = false;
  deviation_observer_t s;
  deviation_observer_preset(&s, 0, 0, 0);
  for (int n = 0; n < 100000; ++n) {
    std::vector<estimator_window_t> windows;
    for (int k = 0; k < 3; ++k) {
      estimator_window_t w = {};
      w.current_q20 = raw_ab({random.between(-20.0, 20.0), random.between(-20.0, 20.0)}, 20);
      w.voltage_q19 = raw_ab({random.between(-300.0, 300.0), random.between(-300.0, 300.0)}, 19);
      w.middle_tick = static_cast<std::int16_t>(500 + random.below(9000));
      w.span_ticks = static_cast<std::int16_t>(100 + random.below(9000));
      w.change_q19 = raw_change({random.between(-400.0, 400.0), random.between(-400.0, 400.0)}, w.span_ticks);
      windows.push_back(w);
    }
    // the speed is kept where the drive's own supervision would have stopped it
    if (std::abs(s.speed_bpp) > bpp(4000.0)) s.speed_bpp /= 2;
    estimator_input_t in = input_of(m, windows, static_cast<std::int32_t>(random.between(-1e6, 1e6)));
    in.renew = n % GetParam() == 0;
    deviation_observer_step(&s, &c, &in);
    ASSERT_GT(s.p_aa, 0);
    ASSERT_GT(s.p_ss, 0);
    ASSERT_GT(s.p_ll, 0);
  }
  deviation_observer_preset(&s, bam(0.1), 0, 0);
  for (int n = 0; n < 2000; ++n) {
    std::vector<estimator_window_t> windows;
    for (const Window& w : alternating_windows(n)) windows.push_back(observed(motor, w, 0.0, 0.0, {0.0, 0.0}));
    const estimator_input_t in = input_of(m, windows);
    deviation_observer_step(&s, &c, &in);
  }
  EXPECT_NEAR(rad(s.angle_bam) / kDegree, 0.0, 0.05);
}

INSTANTIATE_TEST_SUITE_P(RenewedInEveryPeriodAndRarely, AnyWindow, testing::Values(1, 7));

}  // namespace
