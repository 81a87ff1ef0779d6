// The firmware's own commissioning on the virtual drive: what it finds is what the machine has.

#include "sim_host/bench/commission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace stillspin::bench {
namespace {

CommissionRequest bench_request() {
  CommissionRequest request;
  request.setup.nominal = plant::PlantConfig();
  request.setup.solver = 1;
  return request;
}

double found(const CommissionResult& result, const std::string& name) {
  for (const Identified& value : result.values) {
    if (value.name == name) return value.used ? value.value : NAN;
  }
  return NAN;
}

TEST(Commission, FindsTheMachine) {
  CommissionRequest request = bench_request();
  std::set<std::string> phases;
  double last = 0.0;
  request.progress = [&](double share, const std::string& phase) {
    phases.insert(phase);
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  const CommissionResult result = commission(request);
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_GE(phases.size(), 4u);
  EXPECT_NEAR(found(result, "stator_resistance"), 0.352, 0.03);
  EXPECT_NEAR(found(result, "inductance_d"), 4.655, 0.03 * 4.655);
  EXPECT_NEAR(found(result, "inductance_q"), 7.41, 0.03 * 7.41);
  EXPECT_NEAR(found(result, "magnet_flux"), 0.1552, 0.02 * 0.1552);
  EXPECT_NEAR(found(result, "inertia"), 5.46e-3, 0.05 * 5.46e-3);
}

// A magnet three times what was told is no plausible find: the old value stays, and what rests on it too.
TEST(Commission, KeepsWhatItCannotBelieve) {
  CommissionRequest request = bench_request();
  request.parameters["magnet_flux"] = 0.05;
  const CommissionResult result = commission(request);
  for (const Identified& value : result.values) {
    if (value.name == "magnet_flux") {
      EXPECT_FALSE(value.used) << value.value;
    }
  }
  EXPECT_TRUE(!result.completed || std::isnan(found(result, "magnet_flux")));
}

TEST(Commission, ALockedShaftIsNotMeasuredAsIfItTurned) {
  CommissionRequest request = bench_request();
  request.setup.nominal.mechanics.locked = true;
  const CommissionResult result = commission(request);
  EXPECT_TRUE(std::isnan(found(result, "inertia")));
  EXPECT_TRUE(std::isnan(found(result, "magnet_flux")));
}

// The limit is three times what the motor bears for long: the measuring waits for it to cool, or stays below.
TEST(Commission, AMotorWithALargeLimitIsNotOverloaded) {
  for (const double seconds : {60.0, 10.0}) {
    CommissionRequest request = bench_request();
    request.limit = 600.0;
    request.parameters["rated_current"] = 14.0 / 3.0;
    request.parameters["overload_time"] = 1000.0 * seconds;
    const CommissionResult result = commission(request);
    ASSERT_TRUE(result.completed) << seconds << ": " << result.reason;
    EXPECT_NEAR(found(result, "stator_resistance"), 0.352, 0.03) << seconds;
    EXPECT_NEAR(found(result, "inductance_d"), 4.655, 0.03 * 4.655) << seconds;
    EXPECT_NEAR(found(result, "inductance_q"), 7.41, 0.03 * 7.41) << seconds;
    EXPECT_NEAR(found(result, "inertia"), 5.46e-3, 0.05 * 5.46e-3) << seconds;
  }
}

TEST(Commission, CanBeStopped) {
  for (const double until : {0.01, 0.1, 0.3}) {
    CommissionRequest request = bench_request();
    request.progress = [&](double share, const std::string&) { return share < until; };
    const CommissionResult result = commission(request);
    EXPECT_FALSE(result.completed);
    EXPECT_TRUE(result.values.empty());
  }
}

}  // namespace
}  // namespace stillspin::bench
