// Stop: to standstill within a time, then the power stage opens.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

/// Whatever happened must have opened the power stage, be latched, and stay so until the reset.
void expect_fault(drive_fault_t fault) {
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), fault);
  EXPECT_FALSE(board.gates_on);
  EXPECT_TRUE(board.lamp);
  EXPECT_FALSE(inside::loop_is_closed());
}

TEST_F(Drive, StopThatDoesNotReachStandstillFaults) {
  parameters.stop_time = 50;
  use_parameters();
  make_run();
  inside::config().synchronism.bad_periods = 1000000;  // these windows are no machine's
  drive_command_stop();
  int n = 0;
  while (inside::state() != DRIVE_FAULT && inside::state() != DRIVE_READY && n < 2000) {
    // an encoder that goes on at 5 rpm, above the 2 rpm that count as rest
    encoder.observer.speed_bpp = raw(5.0 / 60.0 * 4.0 * kPeriod, 32);
    inside::avv_angle_bam() = encoder.observer.angle_bam;
    period();
    n++;
  }
  expect_fault(FAULT_STOP);
  EXPECT_NEAR(n, 50 * DRIVE_PERIODS_PER_MS, 15);  // the ramp is at zero from the start; a millisecond of the speed task
}

// At two revolutions per minute or less, in either direction, once the ramp has come down.
TEST_F(Drive, AStopEndsAtTwoRevolutionsPerMinute) {
  for (const int tenths : {18, -18, 22, -22}) {
    SetUp();
    make_run();
    drive_command_stop();
    inside::ramped_bpp() = 0;
    inside::be_in(DRIVE_STOP);
    inside::selected().speed_bpp = bpp_of(1000) / 10000 * tenths;
    drive_sequence(&drive);
    EXPECT_EQ(inside::state(), std::abs(tenths) < 20 ? DRIVE_READY : DRIVE_STOP) << tenths;
    EXPECT_EQ(board.gates_on, std::abs(tenths) > 20) << tenths;
  }
}

}  // namespace
