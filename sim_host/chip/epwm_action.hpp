// The action qualifier of one ePWM: what the events of the counter do to outputs A and B before the dead band.
//
// Several events at one count: the one with the highest priority that has an action wins. Priorities as in the type 0
// tables of TI SPRU791 / SPRUG04 (highest first): software force, then
//     up          period, B up, A up, zero
//     down        zero, B down, A down, period
//     up-down, counting up (from zero)      B up, A up, zero, B down, A down
//     up-down, counting down (from period)  B down, A down, period, B up, A up
// AQCTLA/AQCTLB act at once; only the continuous force AQCSFRC has a shadow.

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_ACTION_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_ACTION_HPP

#include <cstdint>

#include "sim_host/chip/epwm_time_base.hpp"

namespace stillspin::chip {

class ActionQualifier {
 public:
  bool level(int output) const { return level_[output]; }
  std::uint16_t control(int output) const { return control_[output]; }
  std::uint16_t software_force() const { return software_force_; }
  std::uint16_t continuous_force() const { return force_shadow_; }

  void write_control(int output, std::uint16_t value);

  /// AQSFRC: the one-shot bits act at once and read back 0.
  void write_software_force(std::uint16_t value);

  /// AQCSFRC: waits in the shadow unless AQSFRC.RLDCSF says immediate.
  void write_continuous_force(std::uint16_t value);

  /// Events upon which AQCSFRC is loaded (CountEvent bits).
  unsigned load_events() const;

  /// Events that have an action on one of the outputs.
  unsigned used_events() const { return used_[0] | used_[1]; }

  /// The counter reached a count with these events. True if an output changed.
  bool act(unsigned events, CountMode mode, bool up) {
    const bool concerned = (events & (used_[0] | used_[1])) != 0 || force_shadow_ != force_active_;
    return concerned && act_on(events, mode, up);
  }

 private:
  bool act_on(unsigned events, CountMode mode, bool up);
  void take(int output, unsigned action);
  void apply_continuous_force();

  std::uint16_t control_[2] = {0, 0};
  unsigned used_[2] = {0, 0};
  bool level_[2] = {false, false};
  std::uint16_t software_force_ = 0;
  std::uint16_t force_shadow_ = 0;
  std::uint16_t force_active_ = 0;
};

}  // namespace stillspin::chip

#endif
