// The right-hand side between two events, and the functions that say when the next event is.
//
// State: i_d, i_q (A), mechanical speed (rad/s), electrical angle since the start of the segment (rad), link voltage
// (V). Time is counted from the start of the segment, so that no digits are lost to its age. Everything that an event
// can change is a member here and constant in between: legs, directions, clamps, friction, brake, load, source.
//
// Equations: physics in machine.hpp; v_alpha/beta from the legs (the star point floats, so a common voltage drops out).
// A leg that does not conduct has i = 0 and the voltage that keeps di/dt at 0; when none conducts all currents stay 0.

#ifndef STILLSPIN_SIM_HOST_PLANT_MODEL_HPP
#define STILLSPIN_SIM_HOST_PLANT_MODEL_HPP

#include <Eigen/Core>
#include <array>

#include "sim_host/plant/bridge.hpp"
#include "sim_host/plant/machine.hpp"

namespace stillspin::plant {

enum StateIndex : int { kId, kIq, kSpeed, kAngle, kLink, kStates };
using State = Eigen::Matrix<double, kStates, 1>;

/// Event functions: each must stay >= 0. Two per leg, then the shaft, then the brake.
inline constexpr int kShaftEvent = 6;
inline constexpr int kBrakeEvent = 7;
inline constexpr int kEvents = 8;
using Events = std::array<double, kEvents>;
using Fired = std::array<bool, kEvents>;
inline constexpr double kInactive = 1e30;  // value of a function that has nothing to watch

enum class Shaft { kFree, kTurning, kStuck, kLocked };
enum class Clamp : int { kNone = -1, kA = 0, kB = 1, kC = 2, kAll = 3 };

/// What else the right-hand side knows.
struct Probe {
  std::array<double, 3> current;      // A
  std::array<double, 3> leg_voltage;  // V
  Pair flux;
  double torque;          // N m
  double cogging;         // N m
  double load;            // N m
  double source_voltage;  // V
  double source_current;  // A
  double rail_current;    // A from the positive rail into the legs
};

class Model {
 public:
  explicit Model(const PlantConfig& config);

  /// dy/dt. Throws std::runtime_error when the currents leave the flux map.
  void derive(double t, const State& y, State& dy) const;
  void derive(double t, const State& y, State& dy, Probe& probe) const;

  /// Same with the flux given instead of computed, and its slope returned: a Runge-Kutta step that carries the flux
  /// along needs no arc tangent in its stages. The template: `e` is the rotor position at y, `source` the source's
  /// voltage at t, kClamped the number of clamped legs (0, 1, 3), kUsual whether usual(): all known to the caller.
  template <int kClamped, bool kUsual>
  void derive(double t, double source, const State& y, const Rotation& e, const Pair& flux, State& dy,
              Pair& dflux) const;
  /// Same at the start of the segment, where the rotor is at `base`.
  void derive_at_start(const State& y, const Pair& flux, State& dy, Pair& dflux) const;

  void events(double t, const State& y, Events& g) const;

  /// The lowest of them.
  double lowest_event(double t, const State& y) const;

  /// True when all legs conduct and nothing but their currents is watched; then the lowest event function is this, of
  /// rotor currents at rotor position e.
  bool watches_currents_alone() const {
    return clamp == Clamp::kNone && (shaft == Shaft::kFree || shaft == Shaft::kLocked) && !link.brake_chopper;
  }
  double lowest_current(const Rotation& e, double id, double iq) const;

  /// True when currents are the only thing that events can come from, and none can have reached zero: each starts
  /// further from it than it can have moved with the slopes at both ends.
  bool far_from_events(const State& y, const State& slope, const State& end_slope, double h) const;

  /// The usual case, in which a right-hand side has nothing to ask: harmonics or cogging, no friction but the viscous
  /// one, a capacitor in the link, a source that also sinks, no brake.
  bool usual() const { return sixth_ && shaft == Shaft::kFree && !link.stiff && !link.rectifier && !brake; }

  std::array<double, 3> currents(const State& y) const { return currents(turned(base, y[kAngle]), y); }
  double source_voltage(double t) const;
  void set_source_resistance(double ohms) { inverse_source_resistance_ = 1.0 / ohms; }
  double load(double t) const { return load_start + load_slope * t; }

