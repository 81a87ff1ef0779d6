// States and faults: what opens the power stage, and what it takes to close it.

#include <cstring>

#include "sim_host/bench/texts.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/start/step.h"
}

namespace {

using namespace stillspin::test;
using stillspin::bench::text_of;

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

/// Whatever happened must have opened the power stage, be latched, and stay so until the reset.
void expect_fault(drive_fault_t fault) {
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), fault);
  EXPECT_FALSE(board.gates_on);
  EXPECT_TRUE(board.lamp);
  EXPECT_FALSE(inside::loop_is_closed());
}

TEST_F(Drive, ComparatorTrip) {
  make_run();
  board.tripped_by_pin = true;
  period();
  expect_fault(FAULT_OVER_CURRENT);
}

TEST_F(Drive, SampledCurrentBeyondTheTripLevel) {
  make_run();
  hal_adc_window_t w = still_window();
  const auto codes = [](double amps) { return 2048.0 + amps / 20.0 * 2048.0; };
  for (const double amps : {17.5, 18.5}) {  // the limit is 18 A
    w.start_a = static_cast<std::uint16_t>(4 * codes(amps));
    w.end_a = static_cast<std::uint16_t>(3 * codes(amps));
    w.start_b = static_cast<std::uint16_t>(4 * codes(-amps / 2));
    w.end_b = static_cast<std::uint16_t>(3 * codes(-amps / 2));
    period(w);
    if (amps < 18.0) {
      EXPECT_EQ(inside::state(), DRIVE_RUN);
    }
  }
  expect_fault(FAULT_CURRENT_LIMIT);
}

TEST_F(Drive, TheThirdPhaseIsWatchedToo) {
  make_run();
  hal_adc_window_t w = still_window();
  w.start_a = w.start_b = static_cast<std::uint16_t>(4 * (2048 + 10 * 102.4));  // 10 A each, so c has -20 A
  w.end_a = w.end_b = static_cast<std::uint16_t>(3 * (2048 + 10 * 102.4));
  period(w);
  expect_fault(FAULT_CURRENT_LIMIT);
}

TEST_F(Drive, LinkVoltageOutOfItsRange) {
  for (const double volts : {140.0, 430.0}) {
    SetUp();
    make_run();
    for (int n = 0; n < 40; ++n) period(still_window(volts));  // the filter takes a few windows
    expect_fault(volts < 200.0 ? FAULT_LINK_LOW : FAULT_LINK_HIGH);
  }
}

TEST_F(Drive, FivePeriodsWithoutSamplesAreBornSixAreNot) {
  make_run();
  for (int n = 0; n < 5; ++n) period(still_window(), 1);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  period();
  for (int n = 0; n < 5; ++n) period(still_window(), 1);
  EXPECT_EQ(inside::state(), DRIVE_RUN) << "one good period starts the count again";
  period(still_window(), 1);
  expect_fault(FAULT_NO_SAMPLES);
}

TEST_F(Drive, LateInterruptsRepeatThePatternAndFaultInTheEnd) {
  make_run();
  board.late = true;
  const int frames = board.frames;
  for (int n = 0; n < 8; ++n) period();
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_EQ(board.frames, frames);
  EXPECT_NE(inside::limits() & LIMIT_OVERRUN, 0);
  for (int n = 0; n < 5; ++n) period();
  expect_fault(FAULT_OVERRUN);
}

TEST_F(Drive, EstimatorsApartForTooLongAreDivergence) {
  make_run();
  const int allowed = parameters.divergence_time * DRIVE_PERIODS_PER_MS;
  int n = 0;
  while (inside::state() == DRIVE_RUN && n < 2 * allowed) {
    // the encoder says one thing, AVV is held 70 degrees away: beyond divergence_limit, less than a quarter turn
    inside::avv().observer.angle_bam = encoder.observer.angle_bam + 0x31C71C72u;
    period();
    n++;
  }
  expect_fault(FAULT_DIVERGENCE);
  EXPECT_NEAR(n, allowed, 3);
}

// An encoder that runs at 600 rpm over windows of a shaft at rest: there is one estimator, and no second opinion.
TEST_F(Drive, AnAngleThatRunsOnAloneIsALossOfSynchronism) {
  make_run();
  int n = 0;
  while (inside::state() == DRIVE_RUN && n < 400) {
    board.encoder = (board.encoder + 4u) & 4095u;
    inside::avv().observer.angle_bam = encoder.observer.angle_bam;
    period();
    n++;
  }
  expect_fault(FAULT_SYNCHRONISM);
}

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
  inside::request().reload = true;  // the background level never gets to it
  drive_command_coast();
  period();
  EXPECT_FALSE(board.gates_on);
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
    inside::avv().observer.angle_bam = encoder.observer.angle_bam;
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
    inside::speed_ramp().value = 0;
    inside::state() = DRIVE_STOP;
    inside::selected().speed_bpp = bpp_of(1000) / 10000 * tenths;
    drive_sequence(&drive);
    EXPECT_EQ(inside::state(), std::abs(tenths) < 20 ? DRIVE_READY : DRIVE_STOP) << tenths;
    EXPECT_EQ(board.gates_on, std::abs(tenths) > 20) << tenths;
  }
}

