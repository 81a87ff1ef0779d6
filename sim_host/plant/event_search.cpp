#include "sim_host/plant/event_search.hpp"

#include <algorithm>
#include <cmath>

namespace stillspin::plant {
namespace {

constexpr double kMissed = 1e-10;  // A or V: an event function this far below zero has crossed
constexpr double kFound = 0.1 * kMissed;
constexpr double kAtZero = 1e-9;     // A or V: reached together with the first one
constexpr double kShortest = 1e-15;  // s: below this a bracket is a point

double lowest(const Events& g) { return *std::min_element(g.begin(), g.end()); }

/// The event functions along one step.
class Curve {
 public:
  Curve(const Model& model, const SegmentStart& start, const State& end, const State& end_slope, double h)
      : model_(model), start_(start), end_(end), end_slope_(end_slope), h_(h) {}

  double at(double s) {
    y_ = hermite(start_, end_, end_slope_, h_, s);
    model_.events(s, y_, g_);
    return lowest(g_);
  }

  /// Where the lowest function turns negative; at `high` it is. When it starts from about zero (a current that has just
  /// left zero): the point at which it comes back, `low` when it never left.
  double root(double low, double g_low, double high) {
    double g_high = at(high);
    for (double probe = high; g_low <= kMissed;) {
      probe = low + 0.5 * (probe - low);
      if (probe - low < kShortest) return low;
      const double value = at(probe);
      (value < 0.0 ? g_high : g_low) = value;
      (value < 0.0 ? high : low) = probe;
      if (value >= 0.0) break;
    }
    return illinois(low, g_low, high, g_high);
  }

  /// The segment ends there with an event. At the very start: with what is negative a little later.
  void finish(double where, State& end, Advance& result) {
    at(where > 0.0 ? where : h_);
    const double lowest_value = lowest(g_);
    for (int n = 0; n < kEvents; ++n) result.fired[n] = g_[n] < kAtZero || g_[n] == lowest_value;
    end = where > 0.0 ? y_ : start_.y;
    result.reached = where;
    result.event = true;
    result.has_end_slope = false;
  }

 private:
  double illinois(double low, double g_low, double high, double g_high) {
    double where = high;
    for (int n = 0, side = 0; n < 100 && high - low > kShortest; ++n) {
      where = (low * g_high - high * g_low) / (g_high - g_low);
      const double value = at(where);
      if (std::fabs(value) < kFound) break;
      const int now = value < 0.0 ? -1 : 1;
      (now < 0 ? high : low) = where;
      (now < 0 ? g_high : g_low) = value;
      if (now == side) (now < 0 ? g_low : g_high) *= 0.5;
      side = now;
    }
    return where;
  }

  const Model& model_;
  const SegmentStart& start_;
  State end_, end_slope_;
  double h_;
  State y_;  // where at() has looked last
  Events g_;
};

}  // namespace

void SteppingFlow::advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) {
  step(model, start, h, end, result.end_slope);
  result.reached = h;
  result.event = false;
  result.has_end_slope = true;
  result.far = model.far_from_events(start.y, start.slope, result.end_slope, h);
  if (result.far) return;
  Events g;
  model.events(h, end, g);
  if (lowest(g) < -kMissed) locate(model, start, h, end, result);
}

/// The event lies in the first cell of the grid at whose end a step finds something negative: so neither the cell nor
/// the polynomial in it depends on h, and the instant found does not depend on how far somebody looked ahead.
void SteppingFlow::locate(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) {
  Events g;
  model.events(0.0, start.y, g);
  const double g_start = lowest(g);
  Curve whole(model, start, end, result.end_slope, h);
  const double expected = whole.root(0.0, g_start, h);
  long cell = static_cast<long>(expected / kEventCell);
  for (bool clear_before = false;;) {  // clear: a step to the start of the cell finds nothing negative
    const double low = static_cast<double>(cell) * kEventCell;
    const double high = static_cast<double>(cell + 1) * kEventCell;
    State near_end, near_slope;
    step(model, start, high, near_end, near_slope);
    Curve curve(model, start, near_end, near_slope, high);
    if (curve.at(high) >= 0.0) {
      if (high >= h) return whole.finish(expected, end, result);  // it comes back between h and the grid point
      ++cell;
      clear_before = true;
      continue;
    }
    const double g_low = cell == 0 ? g_start : curve.at(low);
    if (cell > 0 && !clear_before && g_low < kAtZero) {
      --cell;
      continue;
    }
    return curve.finish(curve.root(low, g_low, high), end, result);
  }
}

}  // namespace stillspin::plant
