// The stator-flux family in double precision, written from the paper's equations (Ton, Hsieh, Chen 2021) alone: SI
// units, one function per equation, its number beside it. What the paper prints wrongly stands here corrected, and as
// printed where a test shows the difference. Nothing here is shared with the firmware.

#ifndef STILLSPIN_TESTS_ESTIMATORS_FLUX_PAPER_HPP
#define STILLSPIN_TESTS_ESTIMATORS_FLUX_PAPER_HPP

#include <cmath>

#include "tests/control/quantities.hpp"

namespace stillspin::test::flux_paper {

/// Motor B of the paper's Table 2 with a surface magnet.
inline Motor motor_b_spm() {
  Motor m = motor_b();
  m.ld = 1.2e-3, m.lq = 1.2e-3;
  return m;
}

inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vector a, Vector b) { return a.x * b.y - a.y * b.x; }
inline double angle(Vector a) { return std::atan2(a.y, a.x); }

/// (3), x along d.
inline Vector flux_dq(const Motor& m, Vector i_dq) { return {m.ld * i_dq.x + m.flux, m.lq * i_dq.y}; }

/// (7a), (7b)
inline double torque_dq(const Motor& m, Vector i) { return 1.5 * m.pole_pairs * (m.flux + (m.ld - m.lq) * i.x) * i.y; }
inline double torque_ab(const Motor& m, Vector flux, Vector i) { return 1.5 * m.pole_pairs * cross(flux, i); }

/// (11), (12)
inline double active_flux_angle(const Motor& m, Vector flux, Vector i) { return angle(flux - i * m.lq); }

/// Currents along and across the stator flux.
inline Vector current_ft(Vector flux, Vector i) {
  return {dot(flux, i) / flux.length(), cross(flux, i) / flux.length()};
}

/// (15)
inline double conv_load_angle(const Motor& m, Vector flux, Vector i) {
  const Vector ft = current_ft(flux, i);
  return std::atan2(m.lq * ft.y, flux.length() - m.lq * ft.x);
}

/// Argument of the root in (27); `d` as corrected, or as printed.
inline double radicand(const Motor& m, double flux, double i, bool printed = false) {
  const double a = m.lq * m.lq - m.ld * m.ld;
  const double d = m.lq * m.lq * m.flux * m.flux / (printed ? a : a * a);
  return m.lq * m.lq / a * i * i - flux * flux / a + d;
}

/// (27); the root's argument is guarded.
inline double id_ipm(const Motor& m, double flux, double i, bool printed = false) {
  const double a = m.lq * m.lq - m.ld * m.ld;
  return m.flux * m.ld / a - std::sqrt(std::fmax(radicand(m, flux, i, printed), 0.0));
}

/// (29)
inline double id_spm(const Motor& m, double flux, double i) {
  return (flux * flux - m.flux * m.flux - m.ld * m.ld * i * i) / (2.0 * m.flux * m.ld);
}

inline double id_of(const Motor& m, double flux, double i) {
  return m.lq > m.ld ? id_ipm(m, flux, i) : id_spm(m, flux, i);
}

/// (30)
inline double iq_of(const Motor& m, double torque, double id) {
  return torque / (1.5 * m.pole_pairs * (m.flux + (m.ld - m.lq) * id));
}

/// (31)
inline double load_angle(const Motor& m, double id, double iq) { return std::atan2(m.lq * iq, m.flux + m.ld * id); }

/// Method 1: (27) or (29), (30), (31). The magnitude is that of the flux seen (PP-01) or the reference's (PP-02).
inline double proposed_load_angle(const Motor& m, Vector flux, Vector i, double magnitude) {
  const double id = id_of(m, magnitude, i.length());
  return load_angle(m, id, iq_of(m, torque_ab(m, flux, i), id));
}

/// (33)
inline double reference_flux(const Motor& m, Vector i_dq) { return flux_dq(m, i_dq).length(); }

/// (34); the sign follows the direction of rotation, as atan does.
inline double phase_compensation(double cutoff, double w) { return -std::atan(cutoff / w); }

/// (36), of the torque's magnitude: saturation does not know its sign.
inline double updated_lq(double lq, double kt, double torque, double rated) {
  return lq / (1.0 + kt * std::fabs(torque) / rated);
}

/// (37): i_dq are the currents fed back, in the frame in use.
inline double flux_change(const Motor& m, Vector flux, Vector i, Vector i_dq) {
  const Vector ft = current_ft(flux, i);
  return (flux.length() - m.lq * ft.x) * i_dq.y / ft.y - (m.flux + m.ld * i_dq.x);
}

/// Fig. 5 as Hu and Wu (1998) have it, method 3: two low-passes and a PI controller of the quadrature of EMF and flux.
/// One step of the classic Runge-Kutta method while the EMF turns evenly.
class HuWu {
 public:
  HuWu(double cutoff, double kp, double ki, Vector flux)
      : cutoff_(cutoff), kp_(kp), s_{{0.0, 0.0}, flux, flux.length() / ki}, ki_(ki) {}
  Vector flux() const { return s_.first + s_.second; }

  template <class Emf>
  void step(double t, double h, const Emf& emf) {
    const State a = rate(s_, emf(t));
    const State b = rate(moved(s_, a, h / 2), emf(t + h / 2));
    const State c = rate(moved(s_, b, h / 2), emf(t + h / 2));
    const State d = rate(moved(s_, c, h), emf(t + h));
    s_ = moved(moved(moved(moved(s_, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
  }

 private:
  struct State {
    Vector first, second;  // low-pass of the EMF, low-pass of the compensation
    double integral;
  };
  static State moved(const State& s, const State& r, double h) {
    return {s.first + r.first * h, s.second + r.second * h, s.integral + r.integral * h};
  }
  State rate(const State& s, Vector emf) const {
    const Vector flux = s.first + s.second;
    const Vector unit = flux * (1.0 / flux.length());
    const double quadrature = dot(emf, unit);
    const double compensation = kp_ * quadrature + ki_ * s.integral;
    return {emf - s.first * cutoff_, (unit * compensation - s.second) * cutoff_, quadrature};
  }
  double cutoff_, kp_;
  State s_;
  double ki_;
};

}  // namespace stillspin::test::flux_paper

#endif
