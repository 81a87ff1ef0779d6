// The table of a saturated machine against the machine itself, in double precision.

#include <gtest/gtest.h>

#include <array>

#include "tests/control/quantities.hpp"

namespace {

using namespace stillspin::test;

// A field that stores energy, as in the literature of synchronous machines with a magnet on the d axis:
//   psi_d = lambda + Ld id + k iq^2 / 2,  psi_q = Lq s atan(iq / s) + k id iq.
struct Saturated {
  Motor motor;
  double k = 1.1e-5;   // H/A
  double knee = 22.0;  // A
  double ldq(double iq) const { return k * iq; }
  double lqq(double iq) const { return motor.lq / (1.0 + iq * iq / (knee * knee)); }
  double psi_d(double id, double iq) const { return motor.flux + motor.ld * id + 0.5 * k * iq * iq; }
  double psi_q(double id, double iq) const { return motor.lq * knee * std::atan(iq / knee) + k * id * iq; }

  machine_map_parameters_t table(double current) const {
    machine_map_parameters_t p = {};
    p.current_q20 = raw(current, 20);
    for (int n = 0; n < MACHINE_MAP_POINTS; ++n) {
      const double iq = current * n / MACHINE_MAP_SEGMENTS;
      p.ldd_q30[n] = raw(motor.ld, 30);
      p.lqq_q30[n] = raw(lqq(iq), 30);
      p.ldq_q30[n] = raw(ldq(iq), 30);
    }
    return p;
  }

