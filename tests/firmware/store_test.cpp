// The parameter store: what comes back after a power-on, from this firmware, another one, or a damaged memory.

#include "tests/firmware/store_test.hpp"

#include <algorithm>
#include <cstring>
#include <set>

#include "sim_host/bench/texts.hpp"

namespace {

using namespace stillspin;
using namespace stillspin::test;

TEST(Slot, SequenceIsComparedAcrossTheWrap) {
  EXPECT_TRUE(slot_is_newer(2, 1));
  EXPECT_FALSE(slot_is_newer(1, 2));
  EXPECT_FALSE(slot_is_newer(7, 7));
  EXPECT_TRUE(slot_is_newer(0, 0xFFFFFFFFu));
  EXPECT_FALSE(slot_is_newer(0xFFFFFFFFu, 0));
}

TEST_F(Store, ANewMemoryLeavesTheDefaults) {
  EXPECT_EQ(power_on(), STORE_EMPTY);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(nvm.pages, 0);
}

TEST_F(Store, WithoutAMemoryTheDefaultsAreInForce) {
  nvm.absent = true;
  EXPECT_EQ(power_on(), STORE_ABSENT);
  EXPECT_EQ(in_force(), defaults());
  set_variant(1);
  EXPECT_EQ(save(), STORE_FAILED);
}

TEST_F(Store, SavedValuesComeBack) {
  power_on();
  for (int n = 1; n <= 5; ++n) {
    set_variant(n);
    const Values saved = in_force();
    EXPECT_EQ(save(), STORE_SAVED);
    EXPECT_EQ(store_report()->sequence, std::uint32_t(n));
    EXPECT_EQ(store_report()->slot, (n - 1) % 2);
    EXPECT_EQ(power_on(), STORE_LOADED);
    EXPECT_EQ(in_force(), saved) << n;
    EXPECT_EQ(store_report()->sequence, std::uint32_t(n));
    EXPECT_EQ(store_report()->values, parameter_count());
    EXPECT_TRUE(drive.request.reload);
  }
}

TEST_F(Store, EveryParameterIsSaved) {
  power_on();
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    parameters_reset();
    ASSERT_EQ(parameter_set(info->id, info->initial == info->minimum ? info->minimum + 1 : info->initial - 1), SET_OK);
    if (parameter_conflict() != nullptr) continue;
    const Values saved = in_force();
    ASSERT_EQ(save(), STORE_SAVED);
    ASSERT_EQ(power_on(), STORE_LOADED) << info->name;
    ASSERT_EQ(in_force(), saved) << info->name;
  }
}

TEST_F(Store, ASaveTakesTheValuesOfItsMoment) {
  power_on();
  set_variant(1);
  const Values saved = in_force();
  ASSERT_TRUE(store_save());
  for (int k = 0; k < 20; ++k) store_service();
  set_variant(2);
  serve();
  EXPECT_EQ(store_state(), STORE_SAVED);
  power_on();
  EXPECT_EQ(in_force(), saved);
}

TEST_F(Store, WearIsSpreadOverBothSlots) {
  power_on();
  for (int n = 0; n < 10; ++n) save();
  const unsigned pages = (SLOT_HEADER + parameter_count() * SLOT_ENTRY + SLOT_CHECK + HAL_NVM_PAGE - 1) / HAL_NVM_PAGE;
  for (const unsigned slot : {0u, 1u}) {
    const unsigned first = slot * SLOT_SIZE / HAL_NVM_PAGE;
    EXPECT_EQ(nvm.wear[first], 10u) << "the first page: once with the values, once with the magic";
    for (unsigned p = 1; p < pages; ++p) EXPECT_EQ(nvm.wear[first + p], 5u) << p;
    EXPECT_EQ(nvm.wear[first + pages], 0u);
  }
  EXPECT_EQ(store_report()->sequence, 10u);
}

