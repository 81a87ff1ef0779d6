// Where a program spends its cycles: by the address of the instruction, waits included, and by interrupt from its entry
// to its return, without those that came in between.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_PROFILE_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_PROFILE_HPP

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace stillspin::c28x {

class Profile {
 public:
  /// Words at the bottom and at the top of memory; an F2808 has none between.
  static constexpr std::uint32_t kLow = 0x10000;
  static constexpr std::uint32_t kHigh = 0x20000;
  static constexpr std::uint32_t kHighBegin = 0x3E0000;

  static std::uint32_t index(std::uint32_t address) { return address < kLow ? address : kLow + address % kHigh; }
  static std::uint32_t address(std::uint32_t index) { return index < kLow ? index : kHighBegin + index - kLow; }

  void spend(std::uint32_t at, std::uint64_t count, std::uint16_t stack) {
    cycles[index(at)] += count;
    highest_stack = std::max(highest_stack, stack);
  }

  void enter(unsigned vector, std::uint32_t routine, std::uint64_t now) {
    open_.push_back({{vector, routine}, now, 0});
  }
  /// A return without an entry is that of an interrupt from before the profile began.
  void leave(std::uint64_t now) {
    if (open_.empty()) return;
    const Open done = open_.back();
    open_.pop_back();
    const std::uint64_t all = now - done.begin;
    interrupts[done.which].push_back(static_cast<std::uint32_t>(all - done.others));
    if (!open_.empty()) open_.back().others += all;
  }

  std::vector<std::uint64_t> cycles = std::vector<std::uint64_t>(kLow + kHigh);
  std::uint16_t highest_stack = 0;
  using Which = std::pair<unsigned, std::uint32_t>;        // vector and routine
  std::map<Which, std::vector<std::uint32_t>> interrupts;  // cycles of each

 private:
  struct Open {
    Which which;
    std::uint64_t begin;
    std::uint64_t others;
  };

  std::vector<Open> open_;
};

}  // namespace stillspin::c28x

#endif
