// Bootstrap supply of an upper device's driver: a capacitor that is charged while the lower device conducts, and a
// driver that refuses to switch on below its under-voltage lockout.
//
//   on:  v -> 1 with R C;   off:  v -> 0 with the leakage's time constant, as shares of the driver's supply
//
// Typical of a 4.7 uF capacitor behind 20 ohm and a driver of 100 uA at 15 V. What a turn-on takes from the capacitor
// (the gate's charge) is neglected.

#ifndef STILLSPIN_SIM_HOST_DEVICES_BOOTSTRAP_HPP
#define STILLSPIN_SIM_HOST_DEVICES_BOOTSTRAP_HPP

#include <cmath>
#include <cstdint>

#include "sim_host/chip/world.hpp"

namespace stillspin::devices {

class Bootstrap {
 public:
  static constexpr double kCharge = 94e-6 * 1e8;  // ticks: 20 ohm, 4.7 uF
  static constexpr double kLeak = 0.7 * 1e8;      // ticks: 150 kohm, 4.7 uF
  static constexpr double kLockout = 0.75;        // of the supply

  /// Commands of the leg's devices from t on; whether the upper one switches.
  bool switch_leg(chip::Tick t, bool upper, bool lower) {
    const double passed = static_cast<double>(t - at_);
    at_ = t;
    charge_ = charging_ ? 1.0 + (charge_ - 1.0) * std::exp(-passed / kCharge) : charge_ * std::exp(-passed / kLeak);
    charging_ = lower;
    if (upper && !asked_) {
      locked_ = charge_ < kLockout;
      lockouts_ += locked_ ? 1u : 0u;
    }
    asked_ = upper;
    return upper && !locked_;
  }

  double charge() const { return charge_; }
  /// How often it was asked to switch on and had no supply for it.
  std::uint64_t lockouts() const { return lockouts_; }

 private:
  chip::Tick at_ = 0;
  double charge_ = 0.0;
  bool charging_ = false, asked_ = false, locked_ = false;
  std::uint64_t lockouts_ = 0;
};

}  // namespace stillspin::devices

#endif
