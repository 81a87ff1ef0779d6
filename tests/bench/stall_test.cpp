// A shaft that cannot turn, one that is slow to get up, and one that is held: the whole drive.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

// Profile `bench` without the encoder, on the map that a commissioning finds.
RunRequest sensorless(double duration) {
  RunRequest request = noisy_request(duration, 1);
  request.setup.solver = 1;
  request.parameters = {
      {"ldq_1", 0.029}, {"ldq_2", 0.056}, {"ldq_3", 0.084}, {"ldq_4", 0.112}, {"position_source", 4.0}};
  return request;
}

class Stall : public testing::TestWithParam<double> {};

TEST_P(Stall, ABlockedShaftIsNamedAndTheCurrentEnds) {
  for (const int source : {0, 4}) {
    RunRequest request = sensorless(6.0);
    request.parameters["position_source"] = source;
    request.setup.fault.blocked_shaft = 1.0;
    request.setup.fault.blocked_shaft_at = 0.1;
    request.commands = {{0.2, "speed_ref_rpm", GetParam()}};
    const RunResult result = run(request);
    ASSERT_EQ(result.faults.size(), 1u) << source;
    EXPECT_NE(result.faults[0].second.find("stalled"), std::string::npos) << result.faults[0].second;
    EXPECT_GT(result.faults[0].first, 2.2);                                      // stall_time
    EXPECT_LT(result.faults[0].first, GetParam() == 5.0 ? 5.8 : 3.0) << source;  // at 5 rpm the current climbs for long
    EXPECT_EQ(column(result, "i_a").back(), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(References, Stall, testing::Values(5.0, 60.0, -300.0, 1000.0));

// Fifty times the inertia that the drive has been told: most of four seconds at the limit of the current.
TEST(NoStall, AHeavyShaftIsRunUpAtTheLimit) {
  RunRequest request = sensorless(5.0);
  request.setup.nominal.mechanics.inertia = 0.25;
  request.commands = {{0.0, "speed_ref_rpm", 1500.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_GT(at(result, "true_speed", 4.9), 1000.0);
  const auto& limits = column(result, "limit");
  const auto at_limit = std::count_if(limits.begin(), limits.end(), [](double l) { return (int(l) & 1) != 0; });
  EXPECT_GT(double(at_limit), 0.5 * double(limits.size()));
}

// More load than the limit can hold pushes a heavy shaft back, slowly, at a reference of zero: it is held on purpose.
TEST(NoStall, ALoadAtAReferenceOfZeroIsHeldAtTheLimit) {
  RunRequest request = sensorless(5.0);
  request.setup.nominal.mechanics.inertia = 0.25;
  request.parameters["inertia"] = 0.25;
  request.parameters["current_limit"] = 9.0;
  request.parameters["weakening_limit"] = 9.0;
  request.commands = {{0.0, "speed_ref_rpm", 0.0}};
  request.load = {{0.2, 0.0}, {0.5, 9.0}};
  const RunResult result = run(request);
  EXPECT_TRUE(result.completed) << result.reason;
  EXPECT_NE(int(at(result, "limit", 4.0)) & 1, 0);
  EXPECT_LT(at(result, "true_speed", 4.9), -5.0);
}

TEST(NoStall, ZeroSwitchesItOff) {
  RunRequest request = sensorless(4.0);
  request.setup.fault.blocked_shaft = 1.0;
  request.setup.fault.blocked_shaft_at = 0.1;
  request.parameters["stall_time"] = 0.0;
  request.commands = {{0.2, "speed_ref_rpm", 60.0}};
  const RunResult result = run(request);
  EXPECT_TRUE(result.completed) << result.reason;
  EXPECT_GT(std::fabs(column(result, "i_q_ref").back()), 13.0);
}

}  // namespace
}  // namespace stillspin::bench
