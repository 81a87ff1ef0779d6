// What becomes of a drive when the command from the bus stays away, comes back, or finds a fault.

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "tests/firmware/can_command.hpp"

namespace stillspin::test {
namespace {

TEST_F(CanCommand, TheTimeOutIsAsLongAsItSays) {
  parameters.can_timeout = 50;
  inside::time_ms() = 1000;
  take(frame(CAN_MODE_OFF));
  can_command_service(&command, 1049);
  EXPECT_FALSE(command.timed_out);
  can_command_service(&command, 1050);
  EXPECT_TRUE(command.timed_out);
  take(frame(CAN_MODE_OFF));
  EXPECT_FALSE(command.timed_out) << "until a command counts again";
}

TEST_F(CanCommand, SilenceBeforeTheFirstCommandIsNoTimeOut) {
  make_ready();
  pass(1000);
  EXPECT_FALSE(command.timed_out);
}

TEST_F(CanCommand, WithoutAReactionTheBusKeepsTheCommand) {
  parameters.can_reaction = CAN_REACTION_NONE;
  make_running_by_bus();
  pass(300);
  EXPECT_TRUE(command.timed_out);
  EXPECT_TRUE(command.commanding);
  take(frame(CAN_MODE_RUN, 400));
  EXPECT_EQ(drive_commanded_speed(), 100 << 16) << "the next command goes on with it";
}

TEST_F(CanCommand, SilenceLeadsToTheConfiguredReaction) {
  const drive_state_t after[] = {DRIVE_RUN, DRIVE_STOP, DRIVE_READY};
  for (int reaction = 0; reaction <= 2; ++reaction) {
    board = FakeBoard{};
    drive_reset();
    SetUp();
    parameters.can_reaction = reaction;
    parameters.can_timeout = 50;
    make_running_by_bus();
    inside::ramped_bpp() = 50'000'000;  // it is turning: a stop takes a while
    pass(39);
    EXPECT_EQ(inside::state(), DRIVE_RUN);
    EXPECT_FALSE(command.timed_out);
    pass(3);
    EXPECT_TRUE(command.timed_out);
    EXPECT_EQ(inside::state(), after[reaction]) << "reaction " << reaction;
  }
}

TEST_F(CanCommand, CommandsThatComeBackDoNotStartItAgain) {
  parameters.can_reaction = CAN_REACTION_COAST;
  make_running_by_bus();
  pass(300);
  ASSERT_EQ(inside::state(), DRIVE_READY);
  say(CAN_MODE_RUN, 0, 300);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(command.timed_out);
  say(CAN_MODE_OFF, 0, 20);
  say(CAN_MODE_RUN, 0, 60);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

TEST_F(CanCommand, SilenceWhileOffDoesNotMakeTheNextRunAStart) {
  make_ready();
  say(CAN_MODE_OFF, 0, 20);
  pass(300);
  ASSERT_TRUE(command.timed_out);
  say(CAN_MODE_RUN, 0, 100);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(CanCommand, AFaultIsClearedByARisingBitAndTheDriveDoesNotStartByItself) {
  make_tripped();
  say(CAN_MODE_RUN, 0, 50);
  EXPECT_FALSE(command.commanding);
  take(frame(CAN_MODE_RUN, 0, true));
  pass(10);
  EXPECT_NE(inside::state(), DRIVE_FAULT);
  say(CAN_MODE_RUN, 0, 150);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(CanCommand, ARunGivenDuringAFaultIsForgotten) {
  make_tripped();
  say(CAN_MODE_OFF, 0, 20);
  say(CAN_MODE_RUN, 0, 20);
  drive_command_reset();  // somebody else clears it
  say(CAN_MODE_RUN, 0, 150);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

// In one message, and the fault is gone before the background level comes by again.
TEST_F(CanCommand, ARunThatClearsAFaultDoesNotStartToo) {
  make_tripped();
  say(CAN_MODE_OFF, 0, 20);
  take(frame(CAN_MODE_RUN, 0, true));
  periods(2);
  ASSERT_NE(inside::state(), DRIVE_FAULT);
  say(CAN_MODE_RUN, 0, 150);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(CanCommand, OnlyARisingBitClearsAndOnlyAFault) {
  make_ready();
  take(frame(CAN_MODE_OFF, 0, true));
  EXPECT_FALSE(inside::reset_requested()) << "there is no fault";
  inside::be_in(DRIVE_FAULT);
  take(frame(CAN_MODE_OFF, 0, true));
  EXPECT_FALSE(inside::reset_requested()) << "the bit has been there since before the fault";
  take(frame(CAN_MODE_OFF, 0, false));
  EXPECT_FALSE(inside::reset_requested());
  take(frame(CAN_MODE_OFF, 0, true));
  EXPECT_TRUE(inside::reset_requested());
}

TEST_F(CanCommand, ADriveThatSomebodyElseStartedIsNotStoppedBySilence) {
  make_ready();
  say(CAN_MODE_OFF, 0, 20);
  drive_command_start();
  pass(400);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_TRUE(command.timed_out);
  say(CAN_MODE_OFF, 0, 20);
  EXPECT_EQ(inside::state(), DRIVE_RUN) << "no change of mode";
  say(CAN_MODE_STOP, 0, 10);
  EXPECT_NE(inside::state(), DRIVE_RUN) << "a change to stop is meant";
}

TEST_F(CanCommand, TheClockMayWrap) {
  inside::time_ms() = 0xFFFFFF00u;
  make_running_by_bus();
  say(CAN_MODE_RUN, 0, 500);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  pass(250);
  EXPECT_TRUE(command.timed_out);
}

}  // namespace
}  // namespace stillspin::test
