// What is wired wrongly from power-on is named at the first start: the whole drive, with the motors that it knows.

#include "estimators/wiring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kTurn = 6.283185307179586;

RunRequest motor_a(double angle) {
  RunRequest request = noisy_request(0.05, 1);
  request.setup.solver = 1;
  request.setup.nominal.initial.angle = angle;
  request.setup.fault.from_power_on = 1.0;
  request.parameters = {{"position_source", 4.0}};
  return request;
}

RunRequest motor_b(double angle) {
  RunRequest request = motor_a(angle);
  plant::PlantConfig& c = request.setup.nominal;
  c.machine.resistance = 0.175;
  c.machine.inductance_d = 0.72e-3;
  c.machine.inductance_q = 1.55e-3;
  c.machine.magnet_flux = 0.084;
  c.machine.rated_peak_current = 15.0;
  c.machine.cross_inductance = 4.6e-5;
  c.mechanics.inertia = 2e-3;
  c.link.source_voltage = 150.0;
  c.adc.current_range = 40.0;
  c.adc.voltage_range = 225.0;
  const std::map<std::string, double> told = {
      {"stator_resistance", 0.175}, {"inductance_d", 0.76}, {"inductance_q", 1.63},  {"magnet_flux", 0.0865},
      {"inertia", 0.002},           {"friction", 0.001},    {"rated_current", 15},   {"current_limit", 25.0},
      {"trip_current", 32.0},       {"map_current", 25.0},  {"weakening_limit", 20}, {"current_full_scale", 40.0},
      {"link_full_scale", 225.0},   {"link_minimum", 75.0}, {"link_maximum", 210.0}, {"link_regulation", 202.5},
      {"observer_noise", 200.0},    {"speed_alpha", 60.0}};
  request.parameters.insert(told.begin(), told.end());
  return request;
}

struct Mistake {
  wiring_t name;
  std::string words;
  std::function<void(Setup&)> make;
};

std::function<void(Setup&)> open(int phase) {
  return [phase](Setup& s) { s.fault.open_phase = phase; };
}
std::function<void(Setup&)> stuck(int phase) {
  return [phase](Setup& s) { s.fault.stuck_sensor = phase; };
}
std::function<void(Setup&)> reversed(int phase) {
  return [phase](Setup& s) {
    s.fault.gain_sensor = phase;
    s.fault.gain_sensor_factor = -1.0;
  };
}
std::function<void(Setup&)> inputs(int a, int b) {
  return [a, b](Setup& s) { s.board.input = {a, b}; };
}

const std::vector<Mistake> kMistakes = {
    {WIRING_OPEN_A, "motor phase carries no current", open(1)},
    {WIRING_OPEN_B, "motor phase carries no current", open(2)},
    {WIRING_OPEN_C, "motor phase carries no current", open(3)},
    {WIRING_DEAD_A, "a current sensor shows nothing", stuck(1)},
    {WIRING_DEAD_B, "a current sensor shows nothing", stuck(2)},
    {WIRING_REVERSED_A, "a current sensor shows nothing or is reversed", reversed(1)},
    {WIRING_REVERSED_B, "a current sensor shows nothing or is reversed", reversed(2)},
    {WIRING_SWAPPED, "sensors are on different phases", inputs(1, 0)},
    {WIRING_OTHER_PHASES, "sensors are on different phases", inputs(0, 2)},
    {WIRING_OTHER_PHASES, "sensors are on different phases", inputs(1, 2)},
    {WIRING_OTHER_PHASES, "sensors are on different phases", inputs(2, 1)},
};

void expect_named(RunRequest request, const Mistake& mistake) {
  mistake.make(request.setup);
  const RunResult result = run(request);
  EXPECT_FALSE(result.completed);
  EXPECT_NE(result.reason.find(mistake.words), std::string::npos) << mistake.name << ": " << result.reason;
  EXPECT_EQ(drive_signals().wiring, mistake.name);
}

TEST(Wiring, EveryMistakeIsNamedBeforeAnythingTurns) {
  for (const Mistake& mistake : kMistakes) {
    for (int k = 0; k < 6; ++k) {
      expect_named(motor_a(0.2 + k * kTurn / 6.0), mistake);
      expect_named(motor_b(0.2 + k * kTurn / 6.0), mistake);
    }
  }
}

// Also where a current vector is to turn the shaft.
TEST(Wiring, TheIFStartLooksAtIt) {
  for (const Mistake& mistake : kMistakes) {
    RunRequest request = motor_a(0.7);
    request.parameters["start_method"] = 1.0;
    expect_named(request, mistake);
  }
}

