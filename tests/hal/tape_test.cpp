// The tape: interrupts are put back between the same two pieces of the drive's code as when it was recorded.

#include <gtest/gtest.h>

#include <string>

#include "hal/hal_tape.h"

namespace {

std::string order;  // what ran, in turn

// A window interrupt: reads its results, acts, makes a call of its own.
void window() {
  std::uint16_t results[TAPE_RESULTS];
  tape_take_results(results, TAPE_RESULTS);
  order += static_cast<char>('0' + results[0]);
  tape_call();
}

void interrupted_by(std::uint16_t number) {
  const std::uint16_t results[TAPE_RESULTS] = {number};
  tape_note_results(results, TAPE_RESULTS);
  order += static_cast<char>('0' + number);
  tape_call();
}

// Three calls with code between them; what comes in them when it is recorded.
void step(bool records) {
  hal_tape_step_begin();
  order += 'a';
  tape_call();
  if (records) interrupted_by(2);
  if (records) interrupted_by(3);
  order += 'b';
  tape_tell(TAPE_ENABLE, nullptr, 0u);
  tape_call();
  if (records) interrupted_by(4);
  order += 'c';
  tape_call();
  order += 'd';
  hal_tape_step_end();
}

class Tape : public ::testing::Test {
 protected:
  void SetUp() override { order.clear(); }
  void TearDown() override { hal_tape_start(TAPE_OFF, nullptr); }
};

TEST_F(Tape, InterruptsComeBackBetweenTheSamePieces) {
  hal_tape_start(TAPE_RECORDS, nullptr);
  interrupted_by(1);
  step(true);
  interrupted_by(5);
  ASSERT_TRUE(hal_tape_finish_period());
  const std::string recorded = order;
  EXPECT_EQ(recorded, "1a23b4cd5");
  const tape_period_t period = hal_tape.period;

  order.clear();
  hal_tape_start(TAPE_PLAYS, window);
  hal_tape.period = period;
  hal_tape.period.output_count = 0;
  step(false);
  EXPECT_TRUE(hal_tape_finish_period());
  EXPECT_EQ(order, recorded);
}

int taken = 0;  // steps

TEST_F(Tape, AStepIsTakenFromItBeforeTheNextBegins) {
  taken = 0;
  hal_tape_start(TAPE_RECORDS, [] {
    taken++;
    hal_tape_next_period();
  });
  step(false);
  EXPECT_EQ(taken, 0);
  step(false);
  EXPECT_EQ(taken, 1);
  EXPECT_EQ(hal_tape.period.output_count, 1) << "of the second alone";
}

// Work of the background that is asked for by a step and done behind that one or the next.
TEST_F(Tape, WorkIsDoneBehindTheStepThatItWasDoneBehind) {
  hal_tape_start(TAPE_RECORDS, nullptr);
  step(false);
  ASSERT_TRUE(hal_tape_finish_period());
  const tape_period_t without = hal_tape.period;
  hal_tape_next_period();
  step(false);
  EXPECT_TRUE(hal_tape_has_work(TAPE_RELOADED));
  hal_tape_work_begin(TAPE_RELOADED);
  EXPECT_TRUE(hal_tape.working);
  EXPECT_EQ(tape_note(7u), 7u);
  hal_tape_work_end();
  EXPECT_FALSE(hal_tape.working);
  ASSERT_TRUE(hal_tape_finish_period());
  const tape_period_t with = hal_tape.period;

  hal_tape_start(TAPE_PLAYS, window);
  hal_tape.period = without;
  step(false);
  EXPECT_FALSE(hal_tape_has_work(TAPE_RELOADED));
  EXPECT_TRUE(hal_tape_finish_period());
  hal_tape_next_period();
  hal_tape.period = with;
  step(false);
  EXPECT_FALSE(hal_tape_has_work(TAPE_EVALUATED)) << "another piece";
  ASSERT_TRUE(hal_tape_has_work(TAPE_RELOADED));
  hal_tape_work_begin(TAPE_RELOADED);
  EXPECT_EQ(tape_take(), 7u);
  hal_tape_work_end();
  EXPECT_FALSE(hal_tape_has_work(TAPE_RELOADED)) << "once";
  EXPECT_TRUE(hal_tape_finish_period());
}

void work(char name) {
  hal_tape_work_begin(TAPE_RELOADED);
  order += name;
  hal_tape_work_end();
}

void play_work(char name) {
  if (hal_tape_has_work(TAPE_RELOADED)) work(name);
}

// An interrupt that is late leaves the background level the beginning of its period.
TEST_F(Tape, WorkIsDoneOnTheSameSideOfTheStepBetweenTheSameWindows) {
  hal_tape_start(TAPE_RECORDS, nullptr);
  interrupted_by(1);
  work('X');
  step(true);
  interrupted_by(5);
  work('Y');
  interrupted_by(6);
  ASSERT_TRUE(hal_tape_finish_period());
  const std::string recorded = order;
  EXPECT_EQ(recorded, "1Xa23b4cd5Y6");
  const tape_period_t period = hal_tape.period;

  order.clear();
  hal_tape_start(TAPE_PLAYS, window);
  hal_tape.period = period;
  hal_tape.period.output_count = 0;
  play_work('X');
  EXPECT_FALSE(hal_tape_has_work(TAPE_RELOADED)) << "the next is behind the step";
  step(false);
  play_work('Y');
  EXPECT_FALSE(hal_tape_has_work(TAPE_RELOADED));
  EXPECT_TRUE(hal_tape_finish_period());
  EXPECT_EQ(order, recorded);
}

TEST_F(Tape, WorkThatIsLeftTearsIt) {
  hal_tape_start(TAPE_PLAYS, window);
  hal_tape.period.work_count = 1;
  hal_tape.period.works[0] = TAPE_RELOADED;
  step(false);
  EXPECT_FALSE(hal_tape_finish_period());
}

TEST_F(Tape, WorkThatThereIsNotTearsIt) {
  hal_tape_start(TAPE_PLAYS, window);
  step(false);
  hal_tape_work_begin(TAPE_RELOADED);
  hal_tape_work_end();
  EXPECT_EQ(order, "abcd");
  EXPECT_FALSE(hal_tape_finish_period());
}

TEST_F(Tape, AWindowWithoutAnInterruptTearsIt) {
  hal_tape_start(TAPE_PLAYS, nullptr);
  hal_tape.period.window_count = 1u;
  step(false);
  EXPECT_EQ(order, "abcd");
  EXPECT_FALSE(hal_tape_finish_period());
}

TEST_F(Tape, MoreWorkThanItHoldsTearsIt) {
  hal_tape_start(TAPE_RECORDS, nullptr);
  step(false);
  for (unsigned k = 0; k < TAPE_WORKS; k++) work('X');
  EXPECT_TRUE(hal_tape_finish_period());
  work('X');
  EXPECT_FALSE(hal_tape_finish_period());
}

// What is asked of the drive as a period ends is for the next step, and so is the work that it brings about.
TEST_F(Tape, APeriodThatEndsInItsStepIsTakenBeforeWork) {
  taken = 0;
  hal_tape_start(TAPE_RECORDS, [] {
    taken++;
    hal_tape_next_period();
  });
  EXPECT_FALSE(hal_tape_end_period()) << "there is no step on it";
  hal_tape_step_begin();
  EXPECT_FALSE(hal_tape_end_period());
  hal_tape_step_end();
  EXPECT_EQ(taken, 0);
  work('X');
  EXPECT_EQ(taken, 1);
  ASSERT_EQ(hal_tape.period.work_count, 1) << "of the next";
  step(false);
  EXPECT_TRUE(hal_tape_end_period());
}

TEST_F(Tape, APeriodThatEndsInWorkIsTakenBehindIt) {
  taken = 0;
  hal_tape_start(TAPE_RECORDS, [] {
    taken += 10 * hal_tape.period.work_count + 1;
    hal_tape_next_period();
  });
  step(false);
  hal_tape_work_begin(TAPE_RELOADED);
  EXPECT_FALSE(hal_tape_end_period());
  EXPECT_EQ(taken, 0);
  hal_tape_work_end();
  EXPECT_EQ(taken, 11) << "with the work";
  EXPECT_EQ(hal_tape.period.work_count, 0);
}

// A computer's word for where its work was done may be wrong.
TEST_F(Tape, WorkIsNotPlayedBehindWindowsThatThereAreNot) {
  hal_tape_start(TAPE_PLAYS, window);
  hal_tape.period.window_count = 1;
  hal_tape.period.windows[0].results[0] = 1;
  hal_tape.period.work_count = 1;
  hal_tape.period.works[0] = TAPE_RELOADED | 3u << 4;
  step(false);
  play_work('X');
  EXPECT_EQ(order, "1abcdX") << "the one, and the work behind it";
  EXPECT_TRUE(hal_tape_finish_period());
}

TEST_F(Tape, ResultsThatThereAreNotAreZeroAndTearIt) {
  std::uint16_t results[TAPE_RESULTS] = {9, 9};
  hal_tape_start(TAPE_PLAYS, window);
  tape_take_results(results, TAPE_RESULTS);
  EXPECT_EQ(results[0] | results[1], 0);
  step(false);
  EXPECT_FALSE(hal_tape_finish_period());
}

TEST_F(Tape, MoreThanItHoldsTearsIt) {
  const auto whole_with = [](unsigned inputs, unsigned windows) {
    const std::uint16_t results[] = {1, 2, 3};
    hal_tape_start(TAPE_RECORDS, nullptr);
    for (unsigned k = 0; k < inputs; k++) EXPECT_EQ(tape_note(7u), 7u);
    for (unsigned k = 0; k < windows; k++) tape_note_results(results, 3u);
    step(false);
    return hal_tape_finish_period();
  };
  EXPECT_TRUE(whole_with(TAPE_INPUTS, TAPE_WINDOWS));
  EXPECT_EQ(hal_tape.period.windows[TAPE_WINDOWS - 1].results[2], 3);
  EXPECT_EQ(hal_tape.period.windows[TAPE_WINDOWS - 1].results[3], 0) << "a slice has three";
  EXPECT_FALSE(whole_with(TAPE_INPUTS + 1, TAPE_WINDOWS));
  EXPECT_FALSE(whole_with(TAPE_INPUTS, TAPE_WINDOWS + 1));
}

TEST_F(Tape, AWindowThatNobodyReadsTearsIt) {
  hal_tape_start(TAPE_PLAYS, [] {});
  hal_tape.period.window_count = 1;
  step(false);
  EXPECT_FALSE(hal_tape_finish_period());
}

TEST_F(Tape, InputsThatAreLeftTearIt) {
  hal_tape_start(TAPE_PLAYS, window);
  hal_tape.period.input_count = 1;
  step(false);
  EXPECT_FALSE(hal_tape_finish_period());
}

}  // namespace
