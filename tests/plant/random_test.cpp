// Random gates at random times (dead times, single pulses, everything off), loads, speeds and configurations: no
// combination of modes may get stuck, energy must balance in each, and two solvers must agree.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim_host/plant/noise.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {
namespace {

class Dice {
 public:
  Dice(int seed, int stream) : noise_(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(stream)) {}
  double fraction() { return static_cast<double>(noise_.bits() >> 11) * 0x1p-53; }
  bool chance(double p) { return fraction() < p; }

 private:
  Noise noise_;
};

PlantConfig random_config(int seed) {
  Dice dice(seed, 1);
  PlantConfig c;
  c.solver.ledger = true;
  c.initial.angle = 6.0 * dice.fraction();
  c.initial.speed = 400.0 * (dice.fraction() - 0.5);  // EMF up to 1.2 times the link voltage
  if (dice.chance(0.2)) c.inverter = {0.0, 0.0, 0.0, 0.0, 30, 60};
  if (dice.chance(0.2)) c.inverter.switch_resistance = c.inverter.diode_resistance = 0.0;
  if (dice.chance(0.2)) c.link.stiff = true;
  if (dice.chance(0.3)) {
    c.link.brake_chopper = true;
    c.link.brake_on_voltage = 320.0;
    c.link.brake_off_voltage = 310.0;
  }
  if (dice.chance(0.2)) {
    c.mechanics.coulomb_friction = 0.5;
    c.initial.speed *= 0.02;
  }
  return c;
}

struct Outcome {
  std::array<double, 3> current;
  double imbalance;  // fraction of the energy moved
  std::uint64_t events;
};

void drive(Plant& plant, Dice dice) {
  int target[3] = {0, 0, 0};
  plant.set_load({{0, 0.0}, {500'000, 10.0 * (dice.fraction() - 0.5)}});
  Tick t = 0;
  while (t < 2'000'000) {
    t += 100 + static_cast<Tick>(3000.0 * dice.fraction() * dice.fraction());
    const int leg = static_cast<int>(3.0 * dice.fraction());
    const int wanted = static_cast<int>(3.0 * dice.fraction()) - 1;
    if (target[leg] != 0) {
      plant.set_gate(t, leg, false, false);
      t += 40 + static_cast<Tick>(200.0 * dice.fraction());
    }
    plant.set_gate(t, leg, wanted > 0, wanted < 0);
    target[leg] = wanted;
    const bool trip = plant.take_peak_current(t) > 25.0;  // as an over-current comparator would
    if (!trip && !dice.chance(0.02)) continue;
    for (int k = 0; k < 3; ++k) {
      plant.set_gate(t, k, false, false);
      target[k] = 0;
    }
    t += static_cast<Tick>(100'000.0 * dice.fraction());
  }
  plant.advance(t + 500);
}

Outcome run(PlantConfig config, Solver solver, int seed) {
  config.solver.solver = solver;
  Plant plant(config);
  const double before = plant.energy().stored;
  drive(plant, Dice(seed, 2));
  EXPECT_FALSE(plant.shoot_through()) << seed;
  const EnergyLedger e = plant.energy();
  const double sinks = e.source_resistance + e.brake + e.device + e.copper + e.friction + e.load;
  const double moved = std::fabs(e.source) + std::fabs(e.stored - before) + std::fabs(e.load) + e.copper;
  return {plant.state().current, (e.source - sinks - (e.stored - before)) / moved, plant.stats().events};
}

TEST(RandomGates, NothingSticksEnergyBalancesSolversAgree) {
  std::uint64_t events = 0;
  for (int seed = 0; seed < 150; ++seed) {
    const PlantConfig config = random_config(seed);
    const Outcome fast = run(config, Solver::kRungeKutta, seed);
    const Outcome adaptive = run(config, Solver::kErkStep, seed);
    EXPECT_LT(std::fabs(fast.imbalance), 1e-6) << seed;
    EXPECT_LT(std::fabs(adaptive.imbalance), 1e-5) << seed;  // a few of its relative tolerances
    for (int k = 0; k < 3; ++k) {
      // Some 200 crossings in 20 ms at up to 30 A, some of them grazing: ten times the figure of the realistic run.
      EXPECT_NEAR(fast.current[k], adaptive.current[k], 1e-4) << seed;
    }
    events += fast.events;
  }
  EXPECT_GT(events, 10000u);
}

}  // namespace
}  // namespace stillspin::plant
