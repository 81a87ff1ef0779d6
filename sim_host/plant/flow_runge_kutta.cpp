// The fast path: one classical Runge-Kutta step per segment, zero crossings polished by repeating the step.
//
// The step carries the flux linkage along with the currents (d psi/dt is known before it is divided by the inductance),
// so that the map, with its arc tangent, is evaluated once per segment; both agree to the order of the method.

#include <algorithm>
#include <cmath>

#include "sim_host/plant/flow.hpp"
#include "sim_host/plant/model_core.hpp"

namespace stillspin::plant {
namespace {

constexpr double kMissed = 1e-10;    // A or V: an event function this far below zero has crossed
constexpr double kShortest = 1e-15;  // s: below this a bracket is a point
constexpr double kAtZero = 1e-9;     // A or V: reached together with the first one

State plus(const State& y, double h, const State& slope) {
  State r;
  for (int n = 0; n < kStates; ++n) r[n] = y[n] + h * slope[n];
  return r;
}

class RungeKutta final : public Flow {
 public:
  void advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) override {
    step(model, start, h, end);
    result.reached = h;
    result.event = false;
    result.far = model.far_from_events(start.y, start.slope, last_slope_, h);
    result.has_end_slope = true;
    if (!result.far) {
      Events g;
      model.events(h, end, g);
      if (lowest(g) < -kMissed) {
        result = locate(model, start, h, end);
        return;
      }
    }
    result.end_slope = last_slope_;
  }

 private:
  static double lowest(const Events& g) { return *std::min_element(g.begin(), g.end()); }

  void step(const Model& model, const SegmentStart& s, double h, State& end) {
    if (model.clamp == Clamp::kNone) return step<0>(model, s, h, end);
    if (model.clamp == Clamp::kAll) return step<3>(model, s, h, end);
    step<1>(model, s, h, end);
  }

  template <int kClamped>
  void step(const Model& model, const SegmentStart& s, double h, State& end) {
    const double half = 0.5 * h;
    State k2, k3;
    State& k4 = last_slope_;
    Pair f2, f3, f4;
    const State y2 = plus(s.y, half, s.slope);
    const Rotation e2 = turned(model.base, y2[kAngle]);
    model.derive<kClamped>(half, y2, e2, moved(s.flux, half, s.flux_slope), k2, f2);
    const State y3 = plus(s.y, half, k2);
    const Rotation e3 = nudged(e2, y3[kAngle] - y2[kAngle]);
    model.derive<kClamped>(half, y3, e3, moved(s.flux, half, f2), k3, f3);
    const State y4 = plus(s.y, h, k3);
    const Rotation e4 = turned(model.base, y4[kAngle]);
    model.derive<kClamped>(h, y4, e4, moved(s.flux, h, f3), k4, f4);
    for (int n = 0; n < kStates; ++n) {
      end[n] = s.y[n] + h * (1.0 / 6.0) * ((s.slope[n] + k4[n]) + 2.0 * (k2[n] + k3[n]));
    }
  }

  static Pair moved(const Pair& flux, double h, const Pair& slope) {
    return {flux.d + h * slope.d, flux.q + h * slope.q};
  }

  double trial(const Model& model, const SegmentStart& start, double h, State& end, Events& g) {
    step(model, start, h, end);
    model.events(h, end, g);
    return lowest(g);
  }

  /// First zero of the lowest event function in (0, h], at the end of which it is negative.
  Advance locate(const Model& model, const SegmentStart& start, double h, State& end) {
    Events g;
    Bracket b = cell(model, start, h, end, g);
    if (b.g_low <= kMissed) {
      // A current that has just left zero starts at about zero: look for the point from which it comes back.
      for (double probe = 0.5 * b.high; b.g_low <= kMissed; probe *= 0.5) {
        if (probe < kShortest) {  // it goes the wrong way from the start
          trial(model, start, b.high, end, g);
          end = start.y;
          return finish(0.0, g);
        }
        const double value = trial(model, start, probe, end, g);
        if (std::fabs(value) <= kMissed) return finish(probe, g);
        b.take(probe, value);
      }
    }
    return polish(model, start, b, end, g);
  }

  struct Bracket {
    double low, g_low;    // >= 0 here
    double high, g_high;  // < 0 here

    void take(double where, double value) {
      (value < 0.0 ? high : low) = where;
      (value < 0.0 ? g_high : g_low) = value;
    }
    double secant() const { return (low * g_high - high * g_low) / (g_high - g_low); }
  };

  /// The cell of the grid in which the function turns negative: found by bisection between grid points, started where
  /// the secant points, because nearly always the function is nearly straight.
  Bracket cell(const Model& model, const SegmentStart& start, double h, State& end, Events& g) {
    model.events(0.0, start.y, g);
    const double g_start = lowest(g);
    Bracket whole{0.0, g_start, h, trial(model, start, h, end, g)};
    long low = 0, high = static_cast<long>(std::ceil(h / kEventCell));
    Bracket b{0.0, g_start, static_cast<double>(high) * kEventCell, whole.g_high};
    bool high_known = false;  // the value at the grid point beyond h is not that at h
    long probe = static_cast<long>(whole.secant() / kEventCell);
    for (int n = 0; high - low > 1; ++n) {
      if (n > 1 || probe <= low || probe >= high) probe = n == 1 ? low + 1 : (low + high) / 2;
      const double where = static_cast<double>(probe) * kEventCell;
      const double value = trial(model, start, where, end, g);
      b.take(where, value);
      (value < 0.0 ? high : low) = probe;
      high_known |= value < 0.0;
      probe = value < 0.0 ? probe - 1 : probe + 1;
    }
    if (!high_known) b.g_high = trial(model, start, b.high, end, g);
    if (b.g_high >= 0.0) {  // it comes back between h and the grid point
      b.high = h;
      b.g_high = whole.g_high;
    }
    return b;
  }

  /// Illinois method.
  Advance polish(const Model& model, const SegmentStart& start, Bracket b, State& end, Events& g) {
    double where = b.high;
    int side = 0;
    for (int n = 0; n < 100 && b.high - b.low > kShortest; ++n) {
      where = b.secant();
      const double value = trial(model, start, where, end, g);
      if (std::fabs(value) < 0.1 * kMissed) break;
      b.take(where, value);
      const int now = value < 0.0 ? -1 : 1;
      if (now == side) (now < 0 ? b.g_low : b.g_high) *= 0.5;
      side = now;
    }
    return finish(where, g);
  }

  Advance finish(double reached, const Events& g) {
    Advance a;
    a.reached = reached;
    a.event = true;
    a.has_end_slope = true;
    a.end_slope = last_slope_;
    const double lowest_value = lowest(g);
    for (int n = 0; n < kEvents; ++n) a.fired[n] = g[n] < kAtZero || g[n] == lowest_value;
    return a;
  }

  State last_slope_{};  // fourth stage of the last step: the slope at its end to third order
};

}  // namespace

std::unique_ptr<Flow> make_runge_kutta() { return std::make_unique<RungeKutta>(); }

}  // namespace stillspin::plant
