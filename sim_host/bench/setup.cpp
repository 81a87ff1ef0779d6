#include "sim_host/bench/setup.hpp"

#include <cmath>
#include <stdexcept>

namespace stillspin::bench {
namespace {

const std::vector<std::string> kSolvers = {"erkstep", "rk4", "reference"};
const std::vector<std::string> kPhases = {"none", "a", "b", "c"};
const std::vector<std::string> kLegs = {"a", "b", "c"};
const std::vector<std::string> kPairs = {"none", "bc", "ca", "ab"};

#define ROW(section, key, unit, kind, minimum, maximum, field, help, choices)                                \
  Entry {                                                                                                    \
    #section, #key, unit, EntryKind::kind, minimum, maximum,                                                 \
        [](const Setup& s) { return static_cast<double>(s.field); },                                         \
        [](Setup& s, double v) { s.field = static_cast<std::decay_t<decltype(s.field)>>(v); }, help, choices \
  }
#define ENTRY(section, key, unit, kind, minimum, maximum, field, help) \
  ROW(section, key, unit, kind, minimum, maximum, field, help, nullptr)
#define CHOICE(section, key, words, field, help) \
  ROW(section, key, "", kChoice, 0, static_cast<double>((words).size() - 1), field, help, &(words))
#define TEXT(section, key, field, help)                                                                        \
  Entry {                                                                                                      \
    #section, #key, "", EntryKind::kText, 0, 0, [](const Setup&) { return 0.0; }, [](Setup&, double) {}, help, \
        nullptr, [](Setup& s) -> std::string& { return s.field; }                                              \
  }
#define AT(key, help) ENTRY(fault, key, "s", kNumber, 0, 3600, fault.key, help)

const std::vector<Entry> kEntries = {
    ENTRY(machine, pole_pairs, "", kWhole, 1, 50, nominal.machine.pole_pairs, "pole pairs"),
    ENTRY(machine, resistance, "ohm", kNumber, 1e-4, 100, nominal.machine.resistance, "nominal stator resistance"),
    ENTRY(machine, inductance_d, "H", kNumber, 1e-6, 1, nominal.machine.inductance_d, "nominal d-axis inductance"),
    ENTRY(machine, inductance_q, "H", kNumber, 1e-6, 1, nominal.machine.inductance_q,
          "nominal q-axis inductance at zero current"),
    ENTRY(machine, magnet_flux, "Vs", kNumber, 0, 10, nominal.machine.magnet_flux, "nominal magnet flux linkage"),
    ENTRY(machine, rated_peak_current, "A", kNumber, 0.1, 1000, nominal.machine.rated_peak_current,
          "scale of the saturation map"),
    ENTRY(machine, saturation, "", kSwitch, 0, 1, nominal.machine.saturation, "saturation with cross-coupling"),
    ENTRY(machine, cross_inductance, "H", kNumber, -0.01, 0.01, nominal.machine.cross_inductance,
          "nominal incremental Ldq at rated i_q"),
    ENTRY(machine, emf_harmonic_5, "", kNumber, 0, 0.3, nominal.machine.emf_harmonic_5, "share of the fundamental EMF"),
    ENTRY(machine, emf_harmonic_7, "", kNumber, 0, 0.3, nominal.machine.emf_harmonic_7, "share of the fundamental EMF"),
    TEXT(machine, flux_map, nominal.machine.flux_map,
         "file of the flux over the currents, in the place of inductances and saturation"),
    ENTRY(mechanics, inertia, "kgm2", kNumber, 1e-6, 100, nominal.mechanics.inertia, "nominal inertia"),
    ENTRY(mechanics, viscous_friction, "Nms", kNumber, 0, 10, nominal.mechanics.viscous_friction, "viscous friction"),
    ENTRY(mechanics, coulomb_friction, "Nm", kNumber, 0, 100, nominal.mechanics.coulomb_friction, "dry friction"),
    ENTRY(mechanics, stiction, "Nm", kNumber, 0, 100, nominal.mechanics.stiction, "torque to break loose"),
    ENTRY(mechanics, cogging_torque, "Nm", kNumber, 0, 10, nominal.mechanics.cogging_torque,
          "cogging, six per pole pair"),
    ENTRY(mechanics, locked, "", kSwitch, 0, 1, nominal.mechanics.locked, "the rotor cannot turn"),
    ENTRY(mechanics, brake_until_run, "", kSwitch, 0, 1, brake_until_run,
          "a holding brake that opens at the end of the start procedure"),
    ENTRY(inverter, switch_threshold, "V", kNumber, 0, 10, nominal.inverter.switch_threshold, "switch on-state drop"),
    ENTRY(inverter, switch_resistance, "ohm", kNumber, 0, 10, nominal.inverter.switch_resistance, "and its slope"),
    ENTRY(inverter, diode_threshold, "V", kNumber, 0, 10, nominal.inverter.diode_threshold, "diode on-state drop"),
    ENTRY(inverter, diode_resistance, "ohm", kNumber, 0, 10, nominal.inverter.diode_resistance, "and its slope"),
    ENTRY(inverter, turn_on_delay, "10ns", kWhole, 0, 1000, nominal.inverter.turn_on_delay,
          "driver input to conduction"),
    ENTRY(inverter, turn_off_delay, "10ns", kWhole, 0, 1000, nominal.inverter.turn_off_delay,
          "driver input to blocking"),
    ENTRY(link, source_voltage, "V", kNumber, 1, 2000, nominal.link.source_voltage, "DC-link source"),
    ENTRY(link, stiff, "", kSwitch, 0, 1, nominal.link.stiff, "the link is the source itself"),
    ENTRY(link, source_resistance, "ohm", kNumber, 1e-3, 1000, nominal.link.source_resistance, "source resistance"),
    ENTRY(link, capacitance, "F", kNumber, 1e-6, 1, nominal.link.capacitance, "link capacitor"),
    ENTRY(link, ripple, "", kNumber, 0, 0.5, nominal.link.ripple, "peak ripple, share of the source voltage"),
    ENTRY(link, ripple_frequency, "Hz", kNumber, 0, 5000, nominal.link.ripple_frequency, "its frequency"),
    ENTRY(link, rectifier, "", kSwitch, 0, 1, nominal.link.rectifier, "the source does not sink"),
    ENTRY(link, brake_chopper, "", kSwitch, 0, 1, nominal.link.brake_chopper, "brake resistor with hysteresis"),
    ENTRY(link, brake_on_voltage, "V", kNumber, 1, 5000, nominal.link.brake_on_voltage, "brake on"),
    ENTRY(link, brake_off_voltage, "V", kNumber, 1, 5000, nominal.link.brake_off_voltage, "brake off"),
    ENTRY(link, brake_resistance, "ohm", kNumber, 0.1, 10000, nominal.link.brake_resistance, "brake resistor"),
    ENTRY(sensor, count, "", kWhole, 2, 3, nominal.sensor.count, "current sensors"),
    ENTRY(sensor, bandwidth, "Hz", kNumber, 0, 1e8, nominal.sensor.bandwidth, "first order; 0 is ideal"),
    ENTRY(sensor, gain_a, "", kNumber, 0.5, 1.5, nominal.sensor.gain[0], "gain of sensor a"),
    ENTRY(sensor, gain_b, "", kNumber, 0.5, 1.5, nominal.sensor.gain[1], "gain of sensor b"),
    ENTRY(sensor, gain_c, "", kNumber, 0.5, 1.5, nominal.sensor.gain[2], "gain of sensor c"),
    ENTRY(sensor, offset_a, "A", kNumber, -5, 5, nominal.sensor.offset[0], "offset of sensor a"),
    ENTRY(sensor, offset_b, "A", kNumber, -5, 5, nominal.sensor.offset[1], "offset of sensor b"),
    ENTRY(sensor, offset_c, "A", kNumber, -5, 5, nominal.sensor.offset[2], "offset of sensor c"),
    ENTRY(sensor, ring_amplitude, "A", kNumber, 0, 10, nominal.sensor.ring_amplitude, "ringing after an edge"),
    ENTRY(sensor, ring_frequency, "Hz", kNumber, 1e3, 5e6, nominal.sensor.ring_frequency, "its frequency"),
    ENTRY(sensor, ring_decay, "s", kNumber, 1e-8, 1e-4, nominal.sensor.ring_decay, "its time constant"),
    ENTRY(adc, current_range, "A", kNumber, 0.1, 10000, nominal.adc.current_range, "codes 0..4095 are -range..range"),
    ENTRY(adc, voltage_range, "V", kNumber, 1, 5000, nominal.adc.voltage_range, "codes 0..4095 are 0..range"),
    ENTRY(adc, voltage_gain, "", kNumber, 0.5, 1.5, nominal.adc.voltage_gain, "gain of the link divider"),
    ENTRY(adc, noise, "LSB", kNumber, 0, 100, nominal.adc.noise, "rms noise of a conversion"),
    ENTRY(adc, inl, "LSB", kNumber, 0, 50, nominal.adc.inl, "integral non-linearity, peak"),
    ENTRY(adc, revision, "", kWhole, 0, 3, nominal.adc.revision, "of the silicon, 0, A, B, C; crosstalk before C"),
    ENTRY(adc, temperature_code, "", kWhole, 0, 4095, nominal.adc.temperature_code, "code of the heat-sink channel"),
    ENTRY(board, bootstrap, "", kSwitch, 0, 1, board.bootstrap, "upper drivers have bootstrap supplies"),
    ENTRY(board, precharge_resistance, "ohm", kNumber, 0, 1e4, board.precharge_resistance,
          "in series with the source until the precharge relay closes; 0: none"),
    ENTRY(board, brake, "", kSwitch, 0, 1, board.brake, "the drive switches the brake resistor"),
    ENTRY(board, enable_stuck, "", kSwitch, 0, 1, board.enable_stuck, "the gate enable passes the gates for ever"),
    CHOICE(wiring, input_a, kLegs, board.input[0], "whose sensor is on the converter's input a"),
    CHOICE(wiring, input_b, kLegs, board.input[1], "whose sensor is on the converter's input b"),
    CHOICE(wiring, motor_crossed, kPairs, board.crossed, "two motor wires are on each other's terminals"),
    ENTRY(initial, link_voltage, "V", kNumber, -1, 2000, nominal.initial.link_voltage,
          "DC link at power-on; negative: that of the source"),
    ENTRY(initial, angle, "rad", kNumber, -1e3, 1e3, nominal.initial.angle, "electrical angle at power-on"),
    ENTRY(initial, speed, "rad/s", kNumber, -1e4, 1e4, nominal.initial.speed, "mechanical speed at power-on"),
    ENTRY(parameter_error, resistance, "", kNumber, -0.9, 5, error.resistance, "true minus nominal, share of nominal"),
    ENTRY(parameter_error, inductance_d, "", kNumber, -0.9, 5, error.inductance_d, "true minus nominal"),
    ENTRY(parameter_error, inductance_q, "", kNumber, -0.9, 5, error.inductance_q, "true minus nominal"),
    ENTRY(parameter_error, magnet_flux, "", kNumber, -0.9, 5, error.magnet_flux, "true minus nominal"),
    ENTRY(parameter_error, inertia, "", kNumber, -0.9, 5, error.inertia, "true minus nominal"),
    CHOICE(fault, open_phase, kPhases, fault.open_phase, "a motor wire breaks"),
    AT(open_phase_at, "when, from the end of the start"),
    CHOICE(fault, stuck_sensor, kPhases, fault.stuck_sensor, "a current sensor sticks"),
    AT(stuck_sensor_at, "when, from the end of the start"),
    ENTRY(fault, stuck_sensor_value, "A", kNumber, -1000, 1000, fault.stuck_sensor_value, "what it then reads"),
    CHOICE(fault, drift_sensor, kPhases, fault.drift_sensor, "a current sensor's offset runs away"),
    AT(drift_sensor_at, "from when, from the end of the start"),
    ENTRY(fault, drift_sensor_rate, "A/s", kNumber, -1e4, 1e4, fault.drift_sensor_rate, "how fast"),
    CHOICE(fault, gain_sensor, kPhases, fault.gain_sensor, "a current sensor's gain jumps"),
    AT(gain_sensor_at, "when, from the end of the start"),
    ENTRY(fault, gain_sensor_factor, "", kNumber, -10, 10, fault.gain_sensor_factor, "by this factor"),
    ENTRY(fault, link_sag, "", kNumber, 0, 2, fault.link_sag, "factor on the source voltage; 1 is none"),
    AT(link_sag_at, "when, from the end of the start"),
    ENTRY(fault, link_sag_time, "s", kNumber, 0, 3600, fault.link_sag_time, "for how long"),
    AT(lost_triggers_at, "from when the ADC is not triggered, from the end of the start"),
    ENTRY(fault, lost_triggers_time, "s", kNumber, 0, 3600, fault.lost_triggers_time, "for how long; 0 is never"),
    ENTRY(fault, late_interrupts, "us", kNumber, 0, 95, fault.late_interrupts,
          "interrupts are held off for this long in every period; 0 is none"),
    AT(late_interrupts_at, "from when, from the end of the start"),
    ENTRY(fault, late_interrupts_time, "s", kNumber, 0, 3600, fault.late_interrupts_time, "for how long"),
    ENTRY(fault, blocked_shaft, "", kSwitch, 0, 1, fault.blocked_shaft, "the shaft is held and cannot turn"),
    AT(blocked_shaft_at, "from when, from the end of the start"),
    ENTRY(fault, from_power_on, "", kSwitch, 0, 1, fault.from_power_on,
          "the times of all faults count from power-on, not from the end of the start"),
    CHOICE(solver, method, kSolvers, solver, "erkstep: ARKODE, adaptive; rk4: fixed steps, fast; reference: CVODE"),
    ENTRY(solver, relative_tolerance, "", kNumber, 1e-13, 1e-3, nominal.solver.relative_tolerance, "of erkstep"),
    ENTRY(solver, max_segment, "10ns", kWhole, 1, 10000, nominal.solver.max_segment, "longest step between events"),
};

#undef AT
#undef TEXT
#undef CHOICE
#undef ENTRY
#undef ROW

}  // namespace

const std::vector<Entry>& entries() { return kEntries; }

namespace {

const Entry& entry_of(const std::string& section, const std::string& key) {
  for (const Entry& e : kEntries) {
    if (section == e.section && key == e.key) return e;
  }
  throw std::invalid_argument("there is no plant entry " + section + "." + key);
}

}  // namespace

void set_entry(Setup& setup, const std::string& section, const std::string& key, double value) {
  const Entry& e = entry_of(section, key);
  if (e.kind == EntryKind::kText) throw std::invalid_argument(section + "." + key + ": must be a text");
  if (!std::isfinite(value) || value < e.minimum || value > e.maximum) {
    throw std::invalid_argument(section + "." + key + " = " + std::to_string(value) + " " + e.unit +
                                ": out of range, allowed is " + std::to_string(e.minimum) + " to " +
                                std::to_string(e.maximum));
  }
  e.set(setup, value);
}

void set_entry(Setup& setup, const std::string& section, const std::string& key, const std::string& word) {
  const Entry& e = entry_of(section, key);
  if (e.kind == EntryKind::kText) {
    e.text(setup) = word;
    return;
  }
  const auto count = e.choices == nullptr ? 0 : e.choices->size();
  for (std::size_t n = 0; n < count; ++n) {
    if ((*e.choices)[n] == word) return e.set(setup, static_cast<double>(n));
  }
  throw std::invalid_argument(section + "." + key + " = '" + word + "': not a choice");
}

plant::PlantConfig Setup::plant() const {
  plant::PlantConfig c = nominal;
  c.machine.resistance *= 1.0 + error.resistance;
  c.machine.inductance_d *= 1.0 + error.inductance_d;
  c.machine.inductance_q *= 1.0 + error.inductance_q;
  c.machine.cross_inductance *= 1.0 + error.inductance_q;
  c.machine.magnet_flux *= 1.0 + error.magnet_flux;
  c.mechanics.inertia *= 1.0 + error.inertia;
  constexpr plant::Solver kMethods[] = {plant::Solver::kErkStep, plant::Solver::kRungeKutta, plant::Solver::kReference};
  c.solver.solver = kMethods[static_cast<int>(solver)];
  // The sensor of phase c is there where something is wired to it.
  if (board.crossed != 0 || board.input[0] == 2 || board.input[1] == 2) c.sensor.count = 3;
  c.validate();
  return c;
}

}  // namespace stillspin::bench
