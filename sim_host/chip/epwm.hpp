// The six ePWM modules of the F2808 and what ties them together: the synchronisation chain, TBCLKSYNC, the trip pins
// and the common start-of-conversion lines.
//
// Events at one tick are handled module by module, then synchronisation pulses travel down the chain ePWM1 -> 2 .. 6
// (a module whose SYNCOSEL is 0 passes its input on in the same tick; the phase load comes two SYSCLKOUT later), then
// one SOCA and one SOCB pulse leave, however many modules asked for one.
//
// Cost: an event is some tens of nanoseconds of host time; modules in phase share one call at zero.

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_HPP

#include <cstdint>

#include "sim_host/chip/epwm_module.hpp"
#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class EPwmBank final {
 public:
  static constexpr int kModules = 6;

  explicit EPwmBank(ChipServices& services) : services_(services) {}

  void reset(Tick t);

  /// `module` 0..5, `offset` EPWM_x of hal/f2808/registers.h.
  std::uint16_t read(int module, std::uint16_t offset, Tick t) const;
  void write(int module, std::uint16_t offset, std::uint16_t value, Tick t);

  Tick next_event() const { return next_event_; }
  void run_event(Tick t);
  void clocks_changed(Tick t);

  /// PCLKCR0.TBCLKSYNC: all time bases stop or start in the same tick.
  void set_time_base_clock(bool running, Tick t);

  /// Bit n-1: TZn is active, that is its pin is low and routed to the trip zone.
  void set_trip_pins(unsigned active_mask, Tick t);

 private:
  /// After a call to a module.
  void carry_out(int module, unsigned effects, Tick t) {
    next_[module] = modules_[module].next_event();
    if ((effects & (kEffectInterrupt | kEffectTripInterrupt | kEffectPins)) != 0) {
      tell(module, effects, t);
    }
  }
  void tell(int module, unsigned effects, Tick t);
  void publish(int module, Tick t);
  void send_sync(int source, Tick t);
  void refresh_next_event();

  ChipServices& services_;
  EPwmModule modules_[kModules];
  Tick next_[kModules] = {kNever, kNever, kNever, kNever, kNever, kNever};
  Tick next_event_ = kNever;
  std::uint8_t pins_[kModules] = {};  // bit 0 A, bit 1 B, as last told to the core
  bool time_base_clock_ = false;
};

}  // namespace stillspin::chip

#endif
