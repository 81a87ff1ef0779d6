// Load torque, piecewise linear in absolute time.

#ifndef STILLSPIN_SIM_HOST_PLANT_LOAD_PROFILE_HPP
#define STILLSPIN_SIM_HOST_PLANT_LOAD_PROFILE_HPP

#include <vector>

#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {

class LoadProfile {
 public:
  /// Throws std::invalid_argument when times decrease or a torque is out of range.
  void set(std::vector<LoadPoint> points);

  struct Piece {
    double torque;  // N m at t
    double slope;   // N m/s from t on
    Tick end;       // where the slope or the torque changes next
  };

  /// The piece that begins or runs at t (after a jump at t). t does not decrease from call to call.
  Piece at(Tick t);

 private:
  std::vector<LoadPoint> points_;
  std::size_t passed_ = 0;  // points at or before t
};

}  // namespace stillspin::plant

#endif
