// Linear machine against closed forms: voltage steps on a locked rotor, three-phase short circuit at constant speed.

#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/plant/plant.hpp"
#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {
namespace {

class Transient : public ::testing::TestWithParam<Solver> {
 protected:
  static PlantConfig config() {
    PlantConfig c = PlantConfig::ideal();
    c.solver.solver = GetParam();
    return c;
  }
};

// Reached by every solver with room: RK4 over 25 us leaves (R h/L)^4 = 1e-11 of 30 A here, ERKStep 1e-6 relative.
double tolerance(Solver solver) { return solver == Solver::kErkStep ? 2e-6 : 1e-8; }

TEST_P(Transient, StepOnLockedRotorDAxis) {
  PlantConfig c = config();
  c.mechanics.locked = true;
  c.initial.angle = 0.0;
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  plant.set_gate(0, 2, false, true);
  for (Tick t : {1, 137, 2500, 5000, 12345, 100000}) {
    plant.advance(t);
    const double seconds = static_cast<double>(t) * kSecondsPerTick;
    const double expected = 200.0 / 0.32 * -std::expm1(-0.32 / 4.9e-3 * seconds);
    const PlantState s = plant.state();
    EXPECT_NEAR(s.current_d, expected, tolerance(GetParam()) * (1.0 + expected)) << t;
    EXPECT_NEAR(s.current_q, 0.0, 1e-9) << t;
    EXPECT_NEAR(s.current[0], expected, tolerance(GetParam()) * (1.0 + expected)) << t;
    EXPECT_EQ(s.speed_m, 0.0);
  }
}

TEST_P(Transient, StepOnLockedRotorQAxis) {
  PlantConfig c = config();
  c.mechanics.locked = true;
  c.initial.angle = -0.5 * kPi;  // phase a lies on the q-axis
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  plant.set_gate(0, 2, false, true);
  plant.advance(50000);
  const double expected = 200.0 / 0.32 * -std::expm1(-0.32 / 7.8e-3 * 5e-4);
  const PlantState s = plant.state();
  EXPECT_NEAR(s.current_q, expected, tolerance(GetParam()) * expected);
  EXPECT_NEAR(s.torque, 1.5 * 4 * 0.16 * expected, 1e-5 * expected);
}

TEST_P(Transient, ShortCircuitAtConstantSpeed) {
  PlantConfig c = config();
  c.mechanics.inertia = 1e6;
  c.mechanics.viscous_friction = 0.0;
  c.initial.speed = 100.0;
  Plant plant(c);
  for (int leg = 0; leg < 3; ++leg) plant.set_gate(0, leg, false, true);
  // di/dt = A i + b with A = [-R/Ld, w Lq/Ld; -w Ld/Lq, -R/Lq], b = (0, -w lambda/Lq).
  const double r = 0.32, ld = 4.9e-3, lq = 7.8e-3, flux = 0.16, w = 400.0;
  const double a11 = -r / ld, a12 = w * lq / ld, a21 = -w * ld / lq, a22 = -r / lq;
  const double determinant = a11 * a22 - a12 * a21, b2 = -w * flux / lq;
  const double end_d = a12 * b2 / determinant, end_q = -a11 * b2 / determinant;
  const double mean = 0.5 * (a11 + a22), beat = std::sqrt(determinant - mean * mean);
  for (Tick t : {1000, 54321, 200000, 2'000'000, 20'000'000}) {
    plant.advance(t);
    const double seconds = static_cast<double>(t) * kSecondsPerTick;
    const double decay = std::exp(mean * seconds), c1 = decay * std::cos(beat * seconds),
                 s1 = decay * std::sin(beat * seconds) / beat;
    const double d = end_d - (c1 + s1 * (a11 - mean)) * end_d - s1 * a12 * end_q;
    const double q = end_q - s1 * a21 * end_d - (c1 + s1 * (a22 - mean)) * end_q;
    const PlantState s = plant.state();
    EXPECT_NEAR(s.current_d, d, 5e-6) << t;  // 40 A peak; RK4 at 400 rad/s over 25 us: (w h)^5/120 per step
    EXPECT_NEAR(s.current_q, q, 5e-6) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, Transient,
                         ::testing::Values(Solver::kRungeKutta, Solver::kErkStep, Solver::kReference));

}  // namespace
}  // namespace stillspin::plant
