#include "sim_host/chip/c28x/timing.hpp"

#include <algorithm>

namespace stillspin::c28x {

void Timing::wait_for_registers(unsigned early, unsigned current) {
  constexpr unsigned kRegisters = 0x3FF;
  // By ARP: that pointer, and the index AR0, which some of these modes have.
  const unsigned needed = (early & kUsesCurrent) != 0 ? 1U << current | 1U : early & kRegisters;
  for (unsigned since = 0; since < 3; ++since) {
    if ((late_ >> 16 * since & needed) == 0) continue;
    const unsigned wait = 3 - since;
    cycles += wait;
    waits.registers += wait;
    late_ = wait < 4 ? late_ << 16 * wait : 0;
    return;
  }
}

void Timing::wait_for_words(std::uint32_t address, unsigned words) {
  const Region& region = region_of(address);
  const std::uint64_t begin = cycles;
  if (jumped_ || &region != &fetcher_.region()) {
    jumped_ = false;
    fetcher_.jump(region, address, cycles);
    cycles += region.fetch_first - 1U;
  }
  cycles += fetcher_.enter(address, cycles);
  cycles += fetcher_.enter(address + words - 1, cycles);
  waits.fetch += cycles - begin;
}

void Timing::wait_for_writes(std::uint32_t address, std::uint32_t words, const Region& region) {
  const std::uint32_t first = address & kProgramMask;
  std::uint64_t wait = 0;
  for (const Written& written : written_) {
    const std::uint64_t since = cycles - written.at;
    if (since == 0 || since >= kWriteDelay || written.words == 0) continue;
    const bool same = first < written.address + written.words && written.address < first + words;
    const Region& to = region_of(written.address);
    if (same || (region.ordered && &to == &region)) {
      wait = std::max(wait, kWriteDelay - since);
    } else if (since == kWriteDelay - 1 && region.block != 0 && to.block == region.block) {
      wait = std::max(wait, std::uint64_t{1});  // the write goes first
    }
  }
  wait_for_data(wait);
}

void Timing::share(const Region& region) {
  const bool with_code = timed_code_ && !jumped_ && fetcher_.region().block == region.block;
  if (region.read_waits != 0) {
    if (with_code) wait_for_data(fetcher_.read_after_fetch(region.read_waits + 1U, cycles));
    wait_for_data(region.read_waits);
  } else if (with_code) {
    fetcher_.go_first(cycles);
  }
}

}  // namespace stillspin::c28x
