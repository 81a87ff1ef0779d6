// Microseconds of host time per PWM period of 100 us in the bench profile: plant_speed [periods]
//
// 12 gate edges per period; 24 ADC codes: pairs (a, b) in six bursts of two, as the three windows of the board ask.

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "sim_host/plant/plant.hpp"
#include "tests/plant/recording.hpp"

namespace {

using namespace stillspin::plant;

double microseconds_per_period(const PlantConfig& config, const testing::Recording& r, const std::vector<Tick>& at) {
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    Plant plant(config);
    const auto start = std::chrono::steady_clock::now();
    testing::replay(plant, r, at, [&](Tick t) {
      plant.adc_code(t, AdcInput::kCurrentA);
      plant.adc_code(t, AdcInput::kCurrentB);
    });
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    best = std::min(best, elapsed.count() / r.periods);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  const int periods = argc > 1 ? std::atoi(argv[1]) : 2000;
  PlantConfig config;
  const testing::Recording r = testing::record_ramp_and_load(config, periods);
  std::vector<Tick> at;
  for (Tick window : {700, 3000, 3900, 6200, 7100, 9400}) {
    at.push_back(window);
    at.push_back(window + 24);
  }
  std::printf("RK4        %7.2f us per period, 24 codes\n", microseconds_per_period(config, r, at));
  std::printf("RK4        %7.2f us per period, 2 codes\n", microseconds_per_period(config, r, {9999}));
  config.solver.solver = Solver::kErkStep;
  std::printf("ERKStep    %7.2f us per period, 24 codes\n", microseconds_per_period(config, r, at));
  config = PlantConfig::ideal();
  const testing::Recording ideal = testing::record_ramp_and_load(config, periods);
  std::printf("RK4 ideal  %7.2f us per period, 24 codes\n", microseconds_per_period(config, ideal, at));
  return 0;
}
