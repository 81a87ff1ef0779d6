// The program fails while the motor turns: what becomes of the gates, and what the user is told. The list of these ways
// is in docs/board.md.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "hal/hal_time.h"
#include "tests/bench/loop.hpp"

namespace stillspin::bench {
namespace {

constexpr Tick kReady = 60 * kMillisecond;  // clock, offsets
constexpr Tick kWatchdog = 100 * Tick{HAL_WATCHDOG_PERIOD_US + 1};
constexpr Tick kNext = kPeriod;               // the program fails at its next step, at most a period later
constexpr Tick kServed = 11 * kPeriod;        // served once more for the last control interrupt, a millisecond later
constexpr Tick kFaultAt = 50 * kMillisecond;  // of a plan, from RUN on

class Failing : public ::testing::Test {
 protected:
  std::unique_ptr<VirtualBoard> desk;

  void switch_on(const FaultPlan& fault = {}, const std::map<std::string, double>& parameters = {}) {
    desk.reset();  // there is room for one
    BoardRequest request;
    request.setup.nominal = plant::PlantConfig();
    request.setup.solver = 1;  // fixed steps
    request.setup.fault = fault;
    request.parameters = parameters;
    desk = std::make_unique<VirtualBoard>(request);
    desk->advance(kReady);
    ASSERT_EQ(said().find("watchdog"), std::string::npos);
  }

  void wait_for_run() {
    for (int k = 0; k < 2000 && drive_state() != DRIVE_RUN; ++k) desk->advance(kMillisecond);
    ASSERT_EQ(drive_state(), DRIVE_RUN);
    ASSERT_TRUE(pins().any_device_on());
  }

  void start() {
    drive_command_speed(300 << 16);
    drive_command_start();
    wait_for_run();
  }

  void turn(const FaultPlan& fault = {}) {
    switch_on(fault);
    start();
  }

  // Answer to the command status.
  std::string said() {
    desk->serial().take();
    const std::string line = "status\r";
    desk->serial().send({line.begin(), line.end()}, desk->now());
    desk->advance(250 * kMillisecond);
    const auto octets = desk->serial().take();
    return {octets.begin(), octets.end()};
  }

  void advance_to(Tick t) { desk->advance(t - desk->now()); }

  // Since when the program has failed.
  Tick fail(chip::Failure how) {
    desk->fail(how);
    return desk->now();
  }

  // One reset so far. No device has been on since `by`, through the reset, until somebody starts the drive.
  void expect_off_until_a_start(Tick by) {
    EXPECT_EQ(resets(), 1u);
    desk->advance(kReady);
    EXPECT_NE(said().find("reset by the watchdog"), std::string::npos);
    EXPECT_EQ(drive_state(), DRIVE_READY);
    EXPECT_FALSE(pins().any_device_on());
    EXPECT_LE(pins().devices_off_since(), by);
    start();
    EXPECT_EQ(resets(), 1u);
  }

