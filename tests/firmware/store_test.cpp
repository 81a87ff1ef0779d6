// The parameter store: what comes back after a power-on, from this firmware, another one, or a damaged memory.

#include "tests/firmware/store_test.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
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
  for (const std::uint32_t from : {0u, 5u, 0x80000000u, 0xFFFFFFFEu}) {
    EXPECT_TRUE(slot_is_newer(from + 0x7FFFFFFFu, from)) << "half of the circle is ahead";
    EXPECT_FALSE(slot_is_newer(from + 0x80000001u, from)) << "the other half behind";
  }
}

// Other firmwares and the host's tools read it: the octets, not only what the drive reads back.
TEST(Slot, ItsOctetsAreTheDocumentedOnes) {
  const slot_header_t header = {SLOT_MAGIC, 0x0102, 0x0304, 0x05060708, 0x0304};
  std::uint16_t octets[SLOT_HEADER];
  slot_pack_header(&header, octets);
  const std::vector<std::uint16_t> expected = {'S', 'S', 'P', '1', 2, 1, 4, 3, 8, 7, 6, 5, 4, 3, 0, 0};
  EXPECT_EQ(std::vector<std::uint16_t>(octets, octets + SLOT_HEADER), expected);
  const slot_entry_t entry = {0x0102, 31, -2};
  slot_pack_entry(&entry, octets);
  const std::vector<std::uint16_t> packed = {2, 1, 31, 0, 0xFE, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(std::vector<std::uint16_t>(octets, octets + SLOT_ENTRY), packed);
}

TEST(Slot, OnlyErasedOctetsAreBlank) {
  std::uint16_t octets[SLOT_HEADER];
  std::fill(std::begin(octets), std::end(octets), 0xFF);
  EXPECT_TRUE(slot_is_blank(octets));
  for (std::uint16_t& octet : octets) {
    octet = 0xFE;
    EXPECT_FALSE(slot_is_blank(octets));
    octet = 0xFF;
  }
}

TEST_F(Store, ANewMemoryLeavesTheDefaults) {
  EXPECT_EQ(power_on(), STORE_EMPTY);
  EXPECT_EQ(in_force(), defaults());
  EXPECT_EQ(nvm.pages, 0);
  EXPECT_EQ(store_report()->slot, SLOTS) << "none";
  EXPECT_EQ(store_report()->newest, SLOTS);
  EXPECT_EQ(store_report()->damaged, 0);
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
    EXPECT_EQ(store_report()->newest, (n - 1) % 2);
    EXPECT_EQ(store_report()->values, parameter_count());
    EXPECT_EQ(power_on(), STORE_LOADED);
    EXPECT_EQ(store_report()->slot, (n - 1) % 2);
    EXPECT_EQ(store_report()->newest, (n - 1) % 2);
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
    if (parameter_conflict() != PACKED_NONE) continue;
    const Values saved = in_force();
    ASSERT_EQ(save(), STORE_SAVED);
    ASSERT_EQ(power_on(), STORE_LOADED) << bench::text_of(info->name);
    ASSERT_EQ(in_force(), saved) << bench::text_of(info->name);
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
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(store_save());
    EXPECT_EQ(store_state(), STORE_SAVING);
    EXPECT_EQ(store_progress(), 0) << "of this job, not of the one before";
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
    EXPECT_GE(last, 90) << "no jump at the end";
    EXPECT_EQ(store_progress(), 100);
  }
  ASSERT_TRUE(store_load());
  EXPECT_EQ(store_progress(), 0);
  int half = 0, last = 0;
  for (store_service(); store_is_busy(); store_service()) {
    EXPECT_GE(store_progress(), last);
    last = store_progress();
    half += last > 30 && last < 70 ? 1 : 0;
  }
  EXPECT_GT(half, 10) << "of reading, too";
  EXPECT_GE(last, 90);
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
  ASSERT_TRUE(store_save());
  drive_reset();
  EXPECT_EQ(store_state(), STORE_EMPTY);
  EXPECT_FALSE(store_is_busy());
  make_ready();
}

}  // namespace
