// Between the firmware's fixed-point numbers and SI units in double precision, and the motor that most tests use.

#ifndef STILLSPIN_TESTS_CONTROL_QUANTITIES_HPP
#define STILLSPIN_TESTS_CONTROL_QUANTITIES_HPP

#include <cmath>
#include <cstdint>
#include <random>

extern "C" {
#include "control/machine_model.h"
}

namespace stillspin::test {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTurn = 2.0 * kPi;
inline constexpr double kDegree = kPi / 180.0;
inline constexpr double kPeriod = 100e-6;  // PWM period, s

/// A raw number with q fraction bits as a double.
inline double real(std::int64_t raw, int q) { return std::ldexp(static_cast<double>(raw), -q); }

/// The nearest raw number with q fraction bits.
inline std::int32_t raw(double x, int q) { return static_cast<std::int32_t>(std::llround(std::ldexp(x, q))); }

/// An angle as a binary angle; whole turns fall away.
inline std::uint32_t bam(double rad) { return static_cast<std::uint32_t>(std::llround(std::ldexp(rad / kTurn, 32))); }

/// A signed binary angle in rad, -pi..pi; also a speed in rad per period.
inline double rad(std::int32_t angle_bam) { return real(angle_bam, 32) * kTurn; }
inline double rad(std::uint32_t angle_bam) { return rad(static_cast<std::int32_t>(angle_bam)); }

/// An electrical speed, rad/s, as binary angle per period, and back.
inline std::int32_t bpp(double rad_per_s) { return raw(rad_per_s * kPeriod / kTurn, 32); }
inline double rad_per_s(std::int32_t speed_bpp) { return rad(speed_bpp) / kPeriod; }

/// Wrapped to -pi..pi.
inline double wrapped(double rad) { return std::remainder(rad, kTurn); }

struct Vector {
  double x, y;
  Vector turned(double angle) const {
    return {x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)};
  }
  Vector operator+(Vector o) const { return {x + o.x, y + o.y}; }
  Vector operator-(Vector o) const { return {x - o.x, y - o.y}; }
  Vector operator*(double k) const { return {x * k, y * k}; }
  double length() const { return std::hypot(x, y); }
};

inline Vector real(ab_t v, int q) { return {real(v.alpha, q), real(v.beta, q)}; }
inline Vector real(dq_t v, int q) { return {real(v.d, q), real(v.q, q)}; }
inline ab_t raw_ab(Vector v, int q) { return {raw(v.x, q), raw(v.y, q)}; }
inline dq_t raw_dq(Vector v, int q) { return {raw(v.x, q), raw(v.y, q)}; }

/// What a slope, A per period, changes a current over so many ticks, as a window has it, and back.
inline ab_t raw_change(Vector slope, int span) { return raw_ab(slope * (span / 10000.0), 19); }
inline Vector slope_from(ab_t change, int span) {
  return Vector{real(change.alpha, 19), real(change.beta, 19)} * (10000.0 / span);
}

/// Motor A of the benches, with SI numbers.
struct Motor {
  double rs = 0.32, ld = 4.9e-3, lq = 7.8e-3, flux = 0.16;
  double inertia = 0.00455, friction = 0.003;
  int pole_pairs = 4;
  double period = kPeriod;

  double electrical(double rpm) const { return rpm / 60.0 * kTurn * pole_pairs; }
  double torque_constant() const { return 1.5 * pole_pairs * flux; }
};

/// Motor B, of the stator-flux paper's Table 2.
inline Motor motor_b() {
  Motor m;
  m.rs = 0.175;
  m.ld = 0.76e-3;
  m.lq = 1.63e-3;
  m.flux = 0.0865;
  m.inertia = 2e-3;
  m.friction = 1e-3;
  return m;
}

inline machine_parameters_t parameters_of(const Motor& m) {
  machine_parameters_t p;
  p.rs_q24 = raw(m.rs, 24);
  p.ld_q30 = raw(m.ld, 30);
  p.lq_q30 = raw(m.lq, 30);
  p.flux_q28 = raw(m.flux, 28);
  p.inertia_q24 = raw(m.inertia, 24);
  p.pole_pairs = m.pole_pairs;
  p.period_us = static_cast<std::int32_t>(std::lround(m.period * 1e6));
  return p;
}

/// The firmware's model of a motor that is known to be in range.
inline machine_model_t model_of(const Motor& motor) {
  machine_model_t m = {};
  const machine_parameters_t p = parameters_of(motor);
  if (!machine_model_init(&m, &p)) throw "motor out of range";
  return m;
}

/// Random numbers that are the same on every machine: no std:: distribution is, so they are made here.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double unit() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  double log_between(double lo, double hi) { return lo * std::pow(hi / lo, unit()); }
  int below(int limit) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(limit)); }
  double normal() { return std::sqrt(-2.0 * std::log(1.0 - unit())) * std::cos(kTurn * unit()); }
  Vector direction(double length) {
    const double a = between(-kPi, kPi);
    return {length * std::cos(a), length * std::sin(a)};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace stillspin::test

#endif
