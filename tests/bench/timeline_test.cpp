// Commands and load act when they are asked to.

#include <gtest/gtest.h>

#include <algorithm>

#include "firmware/mode/commands.h"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kPeriodSeconds = 1e-4;

// Time of the first row in which a column has this value; 1e9 when it never has.
double first_time(const RunResult& result, const char* name, double value) {
  const auto& values = column(result, name);
  const auto found = std::find(values.begin(), values.end(), value);
  return found == values.end() ? 1e9 : column(result, "time")[static_cast<std::size_t>(found - values.begin())];
}

TEST(Timeline, TimeZeroIsTheStateRun) {
  const RunResult result = run(encoder_request(0.02));
  ASSERT_TRUE(result.completed) << result.reason;
  for (const double state : column(result, "state")) EXPECT_EQ(state, DRIVE_RUN);
  // Not started before 50 ms; the start listens for 17 periods, takes 16 for the axis, 100 for the current loop and 560
  // for the polarity by motion.
  EXPECT_GE(result.stats.at("start_seconds"), 0.119);
  EXPECT_LT(result.stats.at("start_seconds"), 0.121);
}

// A stop request is taken by the control interrupt of the period at whose start it was given: it shows in that very
// row.
TEST(Timeline, CommandActsInThePeriodThatBeginsAtItsTime) {
  RunRequest request = encoder_request(0.05);
  request.commands = {{0.03, "stop", 0.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(first_time(result, "state", DRIVE_STOP), 0.03, 1e-9);
}

TEST(Timeline, CommandBetweenTwoPeriodStartsActsAtTheNext) {
  RunRequest request = encoder_request(0.05);
  request.commands = {{0.03004, "stop", 0.0}};
  const RunResult result = run(request);
  EXPECT_NEAR(first_time(result, "state", DRIVE_STOP), 0.0301, 1e-9);
}

TEST(Timeline, SpeedReferenceFollowsWithinTheSpeedTasksMillisecond) {
  RunRequest request = encoder_request(0.05);
  request.parameters["speed_ramp"] = 0.0;
  request.commands = {{0.02, "speed_ref_rpm", 100.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  const auto& time = column(result, "time");
  const auto& reference = column(result, "speed_ref");
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] < 0.02 - 1e-9) {
      EXPECT_EQ(reference[k], 0.0) << time[k];
    }
    // 0.01 rpm: the firmware keeps speed as angle per period.
    if (time[k] > 0.02 + 11 * kPeriodSeconds) {
      EXPECT_NEAR(reference[k], 100.0, 0.01) << time[k];
    }
  }
}

TEST(Timeline, CommandsAtOneTimeActInTheirOrder) {
  RunRequest request = encoder_request(0.05);
  request.parameters["speed_ramp"] = 0.0;
  request.commands = {{0.02, "speed_ref_rpm", 100.0}, {0.02, "speed_ref_rpm", 50.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(column(result, "speed_ref").back(), 50.0, 0.01);
}

TEST(Timeline, ParametersAreInForceFromTheStart) {
  RunRequest request;
  request.setup.nominal = plant::PlantConfig::ideal();
  request.parameters = {{"speed_limit", 50.0}};
  request.commands = {{0.0, "speed_ref_rpm", 100.0}};
  request.duration = 0.05;
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(column(result, "speed_ref").back(), 50.0, 0.01);
}

TEST(Timeline, ParameterIsSetDuringTheRun) {
  RunRequest request = encoder_request(0.2);
  request.parameters["speed_ramp"] = 100.0;
  request.commands = {{0.0, "speed_ref_rpm", 300.0}, {0.1, "set:speed_ramp", 1000.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  const auto& reference = column(result, "speed_ref");
  // The ramp moves once a millisecond: two steps of slack, and one period until the background has taken the change.
  EXPECT_NEAR(reference[1000], 10.0, 0.3);
  EXPECT_NEAR(reference[1900] - reference[1000], 90.0, 2.2);
}

TEST(Timeline, LoadIsPiecewiseLinearFromTimeZero) {
  RunRequest request = encoder_request(0.1);
  request.load = {{0.02, 0.0}, {0.04, 2.0}, {0.06, 2.0}, {0.06, -1.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  const auto& load = column(result, "load_torque");
  EXPECT_EQ(load[100], 0.0);
  EXPECT_NEAR(load[300], 1.0, 1e-9);
  EXPECT_NEAR(load[500], 2.0, 1e-9);
  EXPECT_NEAR(load[700], -1.0, 1e-9);
}

TEST(Timeline, ProgressCanBreakTheRunOff) {
  RunRequest request = encoder_request(1.0);
  double last = -1.0;
  request.progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
    return share < 0.3;
  };
  const RunResult result = run(request);
  EXPECT_FALSE(result.completed);
  EXPECT_FALSE(result.reason.empty());
  ASSERT_FALSE(column(result, "time").empty());
  EXPECT_GT(column(result, "time").back(), 0.25);
  EXPECT_LT(column(result, "time").back(), 0.4);
}

TEST(Timeline, StartThatTakesTooLongIsAReason) {
  RunRequest request = encoder_request(0.1);
  request.max_start = 0.051;  // the start cannot even settle in a millisecond
  const RunResult result = run(request);
  EXPECT_FALSE(result.completed);
  EXPECT_NE(result.reason.find("start"), std::string::npos) << result.reason;
}

}  // namespace
}  // namespace stillspin::bench
