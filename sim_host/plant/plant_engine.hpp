// The inside of the plant: which edges, events and looks end a segment, and what happens there. Not for users of the
// plant, see plant.hpp.
//
// Split over plant_engine.cpp (time, edges, events), plant_changes.cpp (load, lock, faults) and plant.cpp (looks).

#ifndef STILLSPIN_SIM_HOST_PLANT_PLANT_ENGINE_HPP
#define STILLSPIN_SIM_HOST_PLANT_PLANT_ENGINE_HPP

#include <algorithm>
#include <cmath>

#include "sim_host/plant/adc.hpp"
#include "sim_host/plant/gates.hpp"
#include "sim_host/plant/ledger.hpp"
#include "sim_host/plant/load_profile.hpp"
#include "sim_host/plant/plant.hpp"
#include "sim_host/plant/sensors.hpp"
#include "sim_host/plant/trajectory.hpp"

namespace stillspin::plant {

/// Throws std::invalid_argument for an index that is none of a phase or a leg.
void check_index(const char* what, int index);

/// Largest magnitude of the three phase values.
inline double largest(const AlphaBeta& x) {
  const std::array<double, 3> i = phases(x);
  return std::max(std::fabs(i[0]), std::max(std::fabs(i[1]), std::fabs(i[2])));
}

struct Plant::Impl {
  explicit Impl(const PlantConfig& c);  // validates

  void move_to(Tick t) {
    if (t == now) return;
    if (t < now) refuse(t);
    has_present = has_sensed = false;
    now = t;
  }
  /// Until a segment covers t. An edge at t itself is left for later, since nothing but the leg voltage shows it.
  void integrate_to(Tick t) {
    if (!looked_ahead || !trajectory.covers(t)) integrate_on(t);
  }
  double reading(int phase) { return sensors.reading(phase, now, sensed()[phase]); }
  [[noreturn]] void refuse(Tick t) const;
  void integrate_on(Tick t);
  void settle(Tick t);
  void edges(Tick t);
  Tick next_edge() const;
  void start_segment(Tick t);
  void look_ahead(Tick edge);
  void pass_edges();
  void commit();
  template <typename Change>
  void transition(const Fired& fired, Change change);
  /// The segment has to be begun anew, after a jump of the leg voltages.
  void renew(const std::array<double, 3>& jump) {
    trajectory.restart();
    looked_ahead = false;
    sensors.excite(trajectory.tick(), trajectory.fraction(), jump);
  }
  void cut();
  void set_leg(int k);
  const State& present();
  void sense();
  /// What the current sensors see at the present, before their gains and offsets.
  const std::array<double, 3>& sensed() {
    if (!has_sensed) sense();
    return present_sensed;
  }

  PlantConfig config;
  Trajectory trajectory;
  Gates gates;
  LoadProfile load;
  Tick load_end = kNever;
  Sensors sensors;
  Adc adc;
  Ledger ledger;
  std::array<bool, 3> open{};
  std::array<std::array<Leg, 3>, 2> legs;  // [wire cut][both off, lower on, upper on]
  std::optional<ShootThrough> shoot_through;
  PlantStats stats;
  Tick now = 0;
  bool looked_ahead = false;  // with all edges known so far
  double peak = 0.0;          // A, over committed segments since last asked

  // What has already been evaluated at the present.
  bool has_present = false, has_sensed = false;
  State present_state;
  std::array<double, 3> present_sensed;
};

/// Something changes at the start of the current segment; leg voltages that jump by it make the sensors ring.
template <typename Change>
inline void Plant::Impl::transition(const Fired& fired, Change change) {
  const std::array<double, 3> before = trajectory.leg_voltages();
  change();
  trajectory.model().resolve(trajectory.state(), fired);
  std::array<double, 3> jump = trajectory.leg_voltages();
  for (int k = 0; k < 3; ++k) jump[k] -= before[k];
  renew(jump);
}

}  // namespace stillspin::plant

#endif
