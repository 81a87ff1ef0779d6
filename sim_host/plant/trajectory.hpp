// The continuous state as a chain of segments: a committed past, and one segment looked ahead into a future that a
// later edge may still cut short. Values inside the segment come from a cubic Hermite polynomial.
//
// Hermite error over 25 us: 3e-8 A at 3000 rpm; it touches what is seen, never the state that is carried on.

#ifndef STILLSPIN_SIM_HOST_PLANT_TRAJECTORY_HPP
#define STILLSPIN_SIM_HOST_PLANT_TRAJECTORY_HPP

#include <algorithm>
#include <memory>

#include "sim_host/plant/flow.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {

/// A vector in stator coordinates. Two plain numbers: a vector of Eigen's would be written in halves and read at once,
/// for which the processor has to wait.
struct AlphaBeta {
  double alpha = 0.0;
  double beta = 0.0;

  double dot(const AlphaBeta& o) const { return alpha * o.alpha + beta * o.beta; }
  friend AlphaBeta operator+(const AlphaBeta& a, const AlphaBeta& b) { return {a.alpha + b.alpha, a.beta + b.beta}; }
  friend AlphaBeta operator-(const AlphaBeta& a, const AlphaBeta& b) { return {a.alpha - b.alpha, a.beta - b.beta}; }
  friend AlphaBeta operator*(double k, const AlphaBeta& a) { return {k * a.alpha, k * a.beta}; }
};

/// Values of phases a, b, c.
inline std::array<double, 3> phases(const AlphaBeta& x) {
  const double half = 0.5 * x.alpha, turn = 0.5 * kSqrt3 * x.beta;
  return {x.alpha, turn - half, -turn - half};
}

/// Axis of phase 0..2 in stator coordinates: its dot product with a vector is the phase value.
inline AlphaBeta stator_axis(int phase) {
  if (phase == 0) return {1.0, 0.0};
  return {-0.5, phase == 1 ? 0.5 * kSqrt3 : -0.5 * kSqrt3};
}

class Trajectory {
 public:
  explicit Trajectory(const PlantConfig& config);

  // The start of the current segment.
  Tick tick() const { return tick_; }            // the tick at or before it
  double fraction() const { return fraction_; }  // s after that tick
  bool at(Tick t) const { return tick_ == t && fraction_ == 0.0; }
  double angle() const { return angle_; }        // rad electrical, -pi..pi
  std::int64_t turns() const { return turns_; }  // electrical turns
  const State& start() const { return start_.y; }
  std::array<double, 3> leg_voltages() const { return model_.leg_voltages(start_.y); }

  /// To change what events change (legs, load, ...) or the state; call restart() afterwards.
  Model& model() { return model_; }
  const Model& model() const { return model_; }
  State& state() { return start_.y; }
  void restart() { ahead_ = started_ = false; }

  // The segment looked ahead.
  bool ahead() const { return ahead_; }
  bool ends_after(Tick t) const {
    if (crosses()) return step_.crossing + kEventCell > time_to(t);
    return step_.event ? step_.reached > time_to(t) : end_tick_ > t;
  }
  bool covers(Tick t) const {
    if (crosses()) return step_.crossing - kEventCell > time_to(t);
    return step_.event ? step_.reached >= time_to(t) : end_tick_ >= t;
  }
  /// An event lies ahead of which only the estimate is known: locate() before commit().
  bool crosses() const { return step_.crossing != kNowhere; }
  void locate();
  void look_ahead(Tick end);
  double length() const { return step_.reached; }
  bool has_event() const { return step_.event; }
  const Fired& fired() const { return step_.fired; }
  /// s from the start, within the segment.
  double offset(Tick t) const { return std::min(std::max(time_to(t), 0.0), step_.reached); }
  State at_offset(double s) const;
  /// The same of the current alone, and of the link voltage alone.
  AlphaBeta current_at_offset(double s) const {
    const double h = step_.reached;
    if (s >= h) return current(end_);
    const State& slope = end_slope();
    const Hermite at(h, s);
    const Rotation e = turned(model_.base, at(start_, end_, slope, kAngle));
    return stator(e, at(start_, end_, slope, kId), at(start_, end_, slope, kIq));
  }
  double link_voltage_at_offset(double s) const;
  /// Current where the segment looked ahead starts, and its slope.
  const AlphaBeta& origin_current() const { return origin_current_; }
  const AlphaBeta& origin_slope() const { return origin_slope_; }
  AlphaBeta start_current() const { return stator(model_.base, start_.y[kId], start_.y[kIq]); }
  AlphaBeta current(const State& y) const { return stator(turned(model_.base, y[kAngle]), y[kId], y[kIq]); }

  /// Makes the segment's end the start of the next one. The model still has the modes of before.
  void commit();

  std::uint64_t grazing() const { return grazing_; }

 private:
  static AlphaBeta stator(const Rotation& e, double d, double q) { return {e.c * d - e.s * q, e.s * d + e.c * q}; }
  AlphaBeta start_slope() const {  // A/s
    const double electrical = start_.slope[kAngle];
    return stator(model_.base, start_.slope[kId] - electrical * start_.y[kIq],
                  start_.slope[kIq] + electrical * start_.y[kId]);
  }
  const State& end_slope() const {
    if (!end_slope_known_) find_end_slope();
    return step_.end_slope;
  }
  void find_end_slope() const;
  void begin();
  void turn_bases(double angle);
  double time_to(Tick t) const { return static_cast<double>(t - tick_) * kSecondsPerTick - fraction_; }
  double grazing_instant();

  Model model_;
  std::unique_ptr<Flow> flow_;
  Tick tick_ = 0;
  double fraction_ = 0.0;
  double angle_ = 0.0;
  std::int64_t turns_ = 0;
  double ripple_speed_;  // rad/s of the source ripple
  int since_set_ = 0;    // segments since the rotations were set anew

  SegmentStart start_;
  AlphaBeta origin_current_, origin_slope_;
  State end_;
  mutable Advance step_;  // its end slope may be evaluated late
  Tick end_tick_ = 0;     // of a segment without event
  bool started_ = false;
  bool ahead_ = false;
  mutable bool end_slope_known_ = false;
  int at_once_ = 0;  // events in a row without progress
  int moments_ = 0;  // in a row in which it went on by next to nothing
  std::uint64_t grazing_ = 0;
};

}  // namespace stillspin::plant

#endif
