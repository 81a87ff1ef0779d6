// A table of flux over current gives back the machine that it was made from, conserves energy, and is refused where no
// machine can have it.

#include "sim_host/plant/flux_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "sim_host/plant/machine.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {
namespace {

// Motor A in profile bench, whose formulas are known, on a table of 15 by 21 currents, or of a step so much finer.
std::vector<FluxPoint> table_of(const Machine& m, bool both_signs, int finer = 1) {
  std::vector<FluxPoint> points;
  for (int a = -7 * finer; a <= 7 * finer; ++a) {
    for (int b = both_signs ? -10 * finer : 0; b <= 10 * finer; ++b) {
      const double id = 3.0 * a / finer, iq = 2.0 * b / finer;
      const Pair f = m.flux(id, iq, m.anchor(iq));
      points.push_back({id, iq, f.d, f.q});
    }
  }
  return points;
}

double worst_between(const Machine& m, const FluxMap& map) {
  double worst = 0.0;
  for (double id : {-13.7, -4.1, 0.4, 8.8}) {
    for (double iq : {-15.3, -3.3, 0.7, 11.1}) {
      const FluxMap::Value v = map.at(id, iq);
      const Pair f = m.flux(id, iq, m.anchor(iq));
      worst = std::max(worst, std::hypot(v.psi_d - f.d, v.psi_q - f.q));
    }
  }
  return worst;
}

std::string file_of(const std::vector<FluxPoint>& points, const std::string& name) {
  const std::string path = testing::TempDir() + name;
  std::ofstream file(path);
  file.precision(17);
  file << "i_d,i_q,psi_d,psi_q\n";
  for (const FluxPoint& p : points) file << p.id << ',' << p.iq << ',' << p.psi_d << ',' << p.psi_q << '\n';
  return path;
}

std::string refusal(const std::vector<FluxPoint>& points) {
  try {
    const FluxMap map(points);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// The slope of a cubic spline is off by the third power of its step, here by a few 1e-6 Vs: half a milliampere.
TEST(FluxMap, GivesBackTheMachineBetweenThePoints) {
  const Machine m{MachineConfig{}};
  const FluxMap coarse(table_of(m, true)), fine(table_of(m, true, 2));
  EXPECT_LT(worst_between(m, coarse), 1e-5);
  EXPECT_LT(worst_between(m, fine), worst_between(m, coarse) / 6.0);
  for (double id : {-13.7, 0.4, 8.8}) {
    for (double iq : {-15.3, 0.7, 11.1}) {
      const FluxMap::Value v = fine.at(id, iq);
      double determinant;
      const Pair s = m.slope(id, iq, {1.0, 0.0}, &determinant);
      EXPECT_NEAR(v.lqq / (v.ldd * v.lqq - v.ldq * v.ldq), s.d, 2e-3 * std::fabs(s.d)) << id << ' ' << iq;
    }
  }
}

TEST(FluxMap, IsTheGradientOfOneEnergy) {
  const FluxMap map(table_of(Machine{MachineConfig{}}, true));
  const double h = 1e-3;
  for (double id : {-11.0, 0.0, 5.3}) {
    for (double iq : {-9.1, 2.2, 14.0}) {
      const FluxMap::Value v = map.at(id, iq);
      EXPECT_NEAR((map.at(id + h, iq).co_energy - map.at(id - h, iq).co_energy) / (2 * h), v.psi_d, 1e-9);
      EXPECT_NEAR((map.at(id, iq + h).co_energy - map.at(id, iq - h).co_energy) / (2 * h), v.psi_q, 1e-9);
      EXPECT_NEAR((map.at(id, iq + h).psi_d - map.at(id, iq - h).psi_d) / (2 * h), v.ldq, 1e-8);
      EXPECT_NEAR((map.at(id + h, iq).psi_q - map.at(id - h, iq).psi_q) / (2 * h), v.ldq, 1e-8);
    }
  }
  EXPECT_NEAR(map.at(0.0, 0.0).co_energy, 0.0, 1e-15);
}

TEST(FluxMap, OneSignOfTheTorqueStandsForBoth) {
  MachineConfig c;
  c.cross_inductance = 0.0;  // odd in i_q: a machine that is symmetrical has it at no current
  const Machine m(c);
  const FluxMap half(table_of(m, false)), whole(table_of(m, true));
  for (double iq : {-17.0, -4.0, 6.0}) {
    EXPECT_NEAR(half.at(-5.0, iq).psi_d, whole.at(-5.0, iq).psi_d, 1e-9);
    EXPECT_NEAR(half.at(-5.0, iq).psi_q, whole.at(-5.0, iq).psi_q, 1e-9);
  }
}

TEST(FluxMap, BeyondTheTableNothingIsKnown) {
  const Machine m{MachineConfig{}};
  MachineConfig c;
  c.flux_map = file_of(table_of(m, true), "whole.csv");
  const Machine mapped(c);
  double determinant;
  (void)mapped.slope(0.0, 19.9, {1.0, 1.0}, &determinant);
  EXPECT_GT(determinant, 0.0);
  (void)mapped.slope(0.0, 20.1, {1.0, 1.0}, &determinant);
  EXPECT_EQ(determinant, 0.0);
}

TEST(FluxMap, WhatNoMachineCanHaveIsRefused) {
  const Machine m{MachineConfig{}};
  std::vector<FluxPoint> points = table_of(m, true);
  points[100].psi_q = std::nan("");
  EXPECT_NE(refusal(points).find("not finite"), std::string::npos);
  points = table_of(m, true);
  for (FluxPoint& p : points) p.psi_d += 0.004 * p.iq;  // a Ldq in one direction only
  EXPECT_NE(refusal(points).find("contradict"), std::string::npos) << refusal(points);
  points = table_of(m, true);
  for (FluxPoint& p : points) std::swap(p.psi_d, p.id);
  EXPECT_NE(refusal(points), "");
  points.resize(10);
  EXPECT_NE(refusal(points).find("too few"), std::string::npos);
  points = table_of(m, true);
  for (FluxPoint& p : points) p.id += 30.0;
  EXPECT_NE(refusal(points).find("zero current"), std::string::npos);
}

TEST(FluxMap, AFileIsReadOrNamedWithItsLine) {
  const std::string path = testing::TempDir() + "wrong.csv";
  std::ofstream(path) << "# mine\ni_d,i_q,psi_d,psi_q\n1,2,3\n";
  const auto words = [&](const std::string& at) -> std::string {
    try {
      (void)FluxMap::read(at);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(words(path).find("line 3"), std::string::npos) << words(path);
  EXPECT_NE(words(path + "x").find("cannot be read"), std::string::npos);
}

// The plant on the table goes the way of the plant on the formulas, and its energies add up.
TEST(FluxMap, ThePlantTurnsAsOnTheFormulas) {
  PlantConfig c;
  c.solver.solver = Solver::kErkStep;
  c.solver.relative_tolerance = 1e-9;
  c.solver.ledger = true;
  c.initial.current_d = -4.0;
  c.initial.current_q = 9.0;
  c.initial.speed = 50.0;
  PlantConfig mapped = c;
  mapped.machine.flux_map = file_of(table_of(Machine{c.machine}, true), "motor_a.csv");
  Plant one(c), other(mapped);
  for (Plant* plant : {&one, &other}) {
    plant->advance(200'000);  // 2 ms on the diodes
  }
  EXPECT_NEAR(one.state().speed_m, other.state().speed_m, 1e-4);
  const EnergyLedger e = other.energy();
  Plant fresh(mapped);
  const double before = fresh.energy().stored;
  EXPECT_NEAR(before + e.source, e.stored + e.source_resistance + e.device + e.copper + e.friction + e.load + e.brake,
              1e-6 * before);
}

}  // namespace
}  // namespace stillspin::plant
