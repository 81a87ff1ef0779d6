// A flow made of a method that only knows how to step: looks at the event functions behind the step and, where one has
// turned negative, finds the instant on the cubic Hermite polynomial of a second step that ends just behind it.
//
// Close to that end the polynomial's error is s^2 (h - s)^2 / 24 times the fourth derivative: below 1e-10 A for a step
// of 25 us. What happens between two non-negative ends does not show here, see Trajectory::grazing_instant().

#ifndef STILLSPIN_SIM_HOST_PLANT_EVENT_SEARCH_HPP
#define STILLSPIN_SIM_HOST_PLANT_EVENT_SEARCH_HPP

#include "sim_host/plant/flow.hpp"

namespace stillspin::plant {

class SteppingFlow : public Flow {
 public:
  void advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) final;
  void locate(const Model& model, const SegmentStart& start, State& end, Advance& result) final;

 protected:
  /// State and slope h seconds (> 0) after the start; the slope may be of lower order.
  virtual void step(const Model& model, const SegmentStart& start, double h, State& end, State& end_slope) = 0;

 private:
  double g_start_ = 0.0;  // the lowest event function at the start of the segment that crosses
};

}  // namespace stillspin::plant

#endif
