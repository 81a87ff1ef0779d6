// The tracking observer: a triple pole, and the load found.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/tracking_observer.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr double kBandwidth = 150.0;  // rad/s
const std::int32_t kStep = raw(kBandwidth * kPeriod, 30);

// A shaft in the observer's own discrete time, rad and periods.
struct Shaft {
  double angle = 0.0, speed = 0.0;
  void move(double acceleration) {
    angle += speed + 0.5 * acceleration;
    speed += acceleration;
  }
};

std::int32_t error_bam(double angle, const tracking_observer_t& s) { return angle_diff_bam(bam(angle), s.angle_bam); }

// Error of a triple pole at -a after an initial angle error: e^-at (1 - 2at + a^2 t^2/2), from s^2 / (s + a)^3.
TEST(TrackingObserver, AnAngleErrorDecaysWithTheTriplePole) {
  const double start = 20.0 * kDegree;
  tracking_observer_t s;
  tracking_observer_preset(&s, bam(-start), 0, 0);
  for (int n = 1; n <= 1200; ++n) {
    tracking_observer_predict(&s, 0);
    tracking_observer_correct(&s, error_bam(0.0, s), kStep);
    const double at = kBandwidth * kPeriod * n;
    const double exact = start * std::exp(-at) * (1.0 - 2.0 * at + 0.5 * at * at);
    // a T = 0.015: forward steps instead of continuous time cost up to 1.5 a T of the initial error
    ASSERT_NEAR(rad(error_bam(0.0, s)), exact, 1.5 * kBandwidth * kPeriod * start) << n;
  }
  EXPECT_NEAR(rad(error_bam(0.0, s)), 0.0, 1e-5 * start);  // a t = 18
}

// The same recursion in double precision, with everything moving.
TEST(TrackingObserver, AgreesWithDoublePrecision) {
  Random random(40);
  tracking_observer_t s;
  tracking_observer_preset(&s, bam(0.3), bpp(50.0), 0);
  double angle = rad(s.angle_bam), speed = rad(s.speed_bpp), load = 0.0;
  Shaft shaft;
  shaft.speed = rad(bpp(80.0));
  const double x = real(kStep, 30);
  for (int n = 0; n < 20000; ++n) {
    const std::int32_t torque_q8 = accel_q8(1e-5 * std::sin(n * 0.003));
    const double torque = rad_per_period2(torque_q8);
    shaft.move(torque - 4e-6 * std::sin(n * 0.0007));
    const double noisy = shaft.angle + 0.01 * random.normal();
    tracking_observer_predict(&s, torque_q8);
    tracking_observer_correct(&s, error_bam(noisy, s), kStep);
    angle += speed + 0.5 * (torque - load);
    speed += torque - load;
    const double e = wrapped(noisy - angle);
    angle += 3.0 * x * e;
    speed += 3.0 * x * x * e;
    load -= x * x * x * e;
    // one unit of speed is 1.5e-9 rad per period and half of it may be lost at each rounding; the loop holds a bias of
    // half a unit of speed at 1/(3x) units of angle, and noise of the same size
    ASSERT_NEAR(wrapped(rad(s.angle_bam) - angle), 0.0, 5e-7) << n;
    ASSERT_NEAR(rad(s.speed_bpp), speed, 2e-8) << n;
    ASSERT_NEAR(rad_per_period2(s.load_accel_q8), load, 3e-10) << n;
  }
}

TEST(TrackingObserver, ALoadStepIsEstimated) {
  const double load = 1e-5;  // rad per period^2, 1000 rad/s^2: about 1 N m on motor A
  const double torque = 2.5e-5;
  tracking_observer_t s;
  tracking_observer_preset(&s, 0, 0, 0);
  Shaft shaft;
  const std::int32_t torque_q8 = accel_q8(torque);
  double largest = 0.0;
  int half_way = 0;
  for (int n = 1; n <= 2000; ++n) {
    shaft.move(rad_per_period2(torque_q8) - load);
    tracking_observer_predict(&s, torque_q8);
    largest = std::max(largest, std::fabs(rad(error_bam(shaft.angle, s))));  // before the correction takes 3 a T of it
    tracking_observer_correct(&s, error_bam(shaft.angle, s), kStep);
    if (half_way == 0 && rad_per_period2(s.load_accel_q8) > 0.5 * load) half_way = n;
  }
  EXPECT_NEAR(rad_per_period2(s.load_accel_q8), load, 1e-4 * load);
  EXPECT_NEAR(rad(s.speed_bpp), shaft.speed, 1e-5 * shaft.speed);
  // a step through 1/(s + a)^3 of a: half of it at a t = 2.674
  EXPECT_NEAR(half_way * kPeriod * kBandwidth, 2.674, 0.05);
  // the angle error peaks at a t = 2 with 2 e^-2 load / a^2 (from s/(s + a)^3): 0.2707
  const double per_step = kBandwidth * kPeriod;
  EXPECT_NEAR(largest, 0.2707 * load / (per_step * per_step), 0.03 * 0.2707 * load / (per_step * per_step));
}

// Accelerations below one unit of speed per period must not be lost: 2^-8 of a unit moves the speed once in 256
// periods.
TEST(TrackingObserver, SmallAccelerationsAddUp) {
  for (const std::int32_t torque_q8 : {1, -1, 100, -100}) {
    tracking_observer_t s;
    tracking_observer_preset(&s, 0, 0, 0);
    for (int n = 0; n < 256 * 40; ++n) tracking_observer_predict(&s, torque_q8);
    EXPECT_EQ(s.speed_bpp, 40 * torque_q8);
  }
}

// A preset begins with no part of a unit of speed, however close the next one was.
TEST(TrackingObserver, APresetForgetsThePartsOfAUnit) {
  tracking_observer_t s;
  tracking_observer_preset(&s, 0, 0, 0);
  tracking_observer_predict(&s, 255);
  ASSERT_EQ(s.speed_bpp, 0);
  tracking_observer_preset(&s, 0, 0, 0);
  tracking_observer_predict(&s, 255);
  EXPECT_EQ(s.speed_bpp, 0);
  tracking_observer_predict(&s, 1);
  EXPECT_EQ(s.speed_bpp, 1);
}

TEST(TrackingObserver, TheWayIsShortestThroughHalfATurn) {
  tracking_observer_t s;
  tracking_observer_preset(&s, bam(kPi - 0.05), 0, 0);
  for (int n = 0; n < 1500; ++n) {
    tracking_observer_predict(&s, 0);
    tracking_observer_correct(&s, error_bam(-kPi + 0.05, s), kStep);
    ASSERT_LT(std::fabs(rad(error_bam(-kPi, s))), 0.11) << n;  // never the long way round
  }
  EXPECT_NEAR(rad(error_bam(-kPi + 0.05, s)), 0.0, 1e-5);
}

}  // namespace
