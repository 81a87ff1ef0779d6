#include "sim_host/plant/ledger.hpp"

#include <cmath>

namespace stillspin::plant {
namespace {

void add(EnergyLedger& sum, const Model& model, double t, const State& y, double weight) {
  State ignored;
  Probe p;
  model.derive(t, y, ignored, p);
  const double link = model.link.stiff ? p.source_voltage : y[kLink];
  double terminal = 0.0;
  for (int k = 0; k < 3; ++k) terminal += p.leg_voltage[k] * p.current[k];
  const double speed = y[kSpeed];
  sum.source += weight * p.source_voltage * p.source_current;
  sum.source_resistance += weight * (p.source_voltage - link) * p.source_current;
  if (model.brake) sum.brake += weight * link * link / model.link.brake_resistance;
  sum.link += weight * link * p.rail_current;
  sum.device += weight * (link * p.rail_current - terminal);
  sum.copper += weight * 1.5 * model.machine.resistance * (y[kId] * y[kId] + y[kIq] * y[kIq]);
  double friction = model.mechanics.viscous_friction * speed * speed;
  if (model.shaft == Shaft::kTurning) friction += model.mechanics.coulomb_friction * std::fabs(speed);
  sum.friction += weight * friction;
  sum.load += weight * p.load * speed;
}

}  // namespace

void Ledger::book(const Trajectory& trajectory, double h) {
  const Model& model = trajectory.model();
  add(booked_, model, 0.0, trajectory.at_offset(0.0), h / 6.0);
  add(booked_, model, 0.5 * h, trajectory.at_offset(0.5 * h), h * 4.0 / 6.0);
  add(booked_, model, h, trajectory.at_offset(h), h / 6.0);
}

EnergyLedger Ledger::read(const Model& model, const State& y) const {
  EnergyLedger result = booked_;
  const Rotation six = sixfold(turned(model.base, y[kAngle]));
  result.stored = model.machine.field_energy(y[kId], y[kIq]) + 0.5 * model.mechanics.inertia * y[kSpeed] * y[kSpeed] +
                  model.mechanics.cogging_torque * six.c / (6.0 * model.machine.pole_pairs);
  if (!model.link.stiff) result.stored += 0.5 * model.link.capacitance * y[kLink] * y[kLink];
  return result;
}

}  // namespace stillspin::plant
