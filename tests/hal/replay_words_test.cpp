// What the words of a recording's period are, and that a new one has nothing of the one before. Order is
// replay_test.cpp.

#include <gtest/gtest.h>

#include <vector>

#include "hal/hal_replay.h"

namespace {

int interrupts = 0;

class ReplayWords : public ::testing::Test {
 protected:
  void SetUp() override { interrupts = 0; }
  void TearDown() override { hal_replay_start(REPLAY_OFF, nullptr); }
  static void start(replay_mode_t mode) {
    hal_replay_start(mode, [] { ++interrupts; });
  }
  static void window() {
    const std::uint16_t results[REPLAY_RESULTS] = {1, 2, 3, 4, 5, 6};
    replay_note_results(results, REPLAY_RESULTS);
  }
  static void work(replay_work_t which) {
    hal_replay_work_begin(which);
    hal_replay_work_end();
  }
  static void step() {
    hal_replay_step_begin();
    hal_replay_step_end();
  }
  /// A drive that asks for whatever there is, of either kind.
  static void expect_work(bool reloaded, bool evaluated) {
    EXPECT_EQ(hal_replay_has_work(REPLAY_RELOADED), reloaded);
    EXPECT_EQ(hal_replay_has_work(REPLAY_EVALUATED), evaluated);
  }
};

TEST_F(ReplayWords, WorkHasItsKindItsSideAndTheWindowsBeforeIt) {
  start(REPLAY_RECORDS);
  work(REPLAY_EVALUATED);
  window();
  work(REPLAY_RELOADED);
  step();
  window();
  window();
  work(REPLAY_EVALUATED);
  work(REPLAY_RELOADED);
  const replay_period_t& p = hal_replay_period;
  ASSERT_EQ(p.work_count, 4);
  EXPECT_EQ(p.works[0], REPLAY_EVALUATED | 1u << 3);
  EXPECT_EQ(p.works[1], REPLAY_RELOADED | 1u << 3 | 1u << 4);
  EXPECT_EQ(p.works[2], REPLAY_EVALUATED | 3u << 4);
  EXPECT_EQ(p.works[3], REPLAY_RELOADED | 3u << 4);
}

TEST_F(ReplayWords, WorkIsOfferedByItsKindOnItsSideAlone) {
  start(REPLAY_PLAYS);
  replay_period_t& p = hal_replay_period;
  p.work_count = 3;
  p.works[0] = REPLAY_EVALUATED | 1u << 3;
  p.works[1] = REPLAY_RELOADED;
  p.works[2] = REPLAY_EVALUATED;
  expect_work(false, true);
  work(REPLAY_EVALUATED);
  expect_work(false, false);
  step();
  expect_work(true, false);
  work(REPLAY_RELOADED);
  expect_work(false, true);
  work(REPLAY_EVALUATED);
  expect_work(false, false);
  EXPECT_TRUE(hal_replay_finish_period());
}

TEST_F(ReplayWords, AWindowHasTheNumberOfTheCallItCameIn) {
  start(REPLAY_RECORDS);
  replay_call();  // the background's
  window();
  hal_replay_step_begin();
  window();
  replay_call();
  replay_call();
  window();
  hal_replay_step_end();
  replay_call();
  window();
  const replay_period_t& p = hal_replay_period;
  ASSERT_EQ(p.window_count, 4);
  EXPECT_EQ(p.windows[0].call, 0);
  EXPECT_EQ(p.windows[1].call, 0);
  EXPECT_EQ(p.windows[2].call, 2);
  EXPECT_EQ(p.windows[3].call, REPLAY_BEHIND);
  for (unsigned k = 0; k < REPLAY_RESULTS; ++k) EXPECT_EQ(p.windows[3].results[k], k + 1);
}

TEST_F(ReplayWords, InputsAreTakenInTheirOrderAndZeroBehindTheLast) {
  start(REPLAY_PLAYS);
  hal_replay_period.input_count = 2;
  hal_replay_period.inputs[0] = 11;
  hal_replay_period.inputs[1] = 22;
  EXPECT_EQ(replay_take(), 11);
  EXPECT_EQ(replay_take(), 22);
  EXPECT_TRUE(hal_replay_finish_period());
  EXPECT_EQ(replay_take(), 0);
  EXPECT_FALSE(hal_replay_finish_period()) << "it was too short";
}

TEST_F(ReplayWords, OutputsFitToTheLastWord) {
  const std::vector<std::uint16_t> words(REPLAY_OUTPUTS - 1, 7);
  start(REPLAY_RECORDS);
  replay_output(REPLAY_FRAME, words.data(), REPLAY_OUTPUTS - 1);
  EXPECT_EQ(hal_replay_period.output_count, REPLAY_OUTPUTS);
  EXPECT_EQ(hal_replay_period.outputs[0], REPLAY_FRAME);
  EXPECT_EQ(hal_replay_period.outputs[REPLAY_OUTPUTS - 1], 7);
  EXPECT_TRUE(hal_replay_finish_period());
  replay_output(REPLAY_ENABLE, nullptr, 0);
  EXPECT_EQ(hal_replay_period.output_count, REPLAY_OUTPUTS);
  EXPECT_FALSE(hal_replay_finish_period());
}

TEST_F(ReplayWords, WhatDoesNotFitLeavesTheRestAsItIs) {
  start(REPLAY_RECORDS);
  for (unsigned k = 0; k < REPLAY_WORKS + 1; ++k) work(REPLAY_RELOADED);
  for (std::uint16_t k = 0; k < REPLAY_INPUTS + 1; ++k) replay_note(k);
  for (std::uint16_t k = 0; k < REPLAY_OUTPUTS + 1; ++k) replay_output(REPLAY_LEGS, nullptr, 0);
  for (std::uint16_t k = 0; k < REPLAY_WINDOWS + 1; ++k) window();
  const replay_period_t& p = hal_replay_period;
  EXPECT_EQ(p.works[0], REPLAY_RELOADED | 1u << 3);
  EXPECT_EQ(p.works[REPLAY_WORKS - 1], REPLAY_RELOADED | 1u << 3);
  EXPECT_EQ(p.inputs[0], 0);
  EXPECT_EQ(p.inputs[REPLAY_INPUTS - 1], REPLAY_INPUTS - 1);
  EXPECT_EQ(p.outputs[0], REPLAY_LEGS);
  EXPECT_EQ(p.windows[0].call, 0);
  EXPECT_EQ(p.windows[REPLAY_WINDOWS - 1].results[REPLAY_RESULTS - 1], REPLAY_RESULTS);
  EXPECT_EQ(p.work_count, REPLAY_WORKS);
  EXPECT_EQ(p.input_count, REPLAY_INPUTS);
  EXPECT_EQ(p.output_count, REPLAY_OUTPUTS);
  EXPECT_EQ(p.window_count, REPLAY_WINDOWS);
}

TEST_F(ReplayWords, ANewPeriodHasNothingOfTheLast) {
  const auto expect_new = [] {
    const replay_period_t& p = hal_replay_period;
    EXPECT_EQ(p.input_count + p.output_count + p.window_count + p.work_count, 0);
    EXPECT_FALSE(hal_replay.stepped || hal_replay.playing || hal_replay.ended || hal_replay.torn);
    EXPECT_EQ(hal_replay.call + hal_replay.input + hal_replay.window + hal_replay.work, 0);
    EXPECT_TRUE(hal_replay_finish_period());
  };
  const auto use = [] {
    replay_note(1);
    replay_output(REPLAY_ENABLE, nullptr, 0);
    window();
    hal_replay_step_begin();
    replay_call();
    hal_replay_end_period();
    hal_replay_step_end();
    for (unsigned k = 0; k < REPLAY_WORKS + 1; ++k) work(REPLAY_RELOADED);
    EXPECT_FALSE(hal_replay_finish_period());
  };
  start(REPLAY_RECORDS);
  use();
  hal_replay_next_period();
  expect_new();
  use();
  start(REPLAY_RECORDS);
  expect_new();

  start(REPLAY_PLAYS);
  hal_replay_period.input_count = hal_replay_period.window_count = hal_replay_period.work_count = 1;
  hal_replay_period.works[0] = REPLAY_RELOADED;
  std::uint16_t results[REPLAY_RESULTS];
  replay_take();
  replay_take();
  replay_take_results(results, REPLAY_RESULTS);
  step();
  work(REPLAY_RELOADED);
  hal_replay_next_period();
  expect_new();
}

// A recording may be started anywhere in a period: that one's rest is not its own.
TEST_F(ReplayWords, AStepOrWorkThatGoesOnWhenItStartsIsNotOnIt) {
  start(REPLAY_RECORDS);
  hal_replay_step_begin();
  hal_replay_work_begin(REPLAY_RELOADED);
  start(REPLAY_RECORDS);
  replay_call();
  EXPECT_EQ(hal_replay.call, 0);
  step();
  EXPECT_TRUE(hal_replay_end_period()) << "nothing goes on";
}

TEST_F(ReplayWords, OnlyARecordingTakesNotes) {
  for (const replay_mode_t mode : {REPLAY_OFF, REPLAY_PLAYS}) {
    start(mode);
    EXPECT_EQ(replay_note(7), 7);
    window();
    work(REPLAY_RELOADED);
    EXPECT_EQ(hal_replay_period.input_count + hal_replay_period.window_count + hal_replay_period.work_count, 0);
    replay_output(REPLAY_ENABLE, nullptr, 0);
    EXPECT_EQ(hal_replay_period.output_count, mode == REPLAY_PLAYS ? 1 : 0) << "told again, to be compared";
  }
}

TEST_F(ReplayWords, WithoutOneWorkIsDoneWheneverItIsWanted) {
  start(REPLAY_OFF);
  expect_work(true, true);
  work(REPLAY_RELOADED);
  expect_work(true, true);
  start(REPLAY_RECORDS);
  expect_work(true, true);
}

// Who records takes periods; who plays is given them.
TEST_F(ReplayWords, OnlyARecordingAsksToBeTaken) {
  const std::pair<replay_mode_t, int> modes[] = {{REPLAY_OFF, 0}, {REPLAY_RECORDS, 1}, {REPLAY_PLAYS, 0}};
  for (const auto& [mode, asked] : modes) {
    start(mode);
    interrupts = 0;
    step();
    EXPECT_EQ(interrupts, 0);
    step();
    EXPECT_EQ(interrupts, asked) << "a step is on it when the next begins, mode " << mode;

    start(mode);
    interrupts = 0;
    hal_replay_step_begin();
    EXPECT_FALSE(hal_replay_end_period());
    hal_replay_step_end();
    hal_replay_work_begin(REPLAY_RELOADED);
    EXPECT_EQ(interrupts, asked) << "the period has ended before the work, mode " << mode;
  }
}

TEST_F(ReplayWords, APeriodWithoutAStepGoesOn) {
  start(REPLAY_RECORDS);
  EXPECT_FALSE(hal_replay_end_period());
  work(REPLAY_RELOADED);
  EXPECT_EQ(interrupts, 0) << "there is nothing to be taken";
  step();
  EXPECT_TRUE(hal_replay_end_period());
  work(REPLAY_RELOADED);
  EXPECT_EQ(interrupts, 0) << "it has been taken by who was told so";
}

TEST_F(ReplayWords, AWindowIsPlayedOnceWhateverItsOwnCallsAre) {
  hal_replay_start(REPLAY_PLAYS, [] {
    ++interrupts;
    EXPECT_EQ(hal_replay.window, interrupts - 1);
    replay_call();  // before it takes its results
    std::uint16_t results[REPLAY_RESULTS];
    replay_take_results(results, REPLAY_RESULTS);
    replay_call();
  });
  hal_replay_period.window_count = 3;
  for (unsigned k = 0; k < 3; ++k) hal_replay_period.windows[k].call = k == 2 ? REPLAY_BEHIND : 1;
  hal_replay_step_begin();
  EXPECT_EQ(interrupts, 0);
  replay_call();
  EXPECT_EQ(interrupts, 2) << "both came in the first call";
  replay_call();
  hal_replay_step_end();
  EXPECT_EQ(interrupts, 2) << "the last is behind the step";
  EXPECT_TRUE(hal_replay_finish_period());
  EXPECT_EQ(interrupts, 3);
}

}  // namespace
