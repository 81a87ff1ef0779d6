// Which legs conduct after an event: the part of Model that enumerates modes.
//
// The set of rules (current >= 0 with the low level, <= 0 with the high level, zero in between) is a linear
// complementarity problem with exactly one answer, because a leg's di/dt rises with its own voltage. Away from zero the
// sign of the current decides; at most the legs at zero have to be tried.

#include <algorithm>
#include <cmath>

#include "sim_host/plant/model.hpp"

namespace stillspin::plant {
namespace {

constexpr double kZeroCurrent = 1e-9;  // A: below this a current counts as zero
constexpr double kZeroSpeed = 1e-9;    // rad/s
constexpr double kLeaving = 1e-6;      // V: the accuracy to which the end of a clamp is located

}  // namespace

void Model::set_direction(int leg, int value) {
  direction[leg] = value;
  line_[leg] = value > 0 ? legs[leg].low : value < 0 ? legs[leg].high : LegLine{};
}

void Model::set_clamp() {
  clamp = Clamp::kNone;
  int idle = 0;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] != 0) continue;
    clamp = static_cast<Clamp>(k);
    ++idle;
  }
  if (idle >= 2) {
    clamp = Clamp::kAll;
    for (int k = 0; k < 3; ++k) set_direction(k, 0);
  }
  bridge_ = Bridge::make(line_);
}

void Model::project(State& y) const {
  if (clamp == Clamp::kNone) return;
  if (clamp == Clamp::kAll) {
    y[kId] = 0.0;
    y[kIq] = 0.0;
    return;
  }
  const Pair axis = phase_axis(turned(base, y[kAngle]), static_cast<int>(clamp));
  const double rest = axis.d * y[kId] + axis.q * y[kIq];
  y[kId] -= rest * axis.d;
  y[kIq] -= rest * axis.q;
}

void Model::resolve(State& y, const Fired& fired) {
  resolve_legs(y, fired);
  resolve_shaft(y, fired[kShaftEvent]);
  if (fired[kBrakeEvent]) brake = !brake;
}

bool Model::switch_legs(State& y, const std::array<bool, 3>& changed, std::array<double, 3>& jump) {
  if (clamp != Clamp::kNone) return false;
  const Phases i = phase_currents(base, y[kId], y[kIq]);
  for (int k = 0; k < 3; ++k) {
    const bool decided = (direction[k] > 0 ? i[k] : -i[k]) >= kZeroCurrent;
    if (!decided || legs[k].perfect || legs[k].open) return false;
  }
  const double v = link_voltage(0.0, y);
  for (int k = 0; k < 3; ++k) {
    jump[k] = 0.0;
    if (!changed[k]) continue;
    const double before = line_[k].voltage(v, i[k]);
    line_[k] = direction[k] > 0 ? legs[k].low : legs[k].high;
    jump[k] = line_[k].voltage(v, i[k]) - before;
  }
  bridge_ = Bridge::make(line_);
  resolve_shaft(y, false);
  return true;
}

void Model::resolve_legs(State& y, const Fired& fired) {
  const Phases i = phase_currents(base, y[kId], y[kIq]);
  int idle = 0, small = 0, last = 0;
  double tolerance = 0.0;
  for (int k = 0; k < 3; ++k) {
    const bool is_fired = fired[2 * k] || fired[2 * k + 1];
    if (is_fired && direction[k] == 0) tolerance = kLeaving;
    const bool tiny = std::fabs(i[k]) < kZeroCurrent;
    small += tiny;
    if (legs[k].perfect) {
      set_direction(k, 1);
    } else if (tiny || legs[k].open || (is_fired && clamp != Clamp::kAll)) {
      set_direction(k, 0);
      ++idle;
      last = k;
    } else {
      set_direction(k, i[k] > 0.0 ? 1 : -1);
    }
  }
  set_clamp();
  if (idle == 0) return;
  if (idle > 1 || small > 1) {
    // With two legs at zero so is the third; what rounding leaves could have the wrong sign for the legs that now
    // conduct, and end them again at once.
    y[kId] = 0.0;
    y[kIq] = 0.0;
    decide_all(y, tolerance);
  } else {
    project(y);
    decide_one(y, last, tolerance);
  }
  project(y);
}

