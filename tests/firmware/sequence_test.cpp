// The states of the drive: what ends its calibration, and what a request does where it is of no use.

#include <algorithm>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/commissioning/commissioning.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/states.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
}

namespace {

using namespace stillspin::test;

class States : public Drive {};

TEST_F(States, CalibrationWithoutSamplesIsAFault) {
  const auto silent = [this] { period(still_window(), inside::sampled_pattern().window_count); };
  for (int n = 0; n < 1990; ++n) silent();
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
  for (int n = 0; n < 30; ++n) silent();
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_NO_SAMPLES);
}

TEST_F(States, EitherSensorsOffsetMustBePlausible) {
  for (const auto& [a, b] : {std::pair{95, 95}, {-95, -95}, {105, 0}, {-105, 0}, {0, 105}, {0, -105}}) {
    SetUp();
    hal_adc_window_t w = still_window();
    w.start_a = static_cast<std::uint16_t>(4 * (2048 + a));
    w.start_b = static_cast<std::uint16_t>(4 * (2048 + b));
    for (int n = 0; n < 600; ++n) period(w);
    const bool good = std::abs(a) < 100 && std::abs(b) < 100;
    EXPECT_EQ(inside::state(), good ? DRIVE_READY : DRIVE_FAULT) << a << " " << b;
    EXPECT_EQ(inside::fault(), good ? FAULT_NONE : FAULT_OFFSET);
  }
}

// A current that never ends is no offset: after ten seconds the drive says so.
TEST_F(States, ACurrentThatDoesNotEndIsAFaultAfterTenSeconds) {
  const auto restless = [this](int n) {
    hal_adc_window_t w = still_window();
    w.start_b = static_cast<std::uint16_t>(4 * (2048 + (n / 8 % 2 ? 60 : -60)));
    period(w);
  };
  for (int n = 0; n < 99990; ++n) restless(n);
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
  for (int n = 0; n < 30; ++n) restless(n);
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_OFFSET);
}

// Offsets are looked for as long after a fault as at first: a sensor that has drifted meanwhile is followed.
TEST_F(States, AResetCalibratesAnew) {
  make_ready();
  periods(1000);
  inside::settled_at() = 50000;  // a current has flowed for seconds then
  drive_trip(&drive, FAULT_OFFSET);
  drive_command_reset();
  hal_adc_window_t w = still_window();
  w.start_a = static_cast<std::uint16_t>(4 * (2048 + 8));
  w.end_a = static_cast<std::uint16_t>(3 * (2048 + 8));
  period(w);
  ASSERT_EQ(inside::state(), DRIVE_CALIBRATE);
  for (int n = 0; n < 255; ++n) period(w);
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
  period(w);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_NEAR(real(inside::sensor_trim().offset_a_q8, 8), 2048 + 8, 0.1);
}

