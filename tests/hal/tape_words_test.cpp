// What the words of a tape's period are, and that a new one has nothing of the one before. Order is tape_test.cpp.

#include <gtest/gtest.h>

#include <vector>

#include "hal/hal_tape.h"

namespace {

int interrupts = 0;

class TapeWords : public ::testing::Test {
 protected:
  void SetUp() override { interrupts = 0; }
  void TearDown() override { hal_tape_start(TAPE_OFF, nullptr); }
  static void start(tape_mode_t mode) {
    hal_tape_start(mode, [] { ++interrupts; });
  }
  static void window() {
    const std::uint16_t results[TAPE_RESULTS] = {1, 2, 3, 4, 5, 6};
    tape_note_results(results, TAPE_RESULTS);
  }
  static void work(tape_work_t which) {
    hal_tape_work_begin(which);
    hal_tape_work_end();
  }
  static void step() {
    hal_tape_step_begin();
    hal_tape_step_end();
  }
  /// A drive that asks for whatever there is, of either kind.
  static void expect_work(bool reloaded, bool evaluated) {
    EXPECT_EQ(hal_tape_has_work(TAPE_RELOADED), reloaded);
    EXPECT_EQ(hal_tape_has_work(TAPE_EVALUATED), evaluated);
  }
};

TEST_F(TapeWords, WorkHasItsKindItsSideAndTheWindowsBeforeIt) {
  start(TAPE_RECORDS);
  work(TAPE_EVALUATED);
  window();
  work(TAPE_RELOADED);
  step();
  window();
  window();
  work(TAPE_EVALUATED);
  work(TAPE_RELOADED);
  const tape_period_t& p = hal_tape.period;
  ASSERT_EQ(p.work_count, 4);
  EXPECT_EQ(p.works[0], TAPE_EVALUATED | 1u << 3);
  EXPECT_EQ(p.works[1], TAPE_RELOADED | 1u << 3 | 1u << 4);
  EXPECT_EQ(p.works[2], TAPE_EVALUATED | 3u << 4);
  EXPECT_EQ(p.works[3], TAPE_RELOADED | 3u << 4);
}

TEST_F(TapeWords, WorkIsOfferedByItsKindOnItsSideAlone) {
  start(TAPE_PLAYS);
  tape_period_t& p = hal_tape.period;
  p.work_count = 3;
  p.works[0] = TAPE_EVALUATED | 1u << 3;
  p.works[1] = TAPE_RELOADED;
  p.works[2] = TAPE_EVALUATED;
  expect_work(false, true);
  work(TAPE_EVALUATED);
  expect_work(false, false);
  step();
  expect_work(true, false);
  work(TAPE_RELOADED);
  expect_work(false, true);
  work(TAPE_EVALUATED);
  expect_work(false, false);
  EXPECT_TRUE(hal_tape_finish_period());
}

TEST_F(TapeWords, AWindowHasTheNumberOfTheCallItCameIn) {
  start(TAPE_RECORDS);
  tape_call();  // the background's
  window();
  hal_tape_step_begin();
  window();
  tape_call();
  tape_call();
  window();
  hal_tape_step_end();
  tape_call();
  window();
  const tape_period_t& p = hal_tape.period;
  ASSERT_EQ(p.window_count, 4);
  EXPECT_EQ(p.windows[0].call, 0);
  EXPECT_EQ(p.windows[1].call, 0);
  EXPECT_EQ(p.windows[2].call, 2);
  EXPECT_EQ(p.windows[3].call, TAPE_BEHIND);
  for (unsigned k = 0; k < TAPE_RESULTS; ++k) EXPECT_EQ(p.windows[3].results[k], k + 1);
}

TEST_F(TapeWords, InputsAreTakenInTheirOrderAndZeroBehindTheLast) {
  start(TAPE_PLAYS);
  hal_tape.period.input_count = 2;
  hal_tape.period.inputs[0] = 11;
  hal_tape.period.inputs[1] = 22;
  EXPECT_EQ(tape_take(), 11);
  EXPECT_EQ(tape_take(), 22);
  EXPECT_TRUE(hal_tape_finish_period());
  EXPECT_EQ(tape_take(), 0);
  EXPECT_FALSE(hal_tape_finish_period()) << "it was too short";
}

TEST_F(TapeWords, OutputsFitToTheLastWord) {
  const std::vector<std::uint16_t> words(TAPE_OUTPUTS - 1, 7);
  start(TAPE_RECORDS);
  tape_tell(TAPE_FRAME, words.data(), TAPE_OUTPUTS - 1);
  EXPECT_EQ(hal_tape.period.output_count, TAPE_OUTPUTS);
  EXPECT_EQ(hal_tape.period.outputs[0], TAPE_FRAME);
  EXPECT_EQ(hal_tape.period.outputs[TAPE_OUTPUTS - 1], 7);
  EXPECT_TRUE(hal_tape_finish_period());
  tape_tell(TAPE_ENABLE, nullptr, 0);
  EXPECT_EQ(hal_tape.period.output_count, TAPE_OUTPUTS);
  EXPECT_FALSE(hal_tape_finish_period());
}

TEST_F(TapeWords, WhatDoesNotFitLeavesTheRestAsItIs) {
  start(TAPE_RECORDS);
  for (unsigned k = 0; k < TAPE_WORKS + 1; ++k) work(TAPE_RELOADED);
  for (std::uint16_t k = 0; k < TAPE_INPUTS + 1; ++k) tape_note(k);
  for (std::uint16_t k = 0; k < TAPE_OUTPUTS + 1; ++k) tape_tell(TAPE_LEGS, nullptr, 0);
  for (std::uint16_t k = 0; k < TAPE_WINDOWS + 1; ++k) window();
  const tape_period_t& p = hal_tape.period;
  EXPECT_EQ(p.works[0], TAPE_RELOADED | 1u << 3);
  EXPECT_EQ(p.works[TAPE_WORKS - 1], TAPE_RELOADED | 1u << 3);
  EXPECT_EQ(p.inputs[0], 0);
  EXPECT_EQ(p.inputs[TAPE_INPUTS - 1], TAPE_INPUTS - 1);
  EXPECT_EQ(p.outputs[0], TAPE_LEGS);
  EXPECT_EQ(p.windows[0].call, 0);
  EXPECT_EQ(p.windows[TAPE_WINDOWS - 1].results[TAPE_RESULTS - 1], TAPE_RESULTS);
  EXPECT_EQ(p.work_count, TAPE_WORKS);
  EXPECT_EQ(p.input_count, TAPE_INPUTS);
  EXPECT_EQ(p.output_count, TAPE_OUTPUTS);
  EXPECT_EQ(p.window_count, TAPE_WINDOWS);
}

TEST_F(TapeWords, ANewPeriodHasNothingOfTheLast) {
  const auto expect_new = [] {
    const tape_period_t& p = hal_tape.period;
    EXPECT_EQ(p.input_count + p.output_count + p.window_count + p.work_count, 0);
    EXPECT_FALSE(hal_tape.stepped || hal_tape.playing || hal_tape.ended || hal_tape.torn);
    EXPECT_EQ(hal_tape.call + hal_tape.input + hal_tape.window + hal_tape.work, 0);
    EXPECT_TRUE(hal_tape_finish_period());
  };
  const auto use = [] {
    tape_note(1);
    tape_tell(TAPE_ENABLE, nullptr, 0);
    window();
    hal_tape_step_begin();
    tape_call();
    hal_tape_end_period();
    hal_tape_step_end();
    for (unsigned k = 0; k < TAPE_WORKS + 1; ++k) work(TAPE_RELOADED);
    EXPECT_FALSE(hal_tape_finish_period());
  };
  start(TAPE_RECORDS);
  use();
  hal_tape_next_period();
  expect_new();
  use();
  start(TAPE_RECORDS);
  expect_new();

  start(TAPE_PLAYS);
  hal_tape.period.input_count = hal_tape.period.window_count = hal_tape.period.work_count = 1;
  hal_tape.period.works[0] = TAPE_RELOADED;
  std::uint16_t results[TAPE_RESULTS];
  tape_take();
  tape_take();
  tape_take_results(results, TAPE_RESULTS);
  step();
  work(TAPE_RELOADED);
  hal_tape_next_period();
  expect_new();
}

// A tape may be started anywhere in a period: that one's rest is not its own.
TEST_F(TapeWords, AStepOrWorkThatGoesOnWhenItStartsIsNotOnIt) {
  start(TAPE_RECORDS);
  hal_tape_step_begin();
  hal_tape_work_begin(TAPE_RELOADED);
  start(TAPE_RECORDS);
  tape_call();
  EXPECT_EQ(hal_tape.call, 0);
  step();
  EXPECT_TRUE(hal_tape_end_period()) << "nothing goes on";
}

TEST_F(TapeWords, OnlyARecordingTakesNotes) {
  for (const tape_mode_t mode : {TAPE_OFF, TAPE_PLAYS}) {
    start(mode);
    EXPECT_EQ(tape_note(7), 7);
    window();
    work(TAPE_RELOADED);
    EXPECT_EQ(hal_tape.period.input_count + hal_tape.period.window_count + hal_tape.period.work_count, 0);
    tape_tell(TAPE_ENABLE, nullptr, 0);
    EXPECT_EQ(hal_tape.period.output_count, mode == TAPE_PLAYS ? 1 : 0) << "told again, to be compared";
  }
}

TEST_F(TapeWords, WithoutOneWorkIsDoneWheneverItIsWanted) {
  start(TAPE_OFF);
  expect_work(true, true);
  work(TAPE_RELOADED);
  expect_work(true, true);
  start(TAPE_RECORDS);
  expect_work(true, true);
}

// Who records takes periods; who plays is given them.
TEST_F(TapeWords, OnlyARecordingAsksToBeTaken) {
  const std::pair<tape_mode_t, int> modes[] = {{TAPE_OFF, 0}, {TAPE_RECORDS, 1}, {TAPE_PLAYS, 0}};
  for (const auto& [mode, asked] : modes) {
    start(mode);
    interrupts = 0;
    step();
    EXPECT_EQ(interrupts, 0);
    step();
    EXPECT_EQ(interrupts, asked) << "a step is on it when the next begins, mode " << mode;

    start(mode);
    interrupts = 0;
    hal_tape_step_begin();
    EXPECT_FALSE(hal_tape_end_period());
    hal_tape_step_end();
    hal_tape_work_begin(TAPE_RELOADED);
    EXPECT_EQ(interrupts, asked) << "the period has ended before the work, mode " << mode;
  }
}

TEST_F(TapeWords, APeriodWithoutAStepGoesOn) {
  start(TAPE_RECORDS);
  EXPECT_FALSE(hal_tape_end_period());
  work(TAPE_RELOADED);
  EXPECT_EQ(interrupts, 0) << "there is nothing to be taken";
  step();
  EXPECT_TRUE(hal_tape_end_period());
  work(TAPE_RELOADED);
  EXPECT_EQ(interrupts, 0) << "it has been taken by who was told so";
}

TEST_F(TapeWords, AWindowIsPlayedOnceWhateverItsOwnCallsAre) {
  hal_tape_start(TAPE_PLAYS, [] {
    ++interrupts;
    EXPECT_EQ(hal_tape.window, interrupts - 1);
    tape_call();  // before it takes its results
    std::uint16_t results[TAPE_RESULTS];
    tape_take_results(results, TAPE_RESULTS);
    tape_call();
  });
  hal_tape.period.window_count = 3;
  for (unsigned k = 0; k < 3; ++k) hal_tape.period.windows[k].call = k == 2 ? TAPE_BEHIND : 1;
  hal_tape_step_begin();
  EXPECT_EQ(interrupts, 0);
  tape_call();
  EXPECT_EQ(interrupts, 2) << "both came in the first call";
  tape_call();
  hal_tape_step_end();
  EXPECT_EQ(interrupts, 2) << "the last is behind the step";
  EXPECT_TRUE(hal_tape_finish_period());
  EXPECT_EQ(interrupts, 3);
}

}  // namespace
