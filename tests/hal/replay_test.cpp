// The recording: interrupts are put back between the same two pieces of the drive's code as when it was recorded.

#include <gtest/gtest.h>

#include <string>

#include "hal/hal_replay.h"

namespace {

std::string order;  // what ran, in turn

// A window interrupt: reads its results, acts, makes a call of its own.
void window() {
  std::uint16_t results[REPLAY_RESULTS];
  replay_take_results(results, REPLAY_RESULTS);
  order += static_cast<char>('0' + results[0]);
  replay_call();
}

void interrupted_by(std::uint16_t number) {
  const std::uint16_t results[REPLAY_RESULTS] = {number};
  replay_note_results(results, REPLAY_RESULTS);
  order += static_cast<char>('0' + number);
  replay_call();
}

// Three calls with code between them; what comes in them when it is recorded.
void step(bool records) {
  hal_replay_step_begin();
  order += 'a';
  replay_call();
  if (records) interrupted_by(2);
  if (records) interrupted_by(3);
  order += 'b';
  replay_output(REPLAY_ENABLE, nullptr, 0u);
  replay_call();
  if (records) interrupted_by(4);
  order += 'c';
  replay_call();
  order += 'd';
  hal_replay_step_end();
}

class Replay : public ::testing::Test {
 protected:
  void SetUp() override { order.clear(); }
  void TearDown() override { hal_replay_start(REPLAY_OFF, nullptr); }
};

TEST_F(Replay, InterruptsComeBackBetweenTheSamePieces) {
  hal_replay_start(REPLAY_RECORDS, nullptr);
  interrupted_by(1);
  step(true);
  interrupted_by(5);
  ASSERT_TRUE(hal_replay_finish_period());
  const std::string recorded = order;
  EXPECT_EQ(recorded, "1a23b4cd5");
  const replay_period_t period = hal_replay_period;

  order.clear();
  hal_replay_start(REPLAY_PLAYS, window);
  hal_replay_period = period;
  hal_replay_period.output_count = 0;
  step(false);
  EXPECT_TRUE(hal_replay_finish_period());
  EXPECT_EQ(order, recorded);
}

int taken = 0;  // steps

TEST_F(Replay, AStepIsTakenFromItBeforeTheNextBegins) {
  taken = 0;
  hal_replay_start(REPLAY_RECORDS, [] {
    taken++;
    hal_replay_next_period();
  });
  step(false);
  EXPECT_EQ(taken, 0);
  step(false);
  EXPECT_EQ(taken, 1);
  EXPECT_EQ(hal_replay_period.output_count, 1) << "of the second alone";
}

// Work of the background that is asked for by a step and done behind that one or the next.
TEST_F(Replay, WorkIsDoneBehindTheStepThatItWasDoneBehind) {
  hal_replay_start(REPLAY_RECORDS, nullptr);
  step(false);
  ASSERT_TRUE(hal_replay_finish_period());
  const replay_period_t without = hal_replay_period;
  hal_replay_next_period();
  step(false);
  EXPECT_TRUE(hal_replay_has_work(REPLAY_RELOADED));
  hal_replay_work_begin(REPLAY_RELOADED);
  EXPECT_TRUE(hal_replay.working);
  EXPECT_EQ(replay_note(7u), 7u);
  hal_replay_work_end();
  EXPECT_FALSE(hal_replay.working);
  ASSERT_TRUE(hal_replay_finish_period());
  const replay_period_t with = hal_replay_period;

  hal_replay_start(REPLAY_PLAYS, window);
  hal_replay_period = without;
  step(false);
  EXPECT_FALSE(hal_replay_has_work(REPLAY_RELOADED));
  EXPECT_TRUE(hal_replay_finish_period());
  hal_replay_next_period();
  hal_replay_period = with;
  step(false);
  EXPECT_FALSE(hal_replay_has_work(REPLAY_EVALUATED)) << "another piece";
  ASSERT_TRUE(hal_replay_has_work(REPLAY_RELOADED));
  hal_replay_work_begin(REPLAY_RELOADED);
  EXPECT_EQ(replay_take(), 7u);
  hal_replay_work_end();
  EXPECT_FALSE(hal_replay_has_work(REPLAY_RELOADED)) << "once";
  EXPECT_TRUE(hal_replay_finish_period());
}

void work(char name) {
  hal_replay_work_begin(REPLAY_RELOADED);
  order += name;
  hal_replay_work_end();
}

void play_work(char name) {
  if (hal_replay_has_work(REPLAY_RELOADED)) work(name);
}

// An interrupt that is late leaves the background level the beginning of its period.
TEST_F(Replay, WorkIsDoneOnTheSameSideOfTheStepBetweenTheSameWindows) {
  hal_replay_start(REPLAY_RECORDS, nullptr);
  interrupted_by(1);
  work('X');
  step(true);
  interrupted_by(5);
  work('Y');
  interrupted_by(6);
  ASSERT_TRUE(hal_replay_finish_period());
  const std::string recorded = order;
  EXPECT_EQ(recorded, "1Xa23b4cd5Y6");
  const replay_period_t period = hal_replay_period;

  order.clear();
  hal_replay_start(REPLAY_PLAYS, window);
  hal_replay_period = period;
  hal_replay_period.output_count = 0;
  play_work('X');
  EXPECT_FALSE(hal_replay_has_work(REPLAY_RELOADED)) << "the next is behind the step";
  step(false);
  play_work('Y');
  EXPECT_FALSE(hal_replay_has_work(REPLAY_RELOADED));
  EXPECT_TRUE(hal_replay_finish_period());
  EXPECT_EQ(order, recorded);
}

TEST_F(Replay, WorkThatIsLeftTearsIt) {
  hal_replay_start(REPLAY_PLAYS, window);
  hal_replay_period.work_count = 1;
  hal_replay_period.works[0] = REPLAY_RELOADED;
  step(false);
  EXPECT_FALSE(hal_replay_finish_period());
}

TEST_F(Replay, WorkThatThereIsNotTearsIt) {
  hal_replay_start(REPLAY_PLAYS, window);
  step(false);
  hal_replay_work_begin(REPLAY_RELOADED);
  hal_replay_work_end();
  EXPECT_EQ(order, "abcd");
  EXPECT_FALSE(hal_replay_finish_period());
}

TEST_F(Replay, AWindowWithoutAnInterruptTearsIt) {
  hal_replay_start(REPLAY_PLAYS, nullptr);
  hal_replay_period.window_count = 1u;
  step(false);
  EXPECT_EQ(order, "abcd");
  EXPECT_FALSE(hal_replay_finish_period());
}

TEST_F(Replay, MoreWorkThanItHoldsTearsIt) {
  hal_replay_start(REPLAY_RECORDS, nullptr);
  step(false);
  for (unsigned k = 0; k < REPLAY_WORKS; k++) work('X');
  EXPECT_TRUE(hal_replay_finish_period());
  work('X');
  EXPECT_FALSE(hal_replay_finish_period());
}

// What is asked of the drive as a period ends is for the next step, and so is the work that it brings about.
TEST_F(Replay, APeriodThatEndsInItsStepIsTakenBeforeWork) {
  taken = 0;
  hal_replay_start(REPLAY_RECORDS, [] {
    taken++;
    hal_replay_next_period();
  });
  EXPECT_FALSE(hal_replay_end_period()) << "there is no step on it";
  hal_replay_step_begin();
  EXPECT_FALSE(hal_replay_end_period());
  hal_replay_step_end();
  EXPECT_EQ(taken, 0);
  work('X');
  EXPECT_EQ(taken, 1);
  ASSERT_EQ(hal_replay_period.work_count, 1) << "of the next";
  step(false);
  EXPECT_TRUE(hal_replay_end_period());
}

TEST_F(Replay, APeriodThatEndsInWorkIsTakenBehindIt) {
  taken = 0;
  hal_replay_start(REPLAY_RECORDS, [] {
    taken += 10 * hal_replay_period.work_count + 1;
    hal_replay_next_period();
  });
  step(false);
  hal_replay_work_begin(REPLAY_RELOADED);
  EXPECT_FALSE(hal_replay_end_period());
  EXPECT_EQ(taken, 0);
  hal_replay_work_end();
  EXPECT_EQ(taken, 11) << "with the work";
  EXPECT_EQ(hal_replay_period.work_count, 0);
}

// A computer's word for where its work was done may be wrong.
TEST_F(Replay, WorkIsNotPlayedBehindWindowsThatThereAreNot) {
  hal_replay_start(REPLAY_PLAYS, window);
  hal_replay_period.window_count = 1;
  hal_replay_period.windows[0].results[0] = 1;
  hal_replay_period.work_count = 1;
  hal_replay_period.works[0] = REPLAY_RELOADED | 3u << 4;
  step(false);
  play_work('X');
  EXPECT_EQ(order, "1abcdX") << "the one, and the work behind it";
  EXPECT_TRUE(hal_replay_finish_period());
}

TEST_F(Replay, ResultsThatThereAreNotAreZeroAndTearIt) {
  std::uint16_t results[REPLAY_RESULTS] = {9, 9};
  hal_replay_start(REPLAY_PLAYS, window);
  replay_take_results(results, REPLAY_RESULTS);
  EXPECT_EQ(results[0] | results[1], 0);
  step(false);
  EXPECT_FALSE(hal_replay_finish_period());
}

TEST_F(Replay, MoreThanItHoldsTearsIt) {
  const auto whole_with = [](unsigned inputs, unsigned windows) {
    const std::uint16_t results[] = {1, 2, 3};
    hal_replay_start(REPLAY_RECORDS, nullptr);
    for (unsigned k = 0; k < inputs; k++) EXPECT_EQ(replay_note(7u), 7u);
    for (unsigned k = 0; k < windows; k++) replay_note_results(results, 3u);
    step(false);
    return hal_replay_finish_period();
  };
  EXPECT_TRUE(whole_with(REPLAY_INPUTS, REPLAY_WINDOWS));
  EXPECT_EQ(hal_replay_period.windows[REPLAY_WINDOWS - 1].results[2], 3);
  EXPECT_EQ(hal_replay_period.windows[REPLAY_WINDOWS - 1].results[3], 0) << "a slice has three";
  EXPECT_FALSE(whole_with(REPLAY_INPUTS + 1, REPLAY_WINDOWS));
  EXPECT_FALSE(whole_with(REPLAY_INPUTS, REPLAY_WINDOWS + 1));
}

TEST_F(Replay, AWindowThatNobodyReadsTearsIt) {
  hal_replay_start(REPLAY_PLAYS, [] {});
  hal_replay_period.window_count = 1;
  step(false);
  EXPECT_FALSE(hal_replay_finish_period());
}

TEST_F(Replay, InputsThatAreLeftTearIt) {
  hal_replay_start(REPLAY_PLAYS, window);
  hal_replay_period.input_count = 1;
  step(false);
  EXPECT_FALSE(hal_replay_finish_period());
}

}  // namespace
