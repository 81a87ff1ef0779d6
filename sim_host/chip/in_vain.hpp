// What a program that is executed accesses in vain, since the virtual chip has it not or does not let it through: by
// address how often, and where first.

#ifndef STILLSPIN_SIM_HOST_CHIP_IN_VAIN_HPP
#define STILLSPIN_SIM_HOST_CHIP_IN_VAIN_HPP

#include <cstdint>
#include <map>

namespace stillspin::chip {

class Uses {
 public:
  /// The instruction that accesses, and when.
  struct Access {
    std::uint32_t place = 0;
    std::uint64_t cycle = 0;
  };
  struct Use {
    std::uint64_t reads = 0;
    std::uint64_t writes = 0;
    Access first;
  };

  void note(std::uint32_t address, bool write, const Access& access) {
    if (uses_.size() >= kMost && uses_.count(address) == 0) return;
    Use& use = uses_.try_emplace(address, Use{0, 0, access}).first->second;
    ++(write ? use.writes : use.reads);
  }
  const std::map<std::uint32_t, Use>& uses() const { return uses_; }

 private:
  // A pointer that runs through empty memory finds four million of them.
  static constexpr std::size_t kMost = 0x2000;

  std::map<std::uint32_t, Use> uses_;
};

/// What the chip of the model has not, writes to protected registers with EALLOW clear, and accesses to a peripheral
/// whose clock is off (told as writes).
struct InVain {
  Uses unmodelled, unallowed, unclocked;
};

}  // namespace stillspin::chip

#endif
