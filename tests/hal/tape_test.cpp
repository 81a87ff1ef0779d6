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