TEST_F(Store, ProgressRisesToTheEnd) {
  power_on();
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(store_save());
    EXPECT_EQ(store_state(), STORE_SAVING);
    int last = 0;
    std::set<int> seen;
    while (store_is_busy()) {
      store_service();
      if (!store_is_busy()) break;
      EXPECT_GE(store_progress(), last);
      last = store_progress();
      seen.insert(last);
    }
    EXPECT_GT(seen.size(), 15u);
    EXPECT_LT(last, 100);
    EXPECT_EQ(store_progress(), 100);
  }
}

TEST_F(Store, OneJobAtATimeAndNoLoadWhileRunning) {
  power_on();
  ASSERT_TRUE(store_save());
  EXPECT_FALSE(store_save());
  EXPECT_FALSE(store_load());
  EXPECT_FALSE(store_defaults());
  serve();
  drive.state = DRIVE_RUN;
  EXPECT_FALSE(store_load());
  EXPECT_FALSE(store_defaults());
  EXPECT_EQ(save(), STORE_SAVED) << "the background has time for it";
  drive.state = DRIVE_READY;
  ASSERT_TRUE(store_load());
  drive.state = DRIVE_START;  // meanwhile
  serve();
  EXPECT_EQ(store_state(), STORE_FAILED);
}

TEST_F(Store, LoadAndDefaultsOnCommand) {
  power_on();
  set_variant(3);
  const Values saved = in_force();
  save();
  drive.request.reload = false;
  ASSERT_TRUE(store_defaults());
  EXPECT_EQ(in_force(), defaults());
  EXPECT_TRUE(drive.request.reload);
  ASSERT_TRUE(store_load());
  EXPECT_EQ(store_state(), STORE_READING);
  serve();
  EXPECT_EQ(store_state(), STORE_LOADED);
  EXPECT_EQ(in_force(), saved);
}

// ---- damage ---------------------------------------------------------------------------------------------------------

// Every bit of the only slot: whatever flips, nothing of it is used.
TEST_F(Store, AnyFlippedBitIsNoticed) {
  power_on();
  set_variant(1);
  save();
  const std::vector<std::uint8_t> good = nvm.memory;
  const unsigned length = SLOT_HEADER + parameter_count() * SLOT_ENTRY + SLOT_CHECK;
  for (unsigned bit = 0; bit < 8 * length; ++bit) {
    nvm.memory[bit / 8] = static_cast<std::uint8_t>(good[bit / 8] ^ 1u << bit % 8);
    ASSERT_EQ(power_on(), STORE_DAMAGED) << bit;
    ASSERT_EQ(in_force(), defaults()) << bit;
    nvm.memory[bit / 8] = good[bit / 8];
  }
}

TEST_F(Store, ADamagedSlotLeavesTheOtherOne) {
  power_on();
  set_variant(1);
  const Values first = in_force();
  save();
  set_variant(2);
  save();
  nvm.memory[SLOT_SIZE + 100] ^= 1;
  EXPECT_EQ(power_on(), STORE_OLDER) << "not silently";
  EXPECT_EQ(in_force(), first);
  EXPECT_EQ(store_report()->damaged, 1);
  EXPECT_EQ(store_report()->slot, 0);
  set_variant(4);
  EXPECT_EQ(save(), STORE_SAVED);
  EXPECT_EQ(store_report()->slot, 1) << "the damaged one, not the one that is still good";
  EXPECT_EQ(power_on(), STORE_LOADED);
  nvm.memory[100] ^= 1;  // the older one: nothing that anybody wants is lost
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(store_report()->damaged, 0) << "nobody has looked at it";
  nvm.memory[0] ^= 1;
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(store_report()->damaged, 1);
}