  const Board& pins() const { return desk->pins(); }
  std::uint64_t resets() const { return desk->statistics().resets; }
};

// The control interrupt goes on with all its protection: the gates are in good hands until the reset.
TEST_F(Failing, ABackgroundLevelThatHangsEndsInAReset) {
  turn();
  const Tick failed = fail(chip::Failure::kBackgroundHangs);
  desk->advance(24 * kMillisecond);
  EXPECT_EQ(resets(), 0u);
  EXPECT_EQ(drive_state(), DRIVE_RUN);
  EXPECT_TRUE(pins().any_device_on());
  EXPECT_GE(pins().enable_toggled(), desk->now() - kPeriod);
  advance_to(failed + kNext + kWatchdog);
  expect_off_until_a_start(failed + kNext + kWatchdog);
}

// Wherever in its period the drive is hit: in the control interrupt, or in a window's.
TEST_F(Failing, AnInterruptThatDoesNotReturnLosesTheGateEnable) {
  for (const Tick phase : {0, 1'500, 3'100, 4'700, 6'300, 7'900}) {
    turn();
    desk->advance(phase);
    const Tick failed = fail(chip::Failure::kInterruptHangs);
    const Tick off_by = failed + kNext + kEnableTimeout + kPeriod;  // the board looks once a period
    advance_to(off_by);
    EXPECT_LE(pins().enable_toggled(), failed + kNext) << phase;
    EXPECT_FALSE(pins().any_device_on()) << phase;
    EXPECT_EQ(resets(), 0u) << "the enable is the faster one";
    advance_to(failed + kNext + kWatchdog);
    expect_off_until_a_start(off_by);
  }
}

// As when something holds the interrupts off for ever. The background level lives and must not keep the gates.
TEST_F(Failing, AControlInterruptThatDoesNotComeLosesTheGateEnable) {
  FaultPlan none;
  none.late_interrupts = 100.0;
  none.late_interrupts_at = 0.05;
  none.late_interrupts_time = 0.03;
  turn(none);
  const Tick failed = desk->now() + kFaultAt, off_by = failed + kNext + kEnableTimeout + kPeriod;
  desk->advance(kFaultAt - 2 * kMillisecond);
  EXPECT_TRUE(pins().any_device_on());
  advance_to(off_by);
  EXPECT_LE(pins().enable_toggled(), failed + kNext);
  EXPECT_FALSE(pins().any_device_on());
  EXPECT_EQ(resets(), 0u);
  advance_to(failed + kNext + kServed + kWatchdog);
  expect_off_until_a_start(off_by);
}

TEST_F(Failing, AControlInterruptThatNeverComesAgainMeansResetsWithoutEnd) {
  FaultPlan none;
  none.late_interrupts = 100.0;
  none.late_interrupts_at = 0.05;
  turn(none);
  const Tick failed = desk->now() + kFaultAt;
  advance_to(failed + 400 * kMillisecond);
  EXPECT_GE(resets(), 8u) << "26 ms each, and the start";
  EXPECT_NE(drive_state(), DRIVE_RUN);
  EXPECT_FALSE(pins().any_device_on());
  EXPECT_LE(pins().devices_off_since(), failed + kNext + kEnableTimeout + kPeriod);
}

TEST_F(Failing, AnIllegalInstructionTripsTheGatesAtOnce) {
  turn();
  const Tick failed = fail(chip::Failure::kIllegalInstruction);
  desk->advance(kMillisecond);
  EXPECT_FALSE(pins().any_device_on());
  EXPECT_LE(pins().devices_off_since(), failed + kNext);
  EXPECT_EQ(drive_state(), DRIVE_FAULT) << "the control interrupt lives";
  EXPECT_EQ(drive_signals().fault, FAULT_INTERRUPT);
  EXPECT_EQ(resets(), 0u);
  advance_to(failed + kNext + kWatchdog);
  expect_off_until_a_start(failed + kNext);
}

TEST_F(Failing, ConversionsThatDoNotComeAreAFault) {
  FaultPlan lost;
  lost.lost_triggers_at = 0.05;
  lost.lost_triggers_time = 3600.0;
  turn(lost);
  const Tick failed = desk->now() + kFaultAt;
  advance_to(failed + 300 * kMillisecond);
  EXPECT_EQ(drive_signals().fault, FAULT_NO_SAMPLES);
  EXPECT_FALSE(pins().any_device_on());
  EXPECT_LE(pins().devices_off_since(), failed + 8 * kPeriod);
  EXPECT_EQ(resets(), 0u);
}

// Its pins stay as they are, and with them the vector that is on.
TEST_F(Failing, AChipThatADebuggerHaltsLosesTheGateEnable) {
  for (const Tick phase : {0, 1'500, 3'100, 4'700, 6'300, 7'900}) {
    turn();
    desk->advance(phase);
    const Tick failed = fail(chip::Failure::kHalted), off_by = failed + kNext + kEnableTimeout + kPeriod;
    EXPECT_TRUE(pins().any_device_on());
    advance_to(off_by);
    EXPECT_FALSE(pins().any_device_on()) << phase;
    EXPECT_LE(pins().enable_toggled(), failed + kNext) << phase;
    desk->advance(100 * kMillisecond);
    EXPECT_FALSE(pins().any_device_on()) << phase;
    EXPECT_LE(pins().devices_off_since(), off_by) << phase;
    EXPECT_EQ(resets(), 0u) << "the watchdog stands as well";
  }
}

// Whoever holds a switch closed has not asked for a start.
TEST_F(Failing, ARunSwitchThatIsStillClosedStartsNothingAfterTheReset) {
  switch_on({}, {{"speed_input", 1.0}, {"speed_input_full", 1000.0}});
  desk->set_input("speed", 1.5);
  desk->set_input("run", 1.0);
  wait_for_run();
  const Tick failed = fail(chip::Failure::kBackgroundHangs);
  desk->advance(1000 * kMillisecond);
  EXPECT_EQ(resets(), 1u);
  EXPECT_EQ(drive_state(), DRIVE_READY);
  EXPECT_FALSE(pins().any_device_on());
  EXPECT_LE(pins().devices_off_since(), failed + kNext + kWatchdog);
  desk->set_input("run", 0.0);
  desk->advance(10 * kMillisecond);
  desk->set_input("run", 1.0);
  wait_for_run();
}

}  // namespace
}  // namespace stillspin::bench