  // Rotated slope per period, at i_d small enough for Lqq not to depend on it: the equations of the rotor frame.
  Vector slope(Vector i, Vector v, double w) const {
    const Vector u = {v.x - motor.rs * i.x + w * psi_q(i.x, i.y), v.y - motor.rs * i.y - w * psi_d(i.x, i.y)};
    const double a = motor.ld, b = lqq(i.y) + k * i.x, c = ldq(i.y);
    const double det = a * b - c * c;
    const Vector rate = {(b * u.x - c * u.y) / det, (a * u.y - c * u.x) / det};
    return {(rate.x - w * i.y) * kPeriod, (rate.y + w * i.x) * kPeriod};
  }
};

machine_model_t model_with(const Saturated& s, double current) {
  machine_model_t m = model_of(s.motor);
  const machine_map_parameters_t table = s.table(current);
  if (!machine_model_saturate(&m, &table)) throw "map out of range";
  return m;
}

machine_point_t point_at(const machine_map_t& map, std::int32_t iq) {
  machine_slope_t slope;
  return machine_map_at(&map, iq, &slope);
}

TEST(MachineMap, FlatWithoutSaturation) {
  const machine_model_t m = model_of(Motor{});
  for (const double iq : {-30.0, -14.0, -3.0, 0.0, 1.0, 10.0, 40.0}) {
    const machine_point_t p = point_at(m.map, raw(iq, 20));
    EXPECT_EQ(p.ydd_q30, m.yd_q30) << iq;
    EXPECT_EQ(p.yqq_q30, m.yq_q30) << iq;
    EXPECT_EQ(p.ydq_q30, 0) << iq;
    EXPECT_NEAR(real(p.psi_d_q16, 16), 1600.0, 0.01) << iq;
    EXPECT_NEAR(real(p.psi_q_q16, 16), 78.0 * iq, 0.01 + 3e-6 * 78.0 * std::fabs(iq)) << iq;
  }
}

TEST(MachineMap, AdmittanceIsTheInverseOfTheInductance) {
  const Saturated s;
  const machine_model_t m = model_with(s, 14.0);
  for (const double iq : {-14.0, -10.5, -3.5, 0.0, 3.5, 7.0, 14.0}) {
    const machine_point_t p = point_at(m.map, raw(iq, 20));
    const double ydd = real(p.ydd_q30, 30), yqq = real(p.yqq_q30, 30), ydq = real(p.ydq_q30, 30);
    // Y L = T; T is right to 1.7e-6, inductances to 1e-9 H of 5 mH
    EXPECT_NEAR(ydd * s.motor.ld + ydq * s.ldq(iq), kPeriod, 4e-10) << iq;
    EXPECT_NEAR(yqq * s.lqq(iq) + ydq * s.ldq(iq), kPeriod, 4e-10) << iq;
    EXPECT_NEAR(ydd * s.ldq(iq) + ydq * s.lqq(iq), 0.0, 4e-10) << iq;
  }
}

TEST(MachineMap, FluxFollowsFromTheInductances) {
  const Saturated s;
  const machine_model_t m = model_with(s, 14.0);
  for (double iq = -14.0; iq <= 14.0; iq += 0.7) {
    const machine_point_t p = point_at(m.map, raw(iq, 20));
    // straight lines for a curve: a segment's sag is h^2/8 L' = 3.5^2 / 8 * 2 * 7.8e-3 * 14 / 22^2 = 0.7e-3 Vs at most,
    // the trapezoid's own error is a third of that, per segment
    EXPECT_NEAR(real(p.psi_q_q16, 16) * kPeriod, s.psi_q(0.0, iq), 0.8e-3) << iq;
    // the mutual inductance is a straight line: only k h^2/8 = 1.7e-5 Vs between the points
    EXPECT_NEAR(real(p.psi_d_q16, 16) * kPeriod, s.psi_d(0.0, iq), 1.8e-5) << iq;
  }
}

// The whole of machine_model_move: the model's slope is the machine's, for any current near the operating point.
TEST(MachineMap, TheModelsSlopeIsTheMachines) {
  const Saturated s;
  machine_model_t m = model_with(s, 14.0);
  Random random(20);
  for (int n = 0; n < 4000; ++n) {
    const double iq = 3.5 * (random.below(9) - 4);
    machine_model_move(&m, raw(iq, 20));
    const Vector i = {random.between(-0.5, 0.5), iq + random.between(-0.5, 0.5)};
    const Vector v = random.direction(random.between(0.0, 200.0));
    const double w = random.between(-1300.0, 1300.0);
    const dq_t u = {raw(v.x - s.motor.rs * i.x, 16), raw(v.y - s.motor.rs * i.y, 16)};
    const Vector admitted = real(machine_admit_q20(&m, u), 20);
    const Vector h = real(machine_speed_sensitivity_q20(&m, raw_dq(i, 20)), 20);
    const Vector got = admitted + h * (w * kPeriod);
    const Vector exact = s.slope(i, v, w);
    // half an ampere off the point changes Lqq by up to 1.5 %: of |v| T/L + w flux / L; and the flux table's 0.5e-3 Vs
    const double allowed = 2e-3 + 0.006 * exact.length() + 0.02 * std::fabs(w * kPeriod) * s.motor.flux / s.lqq(iq);
    ASSERT_NEAR(got.x, exact.x, allowed) << iq << " A, " << w << " rad/s";
    ASSERT_NEAR(got.y, exact.y, allowed + 0.015 * v.length() * kPeriod / s.lqq(iq)) << iq << " A, " << w << " rad/s";
  }
}

// The same exactly on a point, at the currents of the table: no approximation but the flux's trapezoid.
TEST(MachineMap, OnThePointsTheSlopeIsExact) {
  const Saturated s;
  machine_model_t m = model_with(s, 14.0);
  Random random(21);
  for (int n = 0; n < 4000; ++n) {
    const double iq = 3.5 * (random.below(9) - 4);
    machine_model_move(&m, raw(iq, 20));
    const Vector v = random.direction(random.between(0.0, 200.0));
    const double w = random.between(-1300.0, 1300.0);
    const dq_t u = {raw(v.x, 16), raw(v.y - s.motor.rs * iq, 16)};
    const Vector got = real(machine_admit_q20(&m, u), 20) +
                       real(machine_speed_sensitivity_q20(&m, raw_dq({0.0, iq}, 20)), 20) * (w * kPeriod);
    const Vector exact = s.slope({0.0, iq}, v, w);
    const double flux = 0.5e-3 * std::fabs(w) * kPeriod / s.motor.ld;  // error of psi_q by the trapezoid
    ASSERT_NEAR(got.x, exact.x, 3e-5 + 4e-6 * exact.length() + flux) << iq << " A, " << w << " rad/s";
    ASSERT_NEAR(got.y, exact.y, 3e-5 + 4e-6 * exact.length() + 0.1 * flux) << iq << " A, " << w << " rad/s";
  }
}

// Inductances that are all 30 % off are found at no current, where two numbers tell them; saturated and turned as they
// are at an operating point they must then be right as well.
TEST(MachineMap, InductancesFoundAtNoCurrentHoldUnderLoad) {
  const Saturated told;
  for (const double share : {0.7, 1.3}) {
    Saturated s = told;
    s.motor.ld *= share;
    s.motor.lq *= share;
    s.k *= share;
    machine_model_t m = model_with(told, 14.0);
    const double more = 1.0 / share - 1.0;
    const double yd = kPeriod / told.motor.ld, yq = kPeriod / told.motor.lq;
    machine_model_trim(&m, raw(0.5 * (yd + yq) * more, 30), raw(0.5 * (yd - yq) * more, 30));
    machine_model_settle(&m);
    Random random(22);
    for (int n = 0; n < 1000; ++n) {
      const double iq = 3.5 * (random.below(9) - 4);
      machine_model_move(&m, raw(iq, 20));
      const Vector v = random.direction(random.between(50.0, 200.0));
      const dq_t u = {raw(v.x, 16), raw(v.y - s.motor.rs * iq, 16)};
      const Vector got = real(machine_admit_q20(&m, u), 20);
      const Vector exact = s.slope({0.0, iq}, v, 0.0);
      ASSERT_NEAR(got.x, exact.x, 3e-5 + 1e-5 * exact.length()) << share << ", " << iq << " A";
      ASSERT_NEAR(got.y, exact.y, 3e-5 + 1e-5 * exact.length()) << share << ", " << iq << " A";
    }
  }
}

TEST(MachineMap, RejectsWhatIsNoMachine) {
  const Saturated s;
  machine_model_t m = model_of(s.motor);
  const machine_model_t before = m;
  machine_map_parameters_t p = s.table(14.0);
  EXPECT_TRUE(machine_model_saturate(&m, &p));
  m = before;
  for (const double current : {-1.0, 0.0, 0.9, 101.0}) {
    p = s.table(14.0);
    p.current_q20 = raw(current, 20);
    EXPECT_FALSE(machine_model_saturate(&m, &p)) << current;
  }
  p = s.table(14.0);
  p.ldq_q30[3] = p.ldd_q30[3];  // more mutual than own inductance
  EXPECT_FALSE(machine_model_saturate(&m, &p));
  p = s.table(14.0);
  p.lqq_q30[4] = p.ldd_q30[4] - 1;  // the saliency turned round
  EXPECT_FALSE(machine_model_saturate(&m, &p));
  p = s.table(14.0);
  p.ldd_q30[1] = 0;
  EXPECT_FALSE(machine_model_saturate(&m, &p));
  EXPECT_EQ(point_at(m.map, raw(14.0, 20)).yqq_q30, before.yq_q30);  // the old one is kept
}

// What the formats do not hold is refused: 32000 V for each axis' flux over a period, and an inverse inductance of
// nothing.
TEST(MachineMap, RefusesWhatItsFormatsDoNotHold) {
  const std::int32_t period = raw(kPeriod, 30);
  const machine_map_parameters_t good = Saturated{}.table(14.0);
  machine_map_t map;
  EXPECT_TRUE(machine_map_init(&map, &good, period, raw(1600.0, 16)));
  EXPECT_TRUE(machine_map_init(&map, &good, period, raw(31900.0, 16)));
  EXPECT_FALSE(machine_map_init(&map, &good, period, raw(32001.0, 16)));
  for (const double current : {60.0, 70.0}) {  // 50 mH at these: 30000 and 35000 V
    machine_map_parameters_t wide = good;
    wide.current_q20 = raw(current, 20);
    for (int n = 0; n < MACHINE_MAP_POINTS; ++n) {
      wide.lqq_q30[n] = raw(0.05, 30);
      wide.ldq_q30[n] = 0;
    }
    EXPECT_EQ(machine_map_init(&map, &wide, period, raw(1600.0, 16)), current < 65.0) << current;
  }
  machine_map_parameters_t slow = good;
  for (std::int32_t& lqq : slow.lqq_q30) lqq = INT32_MAX;  // 2 H
  EXPECT_FALSE(machine_map_init(&map, &slow, 0, 0)) << "a period of nothing";
}

// Between its points everything is a straight line, to a digit of the share.
TEST(MachineMap, StraightLinesBetweenThePoints) {
  const Saturated s;
  const machine_model_t m = model_with(s, 14.0);
  Random random(23);
  for (int n = 0; n < 2000; ++n) {
    const std::int32_t iq = raw(random.between(0.0, 13.99), 20);
    const double at = real(iq, 20) * real(m.map.per_segment_q26, 26);
    const auto k = static_cast<int>(at);
    const double share = std::floor((at - k) * 16777216.0) / 16777216.0;
    const machine_point_t p = point_at(m.map, iq);
    const machine_point_t* const a = &m.map.points[k];
    ASSERT_NEAR(p.ydd_q30, a[0].ydd_q30 + share * (a[1].ydd_q30 - a[0].ydd_q30), 1.0);
    ASSERT_NEAR(p.yqq_q30, a[0].yqq_q30 + share * (a[1].yqq_q30 - a[0].yqq_q30), 1.0);
    ASSERT_NEAR(p.ydq_q30, a[0].ydq_q30 + share * (a[1].ydq_q30 - a[0].ydq_q30), 1.0);
  }
}

// Of what a current changes: yqq is even, ydq odd, and neither goes on beyond the last point. In the first segment yqq
// is taken for a parabola; from there on the straight lines are off by what the slope changes in half a
// segment: 3.3e-4.
TEST(MachineMap, TheSlopeIsThatOfTheInverseInductances) {
  const Saturated s;
  const machine_model_t m = model_with(s, 14.0);
  const double segment = 3.5;
  const auto y = [&s](double iq) -> Vector {  // yqq, ydq
    const double a = s.motor.ld, b = s.lqq(iq), c = s.ldq(iq);
    return Vector{a, -c} * (kPeriod / (a * b - c * c));
  };
  for (double iq = -13.9; iq < 14.0; iq += 0.1) {
    machine_slope_t slope;
    (void)machine_map_at(&m.map, raw(iq, 20), &slope);
    const Vector expected = (y(iq + 0.01) - y(iq - 0.01)) * (segment / 0.02);
    EXPECT_NEAR(real(slope.yqq_q30, 30), expected.x, 0.02 * std::abs(expected.x) + 3.3e-4) << iq;
    EXPECT_NEAR(real(slope.ydq_q30, 30), expected.y, 0.02 * std::abs(expected.y) + 1e-4) << iq;
  }
  for (const double iq : {-14.1, 14.1, 40.0}) {
    machine_slope_t slope = {1, 1};
    (void)machine_map_at(&m.map, raw(iq, 20), &slope);
    EXPECT_EQ(slope.yqq_q30, 0) << iq;
    EXPECT_EQ(slope.ydq_q30, 0) << iq;
  }
}

// 0.6 A/V along the axes, 0.45 across; two couplings of opposite sign have a difference.
TEST(MachineMap, AdmittancesEndWithTheEstimatorsFormats) {
  for (const double inductance : {166e-6, 167.5e-6}) {
    machine_map_parameters_t p = Saturated{}.table(14.0);
    for (int n = 0; n < MACHINE_MAP_POINTS; ++n) {
      p.ldd_q30[n] = p.lqq_q30[n] = raw(inductance, 30);
      p.ldq_q30[n] = 0;
    }
    machine_map_t map;
    EXPECT_EQ(machine_map_init(&map, &p, raw(kPeriod, 30), raw(160.0, 16)), inductance > 167e-6);
  }
  machine_map_parameters_t p = Saturated{}.table(14.0);
  const auto couple = [&p](double sign, double inductance) {  // L (1 - 0.95^2)
    for (int n = 0; n < MACHINE_MAP_POINTS; ++n) {
      p.ldd_q30[n] = p.lqq_q30[n] = raw(inductance, 30);
      p.ldq_q30[n] = raw((n % 2 == 0 ? -0.95 : 0.95) * sign * inductance, 30);
    }
  };
  machine_map_t map;
  for (const double sign : {1.0, -1.0}) {
    couple(sign, 2.15e-3);  // 0.48 A/V, 0.453 across
    EXPECT_FALSE(machine_map_init(&map, &p, raw(kPeriod, 30), raw(160.0, 16)));
  }
  couple(1.0, 2.2e-3);  // 0.443
  ASSERT_TRUE(machine_map_init(&map, &p, raw(kPeriod, 30), raw(160.0, 16)));
  EXPECT_NEAR(real(point_at(map, raw(3.5, 20)).ydq_q30, 30), -0.443, 0.005);
  EXPECT_NEAR(real(point_at(map, raw(5.25, 20)).ydq_q30, 30), 0.0, 0.01);
  EXPECT_NEAR(real(point_at(map, raw(7.0, 20)).ydq_q30, 30), 0.443, 0.005);
}

// The mutual inductance must stay below both of the others; Ldd is the smaller one.
TEST(MachineMap, RefusesACouplingAboveTheInductance) {
  for (const double share : {0.99, 1.01, -0.99, -1.01}) {
    machine_map_parameters_t p = Saturated{}.table(14.0);
    p.ldq_q30[2] = static_cast<std::int32_t>(share * p.ldd_q30[2]);
    machine_map_t map;
    EXPECT_EQ(machine_map_init(&map, &p, raw(kPeriod, 30), raw(1600.0, 16)), std::fabs(share) < 1.0) << share;
  }
}

// K = J - Y J Y^-1, what the turning frame makes of a current, at couplings far beyond any machine's: every term
// counts.
TEST(MachineMap, TheTurningFrameSeesTheWholeCoupling) {
  for (const double coupling : {2e-5, 1e-4, 2e-4}) {
    Saturated s;
    s.k = coupling;
    machine_model_t m = model_with(s, 14.0);
    for (const double iq : {-14.0, -7.0, 3.5, 14.0}) {
      machine_model_move(&m, raw(iq, 20));
      const double r = static_cast<double>(m.yd_q30) / m.yq_q30, t = static_cast<double>(m.ydq_q30) / m.yq_q30;
      const double det = r - t * t;
      EXPECT_NEAR(real(m.k_dd_q24, 24), -t * (r + 1.0) / det, 2e-6) << iq;
      EXPECT_NEAR(real(m.k_dq_q24, 24), (r * r + t * t) / det - 1.0, 2e-6) << iq;
      EXPECT_NEAR(real(m.k_qd_q24, 24), 1.0 - (1.0 + t * t) / det, 2e-6) << iq;
    }
  }
}

// K is renewed later than the rest follows the current: what K and k0 make of that current stays what it was, and both
// are then what a move at once would have made of them.
TEST(MachineMap, ASensitivityThatIsRenewedLaterIsThatOfAMoveAtOnce) {
  Saturated s;
  s.k = 1e-4;
  for (const double from : {-14.0, 3.5, 0.0}) {
    for (const double to : {-7.0, 10.5, 14.0}) {
      machine_model_t later = model_with(s, 14.0), at_once = later;
      machine_model_move(&later, raw(from, 20));
      machine_model_follow(&later, raw(to, 20));
      const dq_t there = {0, raw(to, 20)};
      const Vector before = real(machine_speed_sensitivity_q20(&later, there), 20);
      machine_model_renew_sensitivity(&later);
      const Vector after = real(machine_speed_sensitivity_q20(&later, there), 20);
      machine_model_move(&at_once, raw(to, 20));
      EXPECT_NEAR(after.x, before.x, 1e-5) << from << " to " << to;
      EXPECT_NEAR(after.y, before.y, 1e-5) << from << " to " << to;
      EXPECT_EQ(later.k_dd_q24, at_once.k_dd_q24);
      EXPECT_EQ(later.k_dq_q24, at_once.k_dq_q24);
      EXPECT_EQ(later.k_qd_q24, at_once.k_qd_q24);
      EXPECT_NEAR(real(later.k0_q20.d, 20), real(at_once.k0_q20.d, 20), 5e-6) << from << " to " << to;
      EXPECT_NEAR(real(later.k0_q20.q, 20), real(at_once.k0_q20.q, 20), 5e-6) << from << " to " << to;
    }
  }
}

TEST(MachineMap, ItsCurrentIsFromOneToAHundredAmperes) {
  const struct {
    std::int32_t current_q20;
    bool good;
  } cases[] = {{raw(1.0, 20), true}, {raw(1.0, 20) - 1, false}, {raw(100.0, 20), true}, {raw(100.0, 20) + 1, false}};
  for (const auto& c : cases) {
    machine_map_parameters_t p = Saturated{}.table(14.0);
    for (int n = 0; n < MACHINE_MAP_POINTS; ++n) p.ldq_q30[n] = 0;
    p.current_q20 = c.current_q20;
    machine_map_t map;
    EXPECT_EQ(machine_map_init(&map, &p, raw(kPeriod, 30), raw(1600.0, 16)), c.good) << c.current_q20;
  }
}

}  // namespace
