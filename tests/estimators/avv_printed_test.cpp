// AVV as printed against the equations (33) to (41) of the seed paper in double precision, at operating points anywhere
// and where they are singular.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr int kActive[] = {1, 3, 2, 6, 4, 5};  // the six vectors as they follow one another round the circle

// The phase that a switching state has alone, and the sign with which its current grows.
struct Phase {
  int number;
  double sign;
};
Phase phase_of(int state) {
  for (int k = 0; k < 3; ++k) {
    if (state == 1 << k) return {k, 1.0};
    if (state == 7 - (1 << k)) return {k, -1.0};
  }
  return {-1, 0.0};
}

double along(Vector v, int phase) { return v.x * std::cos(phase * kTurn / 3.0) + v.y * std::sin(phase * kTurn / 3.0); }

struct Pair {
  int first, second;  // switching states
};

// The phases' inductances of (9) to (14) from those of the rotor's axes.
struct Printed {
  double ls = 1e-3, aa, bb;
  explicit Printed(const Motor& m) : aa((m.ld + m.lq - 2.0 * ls) / 3.0), bb((m.lq - m.ld) / 3.0) {}
  double product() const { return (2.0 * ls + 3.0 * (aa - bb)) * (2.0 * ls + 3.0 * (aa + bb)); }
  /// (37), A/s
  double deviation(double theta, int phase) const {
    return 4.0 * kLink * (2.0 / 3.0 * ls + aa + bb * std::cos(2.0 * (theta - phase * kTurn / 3.0))) / product();
  }
  double sum() const { return 12.0 * kLink * (2.0 / 3.0 * ls + aa) / product(); }
};

// (38), (41)
double doubled(const double (&of)[3]) {
  const double alpha = of[0] - 0.5 * (of[1] + of[2]);
  const double beta = 0.5 * std::sqrt(3.0) * (of[1] - of[2]);
  return std::atan2(-beta, alpha);
}

// The same of three windows' slopes: two active vectors and, last, the zero vector; rad.
double doubled_seen(const Motor& m, const Pair& p, const std::vector<Window>& windows) {
  double of[3] = {0.0, 0.0, 0.0};
  double missing = Printed(m).sum();
  int third = 3;
  for (int k = 0; k < 2; ++k) {
    const Phase phase = phase_of(k == 0 ? p.first : p.second);
    const Vector difference = windows[static_cast<std::size_t>(k)].slope - windows[2].slope;
    of[phase.number] = phase.sign * along(difference, phase.number) / m.period;
    missing -= of[phase.number];
    third -= phase.number;
  }
  of[third] = missing;
  return doubled(of);
}

double wrapped_half_turn(double doubled_error) { return 0.5 * wrapped(doubled_error); }

struct Seen {
  bool is;
  double doubled;
};

Seen seen(const Motor& m, const std::vector<Window>& windows) {
  const machine_model_t model = model_of(m);
  const Input in(model, windows);
  std::uint32_t doubled_bam = 0;
  const bool is = avv_printed_angle(in.get(), &doubled_bam);
  return {is, rad(doubled_bam)};
}

// The print itself: three phases in a row give the angle, (37) to (41), and what (33) and (36) take along drops out.
TEST(AvvPrinted, TheEquationsGiveTheAngle) {
  Random random(71);
  const Motor m;
  for (int n = 0; n < 2000; ++n) {
    const double theta = random.between(-kPi, kPi);
    const double w = random.between(-1250.0, 1250.0);
    const Vector current = random.direction(random.between(0.0, 15.0));
    double of[3];
    for (int k = 0; k < 3; ++k) {
      const Vector zero = current_derivative(m, theta, w, current, {0.0, 0.0});
      of[k] = along(current_derivative(m, theta, w, current, state_vector(1 << k)) - zero, k);
      ASSERT_NEAR(of[k], Printed(m).deviation(theta, k), 1e-6 * of[k]);
    }
    ASSERT_NEAR(wrapped_half_turn(doubled(of) - 2.0 * theta), 0.0, 1e-9);
    ASSERT_NEAR(of[0] + of[1] + of[2], Printed(m).sum(), 1e-6 * Printed(m).sum());
  }
}