// One octet read wrong in each place of the memory, once: nothing is given up for it.
TEST_F(Store, ADisturbanceOfTheBusIsNoDamage) {
  power_on();
  save();
  set_variant(2);
  const Values saved = in_force();
  save();
  const long quiet = nvm.octets;
  power_on();
  const long octets = nvm.octets - quiet;
  for (long at = 0; at < octets; ++at) {
    nvm.wrong_at_octet = nvm.octets + at;
    ASSERT_EQ(power_on(), STORE_LOADED) << at;
    ASSERT_EQ(in_force(), saved) << at;
  }
}

TEST_F(Store, AMemoryThatDoesNotAnswerOnceIsAskedAgain) {
  power_on();
  set_variant(2);
  const Values saved = in_force();
  save();
  for (int job = 0; job < 4; ++job) {
    nvm.deaf_job = nvm.jobs + job;
    ASSERT_EQ(power_on(), STORE_LOADED) << job;
    ASSERT_EQ(in_force(), saved) << job;
    nvm.refused_job = nvm.jobs + job;
    ASSERT_EQ(power_on(), STORE_LOADED) << job;
  }
}

TEST_F(Store, NoiseIsNotASlot) {
  std::uint32_t x = 1;
  for (int n = 0; n < 200; ++n) {
    for (std::uint8_t& octet : nvm.memory) octet = static_cast<std::uint8_t>((x = x * 1664525u + 1013904223u) >> 24);
    for (const unsigned slot : {0u, 1u}) {
      std::uint16_t magic[4];
      slot_pack_u32(SLOT_MAGIC, magic);
      if (n % 2 == 0) std::copy(magic, magic + 4, nvm.memory.begin() + slot * SLOT_SIZE);
      if (n % 4 == 0) nvm.memory[slot * SLOT_SIZE + 13] = 0;  // a length that fits
    }
    ASSERT_EQ(power_on(), STORE_DAMAGED);
    ASSERT_EQ(in_force(), defaults());
  }
  EXPECT_EQ(save(), STORE_SAVED);
  EXPECT_EQ(save(), STORE_SAVED) << "over the other slot's noise, too";
  EXPECT_EQ(power_on(), STORE_LOADED);
}

TEST_F(Store, APageThatWearsOutIsNoticedBeforeTheOldSlotIsGivenUp) {
  power_on();
  set_variant(1);
  const Values first = in_force();
  save();
  nvm.dead = {SLOT_SIZE + 400};
  set_variant(2);
  EXPECT_EQ(save(), STORE_FAILED);
  EXPECT_EQ(power_on(), STORE_OLDER);
  EXPECT_EQ(in_force(), first);
}

// ---- another firmware -----------------------------------------------------------------------------------------------

TEST_F(Store, AnOlderFirmwareHadFewerParameters) {
  Image image;
  image.entries = table();
  image.entries.resize(20);
  image.entries[7].raw = 12 << 20;  // current_limit
  put(0, image);
  EXPECT_EQ(power_on(), STORE_MIGRATED);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
  EXPECT_EQ(store_report()->missing, parameter_count() - 20);
  EXPECT_EQ(store_report()->values, 20);
  Values expected = defaults();
  expected[8] = 12 << 20;
  EXPECT_EQ(in_force(), expected);
  save();
  EXPECT_EQ(power_on(), STORE_LOADED);
}

TEST_F(Store, OrderDoesNotMatter) {
  Image image;
  image.entries = table();
  image.entries[7].raw = 12 << 20;
  std::reverse(image.entries.begin(), image.entries.end());
  put(1, image);
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
}

TEST_F(Store, AChangedFormatIsRescaled) {
  struct Case {
    std::uint16_t id, q;
    std::int32_t raw, expected;
  };
  for (const Case& c : {Case{8, 8, 12 << 8, 12 << 20}, Case{8, 24, (12 << 24) + 7, 12 << 20},
                        Case{8, 24, (12 << 24) + 8, (12 << 20) + 1}, Case{71, 24, -(1 << 20), -(1 << 16)},
                        Case{1, 8, 3 << 8, 3}, Case{71, 21, -3, -1}, Case{71, 21, -1, 0}}) {
    Image image;
    image.entries = table();
    for (slot_entry_t& e : image.entries) {
      if (e.id == c.id) e = {c.id, c.q, c.raw};
    }
    put(0, image);
    EXPECT_EQ(power_on(), STORE_MIGRATED);
    EXPECT_EQ(parameter_get(c.id), c.expected) << c.id << " q" << c.q;
    EXPECT_EQ(store_report()->rescaled, 1);
    EXPECT_EQ(store_report()->refused, 0);
  }
}

