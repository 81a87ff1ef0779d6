#include "sim_host/plant/model.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sim_host/plant/model_core.hpp"

namespace stillspin::plant {

Model::Model(const PlantConfig& c)
    : machine(c.machine),
      mechanics(c.mechanics),
      link(c.link),
      ripple_speed_(2.0 * kPi * c.link.ripple_frequency),
      inverse_inertia_(1.0 / c.mechanics.inertia),
      inverse_capacitance_(1.0 / c.link.capacitance),
      inverse_source_resistance_(1.0 / c.link.source_resistance),
      stiction_(std::max(c.mechanics.stiction, c.mechanics.coulomb_friction)),
      friction_(stiction_ > 0.0),
      sixth_(c.machine.emf_harmonic_5 != 0.0 || c.machine.emf_harmonic_7 != 0.0 || c.mechanics.cogging_torque != 0.0) {
  for (auto& leg : legs) leg = Leg::make(c.inverter, false, false, false);
  if (mechanics.locked) shaft = Shaft::kLocked;
}

/// At rotor position e, with clamped currents at zero to the last bit.
std::array<double, 3> Model::currents(const Rotation& e, const State& y) const {
  auto i = phase_currents(e, y[kId], y[kIq]);
  if (clamp == Clamp::kNone) return i;
  if (clamp == Clamp::kAll) return {0.0, 0.0, 0.0};
  const int k = static_cast<int>(clamp);
  const int m = (k + 1) % 3, n = (k + 2) % 3;
  const double through = 0.5 * (i[m] - i[n]);
  i[k] = 0.0;
  i[m] = through;
  i[n] = -through;
  return i;
}

/// Terminal voltages when no leg conducts: the machine's EMF on a star point in the middle of where it can be.
void Model::float_legs(double link_voltage, const Rotation& e, const Pair& held, Phases& v) const {
  double low = -kInactive, high = kInactive;
  for (int k = 0; k < 3; ++k) {
    const Pair axis = phase_axis(e, k);
    v[k] = axis.d * held.d + axis.q * held.q;
    if (legs[k].open) continue;
    low = std::max(low, legs[k].low.voltage(link_voltage, 0.0) - v[k]);
    high = std::min(high, legs[k].high.voltage(link_voltage, 0.0) - v[k]);
  }
  const double star = low > -kInactive ? 0.5 * (low + high) : 0.0;
  for (double& x : v) x += star;
}

void Model::derive_at_start(const State& y, const Pair& psi, State& dy, Pair& dflux) const {
  const double v = source_voltage(0.0);
  if (clamp == Clamp::kNone) {
    if (usual()) return core<0, true, false>(0.0, v, y, base, psi, dy, dflux, nullptr);
    return core<0, false, false>(0.0, v, y, base, psi, dy, dflux, nullptr);
  }
  if (clamp == Clamp::kAll) return core<3, false, false>(0.0, v, y, base, psi, dy, dflux, nullptr);
  core<1, false, false>(0.0, v, y, base, psi, dy, dflux, nullptr);
}

void Model::derive(double t, const State& y, State& dy) const {
  Pair ignored;
  const Pair psi = flux(y);
  const Rotation e = turned(base, y[kAngle]);
  const double v = source_voltage(t);
  if (clamp == Clamp::kNone) return core<0, false, false>(t, v, y, e, psi, dy, ignored, nullptr);
  if (clamp == Clamp::kAll) return core<3, false, false>(t, v, y, e, psi, dy, ignored, nullptr);
  core<1, false, false>(t, v, y, e, psi, dy, ignored, nullptr);
}

void Model::derive(double t, const State& y, State& dy, Probe& probe) const {
  Pair ignored;
  const Pair psi = flux(y);
  const Rotation e = turned(base, y[kAngle]);
  const double v = source_voltage(t);
  if (clamp == Clamp::kNone) return core<0, false, true>(t, v, y, e, psi, dy, ignored, &probe);
  if (clamp == Clamp::kAll) return core<3, false, true>(t, v, y, e, psi, dy, ignored, &probe);
  core<1, false, true>(t, v, y, e, psi, dy, ignored, &probe);
}

double Model::link_voltage(double t, const State& y) const { return link.stiff ? source_voltage(t) : y[kLink]; }

std::array<double, 3> Model::leg_voltages(const State& y) const {
  if (clamp != Clamp::kNone) {
    State ignored;
    Probe p;
    derive(0.0, y, ignored, p);
    return p.leg_voltage;
  }
  const double v = link_voltage(0.0, y);
  const Phases i = phase_currents(base, y[kId], y[kIq]);
  return {line_[0].voltage(v, i[0]), line_[1].voltage(v, i[1]), line_[2].voltage(v, i[2])};
}

/// Functions of legs that do not conduct: how far the terminal is from the nearest of its two levels.
void Model::leg_events(double t, const State& y, Events& g) const {
  State dy;
  Probe p;
  derive(t, y, dy, p);
  const double v = link_voltage(t, y);
  Phases below, above;  // distance of the terminal from its levels
  for (int k = 0; k < 3; ++k) {
    below[k] = p.leg_voltage[k] - legs[k].low.voltage(v, 0.0);
    above[k] = legs[k].high.voltage(v, 0.0) - p.leg_voltage[k];
  }
  if (clamp != Clamp::kAll) {
    const int k = static_cast<int>(clamp);
    if (legs[k].open) return;
    g[2 * k] = below[k];
    g[2 * k + 1] = above[k];
    return;
  }
  // The star point floats: a current starts when one leg is pushed up while another is pulled down.
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3;
    if (legs[k].open || legs[m].open) continue;
    g[2 * k] = above[k] + below[m];
    g[2 * k + 1] = above[m] + below[k];
  }
}

