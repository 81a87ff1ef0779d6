// From driver inputs to conducting devices: turn-on and turn-off delay of six devices.
//
// A pulse that is over before its device has reacted never happens: an edge that would take effect before the edge that
// it follows removes both.

#ifndef STILLSPIN_SIM_HOST_PLANT_GATES_HPP
#define STILLSPIN_SIM_HOST_PLANT_GATES_HPP

#include <array>
#include <limits>
#include <vector>

#include "sim_host/plant/config.hpp"

namespace stillspin::plant {

inline constexpr Tick kNever = std::numeric_limits<Tick>::max();

class Gates {
 public:
  Gates(Tick turn_on_delay, Tick turn_off_delay) : on_delay_(turn_on_delay), off_delay_(turn_off_delay) {}

  void set(Tick t, int leg, bool upper, bool lower);

  /// When the next device changes.
  Tick next() const { return next_; }

  /// When next a device changes through which a leg carries its current: the upper one of a current that leaves the leg
  /// (else its lower diode conducts, whatever the lower device does), the lower one of a current that enters it. So is
  /// a change that makes both devices conduct.
  Tick next(int leg, bool leaving) const {
    const Device& carrying = devices_[2 * leg + (leaving ? 0 : 1)];
    const Device& other = devices_[2 * leg + (leaving ? 1 : 0)];
    if (carrying.on) return next_of_both(carrying, other);
    return carrying.next;
  }

  /// Lets all changes up to t happen; the legs whose devices have changed.
  std::array<bool, 3> apply(Tick t);

  bool upper(int leg) const { return devices_[2 * leg].on; }
  bool lower(int leg) const { return devices_[2 * leg + 1].on; }

 private:
  struct Change {
    Tick tick;
    bool on;
  };
  struct Device {
    bool input = false;
    bool on = false;
    Tick next = kNever;           // the first pending change
    std::vector<Change> pending;  // seldom more than one
  };

  static void find_next(Device& device) { device.next = device.pending.empty() ? kNever : device.pending.front().tick; }
  Tick next_of_both(const Device& carrying, const Device& other) const;
  void set_device(Device& device, Tick t, bool on);
  void find_next();

  std::array<Device, 6> devices_;
  Tick on_delay_;
  Tick off_delay_;
  Tick next_ = kNever;
};

}  // namespace stillspin::plant

#endif