// The limits themselves survive every change of format, in spite of two roundings.
TEST_F(Store, LimitsSurviveAChangeOfFormat) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    for (std::uint16_t q = 0; q <= 31; ++q) {
      for (const std::int32_t limit : {info->minimum, info->maximum}) {
        const double exact = std::ldexp(double(limit), int(q) - int(info->q));
        if (std::fabs(exact) > 2147483646.0) continue;
        const slot_entry_t entry = {info->id, q, static_cast<std::int32_t>(std::floor(exact + 0.5))};
        values_reset();
        ASSERT_NE(values_put(&entry), VALUE_REFUSED) << info->name << " q" << q;
        const std::int32_t raw = values_entry(k).raw;
        ASSERT_GE(raw, info->minimum);
        ASSERT_LE(raw, info->maximum);
        ASSERT_LE(std::fabs(double(raw) - limit), std::ldexp(1.0, std::max(0, int(info->q) - int(q))));
      }
    }
  }
}

TEST_F(Store, WhatIsOutOfItsRangeIsRefused) {
  Image image;
  image.entries = table();
  for (slot_entry_t& e : image.entries) {
    if (e.id == 8) e.raw = 101 << 20;         // current_limit, at most 100 A
    if (e.id == 60) e.raw = 9;                // position_source, at most 8
    if (e.id == 25) e = {25, 0, 2147483647};  // does not fit 32 bits any more
    if (e.id == 41) e.q = 32;                 // no format at all
  }
  put(0, image);
  EXPECT_EQ(power_on(), STORE_MIGRATED);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(store_report()->refused, 4);
  EXPECT_EQ(store_report()->first_refused, 8);
}

TEST_F(Store, UnknownNumbersAreKept) {
  for (const unsigned count : {1u, 7u, 8u, 9u, 100u, SLOT_ENTRIES_MAX - parameter_count()}) {
    SetUp();
    Image image;
    image.entries = table();
    std::vector<slot_entry_t> foreign;
    for (unsigned k = 0; k < count; ++k) {
      foreign.push_back(
          {static_cast<std::uint16_t>(1000 + k), static_cast<std::uint16_t>(k % 32), int(k * 77777) - 99});
      image.entries.insert(image.entries.begin() + std::min<int>(int(3 * k), int(image.entries.size())),
                           foreign.back());
    }
    put(1, image);
    EXPECT_EQ(power_on(), STORE_MIGRATED);
    EXPECT_EQ(store_report()->unknown, count);
    for (int n = 0; n < 3; ++n) {
      set_variant(n + 1);
      ASSERT_EQ(save(), STORE_SAVED);
      EXPECT_EQ(store_report()->unknown, count);
      const std::vector<slot_entry_t> now = entries_of(store_report()->slot);
      ASSERT_EQ(now.size(), parameter_count() + count);
      for (unsigned k = 0; k < count; ++k) {
        EXPECT_EQ(now[parameter_count() + k].id, foreign[k].id);
        EXPECT_EQ(now[parameter_count() + k].q, foreign[k].q);
        EXPECT_EQ(now[parameter_count() + k].raw, foreign[k].raw);
      }
    }
    EXPECT_EQ(power_on(), STORE_MIGRATED);
  }
}

