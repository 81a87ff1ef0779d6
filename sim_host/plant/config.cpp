#include "sim_host/plant/config.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace stillspin::plant {
namespace {

void check(const std::string& name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;  // false for NaN
  std::ostringstream message;
  message << "plant configuration: " << name << " = " << value << ' ' << unit << " is outside " << low << ".." << high
          << ' ' << unit;
  throw std::invalid_argument(message.str());
}

void check_machine(const MachineConfig& m) {
  check("machine.pole_pairs", m.pole_pairs, 1, 50, "");
  check("machine.resistance", m.resistance, 1e-4, 100, "Ohm");
  check("machine.inductance_d", m.inductance_d, 1e-6, 1, "H");
  check("machine.inductance_q", m.inductance_q, 1e-6, 1, "H");
  check("machine.magnet_flux", m.magnet_flux, 0, 10, "Vs");
  check("machine.rated_peak_current", m.rated_peak_current, 0.1, 1000, "A");
  check("machine.cross_inductance", m.cross_inductance, -0.01, 0.01, "H");
  check("machine.emf_harmonic_5", m.emf_harmonic_5, 0, 0.3, "");
  check("machine.emf_harmonic_7", m.emf_harmonic_7, 0, 0.3, "");
  if (!m.saturation || !m.flux_map.empty()) return;
  // At rated current the incremental inductances must still form a positive definite matrix.
  const double product = m.inductance_d * (0.8 * m.inductance_q - std::fabs(m.cross_inductance));
  if (m.cross_inductance * m.cross_inductance >= product) {
    std::ostringstream message;
    message << "plant configuration: machine.cross_inductance = " << m.cross_inductance
            << " H makes the field energy negative at rated current; with inductance_d and inductance_q as given its "
               "square must stay below "
            << product << " H2";
    throw std::invalid_argument(message.str());
  }
}

void check_mechanics(const MechanicsConfig& m) {
  check("mechanics.inertia", m.inertia, 1e-6, 1e6, "kg m2");
  check("mechanics.viscous_friction", m.viscous_friction, 0, 10, "N m s/rad");
  check("mechanics.coulomb_friction", m.coulomb_friction, 0, 100, "N m");
  check("mechanics.stiction", m.stiction, 0, 100, "N m");
  check("mechanics.cogging_torque", m.cogging_torque, 0, 10, "N m");
}

void check_inverter(const InverterConfig& i) {
  check("inverter.switch_threshold", i.switch_threshold, 0, 10, "V");
  check("inverter.switch_resistance", i.switch_resistance, 0, 10, "Ohm");
  check("inverter.diode_threshold", i.diode_threshold, 0, 10, "V");
  check("inverter.diode_resistance", i.diode_resistance, 0, 10, "Ohm");
  check("inverter.turn_on_delay", static_cast<double>(i.turn_on_delay), 0, 1000, "ticks");
  check("inverter.turn_off_delay", static_cast<double>(i.turn_off_delay), 0, 1000, "ticks");
}

void check_link(const DcLinkConfig& l) {
  check("link.source_voltage", l.source_voltage, 1, 2000, "V");
  check("link.source_resistance", l.source_resistance, 1e-3, 1000, "Ohm");
  check("link.capacitance", l.capacitance, 1e-6, 1, "F");
  check("link.ripple", l.ripple, 0, 0.5, "");
  check("link.ripple_frequency", l.ripple_frequency, 0, 5000, "Hz");
  check("link.brake_on_voltage", l.brake_on_voltage, 1, 5000, "V");
  check("link.brake_off_voltage", l.brake_off_voltage, 1, l.brake_on_voltage, "V");
  check("link.brake_resistance", l.brake_resistance, 0.1, 1e4, "Ohm");
}

void check_sensor(const SensorConfig& s) {
  check("sensor.count", s.count, 2, 3, "");
  if (s.bandwidth != 0.0) check("sensor.bandwidth", s.bandwidth, 1e3, 1e8, "Hz");
  for (int k = 0; k < 3; ++k) {
    const std::string index = "[" + std::to_string(k) + "]";
    check("sensor.gain" + index, s.gain[k], 0.5, 1.5, "A/A");
    check("sensor.offset" + index, s.offset[k], -5, 5, "A");
  }
  check("sensor.ring_amplitude", s.ring_amplitude, 0, 10, "A");
  check("sensor.ring_frequency", s.ring_frequency, 1e3, 5e6, "Hz");
  check("sensor.ring_decay", s.ring_decay, 1e-8, 1e-4, "s");
}

void check_adc(const AdcConfig& a) {
  check("adc.current_range", a.current_range, 0.1, 1e4, "A");
  check("adc.voltage_range", a.voltage_range, 1, 5000, "V");
  check("adc.voltage_gain", a.voltage_gain, 0.5, 1.5, "V/V");
  check("adc.noise", a.noise, 0, 100, "LSB");
  check("adc.inl", a.inl, 0, 50, "LSB");
  check("adc.revision", a.revision, 0, 3, "");
  check("adc.temperature_code", a.temperature_code, 0, 4095, "");
}

void check_rest(const PlantConfig& c) {
  check("solver.relative_tolerance", c.solver.relative_tolerance, 1e-13, 1e-3, "");
  check("solver.max_segment", static_cast<double>(c.solver.max_segment), 1, 10000, "ticks");
  check("initial.angle", c.initial.angle, -1e3, 1e3, "rad");
  check("initial.speed", c.initial.speed, -1e4, 1e4, "rad/s");
  check("initial.current_d", c.initial.current_d, -1e4, 1e4, "A");
  check("initial.current_q", c.initial.current_q, -1e4, 1e4, "A");
  if (!(c.initial.link_voltage < 0.0)) check("initial.link_voltage", c.initial.link_voltage, 0, 2000, "V");
  check("encoder_counts", c.encoder_counts, 4, 1000000, "");
}

}  // namespace

void PlantConfig::validate() const {
  check_machine(machine);
  check_mechanics(mechanics);
  check_inverter(inverter);
  check_link(link);
  check_sensor(sensor);
  check_adc(adc);
  check_rest(*this);
}

PlantConfig PlantConfig::ideal() {
  PlantConfig c;
  c.machine.resistance = 0.32;
  c.machine.inductance_d = 4.9e-3;
  c.machine.inductance_q = 7.8e-3;
  c.machine.magnet_flux = 0.16;
  c.machine.saturation = false;
  c.machine.cross_inductance = 0.0;
  c.machine.emf_harmonic_5 = 0.0;
  c.machine.emf_harmonic_7 = 0.0;
  c.mechanics.inertia = 0.00455;
  c.mechanics.cogging_torque = 0.0;
  c.inverter = {0.0, 0.0, 0.0, 0.0, 0, 0};
  c.link.stiff = true;
  c.link.ripple = 0.0;
  c.sensor.bandwidth = 0.0;
  c.sensor.gain = {1.0, 1.0, 1.0};
  c.sensor.offset = {0.0, 0.0, 0.0};
  c.sensor.ring_amplitude = 0.0;
  c.adc.voltage_gain = 1.0;
  c.adc.noise = 0.0;
  c.adc.inl = 0.0;
  return c;
}

}  // namespace stillspin::plant
