// The deviation observer against an extended Kalman filter in double precision, and its covariance under abuse.

#include <gtest/gtest.h>

#include <array>

#include "tests/estimators/machine_windows.hpp"
#include "tests/estimators/observer.hpp"

extern "C" {
#include "estimators/deviation_observer.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

using Row = std::array<double, 3>;
using Matrix = std::array<Row, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix transposed(const Matrix& a) {
  Matrix t{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t[j][i] = a[i][j];
  return t;
}

// States in rad, rad per period, rad per period^2 (load). The measurements are taken one after the other, all with the
// sensitivities and residuals at the predicted state, which is algebraically the batch update of the firmware.
class Filter {
 public:
  double angle, speed, load;
  Matrix p{};

  Filter(double angle0, double speed0) : angle(angle0), speed(speed0), load(0.0) {
    // "10 degrees, 20 rad/s, 3 N m or so", exactly as in the header's units: 128, 64, 64 of (2^-6, 2^-12, 2^-18)^2
    p[0][0] = 128.0 * std::ldexp(1.0, -12);
    p[1][1] = 64.0 * std::ldexp(1.0, -24);
    p[2][2] = 64.0 * std::ldexp(1.0, -36);
  }

  void predict(double torque, double load_variance) {
    angle += speed + 0.5 * (torque - load);
    speed += torque - load;
    const Matrix f = {{{1.0, 1.0, -0.5}, {0.0, 1.0, -1.0}, {0.0, 0.0, 1.0}}};
    p = product(product(f, p), transposed(f));
    p[2][2] += load_variance;
  }

  // sigma: rms error of a current difference over a third of the period, A; its square grows with the window
  void update(const Motor& m, const std::vector<Window>& windows, double sigma) {
    const double angle0 = angle, speed0 = speed, load0 = load;
    Row x{0.0, 0.0, 0.0};  // correction so far
    for (const Window& w : windows) {
      const double at = angle0 - speed0 * (10000 - w.middle) * 1e-4;
      const double scale = std::sqrt(w.span * 1e-4 / 3.0) / sigma;
      const auto slope = [&](double theta, double rad_per_period) {
        return (current_derivative(m, theta, rad_per_period / m.period, w.current, w.voltage) * m.period).turned(-at);
      };
      const Vector residual = w.slope.turned(-at) - slope(at, speed0);
      const Vector by_angle = (slope(at + 1e-5, speed0) - slope(at - 1e-5, speed0)) * 0.5e5;
      const Vector by_speed = (slope(at, speed0 + 1e-3) - slope(at, speed0 - 1e-3)) * 0.5e3;
      take({by_angle.x * scale, by_speed.x * scale, 0.0}, residual.x * scale, x);
      take({by_angle.y * scale, by_speed.y * scale, 0.0}, residual.y * scale, x);
    }
    angle = angle0 + x[0];
    speed = speed0 + x[1];
    load = load0 + x[2];
  }

 private:
  void take(const Row& h, double e, Row& x) {
    Row ph{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) ph[i] += p[i][k] * h[k];
    double s = 1.0, left = e;
    for (int i = 0; i < 3; ++i) {
      s += h[i] * ph[i];
      left -= h[i] * x[i];
    }
    for (int i = 0; i < 3; ++i) x[i] += ph[i] / s * left;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) p[i][j] -= ph[i] * ph[j] / s;
  }
};

struct Case {
  const char* name;
  bool zero_vectors_only;
  double noise;        // A, true and believed rms error of a current difference
  double angle_bound;  // of the difference between the two filters, degrees
  double speed_bound;  // rad/s
  double load_bound;   // N m
};

std::vector<Window> windows_of(const Case& c, const Motor& m, int n, double theta, double w, Vector i) {
  if (!c.zero_vectors_only) return alternating(m, n, theta, w, i);
  return {window_at(m, theta, w, i, {0, 0}, 2500, 3500), window_at(m, theta, w, i, {0, 0}, 7500, 3500)};
}

class AgainstEkf : public testing::TestWithParam<Case> {};

TEST_P(AgainstEkf, AgreesOver2000Periods) {
  const Case c = GetParam();
  Random random(70);
  const Motor m;
  const machine_model_t model = model_of(m);
  deviation_observer_config_t config = {};
  design_plain(&config, &model, raw(c.noise, 20), raw(0.6, 20));
  config.zero_vectors_only = c.zero_vectors_only;
  const double per_torque = m.pole_pairs / m.inertia * kPeriod * kPeriod;  // rad per period^2 and N m
  const double load_variance = std::pow(0.6 * per_torque, 2) / 100.0;

  double theta = 0.5, w = 30.0 * kPeriod;  // rad, rad per period
  const double theta0 = theta + 4.0 * kDegree, w0 = rad(bpp(22.0));
  deviation_observer_t s = {};
  deviation_observer_preset(&s, bam(theta0), bpp(22.0), 0);
  Filter f(rad(bam(theta0)), w0);
  double angle_gap = 0.0, speed_gap = 0.0, load_gap = 0.0, true_error = 0.0, furthest = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const double load = n < 700 ? 0.0 : 2.0;  // N m
    const std::int32_t torque_q8 = accel_q8((1.5 * std::sin(n * 0.006) + (n < 700 ? 0.0 : 2.0)) * per_torque);
    const double change = rad_per_period2(torque_q8) - load * per_torque;
    theta += w + 0.5 * change;
    w += change;
    std::vector<Window> windows = windows_of(c, m, n, theta, w / kPeriod, Vector{1.0, 6.0}.turned(theta));
    for (Window& x : windows) {
      x.slope = x.slope + Vector{random.normal(), random.normal()} * (c.noise / (x.span * 1e-4));
    }
    const Input in(model, windows, torque_q8);
    (void)deviation_observer_step(&s, &config, in.get());
    f.predict(rad_per_period2(torque_q8), load_variance);
    f.update(m, windows, c.noise);
    angle_gap = std::max(angle_gap, std::fabs(wrapped(rad(s.angle_bam) - f.angle)));
    speed_gap = std::max(speed_gap, std::fabs(rad(s.speed_bpp) - f.speed));
    load_gap = std::max(load_gap, std::fabs(rad_per_period2(s.load_accel_q8) - f.load));
    if (n > 300) true_error = std::max(true_error, std::fabs(wrapped(rad(s.angle_bam) - theta)));
    furthest = std::max(furthest, std::fabs(theta - 0.5));
  }
  RecordProperty("angle_gap_mdeg", static_cast<int>(1e3 * angle_gap / kDegree));
  RecordProperty("speed_gap_mrads", static_cast<int>(1e3 * speed_gap / kPeriod));
  RecordProperty("load_gap_mNm", static_cast<int>(1e3 * load_gap / per_torque));
  EXPECT_LT(angle_gap / kDegree, c.angle_bound);
  EXPECT_LT(speed_gap / kPeriod, c.speed_bound);
  EXPECT_LT(load_gap / per_torque, c.load_bound);
  EXPECT_LT(true_error / kDegree, 8.0);  // both follow the rotor, not only each other
  EXPECT_GT(furthest, 1.0);              // and it moved
}

