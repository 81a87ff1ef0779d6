#include "tests/plant/recording.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace stillspin::plant::testing {
namespace {

double limited(double x, double limit) { return std::min(std::max(x, -limit), limit); }

/// Speed PI over current PIs, tuned for motor A; nothing to be proud of, it only has to produce plausible edges.
class Controller {
 public:
  /// Voltage in rotor coordinates for the next period.
  std::pair<double, double> step(const PlantState& s, double speed_reference) {
    const double speed_error = speed_reference - s.speed_m;
    speed_sum_ = limited(speed_sum_ + 5.0 * speed_error * kPeriodSeconds, 12.0);
    const double current_q = limited(0.5 * speed_error + speed_sum_, 14.0);
    const double error_d = -s.current_d, error_q = current_q - s.current_q;
    sum_d_ = limited(sum_d_ + 700.0 * error_d * kPeriodSeconds, 100.0);
    sum_q_ = limited(sum_q_ + 700.0 * error_q * kPeriodSeconds, 150.0);
    return {10.0 * error_d + sum_d_, 15.0 * error_q + sum_q_};
  }

 private:
  double speed_sum_ = 0.0, sum_d_ = 0.0, sum_q_ = 0.0;
};

void add_pulse(std::vector<GateEdge>& edges, Tick start, int leg, Tick rise, Tick fall) {
  edges.push_back({start + rise, leg, false, false});
  edges.push_back({start + rise + kDeadTime, leg, true, false});
  edges.push_back({start + fall, leg, false, false});
  edges.push_back({start + fall + kDeadTime, leg, false, true});
}

/// Edges of one period for a voltage in rotor coordinates, centred pulses, common mode in the middle.
void add_period(std::vector<GateEdge>& edges, Tick start, double angle, double link, double vd, double vq) {
  const double alpha = std::cos(angle) * vd - std::sin(angle) * vq;
  const double beta = std::sin(angle) * vd + std::cos(angle) * vq;
  double v[3] = {alpha, -0.5 * alpha + 0.8660254 * beta, -0.5 * alpha - 0.8660254 * beta};
  const double middle = 0.5 * (std::max({v[0], v[1], v[2]}) + std::min({v[0], v[1], v[2]}));
  for (int leg = 0; leg < 3; ++leg) {
    const double duty = std::min(std::max(0.5 + (v[leg] - middle) / link, 0.05), 0.95);
    const Tick half = static_cast<Tick>(std::lround(duty * 0.5 * static_cast<double>(kPeriod)));
    add_pulse(edges, start, leg, kPeriod / 2 - half, kPeriod / 2 + half);
  }
}

void apply(Plant& plant, const std::vector<GateEdge>& edges, std::size_t& next, Tick before) {
  for (; next < edges.size() && edges[next].tick < before; ++next) {
    const GateEdge& e = edges[next];
    plant.set_gate(e.tick, e.leg, e.upper, e.lower);
  }
}

}  // namespace

Recording record(const PlantConfig& config, int periods, const Reference& speed, std::vector<LoadPoint> load) {
  Recording r;
  r.load = std::move(load);
  r.periods = periods;
  Plant plant(config);
  plant.set_load(r.load);
  Controller controller;
  for (int leg = 0; leg < 3; ++leg) r.edges.push_back({kPeriod - 100, leg, false, true});
  std::size_t next = 0;
  double vd = 0.0, vq = 0.0;
  for (int n = 1; n + 1 < periods; ++n) {
    const Tick start = n * kPeriod;
    apply(plant, r.edges, next, start);
    plant.advance(start);
    const PlantState s = plant.state();
    const double angle = s.angle_e + 1.5 * kPeriodSeconds * s.speed_m * config.machine.pole_pairs;
    const std::size_t first = r.edges.size();
    add_period(r.edges, start, angle, s.link_voltage, vd, vq);
    std::stable_sort(r.edges.begin() + static_cast<std::ptrdiff_t>(first), r.edges.end(),
                     [](const GateEdge& a, const GateEdge& b) { return a.tick < b.tick; });
    std::tie(vd, vq) = controller.step(s, speed(static_cast<double>(n) * kPeriodSeconds));
  }
  for (int leg = 0; leg < 3; ++leg) r.edges.push_back({(periods - 1) * kPeriod + 300, leg, false, false});
  return r;
}

Recording record_ramp_and_load(const PlantConfig& config, int periods) {
  const Tick step = static_cast<Tick>(periods) * kPeriod * 6 / 10;
  const double ramp = 0.4 * periods * kPeriodSeconds;
  return record(config, periods, [ramp](double t) { return 100.0 * std::min(t / ramp, 1.0); },
                {{step, 0.0}, {step + 500'000, 3.0}});
}

void replay(Plant& plant, const Recording& recording, const std::vector<Tick>& at,
            const std::function<void(Tick)>& look) {
  plant.set_load(recording.load);
  std::size_t next = 0;
  for (int n = 0; n < recording.periods; ++n) {
    for (const Tick offset : at) {
      const Tick t = n * kPeriod + offset;
      apply(plant, recording.edges, next, t);
      look(t);
    }
  }
  apply(plant, recording.edges, next, recording.periods * kPeriod);
}

}  // namespace stillspin::plant::testing
