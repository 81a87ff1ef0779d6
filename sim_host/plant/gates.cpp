#include "sim_host/plant/gates.hpp"

#include <algorithm>

namespace stillspin::plant {

void Gates::set(Tick t, int leg, bool upper, bool lower) {
  set_device(devices_[2 * leg], t, upper);
  set_device(devices_[2 * leg + 1], t, lower);
  find_next();
}

Tick Gates::next(int leg, bool leaving) const {
  const Device& carrying = devices_[2 * leg + (leaving ? 0 : 1)];
  const Device& other = devices_[2 * leg + (leaving ? 1 : 0)];
  Tick result = carrying.pending.empty() ? kNever : carrying.pending.front().tick;
  if (!carrying.on) return result;
  if (other.on) return next_;
  for (const Change& change : other.pending) {
    if (change.on) return std::min(result, change.tick);
  }
  return result;
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
}

std::array<bool, 3> Gates::apply(Tick t) {
  std::array<bool, 3> changed{};
  for (int n = 0; n < 6; ++n) {
    Device& device = devices_[n];
    while (!device.pending.empty() && device.pending.front().tick <= t) {
      device.on = device.pending.front().on;
      device.pending.pop_front();
      changed[n / 2] = true;
    }
  }
  find_next();
  return changed;
}

void Gates::find_next() {
  next_ = kNever;
  for (const Device& device : devices_) {
    if (!device.pending.empty()) next_ = std::min(next_, device.pending.front().tick);
  }
}

}  // namespace stillspin::plant
