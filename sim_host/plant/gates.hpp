// From driver inputs to conducting devices: turn-on and turn-off delay of six devices.
//
// A pulse that is over before its device has reacted never happens: an edge that would take effect before the edge that
// it follows removes both.

#ifndef STILLSPIN_SIM_HOST_PLANT_GATES_HPP
#define STILLSPIN_SIM_HOST_PLANT_GATES_HPP

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "sim_host/plant/config.hpp"

namespace stillspin::plant {

inline constexpr Tick kNever = std::numeric_limits<Tick>::max();

class Gates {
 public:
  Gates(Tick turn_on_delay, Tick turn_off_delay) : on_delay_(turn_on_delay), off_delay_(turn_off_delay) {}

  void set(Tick t, int leg, bool upper, bool lower) {
    if (upper != devices_[2 * leg].input) set_device(2 * leg, t, upper);
    if (lower != devices_[2 * leg + 1].input) set_device(2 * leg + 1, t, lower);
  }

  /// When the next device changes.
  Tick next() const { return next_; }

  /// When next a device changes through which a leg carries its current: the upper one of a current that leaves the leg
  /// (else its lower diode conducts, whatever the lower device does), the lower one of a current that enters it. So is
  /// a change that makes both devices conduct.
  Tick next(int leg, bool leaving) const {
    const int carrying = 2 * leg + (leaving ? 0 : 1), other = 4 * leg + 1 - carrying;
    if (!devices_[carrying].on) return due_[carrying];
    return devices_[other].on ? next_ : std::min(due_[carrying], due_[other]);
  }

  /// Lets all changes up to t happen; the legs whose devices have changed.
  std::array<bool, 3> apply(Tick t) {
    std::array<bool, 3> changed{};
    for (int n = 0; n < 6; ++n) {
      if (due_[n] > t) continue;
      pass(n, t);
      changed[n / 2] = true;
    }
    find_next();
    return changed;
  }

  bool upper(int leg) const { return devices_[2 * leg].on; }
  bool lower(int leg) const { return devices_[2 * leg + 1].on; }

 private:
  struct Device {
    bool input = false;
    bool on = false;
    std::vector<Tick> later;  // changes behind the first; each turns the device round. Seldom any
  };

  void set_device(int n, Tick t, bool on) {
    devices_[n].input = on;
    const Tick effect = t + (on ? on_delay_ : off_delay_);
    if (due_[n] == kNever) {
      due_[n] = effect;
      next_ = std::min(next_, effect);
    } else {
      queue(n, effect);
    }
  }
  void queue(int n, Tick effect);
  void pass(int n, Tick t);
  void find_next() {
    const Tick a = std::min(due_[0], due_[1]), b = std::min(due_[2], due_[3]), c = std::min(due_[4], due_[5]);
    next_ = std::min(a, std::min(b, c));
  }

  std::array<Device, 6> devices_;
  std::array<Tick, 6> due_{kNever, kNever, kNever, kNever, kNever, kNever};  // first pending change of each device
  Tick on_delay_;
  Tick off_delay_;
  Tick next_ = kNever;
};

}  // namespace stillspin::plant

#endif
