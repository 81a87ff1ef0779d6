#include "sim_host/plant/gates.hpp"

#include <algorithm>

namespace stillspin::plant {

void Gates::set(Tick t, int leg, bool upper, bool lower) {
  set_device(devices_[2 * leg], t, upper);
  set_device(devices_[2 * leg + 1], t, lower);
  find_next();
}

Tick Gates::next_of_both(const Device& carrying, const Device& other) const {
  if (other.on) return next_;
  for (const Change& change : other.pending) {
    if (change.on) return std::min(carrying.next, change.tick);
  }
  return carrying.next;
}

void Gates::set_device(Device& device, Tick t, bool on) {
  if (on == device.input) return;
  device.input = on;
  const Tick effect = t + (on ? on_delay_ : off_delay_);
  if (!device.pending.empty() && effect <= device.pending.back().tick) {
    device.pending.pop_back();
  } else {
    device.pending.push_back({effect, on});
  }
  find_next(device);
}

std::array<bool, 3> Gates::apply(Tick t) {
  std::array<bool, 3> changed{};
  for (int n = 0; n < 6; ++n) {
    Device& device = devices_[n];
    while (device.next <= t) {
      device.on = device.pending.front().on;
      device.pending.erase(device.pending.begin());
      find_next(device);
      changed[n / 2] = true;
    }
  }
  find_next();
  return changed;
}

void Gates::find_next() {
  next_ = kNever;
  for (const Device& device : devices_) next_ = std::min(next_, device.next);
}

}  // namespace stillspin::plant
