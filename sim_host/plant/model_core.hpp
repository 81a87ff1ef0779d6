// The right-hand side itself, in a header so that an integrator can inline its stages: one after the other they wait
// for each other's results, side by side the processor overlaps them.

#ifndef STILLSPIN_SIM_HOST_PLANT_MODEL_CORE_HPP
#define STILLSPIN_SIM_HOST_PLANT_MODEL_CORE_HPP

#include "sim_host/plant/model.hpp"

namespace stillspin::plant {

inline double Model::source_voltage(double t) const {
  return link.ripple == 0.0 ? sag * link.source_voltage : rippled_voltage(t);
}

inline double Model::rippled_voltage(double t) const {
  const double x = ripple_speed_ * t;
  const double q = x * x;
  double sine;
  if (q < 2.5e-3) {  // |x| < 0.05: error below 3e-9 of the ripple
    sine = ripple_base.s * (1.0 - q * (0.5 - q * (1.0 / 24))) + ripple_base.c * x * (1.0 - q * (1.0 / 6));
  } else {
    sine = turned(ripple_base, x).s;
  }
  return sag * link.source_voltage * (1.0 + link.ripple * sine);
}

/// Voltage of the clamped leg such that its current stays zero: axis . di/dt + w (d axis/d theta) . i = 0. `u` is what
/// drives the flux with that leg at 0 V on entry, with the leg's voltage on return.
inline double Model::clamp_leg(int leg, const Rotation& e, double electrical_speed, const State& y, Pair& u) const {
  const Pair axis = phase_axis(e, leg);
  double determinant;
  const Pair n = machine.slope(y[kId], y[kIq], axis, &determinant);
  const double moving = electrical_speed * (axis.q * y[kId] - axis.d * y[kIq]);
  const double v = -(n.d * u.d + n.q * u.q + moving) / (2.0 / 3.0 * (axis.d * n.d + axis.q * n.q));
  u.d += 2.0 / 3.0 * v * axis.d;
  u.q += 2.0 / 3.0 * v * axis.q;
  return v;
}

template <int kClamped, bool kUsual, bool kProbe>
[[gnu::always_inline]] inline void Model::core(double t, double source, const State& y, const Rotation& e,
                                               const Pair& psi, State& dy, Pair& dflux, Probe* probe) const {
  const double id = y[kId], iq = y[kIq];
  const double speed = y[kSpeed];
  const double electrical = machine.pole_pairs * speed;
  const double link_voltage = !kUsual && link.stiff ? source : y[kLink];
  Pair h;
  double cogging = 0.0;
  if (kUsual || sixth_) {
    const Rotation six = sixfold(e);
    h = machine.harmonic(six);
    cogging = mechanics.cogging_torque * six.s;
  }
  // Of the flux in the rotor frame without harmonics: d psi/dt = v - R i - w J psi - w h.
  const Pair moving{electrical * (psi.q - h.d), -electrical * (psi.d + h.q)};
  Pair u{0.0, 0.0};
  Pair slope{0.0, 0.0};
  double rail = 0.0;
  double clamped_voltage = 0.0;
  if (kClamped != 3) {
    // The bridge is turned into rotor coordinates, not the current into stator coordinates: what depends on the angle
    // alone is ready early, and little is left between a current and its slope.
    const Bridge& b = bridge_;
    const double rail_d = e.c * b.rail_alpha + e.s * b.rail_beta;
    const double rail_q = e.c * b.rail_beta - e.s * b.rail_alpha;
    const double constant_d = e.c * b.constant_alpha + e.s * b.constant_beta;
    const double constant_q = e.c * b.constant_beta - e.s * b.constant_alpha;
    const double c2 = e.c * e.c - e.s * e.s, s2 = 2.0 * e.s * e.c;
    const double r_plus = b.r_plus * c2 + b.r_cross * s2;
    const double r_cross = b.r_cross * c2 - b.r_plus * s2;
    const double r = machine.resistance + b.r_mean;
    rail = 1.5 * (rail_d * id + rail_q * iq);
    u.d = (rail_d * link_voltage + constant_d) + (moving.d - ((r + r_plus) * id + r_cross * iq));
    u.q = (rail_q * link_voltage + constant_q) + (moving.q - ((r - r_plus) * iq + r_cross * id));
    if (kClamped == 1) clamped_voltage = clamp_leg(static_cast<int>(clamp), e, electrical, y, u);
    double determinant;
    slope = machine.slope(id, iq, u, &determinant);
    if (!(determinant > 0.0)) outside_map(y);
  }
  const double torque = machine.torque(id, iq, psi, h);
  const double applied = load(t);
  double acceleration = 0.0;
  if (kUsual || shaft == Shaft::kFree || shaft == Shaft::kTurning) {
    double total = torque + cogging - applied - mechanics.viscous_friction * speed;
    if (!kUsual && shaft == Shaft::kTurning) total -= turning * mechanics.coulomb_friction;
    acceleration = total * inverse_inertia_;
  }
  double source_current = rail;
  double link_slope = 0.0;
  if (kUsual || !link.stiff) {
    source_current = (source - link_voltage) * inverse_source_resistance_;
    if (!kUsual && link.rectifier && source_current < 0.0) source_current = 0.0;
    double out = rail;
    if (!kUsual && brake) out += link_voltage / link.brake_resistance;
    link_slope = (source_current - out) * inverse_capacitance_;
  }
  dy = {slope.d, slope.q, acceleration, electrical, link_slope};
  dflux = u;
  if (kProbe) {
    const Phases i = currents(e, y);
    Phases v;
    for (int k = 0; k < 3; ++k) v[k] = line_[k].voltage(link_voltage, i[k]);
    if (kClamped == 1) v[static_cast<int>(clamp)] = clamped_voltage;
    if (kClamped == 3) float_legs(link_voltage, e, {-moving.d, -moving.q}, v);
    *probe = {i, v, psi, torque, cogging, applied, source, source_current, rail};
  }
}

template <int kClamped, bool kUsual>
[[gnu::always_inline]] inline void Model::derive(double t, double source, const State& y, const Rotation& e,
                                                 const Pair& psi, State& dy, Pair& dflux) const {
  core<kClamped, kUsual, false>(t, source, y, e, psi, dy, dflux, nullptr);
}

}  // namespace stillspin::plant

#endif
