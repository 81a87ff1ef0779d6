// The states of the drive: what ends its calibration, and what a request does where it is of no use.

#include "tests/firmware/fake_hal.hpp"

namespace {

using namespace stillspin::test;

class States : public Drive {};

TEST_F(States, CalibrationWithoutSamplesIsAFault) {
  const auto silent = [this] { period(still_window(), drive.modulation.sampled.window_count); };
  for (int n = 0; n < 1990; ++n) silent();
  EXPECT_EQ(drive.state, DRIVE_CALIBRATE);
  for (int n = 0; n < 30; ++n) silent();
  EXPECT_EQ(drive.state, DRIVE_FAULT);
  EXPECT_EQ(drive.fault, FAULT_NO_SAMPLES);
}

TEST_F(States, EitherSensorsOffsetMustBePlausible) {
  for (const auto& [a, b] : {std::pair{95, 95}, {-95, -95}, {105, 0}, {-105, 0}, {0, 105}, {0, -105}}) {
    SetUp();
    hal_adc_window_t w = still_window();
    w.start_a = static_cast<std::uint16_t>(4 * (2048 + a));
    w.start_b = static_cast<std::uint16_t>(4 * (2048 + b));
    for (int n = 0; n < 600; ++n) period(w);
    const bool good = std::abs(a) < 100 && std::abs(b) < 100;
    EXPECT_EQ(drive.state, good ? DRIVE_READY : DRIVE_FAULT) << a << " " << b;
    EXPECT_EQ(drive.fault, good ? FAULT_NONE : FAULT_OFFSET);
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
  EXPECT_EQ(drive.state, DRIVE_CALIBRATE);
  for (int n = 0; n < 30; ++n) restless(n);
  EXPECT_EQ(drive.state, DRIVE_FAULT);
  EXPECT_EQ(drive.fault, FAULT_OFFSET);
}

// Offsets are looked for as long after a fault as at first: a sensor that has drifted meanwhile is followed.
TEST_F(States, AResetCalibratesAnew) {
  make_ready();
  periods(1000);
  drive_raise(&drive, FAULT_OFFSET);
  drive_command_reset();
  hal_adc_window_t w = still_window();
  w.start_a = static_cast<std::uint16_t>(4 * (2048 + 8));
  w.end_a = static_cast<std::uint16_t>(3 * (2048 + 8));
  period(w);
  ASSERT_EQ(drive.state, DRIVE_CALIBRATE);
  for (int n = 0; n < 255; ++n) period(w);
  EXPECT_EQ(drive.state, DRIVE_CALIBRATE);
  for (int n = 0; n < 250; ++n) period(w);
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_NEAR(real(drive.trim.offset_a_q8, 8), 2048 + 8, 0.1);
}

// The same request twice, or one that its state has no use for, does nothing and is not remembered.
TEST_F(States, RequestsThatAStateHasNoUseForAreForgotten) {
  make_run();
  drive_command_reset();
  drive_command_start();
  drive_command_commission();
  periods(3);
  EXPECT_EQ(drive.state, DRIVE_RUN);
  EXPECT_FALSE(drive.request.start || drive.request.reset || drive.request.commission || drive.request.stop);
  drive_command_stop();
  periods(30);
  EXPECT_EQ(drive.state, DRIVE_READY);
  drive_command_stop();
  periods(5);
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(States, AStopBreaksAStartOffAndOpensThePowerStage) {
  make_ready();
  drive_command_start();
  periods(20);
  ASSERT_EQ(drive.state, DRIVE_START);
  drive_command_stop();
  period();
  EXPECT_EQ(drive.state, DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
}

// A shaft that a commissioning turns is brought to rest; its gates stay on until it stands.
TEST_F(States, AStopInACommissioningsSpinBrakesTheShaft) {
  make_run();
  drive.state = DRIVE_COMMISSION;
  drive.commissioning.outcome = COMMISSIONING_RUNNING;
  drive.commissioning.phase = COMMISSIONING_SPIN;
  drive.commissioning.tick = 1;
  for (const bool turning : {true, false}) {
    drive.commissioning.turning = turning;
    drive.state = DRIVE_COMMISSION;
    drive.commissioning.outcome = COMMISSIONING_RUNNING;
    drive.commissioning.phase = COMMISSIONING_TURN;
    board.gates_on = true;
    drive.request.reload = false;  // the background level has been there
    drive_command_stop();
    drive_sequence(&drive);
    EXPECT_EQ(drive.state, turning ? DRIVE_STOP : DRIVE_READY);
    EXPECT_EQ(board.gates_on, turning);
    EXPECT_EQ(drive.commissioning.outcome, COMMISSIONING_ABORTED);
  }
}

// With the gates off already and the background level at work a stop has nothing to break off.
TEST_F(States, AStopLetsAnEvaluationEnd) {
  make_ready();
  drive.state = DRIVE_COMMISSION;
  drive.commissioning.outcome = COMMISSIONING_RUNNING;
  drive.commissioning.phase = COMMISSIONING_EVALUATE;
  drive.commissioning.evaluate = true;
  drive_command_stop();
  drive_sequence(&drive);
  EXPECT_EQ(drive.state, DRIVE_COMMISSION);
  EXPECT_EQ(drive.commissioning.outcome, COMMISSIONING_RUNNING);
  drive.commissioning.evaluate = false;
  drive_sequence(&drive);
  EXPECT_EQ(drive.state, DRIVE_READY);
}

}  // namespace
