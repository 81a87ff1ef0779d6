// What instructions cost beyond the cycles of their table: conflicts of the pipeline, and the memories' waits.
//
// The core executes one instruction after another; here is what overlaps in the chip. An instruction is thought of by
// the cycle in which it makes its addresses (D2). Results are there three cycles later (E), and a word is written one
// after that, where a read of an instruction comes one cycle after its D2. So an instruction waits
//   * up to three cycles for a register of its address that one of the three before it changes late,
//   * up to three cycles for a word that one of the three before it writes, and in ordered regions for any such write,
//   * one cycle where it reads a block of RAM in the cycle in which the third before it writes there,
//   * for the waits of the memory that it reads, and for its own words (fetch.hpp).
// What each rule is taken from is in docs/c28x.md.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_TIMING_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_TIMING_HPP

#include <array>
#include <cstdint>

#include "sim_host/chip/c28x/fetch.hpp"
#include "sim_host/chip/c28x/instruction.hpp"
#include "sim_host/chip/c28x/registers.hpp"

namespace stillspin::c28x {

/// Cycles that were waited for, by cause.
struct Waits {
  std::uint64_t registers = 0;
  std::uint64_t data = 0;
  std::uint64_t fetch = 0;
};

class Timing {
 public:
  Timing() { regions_.fill(&kPlain); }

  std::uint64_t cycles = 0;
  Waits waits;

  static constexpr std::uint32_t kRegionPage = 1024;

  /// What accesses of these words cost; `first` and `words` are multiples of kRegionPage. `region` has to live as long
  /// and may be changed between instructions. Without it memory costs nothing.
  void set_region(std::uint32_t first, std::uint32_t words, const Region& region) {
    for (std::uint32_t at = first; at < first + words; at += kRegionPage) regions_[at / kRegionPage] = &region;
  }

  /// Waits of a bus, in the middle of an instruction.
  void wait_for_data(std::uint64_t count) {
    cycles += count;
    waits.data += count;
  }

 protected:
  /// Before the operation of an instruction: its registers and its words have to be there.
  void wait_for(const Instruction& i, unsigned current) {
    if ((late_ & i.early * kLanes) != 0) wait_for_registers(i.early, current);
    if (timed_code_) wait_for_words(i.address, i.words);
  }
  /// After it, `begin` is what wait_for left.
  void note_results(const Instruction& i, std::uint64_t begin) {
    if ((late_ | i.late) == 0) return;
    const std::uint64_t spent = cycles - begin;
    late_ = (spent < 4 ? late_ << 16 * spent : 0) | i.late;
  }
  /// Code goes on elsewhere.
  void jump_to(std::uint32_t address) {
    const Region& region = region_of(address);
    timed_code_ = region.fetch_first > 1 || region.fetch_next > 1 || region.block != 0;
    jumped_ = timed_code_;
  }

  void note_read(std::uint32_t address, std::uint32_t words) {
    const Region& region = region_of(address);
    if (cycles - last_write_ < kWriteDelay) wait_for_writes(address, words, region);
    if (region.block != 0) share(region);
  }
  void note_write(std::uint32_t address, std::uint32_t words) {
    last_write_ = cycles;
    written_[next_written_++ % written_.size()] = {address & kProgramMask, words, cycles};
    const Region& region = region_of(address);
    if (timed_code_ && region.block != 0 && !jumped_ && fetcher_.region().block == region.block) {
      fetcher_.go_first(cycles);
    }
  }

 private:
  static constexpr Region kPlain{};
  static constexpr std::uint64_t kLanes = 0x000100010001;  // changed by the one before, by the one before that, ..
  static constexpr std::uint64_t kWriteDelay = 4;          // cycles from an instruction's write to a read that sees it

  struct Written {
    std::uint32_t address = 0;
    std::uint32_t words = 0;
    std::uint64_t at = 0;
  };

  const Region& region_of(std::uint32_t address) const { return *regions_[(address & kProgramMask) / kRegionPage]; }
  void wait_for_registers(unsigned early, unsigned current);
  void wait_for_words(std::uint32_t address, unsigned words);
  void wait_for_writes(std::uint32_t address, std::uint32_t words, const Region& region);
  void share(const Region& region);

  std::uint64_t late_ = 0;  // masks of 16 bits, as kLanes
  std::uint64_t last_write_ = 0;
  std::array<Written, 4> written_{};
  unsigned next_written_ = 0;
  bool timed_code_ = false;
  bool jumped_ = false;
  Fetcher fetcher_;
  std::array<const Region*, (kProgramMask + 1) / kRegionPage> regions_{};
};

}  // namespace stillspin::c28x

#endif
