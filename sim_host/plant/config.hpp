// What the plant is made of, in SI units. A default-constructed PlantConfig is motor A in profile `bench` (parameters
// as they truly are, that is with the parameter errors of the profile applied); PlantConfig::ideal() is profile
// `ideal`.
//
// Every field carries its unit and the range that validate() accepts. Plain structs, so that a profile file can fill
// them entry by entry.

#ifndef STILLSPIN_SIM_HOST_PLANT_CONFIG_HPP
#define STILLSPIN_SIM_HOST_PLANT_CONFIG_HPP

#include <array>
#include <cstdint>
#include <string>

namespace stillspin::plant {

using Tick = std::int64_t;  // 10 ns, counted from power-on
inline constexpr double kSecondsPerTick = 1e-8;
inline constexpr Tick kTicksPerSecond = 100'000'000;

/// Interior permanent magnet machine in rotor coordinates, amplitude-invariant (peak) quantities.
struct MachineConfig {
  int pole_pairs = 4;                   // -, 1..50
  double resistance = 0.352;            // Ohm per phase, 1e-4..100
  double inductance_d = 4.655e-3;       // H, 1e-6..1
  double inductance_q = 7.41e-3;        // H at zero current, 1e-6..1
  double magnet_flux = 0.1552;          // Vs peak, 0..10
  double rated_peak_current = 10.8894;  // A peak (7.7 A rms), 0.1..1000: scale of the saturation map
  bool saturation = true;               // false: linear, no cross-coupling (the next entry is ignored)
  double cross_inductance = 1.121e-4;   // H, incremental Ldq at i_q = +rated, odd in i_q, -0.01..0.01
  double emf_harmonic_5 = 0.02;         // fraction of the fundamental EMF, 0..0.3
  double emf_harmonic_7 = 0.01;         // fraction of the fundamental EMF, 0..0.3
  std::string flux_map;                 // path of a table (flux_map.hpp) instead of inductances, saturation, flux
};

/// Shaft. The load torque is not here: see Plant::set_load.
struct MechanicsConfig {
  double inertia = 5.46e-3;         // kg m2, 1e-6..1e6 (a huge one is a speed source)
  double viscous_friction = 0.003;  // N m s/rad, 0..10
  double coulomb_friction = 0.0;    // N m while turning, 0..100
  double stiction = 0.0;            // N m to break loose, coulomb_friction..100 (raised to it when smaller)
  double cogging_torque = 0.1;      // N m peak of sin(6 theta_e), 0..10
  bool locked = false;              // true: the rotor cannot turn (Plant::set_locked changes it)
};

/// One leg's devices. All zero: perfect switches and diodes.
struct InverterConfig {
  double switch_threshold = 1.0;     // V, 0..10
  double switch_resistance = 0.040;  // Ohm, 0..10
  double diode_threshold = 0.9;      // V, 0..10
  double diode_resistance = 0.030;   // Ohm, 0..10
  Tick turn_on_delay = 30;           // ticks from driver input to conduction, 0..1000
  Tick turn_off_delay = 60;          // ticks from driver input to blocking, 0..1000
};

struct DcLinkConfig {
  double source_voltage = 300.0;     // V, 1..2000
  bool stiff = false;                // true: the link is the source itself; resistance, capacitance, rectifier
                                     // and brake are ignored
  double source_resistance = 0.3;    // Ohm, 1e-3..1000
  double capacitance = 2e-3;         // F, 1e-6..1
  double ripple = 0.01;              // peak of the source's ripple, fraction of source_voltage, 0..0.5
  double ripple_frequency = 300.0;   // Hz, 0..5000
  bool rectifier = false;            // true: the source does not sink
  bool brake_chopper = false;        // true: a resistor across the link with hysteresis (for `rectifier`)
  double brake_on_voltage = 400.0;   // V, 1..5000
  double brake_off_voltage = 390.0;  // V, 1..brake_on_voltage
  double brake_resistance = 47.0;    // Ohm, 0.1..10000
};

/// Current sensors of phases a, b (c), then the ADC. One analogue bandwidth for all three.
struct SensorConfig {
  int count = 2;                                       // -, 2 (phases a and b) or 3
  double bandwidth = 150e3;                            // Hz, first order; 0 = ideal, else 1e3..1e8
  std::array<double, 3> gain{1.005, 0.995, 1.003};     // A/A, 0.5..1.5, phases a, b, c
  std::array<double, 3> offset{0.030, -0.020, 0.010};  // A, -5..5
  double ring_amplitude = 0.3;                         // A for an edge of the full source voltage, 0..10
  double ring_frequency = 200e3;                       // Hz, 1e3..5e6
  double ring_decay = 2e-6;                            // s time constant, 1e-8..1e-4
};

struct AdcConfig {
  double current_range = 20.0;   // A: codes 0..4095 are -range..+range, code 2048 = 0 A, 0.1..10000
  double voltage_range = 450.0;  // V: codes 0..4095 are 0..range, 1..5000
  double voltage_gain = 1.01;    // V/V of the link divider, 0.5..1.5
  double noise = 1.2;            // LSB rms, Gaussian, 0..100
  double inl = 1.5;              // LSB peak, smooth over the range, 0..50
  int temperature_code = 1500;   // constant code of the heat-sink channel, 0..4095
  int revision = 3;              // of the chip's silicon: 0, A, B, C are 0..3 (Chip::set_revision)
  std::uint64_t seed = 1;        // any; the same seed gives the same codes
};

enum class Solver {
  kErkStep,     // ERKStep Zonneveld 4(3), adaptive: the work horse
  kRungeKutta,  // fixed RK4, one step per segment: the fast path
  kReference,   // CVODE Adams at 1e-10, step <= 2 us: for tests
};

struct SolverConfig {
  Solver solver = Solver::kRungeKutta;
  double relative_tolerance = 1e-6;  // -, 1e-13..1e-3 (kErkStep)
  Tick max_segment = 2500;           // ticks, 1..10000: longest step between events
  bool ledger = false;               // true: book energies (Plant::energy), costs about half as much again
};

struct InitialState {
  double angle = 0.3;          // rad electrical, -1e3..1e3
  double speed = 0.0;          // rad/s mechanical, -1e4..1e4
  double current_d = 0.0;      // A, -1e4..1e4
  double current_q = 0.0;      // A, -1e4..1e4
  double link_voltage = -1.0;  // V, 0..2000; negative: the source voltage
};

struct PlantConfig {
  MachineConfig machine;
  MechanicsConfig mechanics;
  InverterConfig inverter;
  DcLinkConfig link;
  SensorConfig sensor;
  AdcConfig adc;
  SolverConfig solver;
  InitialState initial;
  int encoder_counts = 4096;  // counts per mechanical turn, 4..1000000

  /// Motor A, profile `ideal`: perfect switches, linear machine with nominal parameters, no sensor error but 12 bit.
  static PlantConfig ideal();

  /// Throws std::invalid_argument naming the entry, its value and the range.
  void validate() const;
};

}  // namespace stillspin::plant

#endif
