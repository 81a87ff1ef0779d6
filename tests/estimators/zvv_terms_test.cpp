// ZVV against the equations of the seed paper in double precision, as they are printed and with what the print leaves
// out, at operating points anywhere.

#include <gtest/gtest.h>

#include <random>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/zvv.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr double kKp = 11.0, kKi = 1100.0;

zvv_config_t config(std::uint16_t terms) {
  zvv_config_t c = {};
  c.kp_q30 = raw(kKp * kPeriod, 30);
  c.ki_q40 = raw(kKi * kPeriod * kPeriod, 40);
  c.terms = terms;
  return c;
}

// A long zero vector, seen where the frame is that the estimator has next.
struct Point {
  double theta, estimate, w, w_seen, id, iq, drop_d, drop_q;
  Window window() const {
    const Vector current = Vector{id, iq}.turned(estimate);
    return window_at(Motor{}, theta, w, current, Vector{-drop_d, -drop_q}.turned(estimate), 5000, 7000);
  }
};

// One step of ZVV that has had this angle and speed before.
double stepped(const Point& p, std::uint16_t terms, double id_reference, zvv_t* s) {
  const machine_model_t model = model_of(Motor{});
  const zvv_config_t c = config(terms);
  zvv_preset(s, bam(p.estimate + 0.5 * p.w_seen * kPeriod) - static_cast<std::uint32_t>(bpp(p.w_seen)), bpp(p.w_seen),
             0);
  const Input in(model, {p.window()});
  return real(zvv_step(s, &c, in.get(), raw(id_reference, 20)).quality_q15, 15);
}

// (22) and (24) of the window, and D / Kq; rad.
double printed_error(const Point& p, std::uint16_t terms, double id_reference) {
  const Motor m;
  const bool drops = (terms & ZVV_DROPS) != 0;
  const double slope = p.window().slope.turned(-p.estimate).y / kPeriod;
  double d = slope + (m.rs * p.iq + m.flux * p.w_seen + (drops ? p.drop_q : 0.0)) / m.lq;
  if ((terms & ZVV_ROTATION) != 0) d -= p.w_seen * (1.0 - m.ld / m.lq) * p.id;
  const double kq = (m.ld - m.lq) / (m.ld * m.lq) * m.rs * id_reference;
  return std::clamp(d / kq, -6.98, 6.98);
}

Point any_point(std::mt19937& random) {
  const auto within = [&](double most) { return std::uniform_real_distribution<>(-most, most)(random); };
  const double theta = within(3.1);
  const double w = within(40.0);
  return {theta, theta - within(0.3), w, w + within(20.0), within(12.0), within(14.0), within(0.7), within(0.7)};
}

// The speed that comes of it: the integral's step and Kp times the error.
TEST(ZvvTerms, AreThePrintedEquationsAtAnyOperatingPoint) {
  std::mt19937 random(7);
  for (int n = 0; n < 4000; ++n) {
    const auto terms = static_cast<std::uint16_t>(n % 8);
    const Point p = any_point(random);
    const double id_reference = std::copysign(std::uniform_real_distribution<>(1.0, 12.0)(random), p.id);
    zvv_t s = {};
    ASSERT_GT(stepped(p, terms, id_reference, &s), 0.99);
    const double error = printed_error(p, terms, id_reference);
    // D is whole 1e-6 A per period and its slope read to that, a few times over; Kq is 1.2e-3 A per rad and A of i_d*.
    const double unit = 6e-6 / (2.4e-3 * 0.5 * std::fabs(id_reference));
    const double tolerance = unit + 2e-3 * std::fabs(error);
    ASSERT_NEAR((rad_per_s(s.speed_bpp) - p.w_seen) / (kKp + kKi * kPeriod), error, tolerance) << n << " " << terms;
  }
}

