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
constexpr double kAtZero = 1e-9;      // A or V: reached together with the first one

State plus(const State& y, double h, const State& slope) {
  State r;
  for (int n = 0; n < kStates; ++n) r[n] = y[n] + h * slope[n];
  return r;
}

class RungeKutta final : public Flow {
 public:
  Advance advance(const Model& model, const SegmentStart& start, double h, State& end) override {
    step(model, start, h, end);
    Events g;
    model.events(h, end, g);
    if (lowest(g) >= -kMissed) return {h, false, {}, true, last_slope_};
    return locate(model, start, h, end);
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
    model.derive<kClamped>(half, plus(s.y, half, s.slope), moved(s.flux, half, s.flux_slope), k2, f2);
    model.derive<kClamped>(half, plus(s.y, half, k2), moved(s.flux, half, f2), k3, f3);
    model.derive<kClamped>(h, plus(s.y, h, k3), moved(s.flux, h, f3), k4, f4);
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

  /// First zero of the lowest event function in (0, h], which is negative at h: Illinois on repeated steps.
  Advance locate(const Model& model, const SegmentStart& start, double h, State& end) {
    Events g;
    model.events(0.0, start.y, g);
    double low = 0.0, g_low = lowest(g);
    double high = h;
    double g_high = trial(model, start, h, end, g);
    // A current that has just left zero starts at about zero: look for the point from which it comes back.
    for (double probe = 0.5 * h; g_low <= kMissed && probe > kShortest; probe *= 0.5) {
      const double value = trial(model, start, probe, end, g);
      if (value > kMissed) {
        low = probe;
        g_low = value;
      } else if (value < -kMissed) {
        high = probe;
        g_high = value;
      } else {
        return finish(probe, g);
      }
    }
    if (g_low <= kMissed) {  // it goes the wrong way from the start
      trial(model, start, high, end, g);
      end = start.y;
      return finish(0.0, g);
    }
    double where = high;
    int side = 0;
    for (int n = 0; n < 100 && high - low > kShortest; ++n) {
      where = (low * g_high - high * g_low) / (g_high - g_low);
      const double value = trial(model, start, where, end, g);
      if (std::fabs(value) < 0.1 * kMissed) return finish(where, g);
      if (value < 0.0) {
        high = where;
        g_high = value;
        if (side == -1) g_low *= 0.5;
        side = -1;
      } else {
        low = where;
        g_low = value;
        if (side == 1) g_high *= 0.5;
        side = 1;
      }
    }
    return finish(where, g);
  }

  Advance finish(double reached, const Events& g) {
    Advance a{reached, true, {}, true, last_slope_};
    const double lowest_value = lowest(g);
    for (int n = 0; n < kEvents; ++n) a.fired[n] = g[n] < kAtZero || g[n] == lowest_value;
    return a;
  }

  State last_slope_{};  // fourth stage of the last step: the slope at its end to third order
};

}  // namespace

std::unique_ptr<Flow> make_runge_kutta() { return std::make_unique<RungeKutta>(); }

}  // namespace stillspin::plant
