// Mirror symmetry: a machine seen in a mirror along phase a turns the other way with the same currents and voltages,
// the component across the mirror negated. Whatever an estimator says of the one it has to say of the other, mirrored:
// there is no way of turning that an equation may prefer. Random machines, errors and courses, through zero.

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/estimators/flux_paper.hpp"

extern "C" {
#include "estimators/flux_observer.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::flux_paper;

ab_t mirrored(ab_t v) { return {v.alpha, -v.beta}; }
dq_t mirrored(dq_t v) { return {v.d, -v.q}; }
estimator_output_t mirrored(estimator_output_t o) {
  return {0u - o.angle_bam, -o.speed_bpp, -o.load_accel_q8, o.quality_q15};
}

Motor random_motor(Random& random) {
  Motor m;
  m.rs = random.between(0.1, 0.8);
  m.flux = random.between(0.08, 0.2);
  m.ld = random.between(0.7e-3, 5e-3);
  m.lq = m.ld * random.between(1.0, 2.2);
  return m;
}

flux_observer_config_t random_config(Random& random, flux_method_t method) {
  flux_observer_config_t c = {};
  c.method = method;
  c.cutoff_q30 = raw(random.between(10.0, 40.0) * kPeriod, 30);
  c.bandwidth_q30 = raw(random.between(50.0, 150.0) * kPeriod, 30);
  c.adaptation = {raw(random.between(0.0, 0.1), 24), bpp(random.between(50.0, 200.0)), raw(0.05, 24), raw(0.1, 30),
                  raw(random.between(0.0, 0.2), 30)};
  c.adaptation_periods = 100;
  return c;
}

// What a drive sees of a shaft whose speed swings: from one side of zero to the other, or about a mean. The currents,
// motoring on one half and generating on the other, have offsets, noise and references that differ from them.
class Course {
 public:
  explicit Course(Random& random)
      : random_(random),
        truth_(random_motor(random)),
        mean_(random.between(-900.0, 900.0)),
        swing_(random.between(0.0, 900.0)),
        rate_(random.between(1.0, 6.0)),
        i_dq_{random.between(-6.0, 1.0), random.between(-12.0, 12.0)},
        offset_(random.direction(random.between(0.0, 1.0))),
        theta_(random.between(-kPi, kPi)) {
    current_ = i_dq_.turned(theta_);
  }
  const Motor& machine() const { return truth_; }
  double speed() const { return mean_ + swing_ * std::cos(rate_ * time_); }
  estimator_output_t now() const { return {bam(theta_), bpp(speed()), 0, 32767}; }
  ab_t current() const { return raw_ab(current_, 20); }
  std::int32_t acceleration_q8() const {
    return raw(-swing_ * rate_ * std::sin(rate_ * time_) * kPeriod * kPeriod / kTurn, 40);
  }
  flux_period_t step() {
    const Vector before = flux_dq(truth_, current_.turned(-theta_)).turned(theta_);
    theta_ = wrapped(theta_ + speed() * kPeriod);
    time_ += kPeriod;
    const Vector noise{0.03 * random_.normal(), 0.03 * random_.normal()};
    const Vector next = (i_dq_ + noise).turned(theta_);
    const Vector after = flux_dq(truth_, next.turned(-theta_)).turned(theta_);
    const Vector volts = (after - before) * (1.0 / kPeriod) + (current_ + next) * (0.5 * truth_.rs) + offset_;
    current_ = next;
    return {raw_ab(volts, 16), raw_ab(next, 20), raw_dq(i_dq_ + noise, 20), raw_dq(i_dq_ * 1.05, 20), false};
  }

 private:
  Random& random_;
  Motor truth_;
  double mean_, swing_, rate_;
  Vector i_dq_, offset_;
  double theta_, time_ = 0.0;
  Vector current_{};
};

flux_period_t mirrored(const flux_period_t& p) {
  return {mirrored(p.voltage_q16), mirrored(p.current_q20), mirrored(p.measured_q20), mirrored(p.reference_q20),
          p.is_full};
}

struct Differences {
  double angle = 0.0, speed = 0.0, load_angle = 0.0, torque = 0.0, learnt = 0.0;
};

double sum_of(std::int32_t a, std::int32_t b) { return std::fabs(static_cast<double>(a) + static_cast<double>(b)); }

// One course and its mirror image; what of the two does not cancel.
void compare(Random& random, flux_method_t method, Differences& worst) {
  Course course(random);
  Motor told = course.machine();
  told.flux *= random.between(0.9, 1.1);
  told.rs *= random.between(0.7, 1.3);
  const machine_model_t model = model_of(told);
  const flux_observer_config_t c = random_config(random, method);
  ASSERT_TRUE(flux_observer_config_valid(&c, &model));
  flux_observer_t one, other;
  flux_observer_reset(&one, &c, &model);
  flux_observer_reset(&other, &c, &model);
  const estimator_output_t now = course.now(), image = mirrored(now);
  const ab_t i = course.current();
  flux_observer_preset(&one, &now, frame_turned(i, now.angle_bam));
  flux_observer_preset(&other, &image, frame_turned(mirrored(i), image.angle_bam));
  for (int n = 0; n < 4000; ++n) {
    estimator_input_t in = {};
    in.model = &model;
    in.torque_accel_q8 = course.acceleration_q8();
    const flux_period_t p = course.step(), seen = mirrored(p);
    const estimator_output_t a = flux_observer_step(&one, &c, &in, &p);
    in.torque_accel_q8 = -in.torque_accel_q8;
    const estimator_output_t b = flux_observer_step(&other, &c, &in, &seen);
    worst.angle = std::fmax(worst.angle, std::fabs(rad(a.angle_bam + b.angle_bam)));
    worst.speed = std::fmax(worst.speed, std::fabs(rad_per_s(a.speed_bpp + b.speed_bpp)));
    worst.load_angle = std::fmax(worst.load_angle, std::fabs(rad(one.load_angle_bam + other.load_angle_bam)));
    const std::int32_t up = flux_torque_q16(&one.machine, &one.vectors);
    const std::int32_t down = flux_torque_q16(&other.machine, &other.vectors);
    worst.torque = std::fmax(worst.torque, std::ldexp(sum_of(up, down), -16));
    const flux_shares_t& x = one.adaptation.shares;
    const flux_shares_t& y = other.adaptation.shares;
    worst.learnt = std::fmax(worst.learnt, std::fabs(real(x.lq_q24, 24) - real(y.lq_q24, 24)));
    worst.learnt = std::fmax(worst.learnt, std::fabs(real(x.psi_q24, 24) - real(y.psi_q24, 24)));
  }
}

class FluxMirror : public testing::TestWithParam<flux_method_t> {};

TEST_P(FluxMirror, BothDirectionsMirrorEachOther) {
  Random random(341);
  Differences worst;
  for (int n = 0; n < 60; ++n) compare(random, GetParam(), worst);
  std::printf("method %d: mirrored within %.1e rad, %.1e rad/s, load angle %.1e rad, %.1e N m, learnt %.1e\n",
              GetParam(), worst.angle, worst.speed, worst.load_angle, worst.torque, worst.learnt);
  EXPECT_LT(worst.angle, 1e-5);
  EXPECT_LT(worst.speed, 1e-3);
  EXPECT_LT(worst.load_angle, 2e-5);
  EXPECT_LT(worst.torque, 1e-4);
  EXPECT_LT(worst.learnt, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Methods, FluxMirror, testing::Values(FLUX_CONV, FLUX_PP01, FLUX_PP02, FLUX_ACTIVE));

}  // namespace
