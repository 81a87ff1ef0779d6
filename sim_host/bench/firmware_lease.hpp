// The firmware has static state, as on its chip: one virtual drive at a time in a process.
//
// Whoever runs the firmware or touches its tables holds the lease for as long as that lasts; a second one is refused.

#ifndef STILLSPIN_SIM_HOST_BENCH_FIRMWARE_LEASE_HPP
#define STILLSPIN_SIM_HOST_BENCH_FIRMWARE_LEASE_HPP

#include <atomic>
#include <stdexcept>

namespace stillspin::bench {

class FirmwareLease {
 public:
  /// Throws std::logic_error when somebody else holds it.
  FirmwareLease() {
    if (taken().exchange(true)) {
      throw std::logic_error(
          "another virtual drive runs in this process: close that one first, or use another process");
    }
  }
  ~FirmwareLease() { taken() = false; }
  FirmwareLease(const FirmwareLease&) = delete;
  FirmwareLease& operator=(const FirmwareLease&) = delete;

 private:
  static std::atomic<bool>& taken() {
    static std::atomic<bool> flag{false};
    return flag;
  }
};

}  // namespace stillspin::bench

#endif
