// The plant alone, open loop: a given sequence of gate edges and loads in, true values out.
//
// Nothing answers to what the plant does, so two models that are given the same sequence can be held against each
// other to the last digits. Ticks are 10 ns from power-on.

#ifndef STILLSPIN_SIM_HOST_BENCH_REPLAY_HPP
#define STILLSPIN_SIM_HOST_BENCH_REPLAY_HPP

#include <vector>

#include "sim_host/bench/run.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::bench {

/// Driver inputs of leg 0..2 from `tick` on.
struct GateEdge {
  plant::Tick tick;
  int leg;
  bool upper;
  bool lower;
};

struct ReplayRequest {
  Setup setup;
  std::vector<GateEdge> edges;         // in the order of time
  std::vector<plant::LoadPoint> load;  // piecewise linear
  std::vector<plant::Tick> at;         // when to look, in the order of time
};

/// Names, units and meaning of what replay() gives.
const std::vector<ColumnInfo>& replay_columns();

/// One vector for each column, with one value for each element of `at`. An edge at the very tick of a look comes first.
/// Throws std::invalid_argument for times that decrease or a leg that does not exist.
std::vector<std::vector<double>> replay(const ReplayRequest& request);

}  // namespace stillspin::bench

#endif
