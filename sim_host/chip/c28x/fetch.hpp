// The time that instructions need to arrive. A fetcher runs ahead of the core through the code, unit by unit, as far as
// its buffers hold, and the core waits where it overtakes it. A jump begins anew. What is read as data stands in the
// way of the fetcher where both are in one memory.
//
// A memory without waits that nothing else reads never makes the core wait: the table's cycles of a branch are those of
// filling the pipeline again from such a one.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_FETCH_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_FETCH_HPP

#include <cstdint>

namespace stillspin::c28x {

/// What an access of a memory costs. Of two accesses to one block in a cycle one waits; 0 stands for what has no
/// blocks.
struct Region {
  std::uint8_t block = 0;
  std::uint8_t read_waits = 0;
  std::uint8_t fetch_shift = 1;  // a fetch brings 2^n words
  std::uint8_t fetch_first = 1;  // cycles of the first fetch after a jump
  std::uint8_t fetch_next = 1;   // and of each that follows
  std::uint8_t ahead = 3;        // units that are fetched beyond the one in use
  bool ordered = false;          // a read waits for every write that was made before it
};

class Fetcher {
 public:
  /// Where the code is that runs from now on; `now` is when the first of its units is asked for.
  void jump(const Region& region, std::uint32_t address, std::uint64_t now) {
    region_ = &region;
    unit_ = address >> region.fetch_shift;
    next_ = unit_ + 1;
    // Without waits the second unit arrives while the pipeline fills.
    done_ = now + region.fetch_first - 1 + (region.fetch_next > 1 ? region.fetch_next : 0);
  }

  /// How long the core waits for the unit that has this word; the units come one after another.
  std::uint64_t enter(std::uint32_t address, std::uint64_t now) {
    const std::uint32_t unit = address >> region_->fetch_shift;
    if (unit == unit_) return 0;
    catch_up(now);
    std::uint64_t wait = 0;
    if (unit == next_) {
      wait = done_ - now;
      now = done_;
      ++next_;
      done_ += region_->fetch_next;
    }
    const bool was_full = full();
    unit_ = unit;
    if (was_full) done_ = now + region_->fetch_next;
    return wait;
  }

  /// How long a read of `cycles` waits in a memory that finishes a fetch before it; the fetcher goes on after it.
  std::uint64_t read_after_fetch(unsigned cycles, std::uint64_t now) {
    catch_up(now);
    if (full()) return 0;
    const std::uint64_t wait = done_ - now;
    ++next_;
    done_ += cycles + region_->fetch_next;
    return wait;
  }
  /// An access that goes first takes the cycle from the fetcher.
  void go_first(std::uint64_t now) {
    catch_up(now);
    if (!full()) ++done_;
  }

  const Region& region() const { return *region_; }

 private:
  bool full() const { return next_ - unit_ > region_->ahead; }
  void catch_up(std::uint64_t now) {
    while (!full() && done_ <= now) {
      ++next_;
      done_ += region_->fetch_next;
    }
  }

  const Region* region_ = nullptr;
  std::uint32_t unit_ = 0;  // in use
  std::uint32_t next_ = 0;  // to arrive, unless the buffers are full
  std::uint64_t done_ = 0;  // when it will have
};

}  // namespace stillspin::c28x

#endif
