// Where a program spends its cycles: by the address of the instruction, waits included; by interrupt from its entry to
// its return, without those that came in between, and within each interrupt by address.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_PROFILE_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_PROFILE_HPP

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace stillspin::c28x {

/// Cycles of an instruction, and those of them that were waited for.
struct Spent {
  std::uint64_t cycles = 0;
  std::uint64_t registers = 0;
  std::uint64_t data = 0;
  std::uint64_t fetch = 0;

  Spent& operator+=(const Spent& more) {
    cycles += more.cycles;
    registers += more.registers;
    data += more.data;
    fetch += more.fetch;
    return *this;
  }
  Spent operator-(const Spent& less) const {
    return {cycles - less.cycles, registers - less.registers, data - less.data, fetch - less.fetch};
  }
};

class Profile {
 public:
  /// Words at the bottom and at the top of memory; an F2808 has none between.
  static constexpr std::uint32_t kLow = 0x10000;
  static constexpr std::uint32_t kHigh = 0x20000;
  static constexpr std::uint32_t kHighBegin = 0x3E0000;

  static std::uint32_t index(std::uint32_t address) { return address < kLow ? address : kLow + address % kHigh; }
  static std::uint32_t address(std::uint32_t index) { return index < kLow ? index : kHighBegin + index - kLow; }

  using Which = std::pair<unsigned, std::uint32_t>;  // vector and routine
  using ByIndex = std::vector<std::uint64_t>;

  void spend(std::uint32_t at, const Spent& count, std::uint16_t stack) {
    spent[index(at)] += count;
    if (inside_ != nullptr) (*inside_)[index(at)] += count.cycles;
    if (left_) look_inside();  // the return itself was the interrupt's
    highest_stack = std::max(highest_stack, stack);
  }

  void enter(unsigned vector, std::uint32_t routine, std::uint64_t now) {
    open_.push_back({{vector, routine}, now, 0});
    look_inside();
  }
  /// A return without an entry is that of an interrupt from before the profile began.
  void leave(std::uint64_t now) {
    if (open_.empty()) return;
    const Open done = open_.back();
    open_.pop_back();
    const std::uint64_t all = now - done.begin;
    interrupts[done.which].push_back(static_cast<std::uint32_t>(all - done.others));
    if (!open_.empty()) open_.back().others += all;
    left_ = true;
  }

  std::vector<Spent> spent = std::vector<Spent>(kLow + kHigh);
  std::uint16_t highest_stack = 0;
  std::map<Which, std::vector<std::uint32_t>> interrupts;  // cycles of each
  std::map<Which, ByIndex> within;                         // cycles by index, without those of the entry

 private:
  struct Open {
    Which which;
    std::uint64_t begin;
    std::uint64_t others;
  };

  void look_inside() {
    left_ = false;
    inside_ = nullptr;
    if (open_.empty()) return;
    inside_ = &within[open_.back().which];
    inside_->resize(kLow + kHigh);
  }

  std::vector<Open> open_;
  ByIndex* inside_ = nullptr;  // of the interrupt that runs
  bool left_ = false;
};

}  // namespace stillspin::c28x

#endif
