#include "sim_host/plant/gates.hpp"

namespace stillspin::plant {

Tick Gates::next_of_both(int carrying, int other) const {
  if (devices_[other].on) return next_;
  for (const Change& change : devices_[other].pending) {
    if (change.on) return std::min(due_[carrying], change.tick);
  }
  return due_[carrying];
}

/// The input of a device changes.
void Gates::set_device(int n, Tick t, bool on) {
  Device& device = devices_[n];
  device.input = on;
  const Tick effect = t + (on ? on_delay_ : off_delay_);
  if (!device.pending.empty() && effect <= device.pending.back().tick) {
    device.pending.pop_back();
  } else {
    device.pending.push_back({effect, on});
  }
  find_due(n);
  find_next();
}

/// Lets all changes of a device up to t happen.
void Gates::pass(int n, Tick t) {
  Device& device = devices_[n];
  while (due_[n] <= t) {
    device.on = device.pending.front().on;
    device.pending.erase(device.pending.begin());
    find_due(n);
  }
}

}  // namespace stillspin::plant
