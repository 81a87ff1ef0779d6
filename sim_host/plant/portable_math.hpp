// Elementary functions whose bits depend on IEEE arithmetic alone.
//
// A C library picks its sin, exp or atan by processor (with or without fused multiply-add) and differs in the last bit;
// a closed loop turns that bit into another ADC code sooner or later. Here: Taylor series on reduced arguments, only
// + - * / sqrt, absolute or relative error below 4e-16 in the stated range.

#ifndef STILLSPIN_SIM_HOST_PLANT_PORTABLE_MATH_HPP
#define STILLSPIN_SIM_HOST_PLANT_PORTABLE_MATH_HPP

#include <cmath>
#include <cstdint>
#include <cstring>

namespace stillspin::plant {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kSqrt3 = 1.73205080756887729353;

struct Rotation {
  double c = 1.0;  // cosine
  double s = 0.0;  // sine
};

/// cos and sin of x, |x| <= pi/4.
inline Rotation reduced_rotation(double x) {
  const double q = x * x;
  const double s =
      x * (1.0 + q * (-1.0 / 6 + q * (1.0 / 120 + q * (-1.0 / 5040 +
                                                       q * (1.0 / 362880 + q * (-1.0 / 39916800 +
                                                                                q * (1.0 / 6227020800.0 -
                                                                                     q * (1.0 / 1307674368000.0))))))));
  const double c =
      1.0 + q * (-0.5 + q * (1.0 / 24 +
                             q * (-1.0 / 720 + q * (1.0 / 40320 +
                                                    q * (-1.0 / 3628800 + q * (1.0 / 479001600.0 +
                                                                               q * (-1.0 / 87178291200.0 +
                                                                                    q * (1.0 / 20922789888000.0))))))));
  return {c, s};
}

/// Nearest whole number, |x| < 2^62. (std::floor is a library call on processors without SSE4.1.)
inline std::int64_t nearest(double x) { return static_cast<std::int64_t>(x < 0.0 ? x - 0.5 : x + 0.5); }

/// cos and sin of x, |x| < 1e4 (reduction loses |x| * 1e-16).
inline Rotation rotation(double x) {
  const std::int64_t quarter = nearest(x * (2.0 / kPi));
  const double n = static_cast<double>(quarter);
  // pi/2 in two parts, so that n * first is exact.
  const double r = (x - n * 1.5707963267341256) - n * 6.077100506506192e-11;
  const Rotation e = reduced_rotation(r);
  switch (quarter & 3) {
    case 0:
      return e;
    case 1:
      return {-e.s, e.c};
    case 2:
      return {-e.c, -e.s};
    default:
      return {e.s, -e.c};
  }
}

/// `e` turned by the angle x. Short series for the small angles of one integration step.
inline Rotation turned(const Rotation& e, double x) {
  const double q = x * x;
  Rotation d;
  if (q < 2.5e-3) {           // |x| < 0.05: the first neglected terms are below 1e-15
    const double q2 = q * q;  // in pairs: half the latency of Horner's rule
    d.s = x * ((1.0 - q * (1.0 / 6)) + q2 * (1.0 / 120 - q * (1.0 / 5040)));
    d.c = (1.0 - q * 0.5) + q2 * (1.0 / 24 - q * (1.0 / 720));
  } else {
    d = rotation(x);
  }
  return {e.c * d.c - e.s * d.s, e.s * d.c + e.c * d.s};
}

/// Same as turned() for an x that is expected to be tiny.
inline Rotation nudged(const Rotation& e, double x) {
  const double q = x * x;
  if (!(q < 1e-9)) return turned(e, x);  // |x| < 3e-5: the first neglected term is below 5e-15
  const double c = 1.0 - 0.5 * q;
  return {c * e.c - x * e.s, c * e.s + x * e.c};
}

/// Same as `e` six times: cos 6x, sin 6x from cos x, sin x.
inline Rotation sixfold(const Rotation& e) {
  const double c2 = e.c * e.c - e.s * e.s;
  const double s2 = 2.0 * e.s * e.c;
  const double c3 = c2 * e.c - s2 * e.s;
  const double s3 = s2 * e.c + c2 * e.s;
  return {c3 * c3 - s3 * s3, 2.0 * s3 * c3};
}

/// e^x, -700 < x < 700.
inline double exponential(double x) {
  const std::int64_t power = nearest(x * 1.4426950408889634);
  const double n = static_cast<double>(power);
  const double r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  double p = 1.0 / 479001600.0 + r * (1.0 / 6227020800.0);
  p = 1.0 / 39916800.0 + r * p;
  p = 1.0 / 3628800.0 + r * p;
  p = 1.0 / 362880.0 + r * p;
  p = 1.0 / 40320.0 + r * p;
  p = 1.0 / 5040.0 + r * p;
  p = 1.0 / 720.0 + r * p;
  p = 1.0 / 120.0 + r * p;
  p = 1.0 / 24.0 + r * p;
  p = 1.0 / 6.0 + r * p;
  p = 0.5 + r * p;
  p = 1.0 + r * p;
  p = 1.0 + r * p;
  const std::uint64_t bits = static_cast<std::uint64_t>(1023 + power) << 52;
  double scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return p * scale;
}

/// Natural logarithm, x > 0 and normal.
inline double logarithm(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // 0.5 <= m < 1; frexp is exact
  if (m < 0.70710678118654752) {
    m *= 2.0;
    --exponent;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double q = s * s;
  double p = 0.0;
  for (int k = 21; k >= 1; k -= 2) p = 1.0 / k + q * p;
  return exponent * 0.69314718055994531 + 2.0 * s * p;
}

/// Arc tangent of x near x0, whose arc tangent is a0.
double arc_tangent(double x);
inline double arc_tangent_near(double x, double x0, double a0) {
  const double z = (x - x0) / (1.0 + x * x0);
  const double q = z * z;
  if (!(q < 0.0025)) return arc_tangent(x);  // |z| < 0.05: the first neglected term is below 3e-16
  return a0 + z * ((1.0 - q * (1.0 / 3)) + q * q * ((1.0 / 5 - q * (1.0 / 7)) + q * q * (1.0 / 9)));
}

/// Arc tangent, any x.
inline double arc_tangent(double x) {
  const double a = std::fabs(x);
  const bool inverted = a > 1.0;
  double u = inverted ? 1.0 / a : a;
  u = u / (1.0 + std::sqrt(1.0 + u * u));  // half the angle, u <= 0.4142
  u = u / (1.0 + std::sqrt(1.0 + u * u));  // a quarter, u <= 0.1989
  const double q = u * u;
  const double p =
      u *
      (1.0 + q * (-1.0 / 3 +
                  q * (1.0 / 5 +
                       q * (-1.0 / 7 +
                            q * (1.0 / 9 +
                                 q * (-1.0 / 11 +
                                      q * (1.0 / 13 +
                                           q * (-1.0 / 15 + q * (1.0 / 17 + q * (-1.0 / 19 + q * (1.0 / 21)))))))))));
  const double angle = inverted ? 0.5 * kPi - 4.0 * p : 4.0 * p;
  return x < 0.0 ? -angle : angle;
}

}  // namespace stillspin::plant

#endif
