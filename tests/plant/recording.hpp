// A realistic sequence of gate edges and load points, made once by a sensored current and speed controller that reads
// the true state, and replayed open loop into plants with other solvers: all see exactly the same edges.

#ifndef STILLSPIN_TESTS_PLANT_RECORDING_HPP
#define STILLSPIN_TESTS_PLANT_RECORDING_HPP

#include <functional>
#include <vector>

#include "sim_host/plant/plant.hpp"

namespace stillspin::plant::testing {

inline constexpr Tick kPeriod = 10000;  // 10 kHz
inline constexpr Tick kDeadTime = 200;  // 2 us
inline constexpr double kPeriodSeconds = 1e-4;

struct GateEdge {
  Tick tick;
  int leg;
  bool upper;
  bool lower;
};

struct Recording {
  std::vector<GateEdge> edges;
  std::vector<LoadPoint> load;
  int periods = 0;
};

/// Speed reference (rad/s mechanical) over time (s).
using Reference = std::function<double(double)>;

/// Runs the controller for `periods` on a plant of `config`. Gates are off in the first and the last period.
Recording record(const PlantConfig& config, int periods, const Reference& speed, std::vector<LoadPoint> load);

/// 1 s when `periods` is 10000: 0 to 100 rad/s in 0.4 s, load 3 N m at 60 % of the time, rising over 5 ms.
Recording record_ramp_and_load(const PlantConfig& config, int periods);

/// Replays; `at` is called at the given ticks after the start of every period.
void replay(Plant& plant, const Recording& recording, const std::vector<Tick>& at,
            const std::function<void(Tick)>& look);

}  // namespace stillspin::plant::testing

#endif