// Any two vectors that are not one phase's, at any speed and current, with a current that changes between the windows:
// the firmware has the print's angle, be it the rotor's or not.
TEST(AvvPrinted, IsThePrintAtAnyOperatingPoint) {
  Random random(72);
  double worst = 0.0;
  for (int n = 0; n < 6000; ++n) {
    Motor m;
    m.ld = random.between(2e-3, 12e-3);
    m.lq = m.ld * random.between(1.2, 2.5);
    const double w = random.between(-1250.0, 1250.0);
    const double theta = random.between(-kPi, kPi);
    const int first = random.below(6);
    const int apart[] = {1, 2, 4, 5};
    const Pair p = {kActive[first], kActive[(first + apart[random.below(4)]) % 6]};
    const Vector current = random.direction(random.between(0.0, 15.0));
    std::vector<Window> windows;
    for (const int state : {p.first, p.second, 0}) {
      windows.push_back(window_at(m, theta, w, current + random.direction(random.between(0.0, 1.5)),
                                  state_vector(state), 1500 + 3000 * static_cast<int>(windows.size()),
                                  500 + random.below(2500)));
    }
    const Seen s = seen(m, windows);
    ASSERT_TRUE(s.is);
    // changes of 1e-6 A, twice, over 500 ticks of a period, beside a saliency of 200 V times what the axes differ by
    const double saliency = 100.0 * m.period * std::fabs(1.0 / m.ld - 1.0 / m.lq);
    const double rounding = 4.0 * 2e-6 * 20.0 / saliency + 1e-4;
    ASSERT_NEAR(wrapped_half_turn(s.doubled - doubled_seen(m, p, windows)), 0.0, rounding) << n;
    worst = std::max(worst, std::fabs(wrapped_half_turn(s.doubled - 2.0 * theta)));
  }
  EXPECT_GT(worst, 5.0 * kDegree) << "the print leaves out what differs between the windows";
}

// At rest, with one current in all windows, it is the rotor's angle, but for the polarity.
TEST(AvvPrinted, AtRestItIsTheRotorsAngle) {
  Random random(73);
  const Motor m;
  for (int n = 0; n < 1000; ++n) {
    const double theta = random.between(-kPi, kPi);
    const int first = random.below(6);
    const Vector current = random.direction(12.0);
    std::vector<Window> windows;
    for (const int state : {0, kActive[first], kActive[(first + 1) % 6]})
      windows.push_back(window_at(m, theta, 0.0, current, state_vector(state), 5000, 2000));
    const Seen s = seen(m, windows);
    ASSERT_TRUE(s.is);
    ASSERT_NEAR(wrapped_half_turn(s.doubled - 2.0 * theta), 0.0, 0.02 * kDegree) << n;
  }
}

// Nothing is said where the print divides by nothing: without a zero vector, by one vector alone, or by a phase's two,
// which are opposite.
TEST(AvvPrinted, IsSilentWhereThePrintIsSingular) {
  const Motor m;
  const auto of = [](const Motor& motor, const std::vector<int>& states) {
    std::vector<Window> windows;
    for (const int state : states)
      windows.push_back(window_at(motor, 0.7, 100.0, {3.0, 2.0}, state_vector(state), 5000, 2000));
    return seen(motor, windows).is;
  };
  EXPECT_TRUE(of(m, {1, 3, 0}));
  EXPECT_TRUE(of(m, {7, 1, 3}));
  for (const std::vector<int>& states : std::vector<std::vector<int>>{
           {}, {0}, {1}, {1, 0}, {1, 3}, {1, 3, 2}, {0, 7, 1}, {1, 6, 0}, {3, 4, 7}, {5, 5, 0}}) {
    EXPECT_FALSE(of(m, states)) << states.size() << (states.empty() ? -1 : states[0]);
  }
}

