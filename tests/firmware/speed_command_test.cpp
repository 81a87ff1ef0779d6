// The speed command: what it leads to, and that a fault puts it to zero wherever it comes.

#include <cstring>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

TEST_F(Drive, ASpeedCommandBeforeTheStartIsKept) {
  make_ready();
  drive_command_speed(raw(300.0, 16));
  make_run();
  inside::config().synchronism.bad_periods = 1000000;  // these windows are no machine's
  periods(20);
  EXPECT_GT(inside::ramped_bpp(), 0);
  EXPECT_NEAR(rad_per_s(inside::target_bpp()) / kTurn * 60.0 / 4.0, 300.0, 0.01);
}

TEST_F(Drive, AFaultPutsTheSpeedCommandToZero) {
  make_run();
  drive_command_speed(raw(300.0, 16));
  board.tripped_by_pin = true;
  period();
  EXPECT_EQ(inside::target_bpp(), 0);
  EXPECT_EQ(inside::command_rpm_q16(), 0);
  period();
  EXPECT_EQ(drive_commanded_speed(), 0) << "asked for before the fault";
  EXPECT_EQ(inside::target_bpp(), 0);
}

// Else a fault could come between command and target, and the next start would run to a speed that nobody sees.
TEST_F(Drive, ASpeedCommandWritesNothingThatTheInterruptWrites) {
  make_run();
  const drive_control_t before = inside::control();
  drive_command_speed(raw(300.0, 16));
  EXPECT_EQ(std::memcmp(&inside::control(), &before, sizeof before), 0);
  EXPECT_EQ(drive_commanded_speed(), raw(300.0, 16)) << "and yet it is seen";
  period();
  EXPECT_EQ(inside::command_rpm_q16(), raw(300.0, 16));
  EXPECT_NEAR(rad_per_s(inside::target_bpp()) / kTurn * 60.0 / 4.0, 300.0, 0.01);
}

// Wherever in the command a fault comes: what is said of the speed and what the next start runs to are one.
TEST_F(Drive, AFaultInTheMidstOfASpeedCommandLeavesCommandAndTargetAsOne) {
  for (const int at : {0, 1, 2}) {
    SetUp();
    make_run();
    drive_command_speed(raw(300.0, 16));
    period();
    const auto fault_at = [&](int place) {
      if (place == at) drive_trip(&drive, FAULT_EMERGENCY);
    };
    fault_at(0);
    inside::write_speed_request(raw(900.0, 16));
    fault_at(1);
    inside::mark_speed_request();
    fault_at(2);
    period();
    ASSERT_EQ(inside::state(), DRIVE_FAULT);
    const double said = drive_commanded_speed() / 65536.0;
    EXPECT_EQ(said, at < 2 ? 900.0 : 0.0) << "given after the fault, or before it";
    EXPECT_NEAR(rad_per_s(inside::target_bpp()) / kTurn * 60.0 / 4.0, said, 0.01);
  }
}

TEST_F(Drive, SpeedReferenceIsClampedToTheLimit) {
  for (const double rpm : {1000.0, 5000.0, -5000.0}) {
    drive_command_speed(raw(rpm, 16));
    period();
    const double expected = std::max(-3300.0, std::min(3300.0, rpm));
    EXPECT_NEAR(rad_per_s(inside::target_bpp()) / kTurn * 60.0 / 4.0, expected, 0.01);
  }
}

}  // namespace
