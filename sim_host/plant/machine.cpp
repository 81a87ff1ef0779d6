#include "sim_host/plant/machine.hpp"

namespace stillspin::plant {

Machine::Machine(const MachineConfig& c)
    : pole_pairs(c.pole_pairs),
      torque_factor(1.5 * c.pole_pairs),
      resistance(c.resistance),
      ld(c.inductance_d),
      lq(c.inductance_q),
      lambda(c.magnet_flux),
      k(c.saturation ? c.cross_inductance / c.rated_peak_current : 0.0),
      knee(2.0 * c.rated_peak_current),
      inverse_knee(c.saturation ? 1.0 / knee : 0.0),
      harmonic_d(-c.magnet_flux * (c.emf_harmonic_5 + c.emf_harmonic_7)),
      harmonic_q(c.magnet_flux * (c.emf_harmonic_7 - c.emf_harmonic_5)) {
  if (c.flux_map.empty()) return;
  map = FluxMap::read(c.flux_map);
  const FluxMap::Value zero = map->at(0.0, 0.0);
  ld = zero.ldd;
  lq = zero.lqq;
  lambda = zero.psi_d;
  harmonic_d = -lambda * (c.emf_harmonic_5 + c.emf_harmonic_7);
  harmonic_q = lambda * (c.emf_harmonic_7 - c.emf_harmonic_5);
}

Pair Machine::mapped_flux(double id, double iq) const {
  const FluxMap::Value v = map->at(id, iq);
  return {v.psi_d, v.psi_q};
}

Pair Machine::mapped_slope(double id, double iq, const Pair& u, double* determinant_sign) const {
  const FluxMap::Value v = map->at(id, iq);
  const double determinant = v.ldd * v.lqq - v.ldq * v.ldq;
  // Positive definite: the inductance is positive, too. Beyond the table nothing is known.
  *determinant_sign = v.inside && v.ldd > 0.0 ? determinant : 0.0;
  const double g = 1.0 / determinant;
  return {(v.lqq * u.d - v.ldq * u.q) * g, (v.ldd * u.q - v.ldq * u.d) * g};
}

double Machine::mapped_energy(double id, double iq) const {
  const FluxMap::Value v = map->at(id, iq);
  return 1.5 * (v.psi_d * id + v.psi_q * iq - v.co_energy);
}

}  // namespace stillspin::plant
