// The fast path: one classical Runge-Kutta step per segment. Its fourth stage is the slope at the end to third order.
//
// The step carries the flux linkage along with the currents (d psi/dt is known before it is divided by the inductance),
// so that the map, with its arc tangent, is evaluated once per segment; both agree to the order of the method.

#include "sim_host/plant/event_search.hpp"
#include "sim_host/plant/model_core.hpp"

namespace stillspin::plant {
namespace {

class RungeKutta final : public SteppingFlow {
 private:
  void step(const Model& model, const SegmentStart& s, double h, State& end, State& end_slope) override {
    if (model.clamp == Clamp::kNone) {
      if (model.usual()) return stages<0, true>(model, s, h, end, end_slope);
      return stages<0, false>(model, s, h, end, end_slope);
    }
    if (model.clamp == Clamp::kAll) return stages<3, false>(model, s, h, end, end_slope);
    stages<1, false>(model, s, h, end, end_slope);
  }

  template <int kClamped, bool kUsual>
  static void stages(const Model& model, const SegmentStart& s, double h, State& end, State& end_slope) {
    const double half = 0.5 * h;
    const double source = model.source_voltage(half);
    State k2, k3, k4;
    Pair f2, f3, f4;
    const State y2 = s.y + half * s.slope;
    const Rotation e2 = turned(model.base, y2[kAngle]);
    model.derive<kClamped, kUsual>(half, source, y2, e2, moved(s.flux, half, s.flux_slope), k2, f2);
    const State y3 = s.y + half * k2;
    const Rotation e3 = nudged(e2, y3[kAngle] - y2[kAngle]);
    model.derive<kClamped, kUsual>(half, source, y3, e3, moved(s.flux, half, f2), k3, f3);
    const State y4 = s.y + h * k3;
    const Rotation e4 = turned(model.base, y4[kAngle]);
    model.derive<kClamped, kUsual>(h, model.source_voltage(h), y4, e4, moved(s.flux, h, f3), k4, f4);
    end_slope = k4;
    end = s.y + h * (1.0 / 6.0) * ((s.slope + k4) + 2.0 * (k2 + k3));
  }

  static Pair moved(const Pair& flux, double h, const Pair& slope) {
    return {flux.d + h * slope.d, flux.q + h * slope.q};
  }
};

}  // namespace

std::unique_ptr<Flow> make_runge_kutta() { return std::make_unique<RungeKutta>(); }

}  // namespace stillspin::plant
