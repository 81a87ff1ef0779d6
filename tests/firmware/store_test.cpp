// The parameter store: what comes back after a power-on, and what a job does; its slots are slot_test.cpp, a memory
// that fails store_damage_test.cpp.

#include "tests/firmware/store.hpp"

#include <set>

#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "sim_host/bench/texts.hpp"

namespace {

using namespace stillspin;
using namespace stillspin::test;

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
    EXPECT_TRUE(inside::reload_requested());
  }
}

TEST_F(Store, EveryParameterIsSaved) {
  power_on();
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    parameters_reset(&parameters);
    ASSERT_EQ(parameter_set(info->id, parameter_initial(info) == parameter_minimum(info) ? parameter_minimum(info) + 1
                                                                                         : parameter_initial(info) - 1),
              SET_OK);
    if (parameter_conflict() != PACKED_NONE) continue;
    const Values saved = in_force();
    ASSERT_EQ(save(), STORE_SAVED);
    ASSERT_EQ(power_on(), STORE_LOADED) << bench::text_of(parameter_name(info));
    ASSERT_EQ(in_force(), saved) << bench::text_of(parameter_name(info));
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
  inside::be_in(DRIVE_RUN);
  EXPECT_FALSE(store_load());
  EXPECT_FALSE(store_defaults());
  EXPECT_EQ(save(), STORE_SAVED) << "the background has time for it";
  inside::be_in(DRIVE_READY);
  ASSERT_TRUE(store_load());
  inside::be_in(DRIVE_START);  // meanwhile
  serve();
  EXPECT_EQ(store_state(), STORE_FAILED);
}

TEST_F(Store, LoadAndDefaultsOnCommand) {
  power_on();
  set_variant(3);
  const Values saved = in_force();
  save();
  inside::withdraw_reload();
  ASSERT_TRUE(store_defaults());
  EXPECT_EQ(in_force(), defaults());
  EXPECT_TRUE(inside::reload_requested());
  ASSERT_TRUE(store_load());
  EXPECT_EQ(store_state(), STORE_READING);
  serve();
  EXPECT_EQ(store_state(), STORE_LOADED);
  EXPECT_EQ(in_force(), saved);
}

// ---- in its place ---------------------------------------------------------------------------------------------------

TEST_F(Store, TheDriveStaysInBootWhileItIsRead) {
  inside::loading() = true;
  periods(100);
  EXPECT_EQ(inside::state(), DRIVE_BOOT);
  inside::loading() = false;
  periods(1);
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
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
