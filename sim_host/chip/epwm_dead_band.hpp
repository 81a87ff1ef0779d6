// The dead-band submodule of one ePWM.
//
// Two delay lines: one lets rising edges through DBRED TBCLKs late (falling edges at once), the other delays falling
// edges by DBFED. An edge the other way before the delay has run out cancels it, so a pulse that is not longer than the
// dead band is swallowed by that line: one switch of the leg stays off while the other still makes its gap.
//     IN_MODE   bit 0: source of the rising-edge line (0 A, 1 B), bit 1: of the falling-edge line
//     POLSEL    bit 0: invert the rising-edge line, bit 1: invert the falling-edge line
//     OUT_MODE  bit 1: output A takes the rising-edge line, bit 0: output B takes the falling-edge line; else bypass
// Source: TI SPRU791; DBRED and DBFED have no shadow and count for the edges that come after the write.

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_DEAD_BAND_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_DEAD_BAND_HPP

#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"
#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

class DeadBand {
 public:
  std::uint16_t control = 0;        // DBCTL
  std::uint16_t rising_delay = 0;   // DBRED, TBCLKs
  std::uint16_t falling_delay = 0;  // DBFED, TBCLKs

  /// Levels of the action qualifier at t, or a changed register.
  void input(bool a, bool b, Tick clock_period, Tick t) {
    source_[0] = a;
    source_[1] = b;
    const unsigned mode = field(control, EPWM_DBCTL_IN_MODE_MASK, EPWM_DBCTL_IN_MODE_LSB);
    rising_.input(source_[mode & 1u], true, rising_delay * clock_period, t);
    falling_.input(source_[mode >> 1], false, falling_delay * clock_period, t);
  }

  Tick next_event() const { return rising_.due < falling_.due ? rising_.due : falling_.due; }

  void run_event(Tick t) {
    rising_.run(t, true);
    falling_.run(t, false);
  }

  bool a() const {
    return bit_set(control, 2u) ? rising_.output != bit_set(control, 1u << EPWM_DBCTL_POLSEL_LSB) : source_[0];
  }
  bool b() const {
    return bit_set(control, 1u) ? falling_.output != bit_set(control, 2u << EPWM_DBCTL_POLSEL_LSB) : source_[1];
  }

 private:
  struct Line {
    bool last = false;
    bool output = false;
    Tick due = kNever;

    /// `late` is the level whose edge is delayed.
    void input(bool level, bool late, Tick delay, Tick t) {
      if (level == last) {
        return;
      }
      last = level;
      if (level == late && delay > 0) {
        due = t + delay;
      } else {
        output = level;
        due = kNever;
      }
    }

    void run(Tick t, bool late) {
      if (due <= t) {
        output = late;
        due = kNever;
      }
    }
  };

  bool source_[2] = {false, false};
  Line rising_;
  Line falling_;
};

}  // namespace stillspin::chip

#endif
