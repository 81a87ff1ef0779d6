// The ways a start goes in the whole drive: a shaft that stands, one that turns, one that a vector turns.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "firmware/mode/commands.h"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kRadsPerRpm = 6.283185307179586 / 60.0;

// Profile `bench` without the encoder.
RunRequest sensorless(double duration, int source = 4) {
  RunRequest request = noisy_request(duration, 1);
  request.setup.solver = 1;
  request.parameters = {{"position_source", source}};
  return request;
}

class Standing : public testing::TestWithParam<double> {};

// At every angle the axis is found and its right end; at rest the estimate stays, and then turns with the shaft.
TEST_P(Standing, StartsWhereverItStands) {
  RunRequest request = sensorless(0.4);
  request.setup.nominal.initial.angle = GetParam();
  request.commands = {{0.1, "speed_ref_rpm", 200.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_LT(error_between(result, 0.0, 0.4), 6.0);
  EXPECT_NEAR(at(result, "true_speed", 0.39), 200.0, 10.0);
}

INSTANTIATE_TEST_SUITE_P(Angles, Standing, testing::Values(0.3, 1.9, 3.4, 5.2));

// Without saturation the magnet shows itself by the motion alone.
TEST(Standing, WithoutSaturationTheMotionTellsThePolarity) {
  for (const double angle : {0.4, 3.0}) {
    RunRequest request = sensorless(0.3);
    request.setup.nominal.machine.saturation = false;
    request.setup.nominal.initial.angle = angle;
    request.commands = {{0.1, "speed_ref_rpm", 200.0}};
    const RunResult result = run(request);
    ASSERT_TRUE(result.completed) << result.reason;
    EXPECT_LT(error_between(result, 0.0, 0.3), 8.0) << angle;
  }
}

// Neither saturation nor motion: the polarity stays unknown, and the drive says so instead of running.
TEST(Standing, AShaftThatShowsNothingIsAFault) {
  RunRequest request = sensorless(0.1);
  request.setup.nominal.machine.saturation = false;
  request.setup.nominal.mechanics.locked = true;
  const RunResult result = run(request);
  EXPECT_FALSE(result.completed);
  EXPECT_NE(result.reason.find("polarity"), std::string::npos) << result.reason;
}

TEST(Standing, TheLookForATurningShaftCanBeLeftOut) {
  RunRequest request = sensorless(0.2);
  request.parameters["flying_start"] = 0.0;
  const RunResult without = run(request);
  ASSERT_TRUE(without.completed) << without.reason;
  request.parameters["flying_start"] = 1.0;
  const RunResult with = run(request);
  ASSERT_TRUE(with.completed) << with.reason;
  EXPECT_LT(without.stats.at("start_seconds"), with.stats.at("start_seconds"));
  EXPECT_LT(error_between(without, 0.0, 0.2), 6.0);
}

// A map lets the drive expect saturation; a machine without any leaves the test open, and the motion decides.
TEST(Standing, WhereSaturationStaysOpenTheMotionDecides) {
  for (const double angle : {0.4, 3.0}) {
    RunRequest request = sensorless(0.3);
    request.setup.nominal.machine.saturation = false;
    request.setup.nominal.initial.angle = angle;
    for (int k = 1; k <= 4; ++k) request.parameters["ldq_" + std::to_string(k)] = 0.036 * k;
    const RunResult open = run(request);
    ASSERT_TRUE(open.completed) << open.reason;
    EXPECT_LT(error_between(open, 0.0, 0.3), 8.0) << angle;
    request.setup.nominal.machine.saturation = true;
    const RunResult clear = run(request);
    ASSERT_TRUE(clear.completed) << clear.reason;
    EXPECT_LT(clear.stats.at("start_seconds"), open.stats.at("start_seconds"));
  }
}

// A winding that is as it was measured is left alone; a warm one is seen by the test of the saturation.
TEST(Standing, AWarmWindingIsStartedUnderLoad) {
  for (const double resistance : {0.32, 0.45}) {
    RunRequest request = sensorless(0.4);
    request.setup.nominal.machine.resistance = resistance;
    for (int k = 1; k <= 4; ++k) request.parameters["ldq_" + std::to_string(k)] = 0.036 * k;
    request.load = {{0.0, 0.0}, {0.05, 3.0}};
    const RunResult result = run(request);
    ASSERT_TRUE(result.completed) << result.reason;
    EXPECT_LT(error_between(result, 0.0, 0.4), 8.0) << resistance;
  }
}

TEST(Standing, BootstrapSuppliesTakeTheirTime) {
  RunRequest request = sensorless(0.1);
  const RunResult without = run(request);
  request.parameters["bootstrap_time"] = 15.0;
  const RunResult with = run(request);
  ASSERT_TRUE(without.completed && with.completed) << with.reason;
  EXPECT_NEAR(with.stats.at("start_seconds") - without.stats.at("start_seconds"), 0.017, 0.002);
}

class Flying : public testing::TestWithParam<double> {};

// Caught with the gates off, the speed is taken over without a jolt and held.
TEST_P(Flying, IsCaughtAtItsSpeed) {
  const double rpm = GetParam();
  RunRequest request = sensorless(0.3);
  request.setup.nominal.initial.angle = 2.0;
  request.setup.nominal.initial.speed = rpm * kRadsPerRpm;
  request.commands = {{0.0, "speed_ref_rpm", rpm}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_LT(error_between(result, 0.0, 0.3), 6.0);
  EXPECT_NEAR(at(result, "true_speed", 0.0), rpm, 0.06 * std::fabs(rpm) + 5.0);
  EXPECT_NEAR(at(result, "true_speed", 0.29), rpm, 0.03 * std::fabs(rpm) + 3.0);
}

INSTANTIATE_TEST_SUITE_P(Speeds, Flying, testing::Values(120.0, -600.0, 1500.0, -2400.0));

struct Turn {
  int source;
  double rpm;
  double high;  // where the stator flux would be alone
};

class Turned : public testing::TestWithParam<Turn> {};

// Turned by the vector against friction, and taken over by the source.
TEST_P(Turned, TheSourceTakesOverFromTheVector) {
  RunRequest request = sensorless(0.6, GetParam().source);
  request.max_start = 5.0;
  request.setup.nominal.mechanics.coulomb_friction = 1.0;
  request.setup.nominal.mechanics.stiction = 1.0;
  request.setup.nominal.initial.angle = 3.1;
  request.parameters["start_method"] = 1.0;
  request.parameters["flux_low"] = GetParam().high / 2.0;
  request.parameters["flux_high"] = GetParam().high;
  request.commands = {{0.0, "speed_ref_rpm", GetParam().rpm}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_LT(error_between(result, 0.0, 0.6), 6.0);
  EXPECT_NEAR(at(result, "true_speed", 0.0), GetParam().rpm, 45.0);  // the way it was told to turn, from the start on
  EXPECT_NEAR(at(result, "true_speed", 0.59), GetParam().rpm, 10.0);
}

INSTANTIATE_TEST_SUITE_P(Sources, Turned,
                         testing::Values(Turn{4, 300.0, 500.0}, Turn{4, -300.0, 500.0}, Turn{7, 300.0, 40.0},
                                         Turn{7, -300.0, 40.0}, Turn{7, 300.0, 700.0}, Turn{7, -300.0, 700.0}));

TEST(Blocked, ABlockedShaftIsAFault) {
  RunRequest request = sensorless(0.1);
  request.max_start = 5.0;
  request.setup.nominal.mechanics.locked = true;
  request.parameters["start_method"] = 1.0;
  request.commands = {{0.0, "speed_ref_rpm", 300.0}};
  const RunResult result = run(request);
  EXPECT_FALSE(result.completed);
  EXPECT_NE(result.reason.find("diverged"), std::string::npos) << result.reason;
}

}  // namespace
}  // namespace stillspin::bench
