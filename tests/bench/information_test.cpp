// What a window tells, against the sensitivities of docs/physics.md, section 3, on a machine without saturation.

#include "sim_host/bench/information.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stillspin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kDirections = 360;

plant::PlantConfig noisy() {
  plant::PlantConfig c = plant::PlantConfig::ideal();
  c.adc.noise = 1.2;
  return c;
}

// Of one phase's current difference, A: 1.2 LSB and the rounding, a mean of four and a mean of three.
double difference_noise() {
  return 20.0 / 2048.0 * std::sqrt(1.2 * 1.2 + 1.0 / 12.0) * std::sqrt(1.0 / 4.0 + 1.0 / 3.0);
}

drive_samples_t one_window(double volts, double amps, double direction, double span) {
  drive_samples_t s = {};
  s.count = 1;
  estimator_window_t& w = s.windows[0];
  w.voltage_q19 = {static_cast<std::int32_t>(std::lround(std::ldexp(volts, 19))), 0};
  w.current_q20 = {static_cast<std::int32_t>(std::lround(std::ldexp(amps * std::cos(direction), 20))),
                   static_cast<std::int32_t>(std::lround(std::ldexp(amps * std::sin(direction), 20)))};
  w.middle_tick = 5000;
  w.span_ticks = static_cast<std::int16_t>(std::lround(span * 1e8));
  return s;
}

// Mean over all directions of the rotor, the current in its q-axis. The two axes' unequal noise averages out: the mean
// of C^-1 over all directions is one over the variance of a phase.
Information mean_of(double volts, double amps, double speed, double span) {
  const WindowInformation told(noisy());
  Information sum;
  for (int k = 0; k < kDirections; k++) {
    plant::PlantState state;
    state.angle_e = 2.0 * kPi * (k + 0.5) / kDirections - kPi;
    state.speed_m = speed / 4.0;
    const double q_axis = state.angle_e - speed * 50e-6 + kPi / 2.0;
    const Information one = told(state, one_window(volts, amps, q_axis, span));
    sum.angle += one.angle / kDirections;
    sum.cross += one.cross / kDirections;
    sum.speed += one.speed / kDirections;
  }
  return sum;
}

constexpr double kLd = 4.9e-3, kLq = 7.8e-3, kFlux = 0.16, kR = 0.32;

TEST(WindowInformation, AnActiveWindowTellsTheAngleByItsVoltage) {
  const double saliency = 1.0 / kLd - 1.0 / kLq;
  const double span = 30e-6;
  const Information got = mean_of(200.0, 0.0, 0.0, span);
  EXPECT_NEAR(std::sqrt(got.angle) * difference_noise() / span, saliency * 200.0, 0.002 * saliency * 200.0);
}

// At standstill without current the speed shows in the EMF alone.
TEST(WindowInformation, AZeroVectorTellsTheSpeed) {
  const double span = 70e-6;
  const Information got = mean_of(0.0, 0.0, 0.0, span);
  EXPECT_NEAR(std::sqrt(got.speed) * difference_noise() / span, kFlux / kLq, 0.002 * kFlux / kLq);
  EXPECT_LT(got.angle, 1e-6 * got.speed * 1e4);
}

// Both terms of the d-axis' sensitivity, and that of the q-axis.
TEST(WindowInformation, CurrentAndSpeedEnterAsDerived) {
  const double amps = 8.0, speed = 50.0, span = 70e-6;
  const double d = -kR * (1.0 / kLd - 1.0 / kLq) * amps + speed * kFlux / kLq;
  const double q = speed * amps * (kLq / kLd - kLd / kLq);
  const Information got = mean_of(0.0, amps, speed, span);
  const double expected = std::hypot(d, q);
  EXPECT_NEAR(std::sqrt(got.angle) * difference_noise() / span, expected, 0.002 * expected);
}

TEST(WindowInformation, GrowsWithTheSquareOfTheSpanAndAddsUp) {
  const Information one = mean_of(200.0, 5.0, 300.0, 20e-6);
  const Information longer = mean_of(200.0, 5.0, 300.0, 40e-6);
  EXPECT_NEAR(longer.angle / one.angle, 4.0, 1e-9);
  drive_samples_t samples = one_window(200.0, 5.0, 1.0, 20e-6);
  const WindowInformation told(noisy());
  const Information single = told(plant::PlantState(), samples);
  samples.windows[1] = samples.windows[0];
  samples.count = 2;
  const Information both = told(plant::PlantState(), samples);
  EXPECT_NEAR(both.angle, 2.0 * single.angle, 1e-9 * single.angle);
  EXPECT_NEAR(both.speed, 2.0 * single.speed, 1e-9 * single.speed);
  samples.count = 0;
  EXPECT_EQ(told(plant::PlantState(), samples).angle, 0.0);
}

}  // namespace
}  // namespace stillspin::bench
