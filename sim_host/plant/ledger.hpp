// Where the energy went: Simpson's rule over each committed segment, middle value from the Hermite polynomial.

#ifndef STILLSPIN_SIM_HOST_PLANT_LEDGER_HPP
#define STILLSPIN_SIM_HOST_PLANT_LEDGER_HPP

#include "sim_host/plant/trajectory.hpp"

namespace stillspin::plant {

class Ledger {
 public:
  /// Books the first `seconds` of the segment that `trajectory` has looked ahead.
  void book(const Trajectory& trajectory, double seconds);

  /// What has been booked, with the energy stored in state y of `model`.
  EnergyLedger read(const Model& model, const State& y) const;

 private:
  EnergyLedger booked_;
};

}  // namespace stillspin::plant

#endif
