// ZVV of the seed paper, on a synthetic machine at standstill whose current is held in the *estimated* frame.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/deviation.h"
#include "estimators/zvv.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

zvv_config_t config(double kp, double ki) {
  zvv_config_t c = {};
  c.terms = ZVV_INTEGRAL | ZVV_DROPS;
  c.kp_q30 = raw(kp * kPeriod, 30);
  c.ki_q40 = raw(ki * kPeriod * kPeriod, 40);
  return c;
}

std::vector<Window> zero_window(double theta, double estimate, double id) {
  return {window_at(Motor{}, theta, 0.0, Vector{id, 0.0}.turned(estimate), {0, 0}, 5000, 6000)};
}

// The loop with the same physics in double precision: error = (sin 2e / 2 of the machine), with the EMF of the
// integral.
struct Loop {
  double estimate, integral = 0.0;  // rad, rad/s
  void step(double theta, double kp, double ki, double id, double& last_speed) {
    const Motor m;
    estimate += last_speed * kPeriod;
    const double saliency = 1.0 / m.ld - 1.0 / m.lq;
    const Vector slope = current_derivative(m, theta, 0.0, Vector{id, 0.0}.turned(estimate), {0, 0}).turned(-estimate);
    const double deviation = slope.y + m.flux * integral / m.lq;
    const double error = deviation / (-m.rs * saliency * id);
    integral += ki * error * kPeriod;
    last_speed = integral + kp * error;
  }
};

struct Course {
  double error, peak, difference;  // true minus estimate at the end, largest; largest difference from the loop above
};

Course run(double start, double theta, double kp, double ki, double id, double seconds) {
  const machine_model_t model = model_of(Motor{});
  const zvv_config_t c = config(kp, ki);
  zvv_t s = {};
  zvv_preset(&s, bam(theta - start), 0, 0);
  Loop loop{theta - start};
  double loop_speed = 0.0;
  Course r{start, 0.0, 0.0};
  for (int n = 0; n < static_cast<int>(seconds / kPeriod); ++n) {
    // the observer turns by its speed before it looks; the current is where it will be
    const std::uint32_t next = s.angle_bam + static_cast<std::uint32_t>(s.speed_bpp);
    const Input in(model, zero_window(theta, rad(next), id));
    (void)zvv_step(&s, &c, in.get(), raw(id, 20));
    loop.step(theta, kp, ki, id, loop_speed);
    r.error = wrapped(theta - rad(s.angle_bam));
    r.peak = std::max(r.peak, std::fabs(r.error));
    r.difference = std::max(r.difference, std::fabs(wrapped(rad(s.angle_bam) - loop.estimate)));
  }
  return r;
}

// Kp = 4 rad/s and Ki = 4 at i_d* = +5 A: closed-loop poles at -1.1 and -3.6 1/s, so 9 s are ten time constants.
TEST(Zvv, ConvergesAtStandstill) {
  for (const double start : {-30.0, -10.0, 2.0, 12.0, 30.0}) {
    const Course r = run(start * kDegree, 0.8, 4.0, 4.0, 5.0, 9.0);
    EXPECT_NEAR(r.error / kDegree, 0.0, 0.05) << start;
    EXPECT_LT(r.peak, std::fabs(start) * kDegree * 1.001) << start;  // without going further away first
    // the slope of 1 A per second and degree is 5e-5 A per period, read to 1e-6: 2 % of a degree
    EXPECT_LT(r.difference / kDegree, 0.05) << start;
  }
}

// With the integral alone fed into D, positive i_d* is stable for any Kp (physics, section 3); the paper's form is not
// above 6 rad/s.
TEST(Zvv, StaysStableBeyondThePapersLimit) {
  EXPECT_NEAR(run(10.0 * kDegree, -1.7, 12.0, 4.0, 5.0, 14.0).error / kDegree, 0.0, 0.1);
}

// With i_d* < 0 the sign of K_q turns and D's EMF term works against it: Ki must stay below Kp Lq |Kq| / lambda (24
// here).
TEST(Zvv, NegativeCurrentIsStableUpToItsLimitOnly) {
  EXPECT_NEAR(run(5.0 * kDegree, 0.3, 4.0, 4.0, -5.0, 9.0).error / kDegree, 0.0, 0.1);
  EXPECT_GT(run(5.0 * kDegree, 0.3, 4.0, 40.0, -5.0, 9.0).peak / kDegree, 20.0);
}