  /// Chooses directions of all legs whose current is zero, clamps, friction and brake after an event, so that a current
  /// leaves zero only to the side to which it is driven; `fired` = the event functions that reached zero (none at a
  /// gate edge). Needs y[kAngle] = 0. Projects y onto the zero currents.
  void resolve(State& y, const Fired& fired);

  /// The same at a gate edge of the legs `changed` that leaves nothing to choose: false when something is, else `jump`
  /// says by how much the leg voltages change.
  bool switch_legs(State& y, const std::array<bool, 3>& changed, std::array<double, 3>& jump);

  /// Sets y so that the currents of legs that do not conduct are exactly zero.
  void project(State& y) const;

  /// Flux linkage without harmonics at state y.
  Pair flux(const State& y) const { return machine.flux(y[kId], y[kIq], anchor); }

  /// At the start of the segment (y[kAngle] = 0).
  std::array<double, 3> leg_voltages(const State& y) const;
  double link_voltage(double t, const State& y) const;

  // What events change.
  std::array<Leg, 3> legs;
  Directions direction{};
  Clamp clamp = Clamp::kAll;
  Shaft shaft = Shaft::kFree;
  int turning = 1;  // sign of the speed while Shaft::kTurning
  bool brake = false;
  double load_start = 0.0;  // N m
  double load_slope = 0.0;  // N m/s
  double sag = 1.0;         // factor on the source voltage
  Rotation base;            // of the angle at the start of the segment
  Rotation ripple_base;     // of the source ripple's phase there
  Machine::Anchor anchor;   // saturation at the currents there

  const Machine machine;
  const MechanicsConfig mechanics;
  const DcLinkConfig link;

 private:
  using Phases = std::array<double, 3>;

  template <int kClamped, bool kUsual, bool kProbe>
  void core(double t, double source, const State& y, const Rotation& e, const Pair& flux, State& dy, Pair& dflux,
            Probe* probe) const;
  double rippled_voltage(double t) const;
  Phases currents(const Rotation& e, const State& y) const;
  double clamp_leg(int leg, const Rotation& e, double electrical_speed, const State& y, Pair& u) const;
  void float_legs(double link_voltage, const Rotation& e, const Pair& held, Phases& v) const;
  void leg_events(double t, const State& y, Events& g) const;

  void set_direction(int leg, int value);
  void set_clamp();
  void resolve_legs(State& y, const Fired& fired);
  void decide_one(const State& y, int leg, double tolerance);
  void decide_all(const State& y, double tolerance);
  double consistency(const State& y) const;
  void resolve_shaft(State& y, bool fired);

  [[noreturn]] void outside_map(const State& y) const;

  std::array<LegLine, 3> line_;  // the line on which each leg is; all zero in a clamped leg
  Bridge bridge_;                // the three together
  double ripple_speed_;          // rad/s
  double inverse_inertia_;
  double inverse_capacitance_;
  double inverse_source_resistance_;
  double stiction_;
  bool friction_;  // Coulomb friction or stiction present
  bool sixth_;     // harmonics or cogging present
};

/// Phase currents of rotor currents (id, iq) at rotor position e.
inline std::array<double, 3> phase_currents(const Rotation& e, double id, double iq) {
  const double alpha = e.c * id - e.s * iq;
  const double beta = 0.5 * kSqrt3 * (e.s * id + e.c * iq);
  return {alpha, -0.5 * alpha + beta, -0.5 * alpha - beta};
}

/// Axis of phase 0..2 in rotor coordinates: i_phase = axis . i_dq.
inline Pair phase_axis(const Rotation& e, int phase) {
  if (phase == 0) return {e.c, -e.s};
  const double turn = phase == 1 ? 0.5 * kSqrt3 : -0.5 * kSqrt3;
  return {-0.5 * e.c + turn * e.s, 0.5 * e.s + turn * e.c};
}

inline double Model::lowest_current(const Rotation& e, double id, double iq) const {
  const Phases i = phase_currents(e, id, iq);
  double lowest = kInactive;
  for (int k = 0; k < 3; ++k) {
    const double g = direction[k] > 0 ? i[k] : -i[k];
    if (!legs[k].perfect && g < lowest) lowest = g;
  }
  return lowest;
}

}  // namespace stillspin::plant

#endif
