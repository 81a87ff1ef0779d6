// A memory that is damaged, disturbed or worn: what is in force is a whole set, and what was wrong is told.

#include <algorithm>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/texts.hpp"
#include "tests/firmware/store.hpp"

namespace {

using namespace stillspin;
using namespace stillspin::test;

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
  nvm.memory[SLOT_SIZE] ^= 1;
  EXPECT_EQ(power_on(), STORE_DAMAGED);
  EXPECT_EQ(store_report()->damaged, 2);
  nvm.memory[100] ^= 1;
  nvm.memory[0] ^= 1;
  EXPECT_EQ(power_on(), STORE_OLDER) << "the newer one has lost only its magic";
  EXPECT_EQ(in_force(), first);
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
  const long before = nvm.jobs;
  power_on();
  const long jobs = nvm.jobs - before;
  for (long job = 0; job < jobs; ++job) {
    nvm.deaf_job = nvm.jobs + job;
    ASSERT_EQ(power_on(), STORE_LOADED) << job;
    ASSERT_EQ(in_force(), saved) << job;
    nvm.refused_job = nvm.jobs + job;
    ASSERT_EQ(power_on(), STORE_LOADED) << job;
    ASSERT_EQ(in_force(), saved) << job;
  }
}

// The second slot's header is asked for as patiently as the first one's, and at a later load as at power-on.
TEST_F(Store, EveryHeaderIsAskedForEquallyOften) {
  power_on();
  save();
  set_variant(1);
  const Values saved = in_force();
  save();
  const auto survives = [&](long job, long deaf) {
    nvm.deaf_job = nvm.jobs + job;
    nvm.deaf_jobs = deaf;
    return power_on() == STORE_LOADED && in_force() == saved;
  };
  long most[2] = {0, 0};  // failures in a row that the header of a slot survives; each takes two jobs without any
  for (const long slot : {0, 1}) {
    while (most[slot] < 100 && survives(2 * slot, most[slot] + 1)) most[slot]++;
  }
  EXPECT_GE(most[0], 1);
  EXPECT_EQ(most[1], most[0]);
  EXPECT_FALSE(survives(0, 1000)) << "not there at all";
  EXPECT_EQ(store_state(), STORE_ABSENT);
  EXPECT_TRUE(survives(0, most[0])) << "there again: no less patient than before";
}

// What was counted in a reading that failed counts for nothing, and what it has staged is gone.
TEST_F(Store, ADisturbanceLeavesNoTraceInTheReport) {
  constexpr std::uint16_t kFlips = 0x10;  // what a disturbance does to an octet
  Image image;
  for (slot_entry_t entry : table()) {
    if ((entry.id & kFlips) != 0) continue;  // so that a disturbed number is often one that is missing
    if (entry.id == 8) entry = {8, 8, 12 << 8};
    if (entry.id == 66) entry.q = 32;
    image.entries.push_back(entry);
  }
  for (std::uint16_t id = 2000; id < 2003; ++id) image.entries.push_back({id, 0, 7});
  put(1, image);
  const long quiet = nvm.octets;
  ASSERT_EQ(power_on(), STORE_MIGRATED);
  const long octets = nvm.octets - quiet;
  const Values values = in_force();
  const store_report_t report = *store_report();
  EXPECT_EQ(report.rescaled, 1);
  EXPECT_EQ(report.refused, 1);
  EXPECT_EQ(report.unknown, 3);
  EXPECT_GT(report.missing, 10);
  for (long at = 0; at < octets; ++at) {
    nvm.wrong_at_octet = nvm.octets + at;
    ASSERT_EQ(power_on(), STORE_MIGRATED) << at;
    ASSERT_EQ(in_force(), values) << at;
    const store_report_t again = *store_report();
    ASSERT_EQ(again.values, report.values) << at;
    ASSERT_EQ(again.rescaled, report.rescaled) << at;
    ASSERT_EQ(again.refused, report.refused) << at;
    ASSERT_EQ(again.first_refused, report.first_refused) << at;
    ASSERT_EQ(again.unknown, report.unknown) << at;
    ASSERT_EQ(again.missing, report.missing) << at;
    ASSERT_EQ(again.damaged, 0) << at;
  }
}

// Read again and again, each time otherwise: it is taken as it was read last, and the slot's check decides.
TEST_F(Store, AHeaderThatIsNeverTwiceTheSameHidesNoSlot) {
  power_on();
  set_variant(1);
  const Values saved = in_force();
  save();
  drive_reset();
  const long first = nvm.jobs;
  nvm.memory[SLOT_MAGIC_OCTETS] ^= 1;
  store_begin();
  while (store_is_busy()) {
    const long jobs = nvm.jobs;
    store_service();
    if (nvm.jobs > jobs && nvm.jobs - first <= 4) nvm.memory[SLOT_MAGIC_OCTETS] ^= 1;
  }
  EXPECT_EQ(store_state(), STORE_LOADED);
  EXPECT_EQ(in_force(), saved);
}

// Not taken by the driver, at any place of a save: what is in the memory is a whole set.
TEST_F(Store, AJobThatIsNotTakenSpoilsNoSet) {
  power_on();
  set_variant(1);
  save();
  set_variant(2);
  const Values old = in_force();
  save();
  set_variant(3);
  const Values fresh = in_force();
  const FakeNvm memory = nvm;
  save();
  const long jobs = nvm.jobs - memory.jobs;
  int failed = 0;
  for (long job = 0; job < jobs; ++job) {
    nvm = memory;
    power_on();
    for (const auto& [id, raw] : fresh) parameter_set(id, raw);
    nvm.refused_job = nvm.jobs + job;
    const bool saved = save() == STORE_SAVED;
    failed += saved ? 0 : 1;
    power_on();
    const Values now = in_force();
    ASSERT_TRUE(now == fresh || (!saved && now == old)) << job;
  }
  EXPECT_GT(failed, 20) << "pages, and the read-back";
}

// Its write-protect pin is high: it acknowledges all, and keeps what it has.
TEST_F(Store, AMemoryThatIsWriteProtectedIsNoticed) {
  power_on();
  for (int n = 1; n <= 3; ++n) {
    set_variant(n);
    save();
  }
  const Values kept = in_force();
  nvm.write_protected = true;
  set_variant(4);
  EXPECT_EQ(save(), STORE_FAILED);
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(in_force(), kept);
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

TEST_F(Store, EveryStateHasItsWords) {
  for (int s = STORE_EMPTY; s <= STORE_OLDER; ++s) {
    EXPECT_GT(bench::words_of(CATALOGUE_STORE, static_cast<std::uint16_t>(s)).size(), 5u) << s;
  }
}

}  // namespace
