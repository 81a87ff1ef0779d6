// The power fails somewhere in a save: at every octet that goes over the bus, and in every page's write cycle with
// everything that may be left of the page. Started again, either the old or the new set is in force, as a whole.

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/texts.hpp"
#include "tests/firmware/store.hpp"

namespace {

using namespace stillspin;
using namespace stillspin::test;

class PowerCut : public Store {
 protected:
  /// Two saves lie behind: `old_` is valid, the slot of the one before will be written.
  void SetUp() override {
    NEEDS("store");
    Store::SetUp();
    power_on();
    set_variant(1);
    save();
    set_variant(2);
    old_ = in_force();
    save();
    set_variant(3);
    new_ = in_force();
    before_ = nvm;
    const long octets = nvm.octets, pages = nvm.pages;
    save();
    octets_ = nvm.octets - octets;
    pages_ = nvm.pages - pages;
    survived_ = nvm.memory;
  }

  /// As it was before the save, with the new values wanted.
  void back() {
    nvm = before_;
    power_on();
    for (const auto& [id, raw] : new_) parameter_set(id, raw);
  }

  /// True for the new set, false for the old one.
  bool check_what_is_left() {
    const store_state_t state = power_on();
    const Values now = in_force();
    EXPECT_TRUE(state == STORE_LOADED || (state == STORE_OLDER && now == old_))
        << bench::words_of(CATALOGUE_STORE, state);
    EXPECT_TRUE(now == old_ || now == new_) << "a mixed set";
    // And the next save works.
    set_variant(7);
    const Values next = in_force();
    EXPECT_EQ(save(), STORE_SAVED);
    EXPECT_EQ(power_on(), STORE_LOADED);
    EXPECT_EQ(in_force(), next);
    return now == new_;
  }

  Values old_, new_;
  FakeNvm before_;
  std::vector<std::uint8_t> survived_;
  long octets_ = 0, pages_ = 0;
};

TEST_F(PowerCut, AtEveryOctet) {
  const long slot = SLOT_HEADER + parameter_count() * SLOT_ENTRY + SLOT_CHECK;
  ASSERT_GT(octets_, 3 * slot) << "the old slot is read, the new one is written and read back";
  int renewed = 0;
  for (long at = 0; at < octets_; ++at) {
    back();
    nvm.cut_at_octet = nvm.octets + at;
    ASSERT_EQ(save(), STORE_FAILED) << at;
    renewed += check_what_is_left() ? 1 : 0;
    ASSERT_FALSE(HasFailure()) << "cut at octet " << at << " of " << octets_;
  }
  EXPECT_EQ(renewed, int(SLOT_MAGIC_OCTETS)) << "those that read the magic back: it has been written by then";
}

TEST_F(PowerCut, InEveryWriteCycleAtEveryOctetOfThePage) {
  for (long page = 0; page < pages_; ++page) {
    for (unsigned split = 0; split <= HAL_NVM_PAGE; ++split) {
      for (const bool first_is_new : {false, true}) {
        back();
        nvm.cut_at_page = nvm.pages + page;
        nvm.torn = [&](unsigned k, std::uint8_t before, std::uint8_t after) {
          return (k < split) == first_is_new ? after : before;
        };
        ASSERT_EQ(save(), STORE_FAILED);
        (void)check_what_is_left();
        ASSERT_FALSE(HasFailure()) << "page " << page << " of " << pages_ << " split at " << split;
      }
    }
  }
}

// Cells that hold neither the old nor the new octet, and a page that has been erased and not written.
TEST_F(PowerCut, InEveryWriteCycleWithAnythingLeft) {
  for (long page = 0; page < pages_; ++page) {
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      std::uint32_t x = seed * 7919u + 1u;
      back();
      nvm.cut_at_page = nvm.pages + page;
      nvm.torn = [&](unsigned, std::uint8_t before, std::uint8_t after) -> std::uint8_t {
        x = x * 1664525u + 1013904223u;
        const std::uint8_t choices[] = {before, after, static_cast<std::uint8_t>(before & after),
                                        static_cast<std::uint8_t>(x >> 8)};
        return seed == 0 ? 0xFF : choices[x >> 30];
      };
      ASSERT_EQ(save(), STORE_FAILED);
      (void)check_what_is_left();
      ASSERT_FALSE(HasFailure()) << "page " << page << " seed " << seed;
    }
  }
}

// The cut comes again while the loss of the first one is being made good.
TEST_F(PowerCut, TwiceInARow) {
  for (long first = 0; first < pages_; ++first) {
    for (long second = 0; second < pages_; second += 3) {
      back();
      nvm.cut_at_page = nvm.pages + first;
      nvm.torn = [](unsigned k, std::uint8_t before, std::uint8_t after) { return k % 2 == 0 ? before : after; };
      save();
      power_on();
      const Values after_first = in_force();
      for (const auto& [id, raw] : new_) parameter_set(id, raw);
      nvm.cut_at_page = nvm.pages + second;
      ASSERT_EQ(save(), STORE_FAILED);
      const store_state_t state = power_on();
      ASSERT_TRUE(state == STORE_LOADED || state == STORE_OLDER) << bench::words_of(CATALOGUE_STORE, state);
      ASSERT_TRUE(in_force() == after_first || in_force() == new_);
    }
  }
}

// The very first save: before it there is nothing, and nothing is what a cut leaves.
TEST_F(PowerCut, InTheFirstSaveOfANewMemory) {
  for (long at = 0;; ++at) {
    nvm = FakeNvm{};
    power_on();
    for (const auto& [id, raw] : new_) parameter_set(id, raw);
    nvm.cut_at_octet = nvm.octets + at;
    if (save() == STORE_SAVED) break;
    const store_state_t state = power_on();
    const bool magic_is_there = state == STORE_LOADED;
    ASSERT_TRUE(magic_is_there || state == STORE_EMPTY || state == STORE_DAMAGED) << at;
    ASSERT_EQ(in_force(), magic_is_there ? new_ : defaults()) << at;
  }
}

// The power may fail while it is read, too: nothing is written by that.
TEST_F(PowerCut, WhileItIsRead) {
  const long before = nvm.octets;
  power_on();
  const long read = nvm.octets - before;
  for (long at = 0; at < read; ++at) {
    nvm.powered = true;
    nvm.cut_at_octet = nvm.octets + at;
    drive_reset();
    store_begin();
    serve();
    ASSERT_EQ(store_state(), STORE_ABSENT) << at;
    ASSERT_EQ(in_force(), defaults());
  }
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(nvm.memory, survived_);
}

// Commands can come with any timing; only one thing is done at a time.
TEST_F(PowerCut, UnknownNumbersSurviveToo) {
  Image image;
  image.entries = table();
  for (std::uint16_t k = 0; k < 40; ++k) image.entries.push_back({static_cast<std::uint16_t>(2000 + k), 3, k});
  nvm = FakeNvm{};
  put(0, image);
  const FakeNvm start = nvm;
  for (long at = 0;; at += 5) {
    nvm = start;
    power_on();
    set_variant(1);
    nvm.cut_at_octet = nvm.octets + at;
    const bool saved = save() == STORE_SAVED;
    const store_state_t state = power_on();
    ASSERT_TRUE(state == STORE_MIGRATED || (state == STORE_OLDER && !saved)) << at;
    ASSERT_EQ(store_report()->unknown, 40) << at;
    if (saved) break;
  }
}

}  // namespace