// The same request twice, or one that its state has no use for, does nothing and is not remembered.
TEST_F(States, RequestsThatAStateHasNoUseForAreForgotten) {
  make_run();
  drive_command_reset();
  drive_command_start();
  drive_command_commission();
  periods(3);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_FALSE(inside::start_requested() || inside::reset_requested() || inside::state_requested() != nullptr ||
               inside::stop_requested());
  drive_command_stop();
  periods(30);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  drive_command_stop();
  periods(5);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(States, AStopBreaksAStartOffAndOpensThePowerStage) {
  make_ready();
  drive_command_start();
  periods(20);
  ASSERT_EQ(inside::state(), DRIVE_START);
  drive_command_stop();
  period();
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
}

// A shaft that a commissioning turns is brought to rest; its gates stay on until it stands.
TEST_F(States, AStopInACommissioningsSpinBrakesTheShaft) {
  NEEDS("commissioning");
  make_run();
  inside::be_in(DRIVE_COMMISSION);
  commissioning.outcome = COMMISSIONING_RUNNING;
  commissioning.phase = COMMISSIONING_SPIN;
  commissioning.tick = 1;
  for (const bool turning : {true, false}) {
    inside::be_in(DRIVE_COMMISSION);
    inside::spins() = turning;
    commissioning.outcome = COMMISSIONING_RUNNING;
    commissioning.phase = COMMISSIONING_ALIGN;
    board.gates_on = true;
    inside::withdraw_reload();  // the background level has been there
    drive_command_stop();
    drive_sequence(&drive);
    EXPECT_EQ(inside::state(), turning ? DRIVE_STOP : DRIVE_READY);
    EXPECT_EQ(board.gates_on, turning);
    EXPECT_EQ(commissioning.outcome, COMMISSIONING_ABORTED);
  }
}

// With the gates off already and the background level at work a stop has nothing to break off.
TEST_F(States, AStopLetsAnEvaluationEnd) {
  NEEDS("commissioning");
  make_ready();
  inside::be_in(DRIVE_COMMISSION);
  commissioning.outcome = COMMISSIONING_RUNNING;
  commissioning.phase = COMMISSIONING_EVALUATE;
  commissioning.evaluate = true;
  inside::is_over() = true;
  drive_command_stop();
  drive_sequence(&drive);
  EXPECT_EQ(inside::state(), DRIVE_COMMISSION);
  EXPECT_EQ(commissioning.outcome, COMMISSIONING_RUNNING);
  commissioning.evaluate = false;
  drive_sequence(&drive);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

// A hundred codes off the middle is too much, and what would leave the formats of the samples is not even used.
TEST_F(States, AnOffsetEndsWhereTheSamplesFormatsDo) {
  for (const int quarters : {399, -399, 401, -401, 1200, -1200}) {
    for (const bool first : {true, false}) {
      SetUp();
      hal_adc_window_t w = still_window();
      (first ? w.start_a : w.start_b) = static_cast<std::uint16_t>(4 * 2048 + quarters);
      for (int n = 0; n < 600; ++n) period(w);
      EXPECT_EQ(inside::state(), std::abs(quarters) < 400 ? DRIVE_READY : DRIVE_FAULT) << quarters;
      const double off =
          real(first ? inside::sensor_trim().offset_a_q8 : inside::sensor_trim().offset_b_q8, 8) - 2048.0;
      EXPECT_NEAR(off, std::clamp(quarters / 4.0, -128.0, 128.0), 0.1) << quarters;
    }
  }
}

// Both sensors together may be ten codes off their offsets, which noise never is.
TEST_F(States, ACurrentIsWhatIsTenCodesOff) {
  for (const auto& [a, b] : {std::pair{38, 0}, {0, 38}, {19, 19}, {44, 0}, {0, 44}, {22, 22}}) {
    SetUp();
    for (int n = 0; n < 600; ++n) {
      hal_adc_window_t w = still_window();
      const int sign = n % 2 == 0 ? 1 : -1;
      w.start_a = static_cast<std::uint16_t>(4 * 2048 + sign * a);  // quarters of a code
      w.start_b = static_cast<std::uint16_t>(4 * 2048 - sign * b);
      period(w);
    }
    EXPECT_EQ(inside::state(), a + b < 40 ? DRIVE_READY : DRIVE_CALIBRATE) << a << " " << b;
  }
}

// The watchdogs of gate driver and processor live on these.
TEST_F(States, EveryPeriodCounts) {
  make_ready();
  const int toggles = board.enable_toggles;
  const std::uint32_t in_state = inside::periods();
  const std::uint16_t beats = inside::heartbeat();
  periods(7);
  EXPECT_EQ(board.enable_toggles, toggles + 7);
  EXPECT_EQ(inside::periods(), in_state + 7);
  EXPECT_EQ(inside::heartbeat(), beats + 7);
}

TEST_F(States, TheDriveBootsUntilItsValuesAreThere) {
  inside::loading() = true;
  periods(100);
  EXPECT_EQ(inside::state(), DRIVE_BOOT);
  inside::loading() = false;
  period();
  EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
  EXPECT_EQ(inside::periods(), 0u);
}

// Gates off at once, whatever is under way; what a commissioning has changed for itself must come back.
TEST_F(States, ACoastEndsACommissioning) {
  NEEDS("commissioning");
  make_run();
  commissioning_t& c = commissioning;
  inside::be_in(DRIVE_COMMISSION);
  c.outcome = COMMISSIONING_RUNNING;
  c.phase = COMMISSIONING_MAP;
  drive_command_coast();
  drive_sequence(&drive);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
  EXPECT_EQ(c.outcome, COMMISSIONING_ABORTED);
  EXPECT_EQ(c.phase, COMMISSIONING_IDLE);
  EXPECT_TRUE(inside::reload_requested());
}

TEST_F(States, ACoastIsCarriedOutOnce) {
  make_run();
  drive_command_coast();
  period();
  EXPECT_EQ(inside::state(), DRIVE_READY);
  drive_command_start();
  period();
  EXPECT_EQ(inside::state(), DRIVE_START);
  SetUp();
  make_ready();
  const std::uint32_t in_state = inside::periods();
  drive_command_coast();
  period();
  EXPECT_EQ(inside::periods(), in_state + 1) << "a power stage that is off has nothing to switch off";
}

// What was asked for before and not carried out yet must not outlive the stop that follows.
TEST_F(States, AStopForgetsWhatWasAskedForBefore) {
  for (void (*end)() : {drive_command_stop, drive_command_coast}) {
    for (void (*begin)() : {drive_command_start, drive_command_commission}) {
      SetUp();
      make_ready();
      begin();
      end();
      periods(3);
      EXPECT_EQ(inside::state(), DRIVE_READY);
      EXPECT_FALSE(board.gates_on);
    }
  }
}

// A commissioning that a fault has ended, and the background level has not been there since.
TEST_F(States, AStartBehindAFailedCommissioningIsAStart) {
  make_ready();
  commissioning.outcome = COMMISSIONING_RUNNING;
  drive_command_start();
  drive_sequence(&drive);
  ASSERT_EQ(inside::state(), DRIVE_START);
  start_run(&drive, 0, 0);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

TEST_F(States, WhereThePowerStageIsOnAndWhereTheShaftIsTurned) {
  const struct {
    drive_state_t state;
    bool energised, turning;
  } cases[] = {{DRIVE_BOOT, false, false}, {DRIVE_CALIBRATE, false, false}, {DRIVE_READY, false, false},
               {DRIVE_START, true, false}, {DRIVE_RUN, true, true},         {DRIVE_STOP, true, true},
               {DRIVE_FAULT, false, false}};
  for (const bool spin : {false, true}) {
    for (const auto& c : cases) {
      inside::spins() = spin;
      drive_enter(&drive, c.state);
      EXPECT_EQ(drive_is_energised(), c.energised) << c.state;
      EXPECT_EQ(drive_is_turning(&drive), c.turning) << c.state;
    }
    drive_enter(&drive, DRIVE_COMMISSION);
    inside::spins() = spin;
    EXPECT_TRUE(drive_is_energised());
    EXPECT_EQ(drive_is_turning(&drive), spin);
    inside::is_over() = true;
    EXPECT_FALSE(drive_is_energised());
  }
}

TEST_F(States, AFeaturesStateHasItsPlace) {
  NEEDS("commissioning");
  EXPECT_EQ(drive_states[DRIVE_START], &start_state);
  EXPECT_EQ(drive_states[DRIVE_COMMISSION], &commissioning_state);
  EXPECT_EQ(drive_states[DRIVE_RUN] != nullptr, (start_phases[START_IF_RAMP] != nullptr));
  for (const drive_state_t own : {DRIVE_BOOT, DRIVE_CALIBRATE, DRIVE_READY, DRIVE_STOP, DRIVE_FAULT})
    EXPECT_EQ(drive_states[own], nullptr) << own;
}

// With the reference at zero a shaft that goes on turning has stop_time, whatever the last one took of it.
TEST_F(States, EachStopHasItsWholeTime) {
  make_run();
  parameters.stop_time = 50;
  use_parameters();
  inside::stopping_periods() = 400;
  drive_command_stop();
  drive_sequence(&drive);
  ASSERT_EQ(inside::state(), DRIVE_STOP);
  inside::selected().speed_bpp = bpp_of(5);
  inside::ramped_bpp() = 1;
  for (int n = 0; n < 100; ++n) drive_sequence(&drive);  // the ramp has its own time
  inside::ramped_bpp() = 0;
  for (int n = 0; n < 500; ++n) drive_sequence(&drive);
  EXPECT_EQ(inside::state(), DRIVE_STOP);
  drive_sequence(&drive);
  EXPECT_EQ(inside::fault(), FAULT_STOP);
}

}  // namespace
