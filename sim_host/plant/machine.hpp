// Flux map of the machine in rotor coordinates, from one co-energy so that it conserves energy exactly:
//
//   W'(i) * 2/3 = lambda id + 1/2 Ld id^2 + 1/2 k id iq^2 + F(iq),   F'(x) = 2 Ir Lq atan(x / (2 Ir))
//   psi_d = lambda + Ld id + 1/2 k iq^2          Ldd = Ld
//   psi_q = 2 Ir Lq atan(iq/(2 Ir)) + k id iq    Lqq = Lq/(1 + (iq/(2 Ir))^2) + k id,   Ldq = k iq
//
// At iq = Ir (rated peak current) the incremental Lqq is 20 % below Lq and Ldq is k Ir.
//
// Harmonics of the EMF: a flux that turns against (5th) and with (7th) the rotor,
//   psi_alpha += lambda (a5 cos 5th + a7 cos 7th),  psi_beta += lambda (-a5 sin 5th + a7 sin 7th),
// with a5 = e5/5, a7 = e7/7 for EMF fractions e5, e7. Differentiated and seen from the rotor this EMF per electrical
// speed is (-lambda (e5 + e7) sin 6th, lambda (e7 - e5) cos 6th). The torque follows from dW'/dtheta at constant
// stationary currents: 3/2 pp (psi_d iq - psi_q id + i . emf per speed).
//
// Not valid where the inductance matrix stops being positive definite (far beyond rated current; the model reports it).
//
// Instead of these formulas a table may say the flux (flux_map.hpp); harmonics and all else stay.
// Units: A, Vs, H, J.

#ifndef STILLSPIN_SIM_HOST_PLANT_MACHINE_HPP
#define STILLSPIN_SIM_HOST_PLANT_MACHINE_HPP

#include <memory>

#include "sim_host/plant/config.hpp"
#include "sim_host/plant/flux_map.hpp"
#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {

struct Pair {
  double d = 0.0;
  double q = 0.0;
};

class Machine {
 public:
  /// Reads the table where there is one: std::invalid_argument as FluxMap::read.
  explicit Machine(const MachineConfig& c);

  /// A point on the saturation curve, from which the neighbourhood is cheap to reach.
  struct Anchor {
    double x = 0.0;    // iq / knee
    double arc = 0.0;  // its arc tangent
  };
  Anchor anchor(double iq) const {
    const double x = iq * inverse_knee;
    return {x, arc_tangent(x)};
  }
  Anchor anchor_near(double iq, const Anchor& near) const {
    const double x = iq * inverse_knee;
    return {x, arc_tangent_near(x, near.x, near.arc)};
  }

  /// Flux linkage without harmonics.
  Pair flux(double id, double iq, const Anchor& near) const {
    if (map) return mapped_flux(id, iq);
    const double main =
        inverse_knee > 0.0 ? knee * lq * arc_tangent_near(iq * inverse_knee, near.x, near.arc) : lq * iq;
    return {lambda + ld * id + 0.5 * k * iq * iq, main + k * id * iq};
  }

  /// The same where `at` is the very point.
  Pair flux_at(double id, double iq, const Anchor& at) const {
    if (map) return mapped_flux(id, iq);
    const double main = inverse_knee > 0.0 ? knee * lq * at.arc : lq * iq;
    return {lambda + ld * id + 0.5 * k * iq * iq, main + k * id * iq};
  }

  /// Inverse of the incremental inductance matrix times `u`; determinant_sign <= 0 outside of the map's validity.
  Pair slope(double id, double iq, const Pair& u, double* determinant_sign) const {
    if (map) return mapped_slope(id, iq, u, determinant_sign);
    const double x = iq * inverse_knee;
    const double m = 1.0 + x * x;
    const double lqq_m = lq + k * id * m;  // both divided by m at the end
    const double ldq = k * iq;
    const double determinant_m = ld * lqq_m - ldq * ldq * m;
    const double g = 1.0 / determinant_m;
    *determinant_sign = determinant_m;
    return {(lqq_m * u.d - ldq * m * u.q) * g, (ld * u.q - ldq * u.d) * m * g};
  }

  /// EMF of the harmonics per electrical speed, rotor coordinates; `six` is the rotation by 6 theta.
  Pair harmonic(const Rotation& six) const { return {harmonic_d * six.s, harmonic_q * six.c}; }

  /// N m, without cogging.
  double torque(double id, double iq, const Pair& psi, const Pair& h) const {
    return torque_factor * (psi.d * iq - psi.q * id + id * h.d + iq * h.q);
  }

  /// Energy of the field above that at zero current, J.
  double field_energy(double id, double iq) const {
    if (map) return mapped_energy(id, iq);
    const double x = iq * inverse_knee;
    const double main = inverse_knee > 0.0 ? 0.5 * knee * knee * lq * logarithm(1.0 + x * x) : 0.5 * lq * iq * iq;
    return 1.5 * (0.5 * ld * id * id + k * id * iq * iq + main);
  }

  double pole_pairs;
  double torque_factor;  // 3/2 pole pairs
  double resistance, ld, lq, lambda;
  double k;             // H/A
  double knee;          // A
  double inverse_knee;  // 1/A, 0 = linear
  double harmonic_d, harmonic_q;
  std::shared_ptr<const FluxMap> map;  // null: the formulas

 private:
  Pair mapped_flux(double id, double iq) const;
  Pair mapped_slope(double id, double iq, const Pair& u, double* determinant_sign) const;
  double mapped_energy(double id, double iq) const;
};

}  // namespace stillspin::plant

#endif
