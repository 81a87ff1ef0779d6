#include "sim_host/plant/gates.hpp"

namespace stillspin::plant {

/// Another change of a device whose last one is still pending.
void Gates::queue(int n, Tick effect) {
  std::vector<Tick>& later = devices_[n].later;
  const Tick last = later.empty() ? due_[n] : later.back();
  if (effect > last) {
    later.push_back(effect);
  } else if (!later.empty()) {
    later.pop_back();
  } else {
    due_[n] = kNever;
    find_next();
  }
}

/// Lets all changes of a device up to t happen.
void Gates::pass(int n, Tick t) {
  Device& device = devices_[n];
  while (due_[n] <= t) {
    device.on = !device.on;
    due_[n] = kNever;
    if (device.later.empty()) return;
    due_[n] = device.later.front();
    device.later.erase(device.later.begin());
  }
}

}  // namespace stillspin::plant
