// The same edges into three solvers. CVODE at 1e-10 with steps of 2 us is the yardstick; the others are held to it
// within 1e-5 A over one second with 8000 zero crossings, of which the goal allows for double crossings that a step
// hides (such a crossing is worth up to its depth).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim_host/plant/plant.hpp"
#include "tests/plant/recording.hpp"

namespace stillspin::plant {
namespace {

using Sample = std::array<double, 5>;  // three currents (A), speed (rad/s), link (V)

std::vector<Sample> run(PlantConfig config, Solver solver, const testing::Recording& recording) {
  config.solver.solver = solver;
  Plant plant(config);
  std::vector<Sample> samples;
  testing::replay(plant, recording, {0, 1300, 2600, 5000, 7777, 9999}, [&](Tick t) {
    plant.advance(t);
    const PlantState s = plant.state();
    samples.push_back({s.current[0], s.current[1], s.current[2], s.speed_m, s.link_voltage});
  });
  EXPECT_FALSE(plant.shoot_through());
  return samples;
}

double worst(const std::vector<Sample>& a, const std::vector<Sample>& b, int from, int to) {
  double result = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    for (int k = from; k < to; ++k) result = std::max(result, std::fabs(a[n][k] - b[n][k]));
  }
  return result;
}

TEST(Solver, OneSecondAgainstTheReference) {
  const PlantConfig config;
  const testing::Recording recording = testing::record_ramp_and_load(config, 10000);
  const auto reference = run(config, Solver::kReference, recording);
  const auto fast = run(config, Solver::kRungeKutta, recording);
  const auto adaptive = run(config, Solver::kErkStep, recording);
  EXPECT_GT(worst(reference, std::vector<Sample>(reference.size()), 0, 3), 3.0) << "the sequence must be alive";
  EXPECT_NEAR(reference.back()[3], 100.0, 2.0);
  EXPECT_LT(worst(reference, fast, 0, 3), 1e-5);
  EXPECT_LT(worst(reference, adaptive, 0, 3), 1e-5);
  EXPECT_LT(worst(reference, fast, 3, 4), 1e-6);
  EXPECT_LT(worst(reference, adaptive, 3, 4), 1e-6);
  EXPECT_LT(worst(reference, fast, 4, 5), 1e-5);
  EXPECT_LT(worst(reference, adaptive, 4, 5), 1e-5);
}

TEST(Solver, IdealSwitchesAgainstTheReference) {
  const PlantConfig config = PlantConfig::ideal();
  const testing::Recording recording = testing::record_ramp_and_load(config, 2000);
  const auto reference = run(config, Solver::kReference, recording);
  EXPECT_LT(worst(reference, run(config, Solver::kRungeKutta, recording), 0, 3), 1e-5);
  EXPECT_LT(worst(reference, run(config, Solver::kErkStep, recording), 0, 3), 1e-5);
}

TEST(Solver, RefinementConvergesWithTheOrderOfTheMethod) {
  // Short-circuit braking from 300 rad/s: smooth, so the error is the method's. Halving the step of a fourth-order
  // method divides it by 16; accept 12..20.
  const auto current = [](Tick segment) {
    PlantConfig c;
    c.initial.speed = 300.0;
    c.inverter = {0.0, 0.0, 0.0, 0.0, 0, 0};
    c.solver.max_segment = segment;
    Plant plant(c);
    for (int leg = 0; leg < 3; ++leg) plant.set_gate(0, leg, false, true);
    plant.advance(320'000);
    return plant.state().current_q;
  };
  const double exact = current(500);
  const double coarse = current(8000) - exact, fine = current(4000) - exact;
  EXPECT_GT(std::fabs(coarse), 1e-7) << "nothing to converge";
  EXPECT_GT(coarse / fine, 12.0);
  EXPECT_LT(coarse / fine, 20.0);
}

TEST(Solver, FastDriveAtTheVoltageLimit) {
  // 250 rad/s (159 Hz electrical) needs more than the link has: clipped duties, and a hard load step.
  const PlantConfig config;
  const testing::Recording recording = testing::record(
      config, 3000, [](double t) { return std::min(250.0, 1500.0 * t); }, {{20'000'000, 0.0}, {20'100'000, 8.0}});
  const auto reference = run(config, Solver::kReference, recording);
  EXPECT_LT(worst(reference, run(config, Solver::kRungeKutta, recording), 0, 3), 1e-5);
  EXPECT_LT(worst(reference, run(config, Solver::kErkStep, recording), 0, 3), 1e-5);
}

}  // namespace
}  // namespace stillspin::plant