TEST_F(Drive, ASpeedCommandBeforeTheStartIsKept) {
  make_ready();
  drive_command_speed(raw(300.0, 16));
  make_run();
  inside::config().synchronism.bad_periods = 1000000;  // these windows are no machine's
  periods(20);
  EXPECT_GT(inside::speed_ramp().value, 0);
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
    inside::request().speed_rpm_q16 = raw(900.0, 16);
    fault_at(1);
    inside::request().speed = true;
    fault_at(2);
    period();
    ASSERT_EQ(inside::state(), DRIVE_FAULT);
    const double said = drive_commanded_speed() / 65536.0;
    EXPECT_EQ(said, at < 2 ? 900.0 : 0.0) << "given after the fault, or before it";
    EXPECT_NEAR(rad_per_s(inside::target_bpp()) / kTurn * 60.0 / 4.0, said, 0.01);
  }
}

// The gates must be safe to open at the highest speed: sqrt(3) * 0.16 Vs * 4 * 2 pi / 60 = 0.1161 V per rpm.
TEST_F(Drive, SpeedLimitWhoseEmfExceedsTheLinkIsAConflict) {
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.speed_limit = raw(3617.0, 8);  // 419.9 V of 420
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  parameters.speed_limit = raw(3619.0, 8);  // 420.1 V
  use_parameters();
  ASSERT_NE(parameter_conflict(), PACKED_NONE);
  EXPECT_NE(text_of(parameter_conflict()).find("speed_limit"), std::string::npos);
}

TEST_F(Drive, LinkRegulationLiesBetweenTheFaults) {
  for (const double volts : {150.0, 419.5, 430.0}) {
    parameters.link_regulation = raw(volts, 16);
    use_parameters();
    ASSERT_NE(parameter_conflict(), PACKED_NONE) << volts;
    EXPECT_NE(text_of(parameter_conflict()).find("link_regulation"), std::string::npos);
  }
  parameters.link_regulation = raw(419.0, 16);
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

TEST_F(Drive, FaultStaysUntilTheReset) {
  make_run();
  board.tripped_by_pin = true;
  period();
  drive_command_start();
  periods(20);
  expect_fault(FAULT_OVER_CURRENT);
  board.tripped_by_pin = false;
  drive_command_reset();
  periods(2);
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE) << "an implausible offset must not slip through a reset";
  periods(400);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  EXPECT_FALSE(board.lamp);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(Drive, SpeedReferenceIsClampedToTheLimit) {
  for (const double rpm : {1000.0, 5000.0, -5000.0}) {
    drive_command_speed(raw(rpm, 16));
    period();
    const double expected = std::max(-3300.0, std::min(3300.0, rpm));
    EXPECT_NEAR(rad_per_s(inside::target_bpp()) / kTurn * 60.0 / 4.0, expected, 0.01);
  }
}

TEST_F(Drive, AHoldWantsTheAlternatingLayout) {
  parameters.hold_time = 100;
  use_parameters();
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  for (const int excitation : {0, 1, 4}) {
    parameters.excitation = excitation;
    use_parameters();
    ASSERT_NE(parameter_conflict(), PACKED_NONE) << excitation;
    EXPECT_NE(text_of(parameter_conflict()).find("hold_time"), std::string::npos);
  }
}

TEST_F(Drive, AMapWithoutSaliencyIsNamed) {
  parameters.lqq_4 = raw(60.0, 16);
  ASSERT_NE(parameter_conflict(), PACKED_NONE);
  EXPECT_NE(text_of(parameter_conflict()).find("lqq"), std::string::npos);
  parameters.lqq_4 = raw(65.0, 16);
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

TEST_F(Drive, ACaughtRotorWithoutAnAxisIsAFault) {
  NEEDS("start/flying");
  make_run();
  inside::state() = DRIVE_START;
  starting = {};
  inside::flags().caught = true;
  inside::start_found().phase = START_CATCH;
  for (int n = 0; n < 300; ++n) {
    inside::avv().regression.information = 0;
    starting.axis.count = 0;
    period();
  }
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_START_VOLTAGE);
  EXPECT_LT(inside::missing_windows(), 5) << "windows there were";
}

}  // namespace
