// The plant as a whole: determinism, looks that do not disturb, load, friction, encoder, comparator, faults, messages.

#include "sim_host/plant/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "sim_host/plant/portable_math.hpp"
#include "tests/plant/recording.hpp"

namespace stillspin::plant {
namespace {

std::vector<std::uint64_t> trace(const PlantConfig& config, const testing::Recording& r, const std::vector<Tick>& at) {
  Plant plant(config);
  std::vector<std::uint64_t> words;
  testing::replay(plant, r, at, [&](Tick t) {
    words.push_back(plant.adc_code(t, AdcInput::kCurrentA));
    words.push_back(plant.adc_code(t, AdcInput::kCurrentB));
    const PlantState s = plant.state();
    for (const double x : {s.current[0], s.speed_m, s.angle_e, s.link_voltage}) {
      std::uint64_t bits;
      std::memcpy(&bits, &x, sizeof bits);
      words.push_back(bits);
    }
  });
  return words;
}

TEST(Plant, TwoRunsAreByteIdentical) {
  PlantConfig c;
  const testing::Recording r = testing::record_ramp_and_load(c, 300);
  for (Solver solver : {Solver::kRungeKutta, Solver::kErkStep}) {
    c.solver.solver = solver;
    EXPECT_EQ(trace(c, r, {100, 4000}), trace(c, r, {100, 4000}));
  }
  PlantConfig other = c;
  other.adc.seed = 2;
  EXPECT_NE(trace(c, r, {100, 4000}), trace(other, r, {100, 4000}));
}

void look_rarely_and_often(const PlantConfig& c, int periods) {
  const testing::Recording r = testing::record_ramp_and_load(c, periods);
  Plant rarely(c), often(c);
  testing::replay(rarely, r, {9999}, [&](Tick) {});
  std::vector<Tick> at;
  for (Tick t = 0; t < testing::kPeriod; t += 97) at.push_back(t);
  testing::replay(often, r, at, [&](Tick t) {
    often.advance(t);
    often.state();
    often.energy();
    often.current_sensor(1);
  });
  const Tick end = periods * testing::kPeriod;
  rarely.advance(end);
  often.advance(end);
  EXPECT_GT(often.stats().events, 50u) << "events must be among what is compared";
  EXPECT_EQ(rarely.state().current, often.state().current);
  EXPECT_EQ(rarely.state().angle_m, often.state().angle_m);
  EXPECT_EQ(rarely.current_sensor(0), often.current_sensor(0));
}

// To the last bit: a run must not become another one because somebody records a trace.
TEST(Plant, LookingDoesNotChangeTheTrajectory) {
  PlantConfig c;
  look_rarely_and_often(c, 2000);
  c.solver.solver = Solver::kErkStep;
  look_rarely_and_often(c, 800);
}

TEST(Plant, LoadIsSignedAndPiecewiseLinear) {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.viscous_friction = 0.0;
  Plant plant(c);
  plant.set_load({{1'000'000, 0.0}, {1'500'000, 2.0}, {2'000'000, 2.0}, {2'000'000, -1.0}});
  plant.advance(1'250'000);
  EXPECT_NEAR(plant.state().load, 1.0, 1e-12);
  plant.advance(2'500'000);
  EXPECT_NEAR(plant.state().load, -1.0, 1e-12);
  // Impulse: 2 N m over half of 5 ms, 2 N m over 5 ms, -1 N m over 5 ms; no current can flow (EMF is small).
  EXPECT_NEAR(plant.state().speed_m, -(0.005 + 0.010 - 0.005) / 0.00455, 1e-9);
  plant.set_load({});
  plant.advance(3'000'000);
  EXPECT_NEAR(plant.state().speed_m, -0.010 / 0.00455, 1e-9);
}

TEST(Plant, StictionHoldsAndLetsGo) {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.viscous_friction = 0.0;
  c.mechanics.coulomb_friction = 0.5;
  c.mechanics.stiction = 0.8;
  for (Solver solver : {Solver::kRungeKutta, Solver::kErkStep}) {
    c.solver.solver = solver;
    Plant plant(c);
    plant.set_load({{0, 0.0}, {10'000'000, -1.0}, {15'000'000, -1.0}, {16'000'000, 0.0}});
    plant.advance(7'990'000);
    EXPECT_EQ(plant.state().speed_m, 0.0);
    plant.advance(10'000'000);  // loose at 80 ms: (0.3 + 0.5)/2 N m drive it, mean 0.4 N m over 20 ms
    EXPECT_NEAR(plant.state().speed_m, 0.4 * 0.020 / 0.00455, 1e-6);
    plant.advance(40'000'000);  // the load is gone: Coulomb friction stops it, and it stays
    EXPECT_EQ(plant.state().speed_m, 0.0);
  }
}

TEST(Plant, LockedRotorCanBeFreed) {
  PlantConfig c = PlantConfig::ideal();
  c.initial.speed = 50.0;
  Plant plant(c);
  plant.advance(1000);
  plant.set_locked(true);
  const double angle = plant.state().angle_e;
  plant.set_load({{0, 1.0}});
  plant.advance(1'000'000);
  EXPECT_EQ(plant.state().speed_m, 0.0);
  EXPECT_EQ(plant.state().angle_e, angle);
  plant.set_locked(false);
  plant.advance(2'000'000);
  EXPECT_NEAR(plant.state().speed_m, -1.0 * 0.01 / 0.00455, 0.01);
}

TEST(Plant, EncoderCountsBothWays) {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.inertia = 1e6;
  c.mechanics.viscous_friction = 0.0;
  c.initial.angle = 0.0;
  c.initial.speed = 2.0 * kPi * 10.0;
  Plant forward(c);
  EXPECT_EQ(forward.encoder_count(0), 0);
  EXPECT_EQ(forward.encoder_count(5'000'001), 2048);  // half a turn after 50 ms
  EXPECT_EQ(forward.encoder_count(100'000'001), 40960);
  EXPECT_NEAR(forward.state().angle_m, 2.0 * kPi * 10.0, 1e-6);
  c.initial.speed = -c.initial.speed;
  Plant backward(c);
  EXPECT_EQ(backward.encoder_count(100'000'001), -40961);
}

TEST(Plant, PeakCurrentSinceLastAsked) {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.locked = true;
  c.initial.angle = 0.0;
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  plant.set_gate(0, 2, false, true);
  plant.set_gate(10000, 0, false, true);  // short circuit: the current decays from 4.1 A
  const double peak = plant.take_peak_current(200'000);
  EXPECT_NEAR(peak, 200.0 / 0.32 * -std::expm1(-0.32 / 4.9e-3 * 1e-4), 1e-6);
  const double later = plant.take_peak_current(400'000);
  EXPECT_LT(later, peak);
  EXPECT_GT(later, 0.0);
}

TEST(Plant, OpenPhaseCarriesNothing) {
  PlantConfig c;
  c.mechanics.locked = true;
  c.initial.angle = 0.0;
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  plant.set_gate(0, 2, false, true);
  plant.advance(5000);
  EXPECT_LT(plant.state().current[2], -0.3);
  plant.inject({FaultKind::kOpenPhase, 2, 0.0});
  plant.advance(15000);
  EXPECT_EQ(plant.state().current[2], 0.0);
  EXPECT_GT(plant.state().current[0], 1.0);
  EXPECT_EQ(plant.state().current[0], -plant.state().current[1]);
  plant.clear_faults();
  plant.advance(25000);
  EXPECT_LT(plant.state().current[2], -0.3);
}

TEST(Plant, LinkSagReachesTheLinkThroughItsResistance) {
  PlantConfig c;
  c.link.ripple = 0.0;
  Plant plant(c);
  plant.inject({FaultKind::kLinkSag, 0, 0.5});
  plant.advance(60'000);  // one time constant of 0.3 Ohm and 2 mF
  EXPECT_NEAR(plant.state().link_voltage, 150.0 + 150.0 * std::exp(-1.0), 5e-6);  // RK4, 25 us: (h/RC)^5/120 a step
}

TEST(Plant, RippleOfTheSource) {
  PlantConfig c;
  c.link.stiff = true;
  Plant plant(c);
  for (Tick t : {0, 83'333, 166'667, 250'000, 83'333'333}) {
    plant.advance(t);
    const double expected = 300.0 * (1.0 + 0.01 * std::sin(2.0 * kPi * 300.0 * static_cast<double>(t) * 1e-8));
    EXPECT_NEAR(plant.state().link_voltage, expected, 1e-7) << t;
  }
}

std::string message_of(const PlantConfig& c) {
  try {
    c.validate();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(PlantConfig, MessagesNameEntryValueAndRange) {
  EXPECT_EQ(message_of(PlantConfig{}), "");
  EXPECT_EQ(message_of(PlantConfig::ideal()), "");
  PlantConfig c;
  c.machine.resistance = -0.5;
  EXPECT_EQ(message_of(c), "plant configuration: machine.resistance = -0.5 Ohm is outside 0.0001..100 Ohm");
  c = PlantConfig{};
  c.sensor.gain[1] = std::nan("");
  EXPECT_NE(message_of(c).find("sensor.gain[1]"), std::string::npos);
  c = PlantConfig{};
  c.link.brake_off_voltage = 401.0;
  EXPECT_NE(message_of(c).find("link.brake_off_voltage = 401 V is outside 1..400 V"), std::string::npos);
  c = PlantConfig{};
  c.machine.cross_inductance = 0.009;
  EXPECT_NE(message_of(c).find("machine.cross_inductance"), std::string::npos);
  EXPECT_THROW(Plant{c}, std::invalid_argument);
}

TEST(Plant, RejectsTimeThatGoesBackAndBadIndices) {
  Plant plant{PlantConfig{}};
  plant.advance(100);
  EXPECT_THROW(plant.advance(99), std::invalid_argument);
  EXPECT_THROW(plant.set_gate(100, 3, false, false), std::invalid_argument);
  EXPECT_THROW(plant.current_sensor(-1), std::invalid_argument);
  EXPECT_THROW(plant.set_load({{200, 0.0}, {100, 1.0}}), std::invalid_argument);
}

TEST(Plant, LeavingTheFluxMapIsAnError) {
  PlantConfig c;
  c.mechanics.locked = true;
  c.initial.angle = -0.75 * kPi;  // drives i_d far down and i_q far up
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  plant.set_gate(0, 2, false, true);
  EXPECT_THROW(plant.advance(10'000'000), std::runtime_error);
}

}  // namespace
}  // namespace stillspin::plant