/// One leg at zero current, the others conduct. Entered with that leg clamped.
void Model::decide_one(const State& y, int leg, double tolerance) {
  if (legs[leg].open) return;
  State dy;
  Probe p;
  derive(0.0, y, dy, p);
  const double supply = link_voltage(0.0, y);
  const double v = p.leg_voltage[leg];
  if (v < legs[leg].low.voltage(supply, 0.0) + tolerance) {
    set_direction(leg, 1);
  } else if (v > legs[leg].high.voltage(supply, 0.0) - tolerance) {
    set_direction(leg, -1);
  }
  set_clamp();
}

/// No current at all: stay so when the star point has a place for it, else the combination that is most consistent.
void Model::decide_all(const State& y, double tolerance) {
  State zero = y;
  zero[kId] = 0.0;
  zero[kIq] = 0.0;
  for (int k = 0; k < 3; ++k) set_direction(k, 0);
  set_clamp();
  Events g;
  g.fill(kInactive);
  leg_events(0.0, zero, g);
  if (*std::min_element(g.begin(), g.begin() + kShaftEvent) > tolerance) return;
  Directions best{0, 0, 0};
  double best_margin = -kInactive;
  for (int n = 0; n < 27; ++n) {
    const Directions trial{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    bool possible = true;
    for (int k = 0; k < 3; ++k) {
      if (legs[k].open && trial[k] != 0) possible = false;
      if (legs[k].perfect && trial[k] != 1) possible = false;
    }
    if (!possible) continue;
    for (int k = 0; k < 3; ++k) set_direction(k, trial[k]);
    set_clamp();
    if (clamp == Clamp::kAll) continue;
    const double margin = consistency(zero);
    if (margin > best_margin) {
      best_margin = margin;
      best = trial;
    }
  }
  for (int k = 0; k < 3; ++k) set_direction(k, best[k]);
  set_clamp();
}

/// The worst of: clamped terminal inside its levels; each current driven to its own side. In V (di/dt times L).
double Model::consistency(const State& y) const {
  State dy;
  Probe p;
  derive(0.0, y, dy, p);
  const double supply = link_voltage(0.0, y);
  double worst = kInactive;
  for (int k = 0; k < 3; ++k) {
    if (legs[k].perfect || legs[k].open) continue;
    if (direction[k] == 0) {
      worst = std::min(worst, p.leg_voltage[k] - legs[k].low.voltage(supply, 0.0));
      worst = std::min(worst, legs[k].high.voltage(supply, 0.0) - p.leg_voltage[k]);
    } else {
      const Pair axis = phase_axis(base, k);
      worst = std::min(worst, direction[k] * machine.ld * (axis.d * dy[kId] + axis.q * dy[kIq]));
    }
  }
  return worst;
}

void Model::resolve_shaft(State& y, bool fired) {
  if (shaft == Shaft::kLocked) {
    y[kSpeed] = 0.0;
    return;
  }
  if (!friction_) {
    shaft = Shaft::kFree;
    return;
  }
  const bool breaking_loose = fired && shaft == Shaft::kStuck;
  if (!fired && std::fabs(y[kSpeed]) > kZeroSpeed) {
    shaft = Shaft::kTurning;
    turning = y[kSpeed] > 0.0 ? 1 : -1;
    return;
  }
  y[kSpeed] = 0.0;
  State dy;
  Probe p;
  derive(0.0, y, dy, p);
  const double torque = p.torque + p.cogging - p.load;
  turning = torque >= 0.0 ? 1 : -1;
  shaft = breaking_loose || std::fabs(torque) > stiction_ ? Shaft::kTurning : Shaft::kStuck;
}

}  // namespace stillspin::plant
