// What a test bench changes while the plant runs: load, lock, faults.

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sim_host/plant/plant_engine.hpp"

namespace stillspin::plant {

void Plant::set_load(std::vector<LoadPoint> points) {
  impl_->cut();
  impl_->load.set(std::move(points));
  impl_->load_end = impl_->now;  // an edge: the new piece begins here
  impl_->looked_ahead = false;
}

void Plant::set_locked(bool locked) {
  impl_->cut();
  const bool coulomb = std::max(impl_->config.mechanics.coulomb_friction, impl_->config.mechanics.stiction) > 0.0;
  impl_->trajectory.model().shaft = locked ? Shaft::kLocked : coulomb ? Shaft::kTurning : Shaft::kFree;
  impl_->transition({}, [] {});
}

void Plant::set_brake(bool on) {
  impl_->cut();
  impl_->transition({}, [&] { impl_->trajectory.model().brake = on; });
}

void Plant::set_precharge(double ohms) {
  impl_->cut();
  const double total = impl_->config.link.source_resistance + ohms;
  impl_->transition({}, [&] { impl_->trajectory.model().set_source_resistance(total); });
}

void Plant::inject(const Fault& fault) {
  check_index("fault index", fault.index);
  impl_->cut();
  const auto k = static_cast<std::size_t>(fault.index);
  switch (fault.kind) {
    case FaultKind::kOpenPhase:
      impl_->open[k] = true;
      impl_->transition({}, [&] { impl_->set_leg(fault.index); });
      break;
    case FaultKind::kSensorStuck:
      impl_->sensors.stick(fault.index, fault.value);
      break;
    case FaultKind::kSensorDrift:
      impl_->sensors.drift(fault.index, impl_->now, fault.value);
      break;
    case FaultKind::kSensorGain:
      impl_->sensors.scale(fault.index, fault.value);
      break;
    case FaultKind::kLinkSag:
      if (!(fault.value >= 0.0 && fault.value <= 2.0)) {
        throw std::invalid_argument("plant: link sag factor " + std::to_string(fault.value) + " is outside 0..2");
      }
      impl_->transition({}, [&] { impl_->trajectory.model().sag = fault.value; });
      break;
  }
}

void Plant::clear_faults() {
  impl_->cut();
  impl_->sensors.repair();
  impl_->open = {};
  impl_->transition({}, [&] {
    impl_->trajectory.model().sag = 1.0;
    for (int k = 0; k < 3; ++k) impl_->set_leg(k);
  });
}

}  // namespace stillspin::plant