// The observer behind it: an angle that is off by less than a quarter turn is followed, and without a measurement it
// goes on.
TEST(AvvPrinted, TheObserverFollowsTheRotor) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const avv_config_t config = {raw(100.0 * kPeriod, 30), raw(200.0 * kPeriod, 30)};
  for (const double off : {-80.0, -10.0, 30.0, 80.0}) {
    avv_t s = {};
    const double w = 60.0;
    double theta = 0.3;
    avv_preset(&s, bam(theta - off * kDegree), bpp(w), 0);
    s.regression.information = 99;  // of another source
    estimator_output_t out = {};
    for (int n = 0; n < 2000; ++n) {
      theta += w * kPeriod;
      std::vector<Window> windows;
      for (const int state : {1, 3, 0})
        windows.push_back(window_at(m, theta, w, {0.0, 0.0}, state_vector(state), 5000, 2000));
      const Input in(model, windows);
      out = avv_printed_step(&s, &config, in.get());
      if (n == 0) {
        EXPECT_NEAR(rad(static_cast<std::uint32_t>(s.error_bam)) / kDegree, off, 0.5);
      }
      ASSERT_EQ(out.quality_q15, 32767);
      ASSERT_EQ(s.regression.information, 0);
    }
    EXPECT_NEAR(wrapped(theta - rad(out.angle_bam)) / kDegree, 0.0, 0.1) << off;
    EXPECT_NEAR(rad_per_s(out.speed_bpp), w, 0.2) << off;
    const Input blind(model, {});
    const std::uint32_t next = s.observer.angle_bam + static_cast<std::uint32_t>(s.observer.speed_bpp);
    out = avv_printed_step(&s, &config, blind.get());
    EXPECT_EQ(out.quality_q15, 0);
    EXPECT_EQ(out.angle_bam, next);
  }
}

// Without a measurement it goes on with the torque that it is told of.
TEST(AvvPrinted, BetweenMeasurementsTheTorqueMovesIt) {
  const machine_model_t model = model_of(Motor{});
  const avv_config_t config = {raw(0.01, 30), raw(0.02, 30)};
  avv_t s = {};
  avv_preset(&s, bam(1.0), bpp(60.0), 0);
  Input blind(model, {});
  estimator_input_t in = *blind.get();
  in.torque_accel_q8 = raw(1000.0, 8);
  for (int n = 0; n < 10; ++n) (void)avv_printed_step(&s, &config, &in);
  EXPECT_NEAR(s.observer.speed_bpp, bpp(60.0) + 10000, 2);
}

// With three active vectors the first and the last of them are taken.
TEST(AvvPrinted, OfMoreVectorsTheFirstAndTheLastCount) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const auto at = [&](int state, Vector more) {
    Window w = window_at(m, 0.7, 0.0, {0.0, 0.0}, state_vector(state), 5000, 2000);
    w.slope = w.slope + more;
    return w.raw();
  };
  estimator_window_t windows[] = {at(1, {0.0, 0.0}), at(3, {1.0, 1.0}), at(0, {0.0, 0.0}), at(2, {0.0, 0.0})};
  estimator_input_t in = {};
  in.model = &model;
  in.windows = windows;
  in.window_count = 4;
  std::uint32_t doubled_bam = 0;
  ASSERT_TRUE(avv_printed_angle(&in, &doubled_bam));
  EXPECT_NEAR(wrapped(rad(doubled_bam) - 1.4), 0.0, 1e-3);
}

// What a vector's slope differs by from the zero vector's is taken as 2048 A per period at most.
TEST(AvvPrinted, ASlopeBeyondItsFormatIsItsEnd) {
  const machine_model_t model = model_of(Motor{});
  const double other = 700.0;
  for (const double slope : {2000.0, 2500.0, -2000.0, -2500.0}) {
    estimator_window_t windows[3] = {};
    const Vector along_a = {slope, 0.0};
    const Vector along_b = Vector{other, 0.0}.turned(kTurn / 3.0);
    windows[0].voltage_q19 = raw_ab(state_vector(1), 19);
    windows[1].voltage_q19 = raw_ab(state_vector(2), 19);
    for (estimator_window_t& w : windows) w.span_ticks = 500;
    windows[0].change_q19 = raw_change(along_a, 500);
    windows[1].change_q19 = raw_change(along_b, 500);
    windows[2].zero_vector = true;
    estimator_input_t in = {};
    in.model = &model;
    in.windows = windows;
    in.window_count = 3;
    std::uint32_t doubled_bam = 0;
    ASSERT_TRUE(avv_printed_angle(&in, &doubled_bam));
    const double most = std::clamp(slope, -2048.0, 2048.0);
    const double of[3] = {most, other, -most - other};
    EXPECT_NEAR(wrapped(rad(doubled_bam) - doubled(of)), 0.0, 0.01) << slope;
  }
}

}  // namespace
