// Faults of the plant and of the chip's surroundings come when they are asked to, and the drive names them.

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/mode/commands.h"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kAt = 0.05;

RunResult run_with(const FaultPlan& fault, double rpm = 300.0) {
  RunRequest request = noisy_request(0.3, 1);
  request.setup.solver = 1;
  request.commands = {{0.0, "speed_ref_rpm", rpm}};
  request.setup.fault = fault;
  return run(request);
}

// The words of the fault, and that it came within `ms` of its cause and not before.
void expect_fault(const RunResult& result, const std::string& part, double ms) {
  ASSERT_EQ(result.faults.size(), 1u) << result.reason;
  EXPECT_NE(result.faults[0].second.find(part), std::string::npos) << result.faults[0].second;
  EXPECT_GT(result.faults[0].first, kAt);
  EXPECT_LT(result.faults[0].first, kAt + ms * 1e-3);
}

TEST(Fault, NothingHappensByItself) { EXPECT_TRUE(run_with(FaultPlan{}).completed); }

TEST(Fault, LostTriggers) {
  FaultPlan f;
  f.lost_triggers_at = kAt;
  f.lost_triggers_time = 0.002;
  expect_fault(run_with(f), "no samples", 1.0);
  f.lost_triggers_time = 0.0003;  // three periods are borne
  EXPECT_TRUE(run_with(f).completed);
}

TEST(Fault, LateInterrupts) {
  FaultPlan f;
  f.late_interrupts_at = kAt;
  f.late_interrupts = 95.0;
  f.late_interrupts_time = 0.01;
  const RunResult result = run_with(f);
  ASSERT_EQ(result.faults.size(), 1u);
  EXPECT_GT(result.faults[0].first, kAt);
  EXPECT_LT(result.faults[0].first, kAt + 0.003);
  f.late_interrupts = 1.0;  // there is this much room
  EXPECT_TRUE(run_with(f).completed);
}

TEST(Fault, LinkSag) {
  FaultPlan f;
  f.link_sag = 0.4;
  f.link_sag_at = kAt;
  expect_fault(run_with(f), "link below", 5.0);  // 0.3 Ohm and 2 mF
  f.link_sag = 0.8;
  f.link_sag_time = 0.02;
  const RunResult dip = run_with(f);
  ASSERT_TRUE(dip.completed) << dip.reason;
  const auto& volts = column(dip, "v_dc");
  EXPECT_NEAR(volts[400], 300.0, 5.0);
  EXPECT_NEAR(volts[690], 240.0, 5.0);
  EXPECT_NEAR(volts[1000], 300.0, 5.0);
}

TEST(Fault, OpenPhase) {
  FaultPlan f;
  f.open_phase = 2;
  f.open_phase_at = kAt;
  const RunResult result = run_with(f);
  EXPECT_FALSE(result.faults.empty());
  EXPECT_NE(column(result, "i_b")[499], 0.0);
  EXPECT_EQ(column(result, "i_b")[502], 0.0);
  EXPECT_NE(column(result, "i_a")[502], 0.0);
}

TEST(Fault, StuckSensor) {
  FaultPlan f;
  f.stuck_sensor = 1;
  f.stuck_sensor_at = kAt;
  f.stuck_sensor_value = 25.0;  // beyond the converter's range
  expect_fault(run_with(f), "current", 0.5);
}

TEST(Fault, DriftAndGainComeInDegrees) {
  FaultPlan f;
  f.drift_sensor = 2;
  f.drift_sensor_at = kAt;
  f.drift_sensor_rate = 1000.0;
  EXPECT_FALSE(run_with(f).faults.empty());
  f.drift_sensor_rate = 0.5;
  EXPECT_TRUE(run_with(f).completed);
  FaultPlan g;
  g.gain_sensor = 1;
  g.gain_sensor_at = kAt;
  g.gain_sensor_factor = -1.0;  // wired the wrong way round
  EXPECT_FALSE(run_with(g).faults.empty());
  g.gain_sensor_factor = 1.01;
  EXPECT_TRUE(run_with(g).completed);
}

TEST(Fault, CoastLetsTheShaftRunOut) {
  RunRequest request = noisy_request(0.3, 1);
  request.setup.solver = 1;
  request.commands = {{0.0, "speed_ref_rpm", 300.0}, {0.2, "coast", 0.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_EQ(column(result, "state").back(), DRIVE_READY);
  EXPECT_EQ(column(result, "i_a").back(), 0.0);
  EXPECT_GT(column(result, "true_speed").back(), 200.0);  // friction alone
}

}  // namespace
}  // namespace stillspin::bench
