#include "sim_host/bench/replay.hpp"

#include <algorithm>
#include <stdexcept>

namespace stillspin::bench {
namespace {

using plant::PlantState;
using plant::Tick;

struct Column {
  ColumnInfo info;
  double (*value)(const PlantState&);
};

const Column kColumns[] = {
    {{"i_a", "A", "current of phase a"}, [](const PlantState& s) { return s.current[0]; }},
    {{"i_b", "A", "current of phase b"}, [](const PlantState& s) { return s.current[1]; }},
    {{"i_c", "A", "current of phase c"}, [](const PlantState& s) { return s.current[2]; }},
    {{"i_d", "A", "d-axis current"}, [](const PlantState& s) { return s.current_d; }},
    {{"i_q", "A", "q-axis current"}, [](const PlantState& s) { return s.current_q; }},
    {{"torque", "Nm", "air-gap torque"}, [](const PlantState& s) { return s.torque; }},
    {{"speed", "rad/s", "mechanical speed"}, [](const PlantState& s) { return s.speed_m; }},
    {{"angle", "rad", "mechanical angle, not wrapped"}, [](const PlantState& s) { return s.angle_m; }},
};

void check(const ReplayRequest& r) {
  const auto later = [](const GateEdge& a, const GateEdge& b) { return a.tick < b.tick; };
  if (!std::is_sorted(r.edges.begin(), r.edges.end(), later) || (!r.edges.empty() && r.edges.front().tick < 0))
    throw std::invalid_argument("edges: times must not be negative or decrease");
  if (!std::is_sorted(r.at.begin(), r.at.end()) || (!r.at.empty() && r.at.front() < 0))
    throw std::invalid_argument("at: times must not be negative or decrease");
  for (const GateEdge& e : r.edges) {
    if (e.leg < 0 || e.leg > 2) throw std::invalid_argument("edges: a leg must be 0, 1 or 2");
  }
}

}  // namespace

const std::vector<ColumnInfo>& replay_columns() {
  static const std::vector<ColumnInfo> list = [] {
    std::vector<ColumnInfo> all;
    for (const Column& c : kColumns) all.push_back(c.info);
    return all;
  }();
  return list;
}

std::vector<std::vector<double>> replay(const ReplayRequest& request) {
  check(request);
  plant::Plant plant(request.setup.plant());
  plant.set_load(request.load);
  std::vector<std::vector<double>> values(replay_columns().size());
  auto edge = request.edges.begin();
  for (const Tick t : request.at) {
    for (; edge != request.edges.end() && edge->tick <= t; ++edge)
      plant.set_gate(edge->tick, edge->leg, edge->upper, edge->lower);
    plant.advance(t);
    const PlantState state = plant.state();
    for (std::size_t k = 0; k < values.size(); k++) values[k].push_back(kColumns[k].value(state));
  }
  return values;
}

}  // namespace stillspin::bench