// What the integral has missed of periods without a zero vector it makes good with the next, up to ten of them.
TEST(Zvv, TheIntegralMakesGoodWhatItHasMissed) {
  const machine_model_t model = model_of(Motor{});
  const zvv_config_t c = config(4.0, 4.0);
  const Input seen(model, zero_window(0.52, 0.5, 5.0));
  const auto integral = [&](int missed) {
    zvv_t s = {};
    zvv_preset(&s, bam(0.5), 0, 0);
    for (int n = 0; n < missed; ++n) zvv_wait(&s);
    (void)zvv_step(&s, &c, seen.get(), raw(5.0, 20));
    EXPECT_EQ(s.waited, 0);
    return static_cast<double>(s.integral_q8bpp);
  };
  const double one = integral(0);
  ASSERT_GT(one, 100.0);
  for (const int missed : {1, 4, 9}) EXPECT_NEAR(integral(missed), (missed + 1) * one, 10.0) << missed;
  EXPECT_NEAR(integral(25), 10.0 * one, 10.0);
}

TEST(Zvv, NothingToSeeWithoutCurrentOrZeroVector) {
  const machine_model_t model = model_of(Motor{});
  zvv_t s = {};
  zvv_preset(&s, bam(0.5), 0, 0);
  const zvv_config_t c = config(4.0, 4.0);
  const Input still(model, zero_window(0.8, 0.5, 0.0));
  EXPECT_EQ(zvv_step(&s, &c, still.get(), 0).quality_q15, 0);
  const Input active(model, alternating(Motor{}, 0, 0.8, 0.0, {5, 0}));
  EXPECT_EQ(zvv_step(&s, &c, active.get(), raw(5.0, 20)).quality_q15, 0);
  EXPECT_EQ(s.angle_bam, bam(0.5));
  EXPECT_EQ(s.speed_bpp, 0);
  const Input seen(model, zero_window(0.8, 0.5, 5.0));
  EXPECT_EQ(zvv_step(&s, &c, seen.get(), raw(5.0, 20)).quality_q15, 32767);
  EXPECT_GT(s.speed_bpp, 0);  // towards the rotor
}

// At rest D = (Ld - Lq) / (Ld Lq) (R i_d + drop) sin(2 error) / 2: the drop of the devices along the d-axis acts like
// R i_d, what they take along the q-axis has been taken off.
TEST(Zvv, DeviationIsASineOfTwiceTheErrorWithAndWithoutDrops) {
  const Motor m;
  const machine_model_t model = model_of(m);
  for (const double drop : {0.0, 0.9}) {
    for (int degree = -85; degree <= 85; degree += 5) {
      const double error = degree * kDegree;
      const double used = 0.8 - error;
      const Vector volts = Vector{-drop, 0.0}.turned(used);
      const Input in(model, {window_at(m, 0.8, 0.0, Vector{5.0, 0.0}.turned(used), volts, 5000, 6000)});
      std::int32_t deviation = 0;
      ASSERT_TRUE(zvv_deviation_q20(in.get(), bam(used), 0, &deviation));
      const double kq = (m.ld - m.lq) / (m.ld * m.lq) * (m.rs * 5.0 + drop);
      // A per second, from A per period; the slope is read to 1e-6 A per period, 0.01 A/s, a few times over
      EXPECT_NEAR(real(deviation, 20) / kPeriod, 0.5 * kq * std::sin(2.0 * error), 0.1) << degree << ", " << drop;
    }
  }
}

// Frames that another estimator has made are used as they are.
TEST(Zvv, FramesThatAreGivenAreThoseOfTheAngleTheyWereMadeAt) {
  const machine_model_t model = model_of(Motor{});
  const double w = 20.0;  // rad/s
  const Input in(model, {window_at(Motor{}, 0.8, w, Vector{5.0, 1.0}.turned(0.7), {0, 0}, 5000, 6000)});
  std::int32_t own = 0, given = 0, elsewhere = 0;
  ASSERT_TRUE(zvv_deviation_q20(in.get(), bam(0.7), bpp(w), &own));
  estimator_frame_t frame[ESTIMATOR_WINDOWS];
  estimator_input_t with = *in.get();
  with.frames = frame;
  for (const double angle : {0.7, 1.1}) {
    deviation_frames(with.windows, 1, deviation_middle(bam(angle), bpp(w)), machine_speed_rad_q30(bpp(w)), frame);
    ASSERT_TRUE(zvv_deviation_q20(&with, bam(0.7), bpp(w), angle == 0.7 ? &given : &elsewhere));
  }
  EXPECT_EQ(given, own);
  EXPECT_NE(elsewhere, own);
}

TEST(Zvv, NoDeviationWithoutAZeroVector) {
  const machine_model_t model = model_of(Motor{});
  const Input active(model, alternating(Motor{}, 0, 0.8, 0.0, {5, 0}));
  std::int32_t deviation = 77;
  EXPECT_FALSE(zvv_deviation_q20(active.get(), bam(0.8), 0, &deviation));
  EXPECT_EQ(deviation, 77);
}

