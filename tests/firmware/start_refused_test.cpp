// What a start asks for before it closes the power stage, and where it gives up.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
}

namespace {

using namespace stillspin::test;

class StartRefused : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    use_source(0);
    parameters.polarity_check = 0;
    use_parameters();
    make_ready();
  }
  void until_on() {
    periods_until([] { return board.gates_on; });
  }
  void expect_refused(drive_fault_t fault) {
    const int frames_with_gates = board.gates_off_calls;
    drive_command_start();
    for (int n = 0; n < 10; ++n) {
      period();
      ASSERT_FALSE(board.gates_on) << n;
    }
    EXPECT_EQ(inside::state(), DRIVE_FAULT);
    EXPECT_EQ(inside::fault(), fault);
    EXPECT_GT(board.gates_off_calls, frames_with_gates);
  }
};

TEST_F(StartRefused, WithASpeedControlThatCouldNotBeSetUp) {
  inside::speed_ready() = false;
  expect_refused(FAULT_PARAMETER);
}

TEST_F(StartRefused, AfterAnInterruptThatNobodyExpected) {
  board.unexpected_interrupts = 1;
  expect_refused(FAULT_INTERRUPT);
}

TEST_F(StartRefused, WhileTheLinkIsNotCharged) {
  parameters.precharge_voltage = raw(200.0, 16);
  use_parameters();
  expect_refused(FAULT_PRECHARGE);
}

TEST_F(StartRefused, WhileTheEmergencyStopIsPressed) {
  parameters.emergency_stop = 1;
  use_parameters();
  board.emergency = true;
  expect_refused(FAULT_EMERGENCY);
}

TEST_F(StartRefused, WhereTheComparatorHoldsTheGatesWithoutALookForATurningShaft) {
  parameters.flying_start = 0;
  use_parameters();
  board.pin_low = true;
  expect_refused(FAULT_OVER_CURRENT);
  EXPECT_NE(inside::start_phase(), START_AXIS);
}

// Windows that never show the axis, for want of voltage: 20 ms, then the drive says so.
TEST_F(StartRefused, WithoutAnAxisItGivesUp) {
  parameters.flying_start = 0;
  use_parameters();
  drive_command_start();
  period();
  ASSERT_EQ(inside::state(), DRIVE_START);
  int n = 0;
  for (; n < 400 && inside::state() == DRIVE_START; ++n) {
    inside::avv_information() = 0;
    starting.axis.count = 0;
    period();
  }
  EXPECT_EQ(inside::fault(), FAULT_START_VOLTAGE);
  EXPECT_NEAR(n, 200, 3);
  EXPECT_FALSE(board.gates_on);
}

// All lower devices on for bootstrap_time, from when the gates are on; a current that flows through them is let die
// away.
TEST_F(StartRefused, TheBootstrapSuppliesAreChargedFirst) {
  parameters.bootstrap_time = raw(5.0, 16);
  parameters.flying_start = 0;
  use_parameters();
  drive_command_start();
  period();
  ASSERT_EQ(inside::start_phase(), START_CHARGE);
  EXPECT_FALSE(board.gates_on);
  int on = 0;
  for (int n = 0; n < 200 && inside::start_phase() == START_CHARGE; ++n) {
    period();
    on += board.gates_on ? 1 : 0;
    EXPECT_TRUE(inside::is_shorted() || inside::start_phase() != START_CHARGE);
  }
  EXPECT_EQ(inside::state(), DRIVE_START);
  EXPECT_NEAR(on, 50, 2);
}

// A period without samples says nothing of a current; the next one will.
TEST_F(StartRefused, ChargingGoesOnInAPeriodWithoutSamples) {
  parameters.bootstrap_time = raw(20.0, 16);
  use_parameters();
  drive_command_start();
  until_on();
  for (int n = 0; n < 4; ++n) period(still_window(), inside::sampled_pattern().window_count);
  EXPECT_EQ(inside::window_count(), 0);
  EXPECT_EQ(inside::start_phase(), START_CHARGE);
  EXPECT_TRUE(board.gates_on);
  EXPECT_EQ(starting.charged, 4);
}

TEST_F(StartRefused, AShortCircuitThatCarriesACurrentRests) {
  parameters.bootstrap_time = raw(20.0, 16);
  parameters.flying_start = 0;
  use_parameters();
  drive_command_start();
  until_on();
  hal_adc_window_t w = still_window();
  w.start_a = 4 * (2048 + 8 * 102);  // 8 A of 14
  w.end_a = 3 * (2048 + 8 * 102);
  for (int n = 0; n < 4; ++n) period(w);
  EXPECT_EQ(inside::start_phase(), START_CHARGE);
  EXPECT_FALSE(board.gates_on);
  int rest = 0;
  for (; rest < 100 && !board.gates_on; ++rest) period();
  EXPECT_NEAR(rest, 20, 4);
  EXPECT_EQ(inside::start_phase(), START_CHARGE) << "only what they were on counts";
}

// Whole periods, and no fewer than asked for.
TEST_F(StartRefused, ChargingTakesAsLongAsItIsTold) {
  for (const auto& [ms, periods_on] : {std::pair{5.0, 50}, {5.01, 51}}) {
    SetUp();
    parameters.bootstrap_time = raw(ms, 16);
    use_parameters();
    drive_command_start();
    until_on();
    inside::window_count() = 0;
    for (int n = 1; n < periods_on; ++n) start_state.step(&drive);
    EXPECT_EQ(inside::start_phase(), START_CHARGE) << ms;
    start_state.step(&drive);
    EXPECT_NE(inside::start_phase(), START_CHARGE) << ms;
  }
}

// Half of the largest current, on either axis and in either direction, in the latest window of a power stage that is
// on.
TEST_F(StartRefused, ACurrentOfHalfTheLimitEndsTheShortCircuit) {
  const double half = 0.5 * real(parameters.current_limit, 20);
  for (const Vector way : {Vector{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
    for (const double share : {0.98, 1.02}) {
      for (const bool latest : {false, true}) {
        for (const bool invalid : {false, true}) {
          SetUp();
          parameters.bootstrap_time = raw(20.0, 16);
          use_parameters();
          drive_command_start();
          until_on();
          inside::invalid_periods() = invalid ? 1 : 0;
          inside::window_count() = 2;
          inside::windows()[0].current_q20 = inside::windows()[1].current_q20 = {0, 0};
          inside::windows()[latest ? 1 : 0].current_q20 = raw_ab(way * (share * half), 20);
          start_state.step(&drive);
          EXPECT_EQ(board.gates_on, share < 1.0 || !latest || invalid) << share << latest << invalid;
        }
      }
    }
  }
}

// For a current to die away.
TEST_F(StartRefused, AShortCircuitRestsForTwoMilliseconds) {
  parameters.bootstrap_time = raw(20.0, 16);
  use_parameters();
  drive_command_start();
  until_on();
  inside::invalid_periods() = 0;
  inside::window_count() = 1;
  inside::windows()[0].current_q20 = {parameters.current_limit, 0};
  start_state.step(&drive);
  ASSERT_FALSE(board.gates_on);
  for (int n = 1; n < 20; ++n) start_state.step(&drive);
  EXPECT_FALSE(board.gates_on);
  start_state.step(&drive);
  EXPECT_TRUE(board.gates_on);
}

}  // namespace
