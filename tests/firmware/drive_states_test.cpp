// From power-on to ready and from there to a start: what each state waits for.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

TEST_F(Drive, FromBootToReadyWithTheGatesOff) {
  EXPECT_EQ(inside::state(), DRIVE_BOOT);
  period();
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
  make_ready();
  EXPECT_FALSE(board.gates_on);
  EXPECT_GT(board.enable_toggles, 300);  // the hardware watchdog of the gate driver
}

TEST_F(Drive, CalibrationTakesTheOffsets) {
  hal_adc_window_t w = still_window();
  w.start_a = 4 * 2048 + 25;
  w.start_b = 4 * 2048 - 13;
  for (int n = 0; n < 400; ++n) period(w);
  ASSERT_EQ(inside::state(), DRIVE_READY);
  // a first-order mean of 16 periods over 256; floor(x / 16) stops up to 15 short
  EXPECT_NEAR(real(inside::sensor_trim().offset_a_q8, 8), 2048.0 + 25.0 / 4.0, 16.0 / 256);
  EXPECT_NEAR(real(inside::sensor_trim().offset_b_q8, 8), 2048.0 - 13.0 / 4.0, 16.0 / 256);
}

TEST_F(Drive, AnImplausibleOffsetIsAFault) {
  hal_adc_window_t w = still_window();
  w.start_a = 4 * (2048 + 130);
  for (int n = 0; n < 400; ++n) period(w);
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_OFFSET);
  EXPECT_TRUE(board.lamp);
}

// A fast shaft drives a current through the diodes: its mean may look like an offset. Once it ends the drive is ready.
TEST_F(Drive, OffsetsAreNotTakenWhileACurrentFlows) {
  hal_adc_window_t w = still_window();
  for (int n = 0; n < 3000; ++n) {
    w.start_a = static_cast<std::uint16_t>(4 * (2048 + (n / 8 % 2 ? 200 : -200)));
    period(w);
    ASSERT_EQ(inside::state(), DRIVE_CALIBRATE) << n;
  }
  for (int n = 0; n < 400; ++n) period(still_window());
  ASSERT_EQ(inside::state(), DRIVE_READY);
  EXPECT_NEAR(real(inside::sensor_trim().offset_a_q8, 8), 2048.0, 16.0 / 256);
}

TEST_F(Drive, StartNeedsReady) {
  drive_command_start();
  periods(20);
  EXPECT_NE(inside::state(), DRIVE_START);
  EXPECT_FALSE(board.gates_on);
  make_ready();
  periods(50);
  EXPECT_EQ(inside::state(), DRIVE_READY) << "an early command must not be remembered";
}

TEST_F(Drive, StartRunStop) {
  make_run();
  EXPECT_TRUE(board.gates_on);
  EXPECT_TRUE(inside::loop_is_closed());
  drive_command_stop();
  periods(30);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
  EXPECT_FALSE(inside::loop_is_closed());
}

TEST_F(Drive, StartIsRefusedWithParametersThatDoNotFit) {
  make_ready();
  inside::config_valid() = false;
  drive_command_start();
  periods(3);
  EXPECT_EQ(inside::fault(), FAULT_PARAMETER);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(Drive, StartIsRefusedWhileTheComparatorIsLow) {
  make_ready();
  board.pin_low = true;
  drive_command_start();
  periods(10);  // the gates come on when the short circuit is what the modulator gives
  EXPECT_EQ(inside::fault(), FAULT_OVER_CURRENT);
  EXPECT_FALSE(board.gates_on);
}

}  // namespace
