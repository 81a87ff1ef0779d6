#include "sim_host/plant/event_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillspin::plant {
namespace {

constexpr double kMissed = 1e-10;  // A or V: an event function this far below zero has crossed
constexpr double kFound = 0.1 * kMissed;
constexpr double kEstimate = 1e-6;   // A or V
constexpr double kAtZero = 1e-9;     // A or V: reached together with the first one
constexpr double kShortest = 1e-15;  // s: below this a bracket is a point

/// The event functions along one step.
class Curve {
 public:
  Curve(const Model& model, const SegmentStart& start, const State& end, const State& end_slope, double h)
      : model_(model),
        start_(start),
        end_(end),
        end_slope_(end_slope),
        h_(h),
        currents_alone_(model.watches_currents_alone()) {}

  double at(double s) const {
    const Hermite y(h_, s);
    if (!currents_alone_) return model_.lowest_event(s, y(start_, end_, end_slope_));
    const Rotation e = turned(model_.base, y(start_, end_, end_slope_, kAngle));
    return model_.lowest_current(e, y(start_, end_, end_slope_, kId), y(start_, end_, end_slope_, kIq));
  }

  struct Bracket {
    double low, g_low;    // nothing negative
    double high, g_high;  // something negative
  };

  /// Where the lowest function turns negative, to `accuracy` of its value. When it starts from about zero (a current
  /// that has just left zero): the point at which it comes back, `low` when it never left.
  double root(Bracket b, double accuracy) const {
    while (b.g_low <= kMissed) {
      const double probe = b.low + 0.5 * (b.high - b.low);
      if (probe - b.low < kShortest) return b.low;
      const double value = at(probe);
      (value < 0.0 ? b.high : b.low) = probe;
      (value < 0.0 ? b.g_high : b.g_low) = value;
      if (value >= 0.0) break;
    }
    return illinois(b, accuracy);
  }

  /// The segment ends there with an event. At the very start: with what is negative a little later.
  void finish(double where, State& end, Advance& result) const {
    const double look = where > 0.0 ? where : h_;
    const State y = hermite(start_, end_, end_slope_, h_, look);
    Events g;
    model_.events(look, y, g);
    const double lowest = *std::min_element(g.begin(), g.end());
    for (int n = 0; n < kEvents; ++n) result.fired[n] = g[n] < kAtZero || g[n] == lowest;
    end = where > 0.0 ? y : start_.y;
    result.reached = where;
    result.event = true;
    result.has_end_slope = false;
  }

 private:
  double illinois(Bracket b, double accuracy) const {
    double where = b.high;
    for (int n = 0, side = 0; n < 100 && b.high - b.low > kShortest; ++n) {
      where = (b.low * b.g_high - b.high * b.g_low) / (b.g_high - b.g_low);
      const double value = at(where);
      if (std::fabs(value) < accuracy) break;
      const int now = value < 0.0 ? -1 : 1;
      (now < 0 ? b.high : b.low) = where;
      (now < 0 ? b.g_high : b.g_low) = value;
      if (now == side) (now < 0 ? b.g_low : b.g_high) *= 0.5;
      side = now;
    }
    return where;
  }

  const Model& model_;
  const SegmentStart& start_;
  const State& end_;
  const State& end_slope_;
  double h_;
  bool currents_alone_;
};

}  // namespace

void SteppingFlow::advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) {
  step(model, start, h, end, result.end_slope);
  result.reached = h;
  result.event = false;
  result.crossing = kNowhere;
  result.has_end_slope = true;
  result.far = model.far_from_events(start.y, start.slope, result.end_slope, h);
  if (result.far) return;
  const double g_end = model.lowest_event(h, end);
  if (g_end >= -kMissed) return;
  g_start_ = model.lowest_event(0.0, start.y);
  const Curve curve(model, start, end, result.end_slope, h);
  result.crossing = curve.root({0.0, g_start_, h, g_end}, kEstimate);
}

/// The event lies in the first cell of the grid at whose end a step finds something negative: so neither the cell nor
/// the polynomial in it depends on h, and the instant found does not depend on how far somebody looked ahead.
void SteppingFlow::locate(const Model& model, const SegmentStart& start, State& end, Advance& result) {
  const double h = result.reached;
  const double estimate = std::exchange(result.crossing, kNowhere);
  long cell = static_cast<long>(estimate / kEventCell);
  for (bool clear_before = false;;) {  // clear: a step to the start of the cell finds nothing negative
    const double low = static_cast<double>(cell) * kEventCell;
    const double high = static_cast<double>(cell + 1) * kEventCell;
    State near_end, near_slope;
    step(model, start, high, near_end, near_slope);
    const Curve curve(model, start, near_end, near_slope, high);
    const double g_high = curve.at(high);
    if (g_high >= 0.0 && high >= h) {  // it comes back between h and the grid point
      const Curve whole(model, start, end, result.end_slope, h);
      return whole.finish(whole.root({0.0, g_start_, h, whole.at(h)}, kFound), end, result);
    }
    if (g_high >= 0.0) {
      ++cell;
      clear_before = true;
      continue;
    }
    const double g_low = cell == 0 ? g_start_ : curve.at(low);
    if (cell > 0 && !clear_before && g_low < kAtZero) {
      --cell;
      continue;
    }
    return curve.finish(curve.root({low, g_low, high, g_high}, kFound), end, result);
  }
}

}  // namespace stillspin::plant