INSTANTIATE_TEST_SUITE_P(DeviationObserver, AgainstEkf,
                         testing::Values(Case{"all_windows", false, 0.1, 0.05, 0.3, 0.05},
                                         Case{"precise", false, 0.012, 0.05, 0.3, 0.05},
                                         Case{"zero_vectors", true, 0.012, 0.05, 0.3, 0.05}),
                         [](const auto& instance) { return instance.param.name; });

// Whatever it is fed: any vectors, saturated slopes, no windows, wild torque. A negative variance turns the sign of a
// gain.
TEST(DeviationObserver, VariancesStayPositiveUnderAbuse) {
  Random random(71);
  const machine_model_t model = model_of(Motor{});
  deviation_observer_config_t config = {};
  deviation_observer_t s = {};
  deviation_observer_preset(&s, 0, 0, 0);
  for (int n = 0; n < 100000; ++n) {
    if (n % 5000 == 0) {
      design_plain(&config, &model, raw(random.log_between(0.001, 1.0), 20), raw(random.log_between(0.01, 100.0), 20));
      config.zero_vectors_only = random.below(3) == 0;
    }
    if (n % 9973 == 0) deviation_observer_preset(&s, bam(random.between(-3.0, 3.0)), bpp(random.between(-900, 900)), 0);
    std::vector<Window> windows;
    const int count = random.below(4);
    const double absurd = random.below(50) == 0 ? 100.0 : 1.0;
    for (int k = 0; k < count; ++k) {
      Window w = window_at(Motor{}, random.between(-kPi, kPi), 0.0, random.direction(random.between(0.0, 20.0)),
                           state_vector(random.below(8)), random.below(10000), 1 + random.below(4000));
      w.slope = (w.slope + random.direction(0.3)) * absurd;
      windows.push_back(w);
    }
    const Input in(model, windows, accel_q8(random.between(-1e-3, 1e-3)));
    const estimator_output_t out = deviation_observer_step(&s, &config, in.get());
    ASSERT_GT(s.p_aa, 0) << n;
    ASSERT_GT(s.p_ss, 0) << n;
    ASSERT_GT(s.p_ll, 0) << n;
    ASSERT_GE(out.quality_q15, 0) << n;
    // wild speeds are for the supervision to catch; the model's range is 1.9 rad per period
    s.speed_bpp = q_clamp(s.speed_bpp, -bpp(15000.0), bpp(15000.0));
    s.load_accel_q8 = q_clamp(s.load_accel_q8, -accel_q8(2e-3), accel_q8(2e-3));
  }
}

