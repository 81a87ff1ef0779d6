// One way to get from the start of a segment to its end, or to the first event on the way.

#ifndef STILLSPIN_SIM_HOST_PLANT_FLOW_HPP
#define STILLSPIN_SIM_HOST_PLANT_FLOW_HPP

#include <memory>

#include "sim_host/plant/model.hpp"

namespace stillspin::plant {

/// Start of a segment, with the slopes there (every user needs them, so they are computed once).
struct SegmentStart {
  State y;          // y[kAngle] = 0
  State slope;      // dy/dt
  Pair flux;        // Vs
  Pair flux_slope;  // V
};

/// Cubic Hermite polynomial through the start and a state `end` after h seconds, at s of them.
class Hermite {
 public:
  Hermite(double h, double s) {
    const double x = s / h;
    end_ = x * x * (3.0 - 2.0 * x);
    start_ = 1.0 - end_;
    start_slope_ = s * (1.0 - x) * (1.0 - x);
    end_slope_ = s * x * (x - 1.0);
  }

  State operator()(const SegmentStart& start, const State& end, const State& end_slope) const {
    return start_ * start.y + end_ * end + start_slope_ * start.slope + end_slope_ * end_slope;
  }
  /// One of its numbers alone.
  double operator()(const SegmentStart& start, const State& end, const State& end_slope, StateIndex n) const {
    return start_ * start.y[n] + end_ * end[n] + start_slope_ * start.slope[n] + end_slope_ * end_slope[n];
  }

 private:
  double start_, end_, start_slope_, end_slope_;  // weights
};

inline State hermite(const SegmentStart& start, const State& end, const State& end_slope, double h, double s) {
  return Hermite(h, s)(start, end, end_slope);
}

inline constexpr double kNowhere = -1.0;

struct Advance {
  double reached = 0.0;  // s from the start, > 0 unless an event is due at once
  bool event = false;
  double crossing = kNowhere;  // s: about where an event happens on the way; locate() finds it
  Fired fired{};               // which event functions have reached zero
  bool far = false;            // no event function came near zero on the way
  bool has_end_slope = false;
  State end_slope = State::Zero();  // dy/dt at the end, when the method has it (to its own order)
};

/// Events are located from brackets on this grid of time since the start of the segment, not from wherever the look
/// ahead happened to end: so the instant found, to its last bit, does not depend on who looked when.
inline constexpr double kEventCell = 1e-7;  // s

class Flow {
 public:
  virtual ~Flow() = default;

  /// From `start` over at most `h` seconds (> 0) to `end`. May stop short of h without an event; may leave a crossing
  /// for later, because a new edge before it often makes it void.
  virtual void advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) = 0;

  /// After advance() with a crossing: the event.
  virtual void locate(const Model&, const SegmentStart&, State&, Advance&) {}
};

std::unique_ptr<Flow> make_runge_kutta();
std::unique_ptr<Flow> make_erkstep(double relative_tolerance);
std::unique_ptr<Flow> make_reference();
std::unique_ptr<Flow> make_flow(const SolverConfig& config);

}  // namespace stillspin::plant

#endif