void Model::events(double t, const State& y, Events& g) const {
  g.fill(kInactive);
  if (clamp != Clamp::kAll) {
    const Phases i = phase_currents(turned(base, y[kAngle]), y[kId], y[kIq]);
    for (int k = 0; k < 3; ++k) {
      if (direction[k] != 0 && !legs[k].perfect) g[2 * k] = direction[k] * i[k];
    }
  }
  if (clamp != Clamp::kNone) leg_events(t, y, g);
  if (shaft == Shaft::kTurning) g[kShaftEvent] = turning * y[kSpeed];
  if (shaft == Shaft::kStuck) {
    State dy;
    Probe p;
    derive(t, y, dy, p);
    g[kShaftEvent] = stiction_ - std::fabs(p.torque + p.cogging - p.load);
  }
  if (link.brake_chopper && !link.stiff) {
    g[kBrakeEvent] = brake ? y[kLink] - link.brake_off_voltage : link.brake_on_voltage - y[kLink];
  }
}

double Model::lowest_event(double t, const State& y) const {
  if (watches_currents_alone()) return lowest_current(turned(base, y[kAngle]), y[kId], y[kIq]);
  Events g;
  events(t, y, g);
  return *std::min_element(g.begin(), g.end());
}

bool Model::far_from_events(const State& y, const State& slope, const State& end_slope, double h) const {
  if (!watches_currents_alone()) return false;
  const double d = std::max(std::fabs(slope[kId]), std::fabs(end_slope[kId]));
  const double q = std::max(std::fabs(slope[kIq]), std::fabs(end_slope[kIq]));
  const double turning_by = std::max(std::fabs(slope[kAngle]), std::fabs(end_slope[kAngle]));
  // Slopes are nearly straight over a segment; a quarter more covers their bend.
  const double reach = 1.25 * h * (d + q + turning_by * (std::fabs(y[kId]) + std::fabs(y[kIq])));
  const Phases i = phase_currents(base, y[kId], y[kIq]);
  return std::fabs(i[0]) > reach && std::fabs(i[1]) > reach && std::fabs(i[2]) > reach;
}

void Model::outside_map(const State& y) const {
  std::ostringstream message;
  message
      << "plant: currents i_d = " << y[kId] << " A, i_q = " << y[kIq]
      << " A are outside of the flux map (its inductance matrix is not positive definite there, or the table ends); "
      << (machine.map ? "widen machine.flux_map" : "switch machine.saturation off") << " or trip the inverter earlier";
  throw std::runtime_error(message.str());
}

}  // namespace stillspin::plant