// Where Kq is nothing the print divides by it.
TEST(ZvvTerms, WithoutKqThereIsNothingToDivideBy) {
  const Point p = {0.8, 0.7, 5.0, 4.0, 0.0, 3.0, 0.0, 0.0};
  zvv_t s = {};
  EXPECT_EQ(stepped(p, 0, 0.0, &s), 0.0);
  EXPECT_EQ(s.speed_bpp, bpp(4.0));
}

struct Course {
  double largest, end;  // of the angle's error, rad
};

// A shaft whose speed is not the one that ZVV has: what that does to the angle.
Course followed(double kp, double accel, double speed_error, std::uint16_t terms) {
  const Motor m;
  const machine_model_t model = model_of(m);
  zvv_config_t c = config(terms);
  c.kp_q30 = raw(kp * kPeriod, 30);
  const double id = 8.0;
  double w = 10.0, theta = 0.4;
  zvv_t s = {};
  zvv_preset(&s, bam(theta), bpp(w - speed_error), 0);
  Course r{0.0, 0.0};
  for (int n = 0; n < 6000; ++n) {
    theta += w * kPeriod + 0.5 * accel * kPeriod * kPeriod;
    w += accel * kPeriod;
    const std::uint32_t next = s.angle_bam + static_cast<std::uint32_t>(s.speed_bpp);
    const double middle = rad(next) - 0.5 * rad_per_s(s.speed_bpp) * kPeriod;
    const Input in(model, {window_at(m, theta, w, Vector{id, 0.0}.turned(middle), {0, 0}, 5000, 7000)});
    (void)zvv_step(&s, &c, in.get(), raw(id, 20));
    r.end = wrapped(theta - rad(s.angle_bam));
    r.largest = std::max(r.largest, std::fabs(r.end));
  }
  return r;
}

// 1/c = Lq |Kq| / (lambda - (Lq - Ld) i_d): with this Kp the error of the angle decays by itself.
double gain_by_the_rule() {
  const Motor m;
  const double id = 8.0;
  return m.rs * id * (m.lq - m.ld) / m.ld / (m.flux - (m.lq - m.ld) * id);
}

TEST(ZvvTerms, WithKpByTheRuleNeitherSpeedNorAccelerationTurnsTheAngle) {
  const double kp = gain_by_the_rule();
  EXPECT_NEAR(kp, 11.1, 0.1);
  const std::uint16_t terms = ZVV_ROTATION | ZVV_INTEGRAL;
  EXPECT_LT(followed(kp, 0.0, 20.0, terms).largest / kDegree, 0.3);
  EXPECT_LT(followed(kp, 50.0, 0.0, terms).largest / kDegree, 0.3);
  // with half or twice that they do
  for (const double off : {0.5, 2.0}) {
    EXPECT_GT(followed(off * kp, 0.0, 20.0, terms).largest / kDegree, 2.0) << off;
    EXPECT_GT(followed(off * kp, 50.0, 0.0, terms).largest / kDegree, 1.0) << off;
  }
}

// On a shaft at rest whose windows have so much noise along q, rad of angle error each: what the angle has of it.
double left_of_noise(double kp, double ki, double noise) {
  const Motor m;
  const machine_model_t model = model_of(m);
  zvv_config_t c = config(ZVV_ROTATION | ZVV_INTEGRAL);
  c.kp_q30 = raw(kp * kPeriod, 30);
  c.ki_q40 = raw(ki * kPeriod * kPeriod, 40);
  const double id = 8.0, theta = 0.4;
  const double kq = (m.ld - m.lq) / (m.ld * m.lq) * m.rs * id;
  std::mt19937 random(3);
  std::normal_distribution<> each(0.0, noise * std::fabs(kq) * kPeriod);
  zvv_t s = {};
  zvv_preset(&s, bam(theta), 0, 0);
  double squares = 0.0;
  const int count = 200000;
  for (int n = 0; n < count; ++n) {
    Window seen = window_at(m, theta, 0.0, Vector{id, 0.0}.turned(rad(s.angle_bam)), {0, 0}, 5000, 7000);
    seen.slope = seen.slope + Vector{0.0, each(random)}.turned(theta);
    const Input in(model, {seen});
    (void)zvv_step(&s, &c, in.get(), raw(id, 20));
    squares += std::pow(wrapped(theta - rad(s.angle_bam)), 2);
  }
  return std::sqrt(squares / count) / noise;
}

