// Legs: levels by gate state and direction, diodes that stop conducting at zero current, device delays, shoot-through.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim_host/plant/gates.hpp"
#include "sim_host/plant/plant.hpp"
#include "sim_host/plant/portable_math.hpp"

namespace stillspin::plant {
namespace {

PlantConfig locked_bench() {
  PlantConfig c;
  c.mechanics.locked = true;
  c.link.stiff = true;
  c.link.ripple = 0.0;
  return c;
}

TEST(Conduction, LevelsOfALeg) {
  PlantConfig c = locked_bench();
  c.initial.current_d = 10.0;
  c.initial.angle = 0.0;  // i_a = +10 A, i_b = i_c = -5 A
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  plant.advance(100);
  plant.advance(101);
  const PlantState s = plant.state();
  const double i_a = s.current[0], i_b = s.current[1], i_c = s.current[2];
  EXPECT_NEAR(s.leg_voltage[0], 300.0 - 1.0 - 0.040 * i_a, 1e-9) << "upper switch";
  EXPECT_NEAR(s.leg_voltage[1], 0.0 + 1.0 - 0.040 * i_b, 1e-9) << "lower switch carries negative current";
  EXPECT_NEAR(s.leg_voltage[2], 300.0 + 0.9 - 0.030 * i_c, 1e-9) << "upper diode";
}

TEST(Conduction, DeadTimeKeepsTheDirectionOfTheCurrent) {
  PlantConfig c = locked_bench();
  c.initial.current_d = 10.0;
  c.initial.angle = 0.0;
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.advance(31);
  EXPECT_GT(plant.state().leg_voltage[0], 298.0) << "conducts 0.3 us after its gate";
  plant.set_gate(1000, 0, false, false);
  plant.advance(1059);
  EXPECT_GT(plant.state().leg_voltage[0], 298.0) << "still conducts 0.59 us after its gate went off";
  plant.advance(1061);
  EXPECT_LT(plant.state().leg_voltage[0], 0.0) << "then the current moves to the lower diode";
}

TEST(Conduction, CurrentDiesOutAndStaysExactlyZero) {
  // Gates off with current flowing: the diodes drive it to zero against the link, then nothing conducts.
  PlantConfig c = locked_bench();
  c.initial.current_d = 3.0;
  c.initial.current_q = 1.0;
  Plant plant(c);
  bool one_clamped = false;
  for (Tick t = 0; t <= 20000; t += 10) {
    plant.advance(t);
    const PlantState s = plant.state();
    const int zeros = static_cast<int>(std::count(s.current.begin(), s.current.end(), 0.0));
    one_clamped |= zeros == 1;
    EXPECT_NEAR(s.current[0] + s.current[1] + s.current[2], 0.0, 1e-12);
    for (const double v : s.leg_voltage) {
      EXPECT_GT(v, -0.9 - 0.030 * 4.0);
      EXPECT_LT(v, 300.9 + 0.030 * 4.0);
    }
  }
  EXPECT_TRUE(one_clamped) << "the smallest current must reach zero before the others";
  const PlantState end = plant.state();
  for (const double i : end.current) EXPECT_EQ(i, 0.0);
  EXPECT_EQ(end.current_d, 0.0);
  EXPECT_EQ(end.current_q, 0.0);
}

TEST(Conduction, ClampedLegLetsGoWhenDriven) {
  // One leg off at zero current while the others drive current through themselves: it stays at zero until its gate.
  PlantConfig c = locked_bench();
  c.initial.angle = 0.3;
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  for (Tick t = 40; t <= 3000; t += 37) {
    plant.advance(t);
    const PlantState s = plant.state();
    EXPECT_EQ(s.current[2], 0.0) << t;
    EXPECT_EQ(s.current[0], -s.current[1]) << t;
    EXPECT_GT(s.leg_voltage[2], 0.0);
    EXPECT_LT(s.leg_voltage[2], 300.0);
  }
  EXPECT_GT(plant.state().current[0], 0.5);
  plant.set_gate(3000, 2, false, true);
  plant.advance(5000);
  EXPECT_LT(plant.state().current[2], -0.1);
}

TEST(Conduction, ClampHoldsWhileTheRotorTurns) {
  // The clamp keeps di/dt of the phase at zero, not that of a rotor coordinate. state().current is zero by decree, so
  // look at the rotor currents in mid-segment, before anything is projected.
  PlantConfig c;
  c.link.stiff = true;
  c.initial.speed = 150.0;  // 600 rad/s electrical: without the rotation the current would drift by 1e-2 A
  c.initial.angle = -2.15;  // the EMF of phase c crosses zero: its terminal floats in mid-link
  Plant plant(c);
  plant.set_gate(0, 0, true, false);
  plant.set_gate(0, 1, false, true);
  double largest = 0.0;
  for (Tick t = 30 + 1250; t < 20000; t += 2500) {
    plant.advance(t);
    const PlantState s = plant.state();
    ASSERT_EQ(s.current[2], 0.0) << t;
    const double i_c =
        std::cos(s.angle_e + 2.0 * kPi / 3.0) * s.current_d - std::sin(s.angle_e + 2.0 * kPi / 3.0) * s.current_q;
    EXPECT_NEAR(i_c, 0.0, 1e-8) << t;  // Hermite error over 25 us
    largest = std::max(largest, s.current[0]);
  }
  EXPECT_GT(largest, 1.0);
}

TEST(Conduction, DoubleCrossingInsideOneSegmentIsSeen) {
  // Short circuit at high speed with a dc part of the currents, such that one phase current dips below zero and
  // comes back. In steps of 43 us its ends show nothing of it; for the time of the dip the drops of the leg have the
  // other sign (1.9 V: 0.01 A).
  std::uint64_t grazing = 0;
  double worst = 0.0;
  for (int n = 0; n < 34; ++n) {
    const auto run = [&](Tick segment) {
      PlantConfig c;
      c.mechanics.inertia = 1e6;
      c.link.stiff = true;
      c.initial.speed = 300.0;
      c.machine.saturation = false;           // 80 A are outside of the map
      c.initial.current_d = 44.2 + 2e-3 * n;  // phase c reaches for zero at 6.3 ms
      c.solver.max_segment = segment;
      Plant plant(c);
      for (int leg = 0; leg < 3; ++leg) plant.set_gate(0, leg, false, true);
      plant.advance(700'000);
      grazing += segment > 1000 ? plant.stats().grazing : 0;
      return plant.state().current;
    };
    const auto coarse = run(4300), fine = run(500);
    for (int k = 0; k < 3; ++k) worst = std::max(worst, std::fabs(coarse[k] - fine[k]));
  }
  EXPECT_GT(grazing, 3u) << "the scenario must contain what it tests";
  EXPECT_LT(worst, 5e-4);  // of 60 A: RK4 at 1200 rad/s over 43 us, and a sixth harmonic of 0.31 rad per step
}

TEST(Conduction, FastRotorRectifiesIntoTheLink) {
  PlantConfig c;
  c.mechanics.inertia = 1e6;
  c.link.rectifier = true;
  c.link.ripple = 0.0;
  c.initial.speed = 400.0;  // EMF line to line 430 V peak
  Plant plant(c);
  plant.advance(20'000'000);
  const double link = plant.state().link_voltage;
  const double emf = std::sqrt(3.0) * 1600.0 * c.machine.magnet_flux;
  EXPECT_GT(link, 0.93 * emf);  // charged to the peak of the line voltage (harmonics add to it), less two diodes
  EXPECT_LT(link, 1.05 * emf);
  c.initial.speed = 200.0;  // 215 V: below the link, so the diodes block
  Plant slow(c);
  slow.advance(10'000'000);
  EXPECT_NEAR(slow.state().link_voltage, 300.0, 1e-9);
  EXPECT_EQ(slow.state().current[1], 0.0);
}

TEST(Conduction, PerfectSwitchesNeedNoDirection) {
  PlantConfig c = PlantConfig::ideal();
  c.mechanics.locked = true;
  Plant plant(c);
  for (int leg = 0; leg < 3; ++leg) plant.set_gate(0, leg, leg == 1, leg != 1);
  plant.advance(4000);
  EXPECT_EQ(plant.stats().events, 0u);
  EXPECT_GT(plant.state().current[1], 0.1);
}

TEST(ShootThrough, IsReportedAtTheDeviceNotAtTheGate) {
  Plant plant{PlantConfig{}};
  plant.set_gate(0, 1, false, true);
  plant.set_gate(1000, 1, true, false);  // without dead time: upper on at 1030, lower off at 1060
  plant.advance(1020);
  EXPECT_FALSE(plant.shoot_through());
  plant.advance(2000);
  ASSERT_TRUE(plant.shoot_through());
  EXPECT_EQ(plant.shoot_through()->leg, 1);
  EXPECT_EQ(plant.shoot_through()->tick, 1030);
}

TEST(ShootThrough, DeadTimeOf40TicksIsEnough) {
  Plant plant{PlantConfig{}};
  plant.set_gate(0, 1, false, true);
  plant.set_gate(1000, 1, false, false);
  plant.set_gate(1040, 1, true, false);
  plant.advance(3000);
  EXPECT_FALSE(plant.shoot_through());
}

TEST(Gates, ShortPulsesNeverReachTheDevice) {
  Gates gates(30, 60);
  gates.set(0, 0, true, false);
  gates.set(1000, 0, false, false);  // 25 ticks off: it would go off at 1060 but be on again at 1055
  gates.set(1025, 0, true, false);
  gates.apply(900);
  EXPECT_TRUE(gates.upper(0));
  EXPECT_EQ(gates.next(), kNever);
  gates.set(2000, 0, false, false);  // 40 ticks off: off at 2060, on at 2070
  gates.set(2040, 0, true, false);
  EXPECT_EQ(gates.next(), 2060);
  gates.apply(2060);
  EXPECT_FALSE(gates.upper(0));
  gates.apply(2070);
  EXPECT_TRUE(gates.upper(0));
}

TEST(Gates, ManyChangesMayWait) {
  Gates gates(1000, 1000);
  for (Tick t = 0; t < 900; t += 100) gates.set(t, 2, (t / 100) % 2 == 0, false);
  int changes = 0;
  for (Tick t = gates.next(); t != kNever; t = gates.next()) {
    EXPECT_TRUE(gates.apply(t)[2]);
    ++changes;
  }
  EXPECT_EQ(changes, 9);
  EXPECT_TRUE(gates.upper(2));
}

}  // namespace
}  // namespace stillspin::plant
