#include "sim_host/plant/plant.hpp"

#include <algorithm>
#include <cmath>

#include "sim_host/plant/plant_engine.hpp"

namespace stillspin::plant {

Plant::Plant(const PlantConfig& config) : impl_(std::make_unique<Impl>(config)) {}
Plant::~Plant() = default;
Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant&&) noexcept = default;

void Plant::set_gate(Tick t, int leg, bool upper, bool lower) {
  check_index("leg", leg);
  impl_->move_to(t);
  impl_->settle(t);
  impl_->gates.set(t, leg, upper, lower);
  impl_->looked_ahead = false;
}

void Plant::advance(Tick t) {
  impl_->move_to(t);
  impl_->integrate_to(t);
}

Tick Plant::now() const { return impl_->now; }

double Plant::current_sensor(int phase) const {
  check_index("phase", phase);
  return impl_->reading(phase);
}

std::uint16_t Plant::adc_code(Tick t, AdcInput input) {
  Impl& plant = *impl_;
  plant.move_to(t);
  if (input == AdcInput::kTemperature) return plant.adc.temperature();
  if (input == AdcInput::kLinkVoltage) {
    plant.integrate_to(t);
    return plant.adc.link_voltage(plant.trajectory.link_voltage_at_offset(plant.trajectory.offset(t)));
  }
  const int phase = static_cast<int>(input) - static_cast<int>(AdcInput::kCurrentA);
  if (phase >= plant.config.sensor.count) return 0;
  return plant.adc.current(phase, plant.reading(phase));
}

PlantState Plant::state() const {
  const State& y = impl_->present();
  const Trajectory& trajectory = impl_->trajectory;
  const Model& model = trajectory.model();
  const double t = trajectory.offset(impl_->now);
  State ignored;
  Probe p;
  model.derive(t, y, ignored, p);
  PlantState s;
  s.tick = impl_->now;
  s.current = p.current;
  s.current_d = y[kId];
  s.current_q = y[kIq];
  s.flux_d = p.flux.d;
  s.flux_q = p.flux.q;
  const double angle = trajectory.angle() + y[kAngle];
  const double turn = std::floor(angle / (2.0 * kPi) + 0.5);
  s.angle_e = angle - 2.0 * kPi * turn;
  s.angle_m = (angle + 2.0 * kPi * static_cast<double>(trajectory.turns())) / impl_->config.machine.pole_pairs;
  s.speed_m = y[kSpeed];
  s.torque = p.torque;
  s.cogging = p.cogging;
  s.load = p.load;
  s.link_voltage = model.link.stiff ? p.source_voltage : y[kLink];
  s.leg_voltage = p.leg_voltage;
  return s;
}

std::int64_t Plant::encoder_count(Tick t) {
  impl_->move_to(t);
  const State& y = impl_->present();
  const Trajectory& trajectory = impl_->trajectory;
  const double turns = static_cast<double>(trajectory.turns()) + (trajectory.angle() + y[kAngle]) / (2.0 * kPi);
  return static_cast<std::int64_t>(std::floor(turns * impl_->config.encoder_counts / impl_->config.machine.pole_pairs));
}

double Plant::take_peak_current(Tick t) {
  impl_->move_to(t);
  const State& y = impl_->present();
  const double here = largest(impl_->trajectory.current(y));
  const double result = std::max(impl_->peak, here);
  impl_->peak = 0.0;
  return result;
}

double Plant::peak_current() const { return impl_->peak; }

std::optional<ShootThrough> Plant::shoot_through() const { return impl_->shoot_through; }

EnergyLedger Plant::energy() const {
  const State& y = impl_->present();
  const Trajectory& trajectory = impl_->trajectory;
  Ledger ledger = impl_->ledger;
  if (impl_->config.solver.ledger) ledger.book(trajectory, trajectory.offset(impl_->now));
  return ledger.read(trajectory.model(), y);
}

PlantStats Plant::stats() const {
  PlantStats s = impl_->stats;
  s.grazing = impl_->trajectory.grazing();
  return s;
}

const PlantConfig& Plant::config() const { return impl_->config; }

}  // namespace stillspin::plant