// sqrt(T (Kp^2 + Ki) / (2 (Kp + Ki c))), and with Kp by the rule sqrt(T / 2c).
TEST(ZvvTerms, TheNoiseOfTheAngleIsWhatGainsAndWindowsMakeOfIt) {
  const double by_rule = gain_by_the_rule();
  const double c = 1.0 / by_rule;
  for (const double share : {0.5, 1.0, 2.0}) {
    const double kp = share * by_rule, ki = 85.0 * by_rule;
    const double expected = std::sqrt(kPeriod * (kp * kp + ki) / (2.0 * (kp + ki * c)));
    EXPECT_NEAR(left_of_noise(kp, ki, 0.5) / expected, 1.0, 0.06) << share;
  }
}

// w Ld / R, physics section 3: 8.8 degrees at 10 rad/s, and this is what the term is for.
TEST(ZvvTerms, WithoutTheRotationsTermTheAngleIsOff) {
  const Motor m;
  const double kp = gain_by_the_rule();
  EXPECT_NEAR(std::fabs(followed(kp, 0.0, 0.0, ZVV_INTEGRAL).end), 10.0 * m.ld / m.rs, 0.02);
  EXPECT_LT(std::fabs(followed(kp, 0.0, 0.0, ZVV_INTEGRAL | ZVV_ROTATION).end) / kDegree, 0.2);
}

// Fig. 7: a torque under which the shaft keeps its speed is all load, with a low-pass of 20 ms.
TEST(ZvvTerms, ATorqueThatMovesNothingIsLoad) {
  const machine_model_t model = model_of(Motor{});
  const double torque = 300.0 * kPeriod * kPeriod;
  const Point p = {0.8, 0.8, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0};
  for (const bool wanted : {false, true}) {
    const zvv_config_t c = config(ZVV_ROTATION | ZVV_INTEGRAL | (wanted ? ZVV_LOAD : 0));
    zvv_t s = {};
    zvv_preset(&s, bam(0.8), 0, 0);
    const Input in(model, {p.window()}, accel_q8(torque));
    for (int n = 0; n < 200; ++n) (void)zvv_step(&s, &c, in.get(), raw(8.0, 20));
    const double expected = wanted ? torque * (1.0 - std::exp(-1.0)) : 0.0;
    EXPECT_NEAR(rad_per_period2(s.load_accel_q8), expected, 0.03 * torque) << wanted;
  }
}

// The load follows the torque by a two-hundredth a period, those included that had no zero vector.
TEST(ZvvTerms, TheLoadFollowsAfterAWaitAsWithoutOne) {
  const machine_model_t model = model_of(Motor{});
  const zvv_config_t c = config(ZVV_DROPS | ZVV_ROTATION | ZVV_LOAD);
  for (const int waits : {0, 1, 4, 9}) {
    zvv_t s = {};
    zvv_preset(&s, 0, 0, 0);
    for (int n = 0; n < waits; ++n) zvv_wait(&s);
    const Input windows(model, {window_at(Motor{}, 0.0, 0.0, {-3.0, 0.0}, {0.0, 0.0}, 5000, 7000)});
    estimator_input_t in = *windows.get();
    in.torque_accel_q8 = raw(10000.0, 8);
    (void)zvv_step(&s, &c, &in, raw(-3.0, 20));
    EXPECT_NEAR(real(s.load_accel_q8, 8), 10000.0 / 200.0 * (waits + 1), 2.0) << waits;
  }
}

}  // namespace
