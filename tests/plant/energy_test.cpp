// Energy is neither made nor lost: source = losses + shaft + change of what is stored, with everything switched on.
//
// The terms are independent of each other (terminal powers, torque times speed, energies of state), so that a torque
// that does not belong to the flux map, or a harmonic EMF without its torque, breaks the balance.

#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/plant/plant.hpp"
#include "tests/plant/recording.hpp"

namespace stillspin::plant {
namespace {

double sinks(const EnergyLedger& e) {
  return e.source_resistance + e.brake + e.device + e.copper + e.friction + e.load;
}

/// Runs a ramp with load steps; the imbalance relative to the energy that went through the link.
double imbalance(PlantConfig config, EnergyLedger* last) {
  config.solver.ledger = false;
  const testing::Recording r = testing::record_ramp_and_load(config, 2000);
  config.solver.ledger = true;
  Plant plant(config);
  const double stored = plant.energy().stored;
  testing::replay(plant, r, {3333}, [&](Tick t) { plant.advance(t); });
  *last = plant.energy();
  return (last->source - sinks(*last) - (last->stored - stored)) / last->source;
}

// Measured 1e-9: Simpson's rule over segments of at most 25 us, and the steps of the solver. A harmonic torque with the
// wrong sign or a forgotten cogging energy shows as 1e-4 and more.
constexpr double kBalance = 1e-7;

TEST(Energy, BenchProfile) {
  EnergyLedger e;
  EXPECT_NEAR(imbalance(PlantConfig{}, &e), 0.0, kBalance);
  // All terms took part: otherwise the balance says little.
  EXPECT_GT(e.copper, 0.5);
  EXPECT_GT(e.device, 0.5);
  EXPECT_GT(e.friction, 0.5);
  EXPECT_GT(e.load, 5.0);
  EXPECT_GT(e.source_resistance, 0.001);
}

TEST(Energy, StrongHarmonicsCoggingAndCoulombFriction) {
  PlantConfig c;
  c.machine.emf_harmonic_5 = 0.1;
  c.machine.emf_harmonic_7 = 0.05;
  c.mechanics.cogging_torque = 0.5;
  c.mechanics.coulomb_friction = 0.3;
  c.mechanics.stiction = 0.6;
  EnergyLedger e;
  EXPECT_NEAR(imbalance(c, &e), 0.0, kBalance);
}

TEST(Energy, ErkStep) {
  PlantConfig c;
  c.solver.solver = Solver::kErkStep;
  EnergyLedger e;
  EXPECT_NEAR(imbalance(c, &e), 0.0, 1e-6);  // its relative tolerance
}

TEST(Energy, BrakingIntoARectifierLinkThroughTheChopper) {
  PlantConfig c;
  c.link.rectifier = true;
  c.link.brake_chopper = true;
  c.link.brake_on_voltage = 310.0;
  c.link.brake_off_voltage = 305.0;
  c.solver.ledger = false;
  // Up to 150 rad/s, then down: the rotor's energy goes into the capacitor and from there into the resistor.
  const testing::Recording r = testing::record(c, 4000, [](double t) { return t < 0.2 ? 150.0 : 0.0; }, {});
  c.solver.ledger = true;
  Plant plant(c);
  const double stored = plant.energy().stored;
  double highest = 0.0;
  testing::replay(plant, r, {1111, 6666}, [&](Tick t) {
    plant.advance(t);
    highest = std::max(highest, plant.state().link_voltage);
  });
  const EnergyLedger e = plant.energy();
  EXPECT_NEAR((e.source - sinks(e) - (e.stored - stored)) / e.source, 0.0, 1e-6);  // the rectifier has a corner
  EXPECT_GT(e.brake, 5.0);
  EXPECT_GT(highest, 309.0);
  EXPECT_LT(highest, 310.1) << "the chopper did not limit the link";
}

}  // namespace
}  // namespace stillspin::plant
