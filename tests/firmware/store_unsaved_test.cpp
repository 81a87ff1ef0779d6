// What would be lost with the power: how many parameters differ from what the next power-on has.

#include "firmware/api/status.h"
#include "firmware/dictionary/parameters.h"
#include "tests/firmware/console.hpp"
#include "tests/firmware/store.hpp"

namespace stillspin::test {
namespace {

TEST_F(Store, AChangeIsUnsavedUntilItIsSavedOrTakenBack) {
  EXPECT_EQ(power_on(), STORE_EMPTY);
  EXPECT_EQ(store_unsaved(), 0) << "a new memory leaves the defaults, and so will the next power-on";
  const std::int32_t before = parameters.stop_time;
  parameters.stop_time = before + 7;
  EXPECT_EQ(store_unsaved(), 1);
  parameters.ldq_1 = -5;
  EXPECT_EQ(store_unsaved(), 2);
  parameters.stop_time = before;
  EXPECT_EQ(store_unsaved(), 1) << "set back to what is kept";
  EXPECT_EQ(save(), STORE_SAVED);
  EXPECT_EQ(store_unsaved(), 0);
  parameters.ldq_1 = 0;
  EXPECT_EQ(store_unsaved(), 1) << "its default is not what is kept";
}

TEST_F(Store, LoadAndDefaultsAreComparedWithWhatIsKept) {
  power_on();
  set_variant(3);
  const auto changed = store_unsaved();
  EXPECT_EQ(changed, 5);
  save();
  EXPECT_TRUE(store_defaults());
  EXPECT_EQ(store_unsaved(), changed);
  EXPECT_TRUE(store_load());
  EXPECT_EQ(store_unsaved(), changed) << "while it is read";
  serve();
  EXPECT_EQ(store_unsaved(), 0);
  EXPECT_EQ(power_on(), STORE_LOADED);
  EXPECT_EQ(store_unsaved(), 0);
}

TEST_F(Store, WhatChangesDuringASaveIsUnsavedBehindIt) {
  power_on();
  parameters.stop_time = 1234;
  EXPECT_TRUE(store_save());
  parameters.pulse_time += 1;
  EXPECT_EQ(store_unsaved(), 1) << "nothing is kept yet: as it was when the save began";
  serve();
  EXPECT_EQ(store_unsaved(), 1) << "the pulse time";
  parameters.pulse_time -= 1;
  EXPECT_EQ(store_unsaved(), 0);
}

TEST_F(Store, BehindASaveThatFailedNobodyKnows) {
  power_on();
  parameters.stop_time = 1234;
  nvm.absent = true;
  EXPECT_TRUE(store_save());
  serve();
  ASSERT_EQ(store_state(), STORE_FAILED);
  EXPECT_EQ(store_unsaved(), UNSAVED_UNKNOWN);
  nvm.absent = false;
  EXPECT_EQ(save(), STORE_SAVED);
  EXPECT_EQ(store_unsaved(), 0);
}

TEST_F(Console, StatusSaysWhatIsNotSaved) {
  NEEDS("store");
  values_copy();  // what is kept, with what the tests' board needs
  EXPECT_TRUE(has(command("status", 3000), "parameters  fit together\r\n"));
  EXPECT_TRUE(has(command("set speed_ramp 100"), "speed_ramp = 100 rpm/s"));
  EXPECT_TRUE(
      has(command("status", 3000), "parameters  fit together; 1 of the parameters not saved: 'save' keeps them\r\n"));
  EXPECT_TRUE(has(command("set speed_ramp 3000"), "speed_ramp = 3000 rpm/s"));
  EXPECT_TRUE(has(command("status", 3000), "parameters  fit together\r\n"));
}

}  // namespace
}  // namespace stillspin::test
