// Where a program spends its cycles: by the address of the instruction, waits included; by interrupt from its entry to
// its return, without those that came in between, and within each interrupt by address.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_PROFILE_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_PROFILE_HPP

#include <algorithm>
#include <cstddef>
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
  /// Words at the bottom and, from the OTP on, at the top of memory; an F2808 has none between: all addresses there
  /// count as one, the first of them.
  static constexpr std::uint32_t kLow = 0x10000;
  static constexpr std::uint32_t kHighBegin = 0x3D7800;
  static constexpr std::uint32_t kHigh = 0x400000 - kHighBegin;
  static constexpr std::uint32_t kBetween = kLow + kHigh;
  static constexpr std::uint32_t kIndices = kBetween + 1;

  static std::uint32_t index(std::uint32_t address) {
    if (address < kLow) return address;
    return address >= kHighBegin ? kLow + (address & 0x3FFFFF) - kHighBegin : kBetween;
  }
  static std::uint32_t address(std::uint32_t index) {
    if (index < kLow) return index;
    return index < kBetween ? kHighBegin + index - kLow : kLow;
  }

  using Which = std::pair<unsigned, std::uint32_t>;  // vector and routine
  using ByIndex = std::vector<std::uint64_t>;

  void spend(std::uint32_t at, const Spent& count, std::uint16_t stack) {
    spent[index(at)] += count;
    if (inside_ != nullptr) (*inside_)[index(at)] += count.cycles;
    if (left_) look_inside();  // the return itself was the interrupt's
    highest_stack = std::max(highest_stack, stack);
  }

  void enter(unsigned vector, std::uint32_t routine, std::uint64_t now) {
    if (open_.size() == kDeepest) open_.clear();
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

  /// The program has set the stack pointer: what was there before it is none of its stack.
  void begin_stack() { highest_stack = 0; }

  /// The core was reset: nothing that was entered returns.
  void abandon() {
    open_.clear();
    look_inside();
  }

  std::vector<Spent> spent = std::vector<Spent>(kIndices);
  std::uint16_t highest_stack = 0;
  std::map<Which, std::vector<std::uint32_t>> interrupts;  // cycles of each
  std::map<Which, ByIndex> within;                         // cycles by index, without those of the entry

 private:
  /// More contexts than fit into all of the stack's reach: of those before nobody returns any more.
  static constexpr std::size_t kDeepest = 0x10000 / 14;

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
    inside_->resize(kIndices);
  }

  std::vector<Open> open_;
  ByIndex* inside_ = nullptr;  // of the interrupt that runs
  bool left_ = false;
};

}  // namespace stillspin::c28x

#endif
