// What opens the power stage as a fault, and what it takes to close it again.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/start/step.h"
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
  EXPECT_NE(inside::modulation_limits() & LIMIT_OVERRUN, 0);
  for (int n = 0; n < 5; ++n) period();
  expect_fault(FAULT_OVERRUN);
}

TEST_F(Drive, EstimatorsApartForTooLongAreDivergence) {
  make_run();
  const int allowed = parameters.divergence_time * DRIVE_PERIODS_PER_MS;
  int n = 0;
  while (inside::state() == DRIVE_RUN && n < 2 * allowed) {
    // the encoder says one thing, AVV is held 70 degrees away: beyond divergence_limit, less than a quarter turn
    inside::avv_angle_bam() = encoder.observer.angle_bam + 0x31C71C72u;
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
    inside::avv_angle_bam() = encoder.observer.angle_bam;
    period();
    n++;
  }
  expect_fault(FAULT_SYNCHRONISM);
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

TEST_F(Drive, ACaughtRotorWithoutAnAxisIsAFault) {
  NEEDS("start/flying");
  make_run();
  inside::be_in(DRIVE_START);
  starting = {};
  inside::is_caught() = true;
  inside::start_phase() = START_CATCH;
  for (int n = 0; n < 300; ++n) {
    inside::avv_information() = 0;
    starting.axis.count = 0;
    period();
  }
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_START_VOLTAGE);
  EXPECT_LT(inside::missing_windows(), 5) << "windows there were";
}

}  // namespace
