// The command from the bus: what counts, and what starts and stops the drive. Silence and faults are
// can_command_silence_test.cpp.

#include "tests/firmware/can_command.hpp"

#include <algorithm>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"

namespace stillspin::test {
namespace {

TEST_F(CanCommand, RunsAtTheSpeedAskedForAndStops) {
  make_running_by_bus();
  take(frame(CAN_MODE_RUN, 400));
  EXPECT_EQ(drive_commanded_speed(), 100 << 16) << "400 quarters of a revolution per minute";
  take(frame(CAN_MODE_RUN, -400));
  EXPECT_EQ(drive_commanded_speed(), -100 * 65536);
  take(frame(CAN_MODE_STOP));
  EXPECT_TRUE(inside::stop_requested());
}

// Its own time-out watches over the motor, and nobody else lets go of it.
TEST_F(CanCommand, TheMotorIsItsOwn) {
  make_running_by_bus();
  EXPECT_TRUE(comm_watchdog_is_on());
  EXPECT_FALSE(comm_watchdog_release());
  comm_watchdog_reset();
  parameters.can_reaction = CAN_REACTION_NONE;
  say(CAN_MODE_OFF, 0, 60);
  say(CAN_MODE_RUN, 0, 60);
  EXPECT_TRUE(drive_is_energised());
  EXPECT_FALSE(comm_watchdog_is_on()) << "it does nothing when the bus is silent";
}

TEST_F(CanCommand, OffOpensTheGates) {
  make_running_by_bus();
  say(CAN_MODE_OFF, 0, 10);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
  EXPECT_FALSE(command.commanding);
}

TEST_F(CanCommand, AModeThatDoesNotExistIsOff) {
  make_running_by_bus();
  say(3, 0, 10);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(CanCommand, RunFromTheFirstMessageOnStartsNothing) {
  make_ready();
  say(CAN_MODE_RUN, 400, 500);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  say(CAN_MODE_STOP, 0, 20);
  say(CAN_MODE_RUN, 0, 60);
  EXPECT_EQ(inside::state(), DRIVE_RUN) << "a change to run starts";
}

TEST_F(CanCommand, RunIsKeptUntilTheDriveIsReady) {
  periods(10);
  ASSERT_EQ(inside::state(), DRIVE_CALIBRATE);
  take(frame(CAN_MODE_OFF));
  say(CAN_MODE_RUN, 0, 120);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

TEST_F(CanCommand, DamagedRepeatedAndForeignCommandsDoNotCount) {
  make_running_by_bus();
  const std::uint16_t bad = command.bad;
  hal_can_frame_t f = frame(CAN_MODE_STOP);
  f.data[1] ^= 1;
  take(f);
  f = frame(CAN_MODE_STOP);
  take(f);
  const auto heard = command.heard_ms;
  inside::withdraw_stop();
  pass(5);
  take(f);
  EXPECT_EQ(command.heard_ms, heard) << "the same message again";
  f = frame(CAN_MODE_STOP);
  f.id++;
  take(f);
  f = frame(CAN_MODE_STOP);
  f.length = 8;
  take(f);
  EXPECT_EQ(command.bad - bad, 4);
}

TEST_F(CanCommand, GapsOfTheAliveCounterAreCounted) {
  make_ready();
  take(frame(CAN_MODE_OFF));
  take(frame(CAN_MODE_OFF));
  EXPECT_EQ(command.gaps, 0);
  alive = (alive + 3) % 16;
  take(frame(CAN_MODE_OFF));
  EXPECT_EQ(command.gaps, 3);
  EXPECT_EQ(command.bad, 0);
}

// The counts tell how bad the bus is, so they must not begin again at zero.
TEST_F(CanCommand, CountsGoToTheEndOfAWordAndStayThere) {
  take(frame(CAN_MODE_OFF));
  for (std::uint32_t n = 1; n <= 5000; ++n) {
    alive = (alive + 14) % 16;
    take(frame(CAN_MODE_OFF));
    ASSERT_EQ(command.gaps, std::min(14u * n, 65'535u));
  }
  const hal_can_frame_t bad = can_frame(CAN_COMMAND, 1);
  for (std::uint32_t n = 1; n <= 65'600; ++n) {
    take(bad);
    ASSERT_EQ(command.bad, std::min(n, 65'535u));
  }
}

// Whoever sends it may have counted for hours.
TEST_F(CanCommand, TheFirstCommandMayHaveAnyCount) {
  for (std::uint16_t count = 0; count < 16; ++count) {
    can_command_reset(&command);
    alive = (count + 15) % 16;
    take(frame(CAN_MODE_OFF));
    EXPECT_TRUE(command.heard) << count;
    EXPECT_EQ(command.gaps, 0) << count;
    EXPECT_EQ(command.bad, 0) << count;
  }
}

TEST_F(CanCommand, TheFirstOffOrStopIsAChangeToIt) {
  for (const std::int32_t mode : {CAN_MODE_OFF, CAN_MODE_STOP}) {
    board = FakeBoard{};
    drive_reset();
    SetUp();
    make_run();  // by somebody else
    take(frame(mode));
    EXPECT_EQ(inside::coast_requested(), mode == CAN_MODE_OFF);
    EXPECT_EQ(inside::stop_requested(), mode == CAN_MODE_STOP);
  }
}

TEST_F(CanCommand, WhatDoesNotCountDoesNothing) {
  make_running_by_bus();
  for (const std::int32_t mode : {CAN_MODE_OFF, CAN_MODE_STOP, CAN_MODE_RUN}) {
    hal_can_frame_t f = frame(mode, 400, true);
    f.data[3] ^= 1;
    take(f);
  }
  EXPECT_FALSE(inside::stop_requested());
  EXPECT_FALSE(inside::coast_requested());
  EXPECT_EQ(drive_commanded_speed(), 0);
  EXPECT_FALSE(command.clear_fault);
}

TEST_F(CanCommand, ARunGivenWhileSomebodyElseRunsTheDriveIsNotForLater) {
  make_run();
  say(CAN_MODE_OFF, 0, 0);
  can_command_reset(&command);
  take(frame(CAN_MODE_STOP));  // heard, and the drive runs on by its own start
  inside::withdraw_stop();
  say(CAN_MODE_RUN, 0, 30);
  ASSERT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_FALSE(command.commanding);
  drive_command_stop();
  say(CAN_MODE_RUN, 400, 300);
  EXPECT_EQ(inside::state(), DRIVE_READY) << "nobody has asked for a start since";
}

TEST_F(CanCommand, AStopForgetsAStartThatHasNotBeenTaken) {
  make_ready();
  say(CAN_MODE_OFF, 0, 20);
  inside::request_reload();  // holds the start back
  take(frame(CAN_MODE_RUN));
  ASSERT_TRUE(inside::start_requested());
  pass(1);
  EXPECT_TRUE(command.commanding) << "the start has only not been taken yet";
  take(frame(CAN_MODE_STOP));
  inside::withdraw_reload();
  pass(100);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(CanCommand, ASpeedIsTakenOnlyByADriveThatTheBusRuns) {
  make_running_by_bus();
  inside::be_in(DRIVE_FAULT);
  take(frame(CAN_MODE_RUN, 400));
  EXPECT_EQ(drive_commanded_speed(), 0) << "not for after the fault";
  inside::be_in(DRIVE_RUN);
  command.commanding = false;
  take(frame(CAN_MODE_RUN, 400));
  EXPECT_EQ(drive_commanded_speed(), 0) << "somebody else's";
}

TEST_F(CanCommand, AStopThatGoesOnDoesNotStopWhatSomebodyElseStarts) {
  make_ready();
  say(CAN_MODE_STOP, 0, 20);
  drive_command_start();
  say(CAN_MODE_STOP, 0, 100);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

TEST_F(CanCommand, AnotherStopEndsTheBusCommand) {
  make_running_by_bus();
  drive_command_coast();
  say(CAN_MODE_RUN, 0, 200);
  EXPECT_FALSE(command.commanding);
  EXPECT_EQ(inside::state(), DRIVE_READY) << "and the next run message does not start it again";
}

}  // namespace
}  // namespace stillspin::test