TEST(DeviationObserver, UncertaintyGrowsWithoutWindowsAndShrinksWithThem) {
  const machine_model_t model = model_of(Motor{});
  deviation_observer_config_t config = {};
  design_plain(&config, &model, raw(0.1, 20), raw(0.6, 20));
  deviation_observer_t s = {};
  deviation_observer_preset(&s, 0, 0, 0);
  const std::int32_t fresh = s.p_aa;
  const Input blind(model, {});
  for (int n = 0; n < 100; ++n) (void)deviation_observer_step(&s, &config, blind.get());
  EXPECT_GT(s.p_aa, fresh);
  for (int n = 0; n < 100; ++n) {
    const Input seen(model, alternating(Motor{}, n, 0.0, 0.0, {0, 0}));
    (void)deviation_observer_step(&s, &config, seen.get());
  }
  EXPECT_LT(s.p_aa, fresh / 10);
  EXPECT_GT(deviation_observer_step(&s, &config, blind.get()).quality_q15, 30000);
}

// Known well and told nothing, it waits to be asked, for twelve periods.
TEST(DeviationObserver, TheCovarianceIsRenewedAfterTwelvePeriodsAtTheLatest) {
  const machine_model_t model = model_of(Motor{});
  deviation_observer_config_t config = {};
  design_plain(&config, &model, raw(0.1, 20), raw(0.6, 20));
  deviation_observer_t s = {};
  deviation_observer_preset(&s, 0, 0, 0);
  s.p_aa = raw(1.0, 20);
  Input blind(model, {});
  estimator_input_t in = *blind.get();
  in.renew = false;
  for (int n = 1; n < 12; ++n) {
    (void)deviation_observer_step(&s, &config, &in);
    EXPECT_EQ(s.gathered.periods, n);
    EXPECT_EQ(s.p_aa, raw(1.0, 20));
  }
  (void)deviation_observer_step(&s, &config, &in);
  EXPECT_EQ(s.gathered.periods, 0);
  EXPECT_GT(s.p_aa, raw(1.0, 20));
}

// What was not seen cannot be taken, and what was taken is gone.
TEST(DeviationObserver, NothingIsLeftBeforeAWindowWasSeen) {
  deviation_observer_t s = {};
  dq_t residual = {5, 6};
  std::int32_t span = 7, periods = 8;
  EXPECT_FALSE(deviation_take_mean_residual(&s.residual, &residual, &span, &periods));
  EXPECT_EQ(residual.d, 5);
  EXPECT_EQ(span, 7);
  EXPECT_EQ(periods, 8);
}

// Each reason alone: a load that is new, seven periods; and, urgent, an angle that is not known, windows that told a
// tenth of what is known.
TEST(DeviationObserver, WhenItsCovarianceIsDue) {
  deviation_observer_t s = {};
  s.gathered.periods = 6;
  EXPECT_FALSE(deviation_observer_is_due(&s));
  s.gathered.periods = 7;
  EXPECT_TRUE(deviation_observer_is_due(&s));
  s.gathered.periods = 0;
  s.load_is_new = true;
  EXPECT_TRUE(deviation_observer_is_due(&s));
  s.load_is_new = false;
  s.p_aa = INT32_MAX;
  EXPECT_FALSE(deviation_observer_is_sure(&s));
  EXPECT_TRUE(deviation_observer_update_is_urgent(&s));
  s.p_aa = 0;
  s.p_ss = s.gathered.ss_q21 = 1 << 24;
  EXPECT_TRUE(deviation_observer_update_is_urgent(&s));
  s.p_ss = 0;
  EXPECT_FALSE(deviation_observer_update_is_urgent(&s));
  EXPECT_FALSE(deviation_observer_is_due(&s));
}

}  // namespace