TEST(Wiring, WithoutAMotorNoCurrentFlows) {
  RunRequest request = motor_a(0.3);
  request.setup.fault.stuck_sensor =
      1.0;                               // two faults of a kind there are not: one phase open, and its sensor dead ...
  request.setup.fault.open_phase = 2.0;  // ... leave a current between a and c that nobody sees
  const RunResult result = run(request);
  EXPECT_NE(result.reason.find("no current flows"), std::string::npos) << result.reason;
  EXPECT_EQ(drive_signals().wiring, WIRING_NO_CURRENT);
}

// The motor is another one that turns the other way.
TEST(Wiring, CrossedMotorWiresOnlyReverseTheDirection) {
  for (const int pair : {1, 2, 3}) {
    RunRequest request = motor_a(0.3);
    request.duration = 0.4;
    request.setup.board.crossed = pair;
    request.commands = {{0.05, "speed_ref_rpm", 200.0}};
    const RunResult result = run(request);
    ASSERT_TRUE(result.completed) << result.reason;
    EXPECT_NEAR(at(result, "true_speed", 0.39), -200.0, 15.0) << pair;
  }
}

// With an encoder that does count the same way as before, the first motion shows it.
TEST(Wiring, CrossedMotorWiresAreNamedByTheEncoder) {
  for (const int pair : {1, 2, 3}) {
    for (int k = 0; k < 6; ++k) {
      for (const double rpm : {200.0, -200.0, 20.0}) {
        RunRequest request = motor_a(0.3 + k * kTurn / 6.0);
        request.duration = 1.0;
        request.setup.board.crossed = pair;
        request.parameters["position_source"] = 0.0;
        request.commands = {{0.05, "speed_ref_rpm", rpm}};
        const RunResult result = run(request);
        EXPECT_NE(result.reason.find("encoder counts against the field"), std::string::npos)
            << pair << ' ' << k << ' ' << rpm << ": " << result.reason;
      }
    }
  }
}

// The first start after power-on, of what is wired as it should be: no false alarm.
TEST(Wiring, WhatIsRightStarts) {
  for (const double volts : {100.0, 150.0, 300.0, 400.0}) {
    for (const double factor : {0.7, 1.0, 1.3}) {
      for (int k = 0; k < 6; ++k) {
        RunRequest request = motor_a(0.4 + k * kTurn / 6.0);
        request.duration = 0.002;
        request.setup.nominal.link.source_voltage = volts;
        request.setup.nominal.machine.inductance_d *= factor;
        request.setup.nominal.machine.inductance_q *= factor;
        request.parameters["link_minimum"] = 10.0;
        const RunResult result = run(request);
        EXPECT_TRUE(result.completed) << volts << ' ' << factor << ' ' << k << ": " << result.reason;
        EXPECT_EQ(drive_signals().wiring, WIRING_GOOD);
      }
    }
  }
  for (int k = 0; k < 12; ++k) {
    RunRequest request = motor_b(k * kTurn / 12.0);
    request.duration = 0.002;
    const RunResult result = run(request);
    EXPECT_TRUE(result.completed) << k << ": " << result.reason;
  }
}

// Too low a link must not look like a broken wire.
TEST(Wiring, ALowLinkIsNoMistake) {
  for (const double volts : {28.0, 32.0, 40.0}) {
    for (int k = 0; k < 12; ++k) {
      RunRequest request = motor_a(k * kTurn / 12.0);
      request.duration = 0.002;
      request.setup.nominal.link.source_voltage = volts;
      request.parameters["link_minimum"] = 10.0;
      (void)run(request);
      EXPECT_EQ(drive_signals().wiring, WIRING_GOOD) << volts << ' ' << k;
    }
  }
}

TEST(Wiring, ATurningShaftIsNotTakenForAMistake) {
  for (const double rpm : {-1500.0, -100.0, -30.0, 20.0, 60.0, 600.0, 2500.0}) {
    RunRequest request = motor_a(1.0);
    request.duration = 0.002;
    request.setup.nominal.initial.speed = rpm * kTurn / 60.0;
    const RunResult result = run(request);
    EXPECT_TRUE(result.completed) << rpm << ": " << result.reason;
    EXPECT_EQ(drive_signals().wiring, WIRING_GOOD) << rpm;
  }
}

TEST(Wiring, AMissingLinkSaysSupplyAndWires) {
  RunRequest request = motor_a(0.3);
  request.setup.nominal.link.source_voltage = 5.0;
  const RunResult result = run(request);
  EXPECT_NE(result.reason.find("DC link below link_minimum"), std::string::npos) << result.reason;
}

}  // namespace
}  // namespace stillspin::bench
