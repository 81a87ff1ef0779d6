// Sensor bandwidth and ringing against closed forms; ADC scale, rounding, noise and INL against their definitions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim_host/plant/plant.hpp"
#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {
namespace {

/// Locked rotor, perfect bridge, no resistance to speak of: the current of phase a is a ramp.
PlantConfig ramp_config() {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.locked = true;
  c.machine.resistance = 1e-4;
  c.initial.angle = 0.0;
  return c;
}

void switch_on(Plant& plant, Tick t) {
  plant.set_gate(t, 0, true, false);
  plant.set_gate(t, 1, false, true);
  plant.set_gate(t, 2, false, true);
}

TEST(CurrentSensor, FirstOrderLagOfARamp) {
  PlantConfig c = ramp_config();
  c.sensor.bandwidth = 150e3;
  Plant plant(c);
  switch_on(plant, 0);
  const double tau = 1.0 / (2.0 * kPi * 150e3), slope = 200.0 / 4.9e-3;
  for (Tick t : {10, 50, 106, 300, 1000, 2600, 9000}) {
    plant.advance(t);
    const double x = static_cast<double>(t) * kSecondsPerTick;
    const double expected = slope * (x - tau * (1.0 - std::exp(-x / tau)));
    // The ramp bends by R i/L = 1e-4 relative at most: 1e-6 A here.
    EXPECT_NEAR(plant.current_sensor(0), expected, 4e-6) << t;
    EXPECT_NEAR(plant.current_sensor(1), -0.5 * expected, 4e-6) << t;
  }
}

TEST(CurrentSensor, FirstOrderLagOfABentCurrent) {
  PlantConfig c = ramp_config();
  c.machine.resistance = 20.0;  // the current bends with 245 us
  c.sensor.bandwidth = 150e3;
  Plant plant(c);
  switch_on(plant, 0);
  const double tau = 1.0 / (2.0 * kPi * 150e3), bend = 4.9e-3 / 20.0;
  for (Tick t : {100, 2000, 2500, 6000, 12345, 30000}) {
    plant.advance(t);
    const double x = static_cast<double>(t) * kSecondsPerTick;
    const double expected =
        200.0 / 20.0 * (1.0 - (bend * std::exp(-x / bend) - tau * std::exp(-x / tau)) / (bend - tau));
    // A parabola over 25 us misses the third derivative: 10 A (25 us)^2 tau/(6 bend^3) = 7.5e-5 A.
    EXPECT_NEAR(plant.current_sensor(0), expected, 1.5e-4) << t;
  }
}

TEST(CurrentSensor, LooksDoNotDisturbIt) {
  PlantConfig c = ramp_config();
  c.sensor.bandwidth = 150e3;
  Plant once(c), often(c);
  switch_on(once, 0);
  switch_on(often, 0);
  for (Tick t = 0; t < 7000; t += 3) {
    often.advance(t);
    often.current_sensor(0);
  }
  once.advance(7000);
  often.advance(7000);
  EXPECT_EQ(once.current_sensor(0), often.current_sensor(0));
}

TEST(CurrentSensor, RingsAfterAnEdge) {
  PlantConfig c = ramp_config();
  c.sensor.ring_amplitude = 0.3;
  Plant plant(c);
  for (int leg = 0; leg < 3; ++leg) plant.set_gate(0, leg, false, true);  // from the middle (blocked) to the rail
  plant.advance(20000);
  plant.set_gate(20000, 0, true, false);
  for (Tick after : {25, 62, 125, 300, 700}) {
    plant.advance(20000 + after);
    const double x = static_cast<double>(after) * kSecondsPerTick;
    const double ring = 0.3 * std::exp(-x / 2e-6) * std::sin(2.0 * kPi * 200e3 * x);
    const PlantState s = plant.state();
    EXPECT_NEAR(plant.current_sensor(0) - s.current[0], ring, 1e-9) << after;
    EXPECT_NEAR(plant.current_sensor(1) - s.current[1], -0.5 * ring, 1e-9) << after;
    EXPECT_NEAR(plant.current_sensor(2) - s.current[2], -0.5 * ring, 1e-9) << after;
  }
  plant.set_gate(40000, 0, false, true);
  plant.advance(40125);
  const double falling = plant.current_sensor(0) - plant.state().current[0];
  EXPECT_NEAR(falling, -0.3 * std::exp(-0.625), 1e-9) << "sign of the edge";
}

TEST(CurrentSensor, RingStartsAtTheRealEdge) {
  // Positive current: switching the upper device off moves the leg at once (after 0.6 us), switching the lower one on
  // later changes next to nothing.
  PlantConfig c;
  c.mechanics.locked = true;
  c.initial.angle = 0.0;
  c.initial.current_d = 8.0;
  c.sensor.bandwidth = 0.0;
  c.sensor.gain = {1.0, 1.0, 1.0};
  c.sensor.offset = {0.0, 0.0, 0.0};
  Plant plant(c);
  switch_on(plant, 0);
  plant.set_gate(8000, 0, false, false);
  plant.advance(8060);
  EXPECT_NEAR(plant.current_sensor(0), plant.state().current[0], 1e-6);
  plant.advance(8060 + 125);  // a quarter of the ring's period
  EXPECT_NEAR(plant.current_sensor(0) - plant.state().current[0], -0.3 * std::exp(-0.625), 0.01);
  plant.set_gate(8200, 0, false, true);
  plant.advance(8230 + 125);
  const double x = (8230 + 125 - 8060) * kSecondsPerTick;
  const double first = -0.3 * std::exp(-x / 2e-6) * std::sin(2.0 * kPi * 200e3 * x);
  // The diode's 0.9 V becomes the switch's: a second ring of 0.3 A * 2 V/300 V.
  EXPECT_NEAR(plant.current_sensor(0) - plant.state().current[0], first, 0.004);
}

TEST(CurrentSensor, GainOffsetAndFailures) {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.locked = true;
  c.initial.angle = 0.0;
  c.initial.current_d = 4.0;
  c.sensor.gain = {1.005, 0.995, 1.0};
  c.sensor.offset = {0.030, -0.020, 0.0};
  Plant plant(c);
  EXPECT_NEAR(plant.current_sensor(0), 4.0 * 1.005 + 0.030, 1e-12);
  EXPECT_NEAR(plant.current_sensor(1), -2.0 * 0.995 - 0.020, 1e-12);
  plant.inject({FaultKind::kSensorStuck, 0, 1.5});
  EXPECT_EQ(plant.current_sensor(0), 1.5);
  plant.clear_faults();
  for (int leg = 0; leg < 3; ++leg) plant.set_gate(0, leg, false, true);
  plant.inject({FaultKind::kSensorDrift, 1, 2.0});
  plant.advance(50'000'000);  // 0.5 s: the current has died out
  EXPECT_NEAR(plant.current_sensor(1) - 0.995 * plant.state().current[1], -0.020 + 1.0, 1e-9);
}

double mean_code(PlantConfig c, double current, double* deviation) {
  c.mechanics.locked = true;
  c.initial.angle = 0.0;
  c.initial.current_d = current;
  c.sensor = PlantConfig::ideal().sensor;
  Plant plant(c);
  constexpr int kSamples = 20000;
  double sum = 0.0, square = 0.0;
  for (int n = 0; n < kSamples; ++n) {
    const double code = plant.adc_code(0, AdcInput::kCurrentA);
    sum += code;
    square += code * code;
  }
  const double mean = sum / kSamples;
  *deviation = std::sqrt(square / kSamples - mean * mean);
  return mean;
}

TEST(Adc, ScaleAndRounding) {
  PlantConfig c = PlantConfig::ideal();
  double deviation;
  EXPECT_EQ(mean_code(c, 0.0, &deviation), 2048.0);
  EXPECT_EQ(mean_code(c, 10.0, &deviation), 3072.0);
  EXPECT_EQ(mean_code(c, -10.0, &deviation), 1024.0);
  EXPECT_EQ(mean_code(c, 20.0 / 2048 * 0.49, &deviation), 2048.0);
  EXPECT_EQ(mean_code(c, 20.0 / 2048 * 0.51, &deviation), 2049.0);
  EXPECT_EQ(mean_code(c, 25.0, &deviation), 4095.0);
  EXPECT_EQ(mean_code(c, -25.0, &deviation), 0.0);
}

TEST(Adc, NoiseIsGaussianPlusRounding) {
  PlantConfig c;
  c.adc.inl = 0.0;
  double deviation;
  const double mean = mean_code(c, 5.0, &deviation);
  // Rounding adds 1/12 LSB^2. Standard errors over 20000 samples: 0.0087 LSB and 0.0061 LSB; five of them.
  EXPECT_NEAR(mean, 2560.0, 0.044);
  EXPECT_NEAR(deviation, std::sqrt(1.2 * 1.2 + 1.0 / 12.0), 0.031);
}

TEST(Adc, InlIsSmoothAndWithinItsLimit) {
  PlantConfig c;
  c.adc.noise = 0.0;
  double deviation, lowest = 0.0, highest = 0.0, last = 0.0;
  for (int n = -200; n <= 200; ++n) {
    const double current = n * 0.099;
    const double ideal = 2048.0 + current * 2048.0 / 20.0;
    const double error = mean_code(c, current, &deviation) - ideal;
    EXPECT_LE(std::fabs(error), 1.5 + 0.5);  // INL and rounding
    if (n > -200) {
      EXPECT_LT(std::fabs(error - last), 1.6) << "neighbours: rounding of both, and the slope at the end";
    }
    last = error;
    lowest = std::min(lowest, error);
    highest = std::max(highest, error);
  }
  EXPECT_GT(highest - lowest, 2.0) << "it is there at all";
}

TEST(Adc, LinkVoltageTemperatureAndMissingSensor) {
  PlantConfig c;
  c.link.ripple = 0.0;
  c.adc.noise = 0.0;
  c.adc.inl = 0.0;
  Plant plant(c);
  EXPECT_EQ(plant.adc_code(10, AdcInput::kLinkVoltage), std::lround(300.0 * 1.01 / 450.0 * 4096.0));
  EXPECT_EQ(plant.adc_code(10, AdcInput::kTemperature), 1500);
  EXPECT_EQ(plant.adc_code(10, AdcInput::kCurrentC), 0);
  c.sensor.count = 3;
  Plant three(c);
  EXPECT_EQ(three.adc_code(10, AdcInput::kCurrentC), std::lround(2048.0 + 0.010 * 102.4));
}

TEST(Adc, AThirdSensorChangesNoOtherCode) {
  PlantConfig c;
  Plant two(c);
  c.sensor.count = 3;
  Plant three(c);
  for (Tick t = 0; t < 1000; t += 10) {
    EXPECT_EQ(two.adc_code(t, AdcInput::kCurrentA), three.adc_code(t, AdcInput::kCurrentA));
    three.adc_code(t, AdcInput::kCurrentC);
    EXPECT_EQ(two.adc_code(t, AdcInput::kCurrentB), three.adc_code(t, AdcInput::kCurrentB));
  }
}

}  // namespace
}  // namespace stillspin::plant
