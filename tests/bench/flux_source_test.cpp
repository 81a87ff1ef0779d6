// The stator flux as position source in the whole drive: hand-over, speed, reversal.

#include <gtest/gtest.h>

#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

class FluxSource : public testing::TestWithParam<int> {};

TEST_P(FluxSource, TurnsTheShaftInBothDirections) {
  RunRequest request = encoder_request(2.4);
  // An inverter without dead time and drops, and a drive that knows it.
  request.parameters = {{"position_source", GetParam()}, {"speed_ramp", 5000.0},  {"dead_time", 0.0},
                        {"turn_on_delay", 0.0},          {"turn_off_delay", 0.0}, {"device_drop", 0.0},
                        {"device_resistance", 0.0}};
  request.commands = {{0.1, "speed_ref_rpm", 1500.0}, {1.0, "speed_ref_rpm", -1500.0}};
  request.load = {{0.6, 0.0}, {0.65, 3.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_NEAR(at(result, "true_speed", 0.95), 1500.0, 15.0);
  EXPECT_NEAR(at(result, "true_speed", 2.35), -1500.0, 15.0);
  EXPECT_EQ(at(result, "weight", 0.05), 1.0);  // the observer at rest, the flux alone above
  EXPECT_EQ(at(result, "weight", 0.95), 0.0);
  EXPECT_EQ(at(result, "weight", 2.35), 0.0);
  // Motoring and generating under 3 N m; on the way through three hand-overs and zero.
  EXPECT_LT(error_between(result, 0.8, 1.0), 0.3);
  EXPECT_LT(error_between(result, 2.1, 2.4), 0.1);
  // The load's ramp, 60 N m/s: of third order, the observer lags by p/J 60 / bandwidth^3 = 3 degrees.
  EXPECT_LT(error_between(result, 0.55, 0.8), 3.0);
  // The flux of PP-02 is that of the current's reference, which steps at the ramp's ends before the current does.
  const double on_the_way = (GetParam() == 7) ? 1.1 : 0.7;
  EXPECT_LT(error_between(result, 0.1, 0.55), on_the_way);
  EXPECT_LT(error_between(result, 0.8, 2.4), on_the_way);
}

INSTANTIATE_TEST_SUITE_P(Methods, FluxSource, testing::Values(5, 6, 7, 8));

}  // namespace
}  // namespace stillspin::bench
