// Coast: the power stage opens at once, whatever the drive is at.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

TEST_F(Drive, CoastOpensThePowerStageAtOnceAtAnySpeed) {
  make_run();
  encoder.observer.speed_bpp = raw(0.01, 32);
  drive_command_coast();
  period();
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  EXPECT_FALSE(board.gates_on);
  EXPECT_FALSE(inside::loop_is_closed());
}

TEST_F(Drive, CoastBreaksAStartOffAndOutlastsIt) {
  make_ready();
  drive_command_start();
  periods(20);
  ASSERT_EQ(inside::state(), DRIVE_START);
  drive_command_coast();
  drive_command_start();  // in the same period: the gates stay off
  periods(3);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(Drive, CoastDoesNotWaitForParameters) {
  make_run();
  inside::request_reload();  // the background level never gets to it
  drive_command_coast();
  period();
  EXPECT_FALSE(board.gates_on);
}

}  // namespace