TEST_F(Store, MoreUnknownNumbersThanThereIsRoomForAreNotGivenUp) {
  Image image;
  for (unsigned k = 0; k < SLOT_ENTRIES_MAX; ++k) image.entries.push_back({static_cast<std::uint16_t>(1000 + k), 0, 0});
  put(0, image);
  EXPECT_EQ(power_on(), STORE_MIGRATED);
  EXPECT_EQ(save(), STORE_FAILED);
  EXPECT_EQ(nvm.pages, 0);
}

TEST_F(Store, ANewerFormatIsToldFromDamage) {
  Image image;
  image.version = SLOT_VERSION + 1;
  image.sequence = 41;
  image.entries = table();
  put(0, image);
  EXPECT_EQ(power_on(), STORE_FOREIGN);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(save(), STORE_SAVED);
  EXPECT_EQ(store_report()->sequence, 42u);
  EXPECT_EQ(power_on(), STORE_LOADED);
  nvm.memory[30] ^= 1;
  nvm.memory[SLOT_SIZE] ^= 1;
  EXPECT_EQ(power_on(), STORE_DAMAGED);
}

TEST_F(Store, OlderValuesAreBetterThanNone) {
  Image image;
  image.entries = table();
  image.entries[7].raw = 12 << 20;
  put(0, image);
  image.version = SLOT_VERSION + 1;
  image.sequence = 2;
  put(1, image);
  EXPECT_EQ(power_on(), STORE_OLDER);
  EXPECT_EQ(parameters.current_limit, 12 << 20);
}

// The set of the newer firmware is the newest one: the save goes over the older one, and the next over that.
TEST_F(Store, ASaveSparesWhatANewerFirmwareSavedLast) {
  for (const unsigned foreign : {0u, 1u}) {
    nvm = FakeNvm{};
    Image image;
    image.entries = table();
    image.entries.push_back({9999, 0, 5});
    put(1 - foreign, image);
    image.version = SLOT_VERSION + 1;
    image.sequence = 2;
    put(foreign, image);
    const auto at = nvm.memory.begin() + foreign * SLOT_SIZE;
    const std::vector<std::uint8_t> kept(at, at + SLOT_SIZE);
    EXPECT_EQ(power_on(), STORE_OLDER);
    EXPECT_EQ(save(), STORE_SAVED);
    EXPECT_EQ(store_report()->slot, 1 - foreign);
    EXPECT_EQ(store_report()->sequence, 3u);
    EXPECT_TRUE(std::equal(kept.begin(), kept.end(), nvm.memory.begin() + foreign * SLOT_SIZE));
    EXPECT_EQ(power_on(), STORE_LOADED);
  }
}

TEST_F(Store, ValuesThatDoNotFitTogetherAreNotUsed) {
  Image image;
  image.entries = table();
  for (slot_entry_t& e : image.entries) {
    if (e.id == 8) e.raw = 15 << 20;         // current_limit: fine for itself
    if (e.id == 30) e.raw = (14 << 20) + 1;  // trip_current below it
  }
  put(0, image);
  EXPECT_EQ(power_on(), STORE_CONFLICT);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(parameter_conflict(), nullptr);
}

TEST_F(Store, EveryStateHasItsWords) {
  for (int s = STORE_EMPTY; s <= STORE_OLDER; ++s) {
    EXPECT_GT(bench::words_of(WORDS_STORE, static_cast<std::uint16_t>(s)).size(), 5u) << s;
  }
}

// ---- in its place ---------------------------------------------------------------------------------------------------

TEST_F(Store, TheDriveStaysInBootWhileItIsRead) {
  drive.loading = true;
  periods(100);
  EXPECT_EQ(drive.state, DRIVE_BOOT);
  drive.loading = false;
  periods(1);
  EXPECT_EQ(drive.state, DRIVE_CALIBRATE);
}

TEST_F(Store, ResetIsThePowerOnStateOfABoardWithoutOne) {
  power_on();
  save();
  drive_reset();
  EXPECT_EQ(store_state(), STORE_EMPTY);
  EXPECT_FALSE(store_is_busy());
  make_ready();
}

}  // namespace
