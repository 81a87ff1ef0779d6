// Every position source but the flux (flux_source_test.cpp) carries the whole drive through its speeds; and what the
// speed control does at its limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "firmware/mode/commands.h"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

RunRequest source_request(double duration, int source) {
  RunRequest request = noisy_request(duration, 1);
  request.setup.solver = 1;
  request.parameters = {{"position_source", source}, {"speed_ramp", 6000.0}};
  return request;
}

double largest(const RunResult& result, const char* name) {
  double most = 0.0;
  for (const double value : column(result, name)) most = std::max(most, std::fabs(value));
  return most;
}

class Source : public testing::TestWithParam<int> {};

TEST_P(Source, CarriesTheShaftThroughTheBlendUnderLoad) {
  RunRequest request = source_request(1.2, GetParam());
  request.load = {{0.1, 0.0}, {0.15, 4.0}};
  request.commands = {{0.2, "speed_ref_rpm", 1500.0}, {0.7, "speed_ref_rpm", 300.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(at(result, "true_speed", 0.65), 1500.0, 30.0);
  EXPECT_NEAR(at(result, "true_speed", 1.15), 300.0, 20.0);
  EXPECT_LT(error_between(result, 0.0, 1.2), 12.0);
}

INSTANTIATE_TEST_SUITE_P(Sources, Source, testing::Values(0, 2, 3, 4));

// The paper's pair, with what it wants (docs/physics.md), from a caught shaft through its blend.
TEST(Source, ThePapersPairHoldsACaughtShaft) {
  RunRequest request = source_request(1.0, 1);
  request.setup.nominal.initial.speed = 600.0 * 6.283185307179586 / 60.0;
  request.parameters["id_low_speed"] = 5.0;
  request.parameters["window_minimum"] = 20.0;
  request.parameters["window_maximum"] = 20.0;
  request.parameters["synchronism_time"] = 1000.0;
  request.commands = {{0.0, "speed_ref_rpm", 600.0}, {0.1, "speed_ref_rpm", 1500.0}, {0.6, "speed_ref_rpm", 400.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(at(result, "true_speed", 0.55), 1500.0, 40.0);
  EXPECT_NEAR(at(result, "true_speed", 0.95), 400.0, 40.0);
}

// A rectifier takes nothing back: the link must stay below its fault while a fast shaft is told to stop.
TEST(Limits, BrakingStopsAtTheLinksLimit) {
  RunRequest request = source_request(1.6, 4);
  request.setup.nominal.link.rectifier = true;
  request.parameters["speed_ramp"] = 30000.0;
  request.commands = {{0.0, "speed_ref_rpm", 2500.0}, {0.5, "speed_ref_rpm", 0.0}, {1.0, "speed_ref_rpm", 1000.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_GT(largest(result, "v_dc"), 380.0) << "it was not braked";
  EXPECT_LT(largest(result, "v_dc"), 420.0);
  EXPECT_NEAR(at(result, "true_speed", 1.59), 1000.0, 40.0);
}

// Above the voltage's limit the field is weakened, and the speed is reached all the same.
TEST(Limits, FieldIsWeakenedAtFullSpeed) {
  RunRequest request = source_request(1.0, 4);
  request.setup.nominal.link.source_voltage = 260.0;
  request.parameters["speed_ramp"] = 10000.0;
  request.commands = {{0.0, "speed_ref_rpm", 3000.0}};
  request.load = {{0.5, 0.0}, {0.55, 2.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(at(result, "true_speed", 0.95), 3000.0, 40.0);
  EXPECT_LT(at(result, "i_d_ref", 0.95), -1.0);
}

// Hysteresis in the place of space vectors holds speed and current.
TEST(Limits, HysteresisHoldsTheSpeed) {
  RunRequest request = source_request(0.6, 0);
  request.parameters["current_law"] = 1.0;
  request.commands = {{0.0, "speed_ref_rpm", 600.0}, {0.4, "speed_ref_rpm", -600.0}};
  request.load = {{0.2, 0.0}, {0.25, 4.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(at(result, "true_speed", 0.39), 600.0, 15.0);
}

struct Mode {
  const char* name;
  std::map<std::string, double> parameters;
  double error = 12.0;  // degrees el, borne on the way
};

class Modes : public testing::TestWithParam<Mode> {};

// Whatever is switched on beside the usual way: the shaft is held under load, in both directions and at zero.
TEST_P(Modes, HoldTheShaft) {
  RunRequest request = source_request(1.4, 4);
  for (const auto& [name, value] : GetParam().parameters) request.parameters[name] = value;
  request.load = {{0.2, 0.0}, {0.25, 3.0}};
  request.commands = {{0.1, "speed_ref_rpm", 800.0}, {0.5, "speed_ref_rpm", -800.0}, {1.0, "speed_ref_rpm", 0.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(at(result, "true_speed", 0.45), 800.0, 20.0);
  EXPECT_NEAR(at(result, "true_speed", 0.95), -800.0, 20.0);
  EXPECT_NEAR(at(result, "true_speed", 1.39), 0.0, 8.0);
  EXPECT_LT(error_between(result, 0.0, 1.4), GetParam().error);
}

const std::map<std::string, double> kMap = {{"ldq_1", 0.036}, {"ldq_2", 0.072}, {"ldq_3", 0.108}, {"ldq_4", 0.144}};

Mode with_map(const char* name, std::map<std::string, double> parameters, double error = 12.0) {
  parameters.insert(kMap.begin(), kMap.end());
  return {name, std::move(parameters), error};
}

// Under its largest torque the shaft turns faster than the observer, told another inertia or load, expects.
constexpr double kFast = 25.0;

INSTANTIATE_TEST_SUITE_P(
    Each, Modes,
    testing::Values(Mode{"divider", {{"current_divider", 2.0}}}, Mode{"corner", {{"current_corner", 1.0}}},
                    Mode{"pi", {{"speed_law", 1.0}, {"speed_pi_bandwidth", 60.0}}}, Mode{"mtpa", {{"mtpa", 1.0}}},
                    Mode{"extended", {{"excitation", 1.0}}}, Mode{"cheapest", {{"excitation", 5.0}}},
                    Mode{"centred", {{"position_source", 0.0}, {"excitation", 0.0}}},
                    Mode{"long zero", {{"position_source", 0.0}, {"excitation", 4.0}}},
                    Mode{"flux beside", {{"position_source", 0.0}, {"flux_beside", 3.0}}},
                    Mode{"step", {{"speed_ramp", 0.0}}, kFast}, Mode{"no place", {{"position_hold", 0.0}}},
                    Mode{"no adaptation", {{"adapt_time", 30000.0}, {"drift_time", 30000.0}}}, with_map("map", {}),
                    with_map("hold", {{"hold_time", 100.0}}),
                    with_map("inertia", {{"inertia", 0.008}, {"speed_ramp", 20000.0}}, kFast),
                    with_map("inertia told", {{"inertia_adapt", 0.0}}),
                    with_map("encoder with a map", {{"position_source", 0.0}}),
                    Mode{"no cogging", {{"cogging_order", 0.0}}}),
    [](const testing::TestParamInfo<Mode>& one) {
      std::string name = one.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

}  // namespace
}  // namespace stillspin::bench
