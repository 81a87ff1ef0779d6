// The flux map is the gradient of one energy, has the saturation and cross-coupling that the profile asks for, and the
// EMF at open terminals has the amplitudes of the harmonics.

#include "sim_host/plant/machine.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {
namespace {

Pair flux_at(const Machine& m, double id, double iq) { return m.flux(id, iq, m.anchor(iq)); }

TEST(Machine, IncrementalInductancesAtRatedCurrent) {
  const MachineConfig c;
  const Machine m(c);
  const double step = 1e-4, iq = c.rated_peak_current;
  const double lqq = (flux_at(m, 0, iq + step).q - flux_at(m, 0, iq - step).q) / (2 * step);
  const double ldq = (flux_at(m, 0, iq + step).d - flux_at(m, 0, iq - step).d) / (2 * step);
  const double lqd = (flux_at(m, step, iq).q - flux_at(m, -step, iq).q) / (2 * step);
  EXPECT_NEAR(lqq, 0.8 * c.inductance_q, 1e-10);  // differences: step^2 curvature and rounding 1e-16/1e-4
  EXPECT_NEAR(ldq, c.cross_inductance, 1e-10);
  EXPECT_NEAR(lqd, c.cross_inductance, 1e-10);
  const double opposite = (flux_at(m, 0, -iq + step).d - flux_at(m, 0, -iq - step).d) / (2 * step);
  EXPECT_NEAR(opposite, -c.cross_inductance, 1e-10) << "the cross inductance is odd in i_q";
}

TEST(Machine, SlopeInvertsTheIncrementalInductance) {
  const Machine m{MachineConfig{}};
  for (double id : {-12.0, -3.0, 0.0, 7.0}) {
    for (double iq : {-14.0, -2.0, 0.0, 5.0, 14.0}) {
      const double step = 1e-4;
      double determinant;
      const Pair r = m.slope(id, iq, {3.0, -5.0}, &determinant);
      EXPECT_GT(determinant, 0.0);
      // Along the direction r the flux must change by (3, -5) per unit.
      const Pair up = flux_at(m, id + step * r.d / 1e3, iq + step * r.q / 1e3);
      const Pair down = flux_at(m, id - step * r.d / 1e3, iq - step * r.q / 1e3);
      EXPECT_NEAR((up.d - down.d) / (2 * step) * 1e3, 3.0, 1e-6) << id << ' ' << iq;
      EXPECT_NEAR((up.q - down.q) / (2 * step) * 1e3, -5.0, 1e-6) << id << ' ' << iq;
    }
  }
}

TEST(Machine, FieldEnergyIsWorkDoneByTheCurrents) {
  const Machine m{MachineConfig{}};
  // 3/2 integral of i . d psi along two different paths to the same point.
  const auto work = [&](bool d_first) {
    constexpr int kSteps = 4000;
    double sum = 0.0;
    double id = 0.0, iq = 0.0;
    for (int leg = 0; leg < 2; ++leg) {
      const bool along_d = (leg == 0) == d_first;
      for (int n = 0; n < kSteps; ++n) {
        const double to_d = along_d ? id - 8.0 / kSteps : id, to_q = along_d ? iq : iq + 12.0 / kSteps;
        const Pair a = flux_at(m, id, iq), b = flux_at(m, to_d, to_q);
        sum += 1.5 * (0.5 * (id + to_d) * (b.d - a.d) + 0.5 * (iq + to_q) * (b.q - a.q));
        id = to_d;
        iq = to_q;
      }
    }
    return sum;
  };
  // Trapezoids: error of (12/4000)^2 relative to curvatures of the map, below 1e-7 J here.
  EXPECT_NEAR(work(true), m.field_energy(-8.0, 12.0), 1e-7);
  EXPECT_NEAR(work(false), m.field_energy(-8.0, 12.0), 1e-7);
  EXPECT_GT(m.field_energy(-8.0, 12.0), 0.5);
}

TEST(Machine, LinearMapWithoutSaturation) {
  MachineConfig c;
  c.saturation = false;
  const Machine m(c);
  const Pair f = flux_at(m, -3.0, 8.0);
  EXPECT_DOUBLE_EQ(f.d, c.magnet_flux - 3.0 * c.inductance_d);
  EXPECT_DOUBLE_EQ(f.q, 8.0 * c.inductance_q);
}

TEST(Machine, OpenCircuitEmfHasTheHarmonics) {
  PlantConfig c;
  c.mechanics.inertia = 1e6;  // a speed source
  c.mechanics.viscous_friction = 0.0;
  c.initial.angle = 0.0;
  c.initial.speed = 2.0 * kPi * 25.0;  // 100 Hz electrical, EMF 97 V: below the link voltage, so nothing conducts
  Plant plant(c);
  constexpr int kPoints = 1000;
  double in_phase[8] = {}, quadrature[8] = {};
  for (int n = 0; n < kPoints; ++n) {
    plant.advance(n * 1000);  // 10 us
    const PlantState s = plant.state();
    const double star = (s.leg_voltage[0] + s.leg_voltage[1] + s.leg_voltage[2]) / 3.0;
    const double v = s.leg_voltage[0] - star;
    for (int h = 1; h < 8; ++h) {
      in_phase[h] += 2.0 / kPoints * v * std::cos(2.0 * kPi * h * n / kPoints);
      quadrature[h] += 2.0 / kPoints * v * std::sin(2.0 * kPi * h * n / kPoints);
    }
    EXPECT_EQ(s.current[0], 0.0);
  }
  const double fundamental = 2.0 * kPi * 100.0 * c.machine.magnet_flux;
  // Phase 0: -sin of every order. Rounding only, since the speed is constant to 1e-9.
  EXPECT_NEAR(quadrature[1], -fundamental, 1e-6);
  EXPECT_NEAR(quadrature[5], -0.02 * fundamental, 1e-6);
  EXPECT_NEAR(quadrature[7], -0.01 * fundamental, 1e-6);
  for (int h : {2, 3, 4, 6}) EXPECT_NEAR(quadrature[h], 0.0, 1e-6) << h;
  for (int h = 1; h < 8; ++h) EXPECT_NEAR(in_phase[h], 0.0, 1e-6) << h;
}

}  // namespace
}  // namespace stillspin::plant
