// The plant: inverter, DC link, machine, shaft, sensors and ADC front end, integrated from edge to edge.
//
// Time is in ticks of 10 ns and never decreases from one call to the next. Everything is lazy: a call integrates only
// as far as its answer needs. Looking (state, sensors, ADC codes, encoder) never changes the trajectory, because steps
// end at edges, zero crossings and every `max_segment` only, never at a sample.
//
// Signs: a phase current is positive out of the leg into the motor; torque and speed are positive counter-clockwise;
// a positive load torque opposes positive rotation (and is signed: it does not change sign with the speed).
// theta_e = 0 when the d-axis lies on phase a. Peak-value (amplitude-invariant) Clarke transformation.
//
// Not modelled: switching transients shorter than a tick, iron and eddy losses, temperature, skin effect.

#ifndef STILLSPIN_SIM_HOST_PLANT_PLANT_HPP
#define STILLSPIN_SIM_HOST_PLANT_PLANT_HPP

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim_host/plant/config.hpp"

namespace stillspin::plant {

/// True values at one instant.
struct PlantState {
  Tick tick = 0;
  std::array<double, 3> current{};      // A, phases a, b, c; exactly 0 in a leg that does not conduct
  double current_d = 0.0;               // A
  double current_q = 0.0;               // A
  double flux_d = 0.0;                  // Vs, without the harmonics
  double flux_q = 0.0;                  // Vs
  double angle_e = 0.0;                 // rad electrical, -pi..pi
  double angle_m = 0.0;                 // rad mechanical, not wrapped, from angle 0 of turn 0
  double speed_m = 0.0;                 // rad/s mechanical
  double torque = 0.0;                  // N m, electromagnetic without cogging
  double cogging = 0.0;                 // N m
  double load = 0.0;                    // N m, as set by set_load
  double link_voltage = 0.0;            // V
  std::array<double, 3> leg_voltage{};  // V against the negative rail
};

struct LoadPoint {
  Tick tick;      // absolute; two points at one tick make a jump
  double torque;  // N m, signed, -1e4..1e4
};

enum class AdcInput { kCurrentA, kCurrentB, kCurrentC, kLinkVoltage, kTemperature };

/// Both devices of a leg conducting: the run is void from here; the leg is treated as switched off while it lasts.
struct ShootThrough {
  Tick tick;
  int leg;
};

/// Booked since power-on (SolverConfig::ledger), all in J.
/// source = copper + device + brake + source_resistance + friction + load + (stored now - stored at power-on).
struct EnergyLedger {
  double source = 0.0;             // delivered by the ideal source
  double source_resistance = 0.0;  // lost in it (and in the jump of an ideal rectifier)
  double brake = 0.0;
  double link = 0.0;    // from the capacitor into the inverter
  double device = 0.0;  // lost in switches and diodes
  double copper = 0.0;
  double friction = 0.0;  // viscous and Coulomb
  double load = 0.0;      // given to the load
  double stored = 0.0;    // now: capacitor + magnetic field + rotor + cogging
};

struct PlantStats {
  std::uint64_t segments = 0;   // committed steps of the driver
  std::uint64_t discarded = 0;  // looked ahead and cut short by a later edge
  std::uint64_t events = 0;     // currents that reached zero, clamps left, stiction, brake
  std::uint64_t grazing = 0;    // double crossings found inside a step
};

enum class FaultKind {
  kOpenPhase,    // index = phase; no current from now on
  kSensorStuck,  // index = phase; the sensor reads `value` A
  kSensorDrift,  // index = phase; the offset moves by `value` A/s
  kSensorGain,   // index = phase; the gain is multiplied by `value`
  kLinkSag,      // the source voltage is multiplied by `value` (0..2)
};

struct Fault {
  FaultKind kind;
  int index = 0;
  double value = 0.0;
};

class Plant {
 public:
  explicit Plant(const PlantConfig& config);  // validates
  ~Plant();
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;

  /// Driver inputs of leg 0..2 (a, b, c) from t on. Device delays are applied inside.
  void set_gate(Tick t, int leg, bool upper, bool lower);

  /// Makes t the present: the instant of state() and current_sensor().
  void advance(Tick t);
  Tick now() const;
  PlantState state() const;

  /// Output of the current sensor of `phase` 0..2 at the present, A, with all its errors.
  double current_sensor(int phase) const;

  /// Advances to t; the 12-bit code of a sample-and-hold that closes at t. An input without a sensor reads 0.
  std::uint16_t adc_code(Tick t, AdcInput input);

  /// Advances to t; quadrature edges since power-on, signed; 0 where angle_m is 0.
  std::int64_t encoder_count(Tick t);

  /// Advances to t; highest |phase current| (true, A) since the last call: what an over-current comparator has seen.
  double take_peak_current(Tick t);

  /// Highest |phase current| at the ends of the steps since the last take_peak_current; costs nothing.
  double peak_current() const;

  /// Load torque from the present on; constant before the first and after the last point; empty = none.
  void set_load(std::vector<LoadPoint> points);
  /// Clamps the shaft where it is, or frees it, at the present.
  void set_locked(bool locked);

  /// Connects the brake resistor to the link, or takes it off, at the present: a board that switches it, in the place
  /// of the chopper of its own (DcLinkConfig::brake_chopper).
  void set_brake(bool on);
  /// Adds so many ohms to the source's resistance from the present on: a precharge resistor.
  void set_precharge(double ohms);

  /// A fault from the present on; several add up. clear_faults() repairs everything.
  void inject(const Fault& fault);
  void clear_faults();

  std::optional<ShootThrough> shoot_through() const;  // the first one
  EnergyLedger energy() const;
  PlantStats stats() const;
  const PlantConfig& config() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stillspin::plant

#endif
