// The trip zone of one ePWM: the last stage before the pins, combinational from TZ1..6 and from TZFRC.
//
// One-shot: latched until TZCLR.OST. Cycle by cycle: the outputs are released at the next counter zero at which the pin
// is no longer active; its flag stays until TZCLR.CBC. A flag whose pin is still active cannot be cleared.
// TZFLG.INT gates the interrupt: while it is set no further pulse is sent; clearing it while an enabled trip flag is
// still set sends another one.
// Source: TI SPRU791 / SPRUI07 chapter 3. A high-impedance pin reads low (pull-down of the board).

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_TRIP_ZONE_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_TRIP_ZONE_HPP

#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

class TripZone {
 public:
  std::uint16_t select = 0;   // TZSEL
  std::uint16_t control = 0;  // TZCTL
  std::uint16_t enable = 0;   // TZEINT

  std::uint16_t flags() const { return flags_; }

  void set_pins(unsigned active_mask) {
    pins_ = active_mask & 0x3Fu;
    sense();
  }

  void force(std::uint16_t word) {  // TZFRC
    trip(word & (EPWM_TZFRC_CBC_MASK | EPWM_TZFRC_OST_MASK));
  }

  void clear(std::uint16_t word) {  // TZCLR
    flags_ = static_cast<std::uint16_t>(flags_ & ~(word & kAllFlags));
    sense();
  }

  /// The pins or TZSEL changed, or a flag was cleared: active pins set what they select.
  void sense() {
    trip((pins_ & (select & 0x3Fu)) != 0 ? EPWM_TZFLG_CBC_MASK : 0u);
    trip((pins_ & (select >> EPWM_TZSEL_OSHT1_LSB)) != 0 ? EPWM_TZFLG_OST_MASK : 0u);
  }

  /// True if a cycle-by-cycle trip ended.
  bool counter_zero() {
    const bool ends = cycle_trip_ && (pins_ & select & 0x3Fu) == 0;
    cycle_trip_ = cycle_trip_ && !ends;
    return ends;
  }

  bool active() const { return cycle_trip_ || bit_set(flags_, EPWM_TZFLG_OST_MASK); }

  bool a(bool level) const { return active() ? tripped(field(control, EPWM_TZCTL_TZA_MASK, 0), level) : level; }
  bool b(bool level) const {
    return active() ? tripped(field(control, EPWM_TZCTL_TZB_MASK, EPWM_TZCTL_TZB_LSB), level) : level;
  }

  /// True if an interrupt pulse goes out now; sets TZFLG.INT.
  bool take_interrupt() {
    if (!bit_set(flags_, enable) || bit_set(flags_, EPWM_TZFLG_INT_MASK)) {
      return false;
    }
    flags_ = static_cast<std::uint16_t>(flags_ | EPWM_TZFLG_INT_MASK);
    return true;
  }

 private:
  static constexpr unsigned kAllFlags = EPWM_TZFLG_INT_MASK | EPWM_TZFLG_CBC_MASK | EPWM_TZFLG_OST_MASK;

  void trip(unsigned mask) {
    flags_ = static_cast<std::uint16_t>(flags_ | mask);
    cycle_trip_ = cycle_trip_ || bit_set(mask, EPWM_TZFLG_CBC_MASK);
  }

  static bool tripped(unsigned action, bool level) {
    constexpr unsigned kForceHigh = 1, kDoNothing = 3;
    return action == kForceHigh || (action == kDoNothing && level);
  }

  unsigned pins_ = 0;
  std::uint16_t flags_ = 0;
  bool cycle_trip_ = false;
};

}  // namespace stillspin::chip

#endif