// Two zero vectors behind and between others: D is the mean of theirs.
TEST(Zvv, ZeroVectorsAmongOthersAreAveragedWithTheirDrops) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const double id = 2.0, error = 4.0 * kDegree;
  const Vector current = Vector{id, 0.0};
  std::vector<Window> windows = {window_at(m, error, 0.0, current, state_vector(1), 1500, 2000),
                                 window_at(m, error, 0.0, current, {-1.0, 0.25}, 5000, 2000),
                                 window_at(m, error, 0.0, current, {-0.5, 0.75}, 8500, 2000)};
  const auto see = [&](std::vector<Window> seen, int zero) {
    std::vector<estimator_window_t> list;
    for (const Window& w : seen) list.push_back(w.raw());
    for (std::size_t k = 0; k < list.size(); ++k) list[k].zero_vector = static_cast<int>(k) >= zero;
    return list;
  };
  const std::vector<estimator_window_t> raws = see(windows, 1);
  const estimator_input_t in = {&model, raws.data(), 3, 0, true, true, true, false, nullptr, 0};
  std::int32_t deviation = 0;
  ASSERT_TRUE(zvv_deviation_q20(&in, 0, 0, &deviation));
  double sum = 0.0;
  for (int k = 1; k < 3; ++k) {
    const Window& w = windows[static_cast<std::size_t>(k)];
    sum += w.slope.y + kPeriod / m.lq * (m.rs * w.current.y - w.voltage.y);
  }
  EXPECT_NEAR(real(deviation, 20), sum / 2.0, 2e-5);

  // Kq = (Ld - Lq) / (Ld Lq) R i_d, (24).
  zvv_t s = {};
  zvv_preset(&s, 0, 0, 0);
  const zvv_config_t c = config(4.0, 0.0);
  const estimator_output_t out = zvv_step(&s, &c, &in, raw(id, 20));
  const double kq = kPeriod * (1.0 / m.lq - 1.0 / m.ld) * m.rs * id;
  // The deviation is 7.4e-4 A per period; it is whole 9.5e-7 A, 0.0013 of that.
  EXPECT_NEAR(rad_per_s(s.speed_bpp), 4.0 * sum / 2.0 / kq, 0.0015 * 4.0 * std::fabs(sum / 2.0 / kq));
  EXPECT_EQ(out.quality_q15, 32767);

  // Only the zero vectors: without one there is nothing, and what was there stays.
  std::vector<estimator_window_t> none = see(windows, 3);
  const estimator_input_t blind = {&model, none.data(), 3, 0, true, true, true, false, nullptr, 0};
  std::int32_t untouched = 77;
  EXPECT_FALSE(zvv_deviation_q20(&blind, 0, 0, &untouched));
  EXPECT_EQ(untouched, 77);
  EXPECT_EQ(zvv_step(&s, &c, &blind, raw(id, 20)).quality_q15, 0);
}

// The speed it begins with lasts until an error moves it.
TEST(Zvv, APresetsSpeedIsKept) {
  const machine_model_t model = model_of(Motor{});
  const zvv_config_t c = config(0.0, 0.0);
  for (const double speed : {20.0, -20.0}) {
    zvv_t s = {};
    zvv_preset(&s, bam(0.5), bpp(speed), 0);
    for (int n = 1; n <= 3; ++n) {
      const Input in(model, zero_window(0.8, 0.5, 5.0));
      const estimator_output_t out = zvv_step(&s, &c, in.get(), raw(5.0, 20));
      ASSERT_EQ(out.quality_q15, 32767);
      EXPECT_EQ(out.speed_bpp, bpp(speed));
      EXPECT_EQ(out.angle_bam, bam(0.5) + static_cast<std::uint32_t>(n * bpp(speed)));
    }
  }
}

// What a period may tell ends at 400 degrees, in either direction: so much is a speed that is 26 rad/s off at 3 A.
TEST(Zvv, AnErrorCountsAsFourHundredDegreesAtMost) {
  const machine_model_t model = model_of(Motor{});
  for (const double sign : {1.0, -1.0}) {
    zvv_t s = {};
    zvv_preset(&s, 0, bpp(-sign * 40.0), 0);
    const zvv_config_t c = config(4.0, 8.0);
    const Input in(model, zero_window(0.0, 0.0, 3.0));
    (void)zvv_step(&s, &c, in.get(), raw(3.0, 20));
    EXPECT_NEAR(rad_per_s(s.speed_bpp), sign * (400.0 * kDegree * (4.0 + 8.0 * kPeriod) - 40.0), 0.01);
  }
}

}  // namespace
