// Where the core is to stop before an instruction, and the last instructions that it executed: for debuggers, and for
// what stands in the place of code.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_WATCH_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_WATCH_HPP

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim_host/chip/c28x/profile.hpp"
#include "sim_host/chip/c28x/registers.hpp"

namespace stillspin::c28x {

class Watch {
 public:
  static constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};

  /// What is executed next, with the registers before it.
  struct Traced {
    std::uint64_t cycles = 0;
    Registers registers;
  };

  /// Stops before each execution of the instruction at this address.
  void stop_at(std::uint32_t address, bool on) { mark(address, kStop, on); }
  /// The same for all of them.
  void stop_nowhere() {
    for (std::uint8_t& marked : marks_) marked = static_cast<std::uint8_t>(marked & ~kStop);
    data_.clear();
    accessed_ = noted_ = {};
  }
  /// Stops after so many instructions, repeats not counted; entries into interrupts are none.
  void stop_after(std::uint64_t instructions) { left_ = instructions; }
  static constexpr std::uint32_t kNowhere = ~0U;
  enum : std::uint8_t { kRead = 1, kWrite = 2 };
  /// What an instruction did to a word that was to be watched.
  struct Access {
    std::uint32_t address = kNowhere;
    std::uint8_t kinds = 0;
  };
  /// Stops behind the instruction that does this to a word: kRead, kWrite or both. `word` is where the core has it,
  /// which may be at two addresses; nullptr where the bus has it.
  void stop_on(std::uint32_t address, const std::uint16_t* word, std::uint8_t kinds) {
    data_.push_back({address, word, kinds});
  }
  bool watches_data() const { return !data_.empty(); }
  /// One of the words of an access, from the core.
  void note_access(std::uint32_t address, const std::uint16_t* word, std::uint8_t kind) {
    for (const Data& data : data_) {
      const bool is_it = word != nullptr ? data.word == word : data.address == address;
      if (!is_it || (data.kinds & kind) == 0) continue;
      if (noted_.address == kNowhere) noted_.address = data.address;
      if (noted_.address == data.address) noted_.kinds = static_cast<std::uint8_t>(noted_.kinds | kind);
    }
  }
  /// The word for which it last stopped so; kNowhere: another reason.
  const Access& accessed() const { return accessed_; }

  /// Other code than the memory's is at this address; whoever runs the core carries it out.
  void replace_code_at(std::uint32_t address) { mark(address, kReplaced, true); }

  /// Keeps the last so many instructions, 0 for none, until one traps as illegal.
  void trace(std::size_t depth) {
    trace_.assign(depth, {});
    traced_ = 0;
    trapped_ = false;
  }
  /// An instruction that is none is going to trap. It ends the trace as its last, whatever the depth: what comes behind
  /// the first of them is seldom what anybody wrote.
  void note_trap(const Registers& before, std::uint64_t cycles) {
    if (trapped_) return;
    trapped_ = true;
    if (trace_.empty()) trace_.resize(1);
    if (traced_ == 0 || trace_[(traced_ - 1) % trace_.size()].registers.pc != before.pc) keep(before, cycles);
  }
  /// Oldest first.
  std::vector<Traced> traced() const {
    const std::uint64_t kept = std::min<std::uint64_t>(traced_, trace_.size());
    std::vector<Traced> all;
    for (std::uint64_t k = traced_ - kept; k < traced_; ++k) all.push_back(trace_[k % trace_.size()]);
    return all;
  }

  /// Before an instruction: whether to stop. The one at which it stopped is not stopped at again when it goes on.
  bool stops(const Registers& r, std::uint64_t cycles) {
    const std::uint8_t marked = mark_at(r.pc);
    const bool passing = r.pc == passing_;
    const bool accessed = !data_.empty() && any_accessed();
    passing_ = kNowhere;
    if ((!passing && (left_ == 0 || (marked & kStop) != 0)) || accessed) {
      passing_ = r.pc;
      left_ = kUnlimited;
      replaced_ = false;
      return true;
    }
    replaced_ = (marked & kReplaced) != 0;
    if (replaced_) return true;
    if (left_ != kUnlimited && left_ > 0) --left_;
    if (!trace_.empty() && !trapped_) keep(r, cycles);
    return false;
  }
  /// What the last stop was for: code that is replaced, rather than a debugger.
  bool is_replaced() const { return replaced_; }

  /// Whether the core stands at such a stop; said by who runs it.
  bool halted = false;

 private:
  static constexpr std::uint8_t kStop = 1;
  static constexpr std::uint8_t kReplaced = 2;

  struct Data {
    std::uint32_t address;
    const std::uint16_t* word;
    std::uint8_t kinds;
  };

  bool any_accessed() {
    accessed_ = std::exchange(noted_, {});
    return accessed_.address != kNowhere;
  }

  // Where an F2808 has no memory nothing is marked: there is no instruction before which to stop.
  void mark(std::uint32_t address, std::uint8_t bit, bool on) {
    const std::uint32_t index = Profile::index(address & kProgramMask);
    if (index == Profile::kBetween) return;
    std::uint8_t& marked = marks_[index];
    marked = static_cast<std::uint8_t>(on ? marked | bit : marked & ~bit);
  }
  std::uint8_t mark_at(std::uint32_t address) const { return marks_[Profile::index(address)]; }
  void keep(const Registers& before, std::uint64_t cycles) { trace_[traced_++ % trace_.size()] = {cycles, before}; }

  std::vector<std::uint8_t> marks_ = std::vector<std::uint8_t>(Profile::kIndices);
  std::uint64_t left_ = kUnlimited;
  std::uint32_t passing_ = kNowhere;
  std::vector<Data> data_;
  Access noted_, accessed_;
  bool replaced_ = false;
  std::vector<Traced> trace_;
  std::uint64_t traced_ = 0;
  bool trapped_ = false;
};

}  // namespace stillspin::c28x

#endif
