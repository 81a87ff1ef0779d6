// What the board does beside the gates, on a board that the test describes: each function at its threshold, on both
// sides of it, and nothing while it is off.

#include "tests/firmware/board_functions.hpp"

namespace stillspin::test {
namespace {

TEST_F(BoardFunctions, NothingIsDoneThatIsNotWired) {
  board.emergency = true;
  look_at_link(30.0, 5000);
  look_at_link(415.0, 5000);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.relay);
  EXPECT_FALSE(board.brake);
  EXPECT_EQ(board.digital_io_wired, 0);
  EXPECT_EQ(board.emergency_wired, 0);
  EXPECT_EQ(interlock_refusal(), FAULT_NONE);
  EXPECT_EQ(interlock_why_off(), FAULT_GATES_OFF);
  EXPECT_EQ(words(), "current limit 100 %");
}

TEST_F(BoardFunctions, OutputsAreSetUpOnce) {
  parameters.precharge_voltage = raw(200.0, 16);
  parameters.emergency_stop = 1;
  use_parameters();
  look(3);
  parameters.brake_voltage = raw(400.0, 16);
  look(3);
  EXPECT_EQ(board.digital_io_wired, 1);
  EXPECT_EQ(board.emergency_wired, 1);
  drive_reset();
  inside::be_in(DRIVE_READY);
  inside::loading() = false;
  parameters.brake_voltage = raw(400.0, 16);
  look();
  EXPECT_EQ(board.digital_io_wired, 2) << "the brake resistor alone wants them, too";
}

TEST_F(BoardFunctions, TheRelayFollowsTheChargeOfTheLink) {
  parameters.precharge_voltage = raw(200.0, 16);
  use_parameters();
  look_at_link(199.0);
  EXPECT_FALSE(board.relay);
  EXPECT_EQ(interlock_refusal(), FAULT_PRECHARGE);
  EXPECT_NE(words().find("precharge relay open"), std::string::npos);
  look_at_link(200.0);
  EXPECT_TRUE(board.relay);
  EXPECT_EQ(interlock_refusal(), FAULT_NONE);
  EXPECT_NE(words().find("precharge relay closed"), std::string::npos);
  look_at_link(151.0);
  EXPECT_TRUE(board.relay);
  inside::be_in(DRIVE_RUN);
  look_at_link(149.0);
  EXPECT_TRUE(board.relay) << "a relay is not opened under current";
  inside::be_in(DRIVE_READY);
  look();
  EXPECT_FALSE(board.relay);
}

TEST_F(BoardFunctions, AChargeThatDoesNotEndIsAFault) {
  parameters.precharge_voltage = raw(200.0, 16);
  parameters.precharge_time = 50;
  use_parameters();
  look_at_link(25.0, 200);
  EXPECT_EQ(inside::state(), DRIVE_READY) << "an eighth: there is no supply yet";
  look_at_link(25.1, 50);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  look_at_link(20.0);  // gone again: the time counts anew
  look_at_link(100.0, 50);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  look();
  EXPECT_EQ(inside::fault(), FAULT_PRECHARGE);
  EXPECT_EQ(::board.charging_ms, 0);
}

TEST_F(BoardFunctions, TheBrakeResistorHasItsHysteresis) {
  parameters.brake_voltage = raw(380.0, 16);
  parameters.brake_hysteresis = raw(10.0, 16);
  look_at_link(300.0);
  for (int n = 0; n < 2; ++n) {
    look_at_link(380.0);
    EXPECT_FALSE(board.brake);
    EXPECT_NE(words().find("brake resistor off"), std::string::npos);
    inside::link_q16() = raw(380.1, 16);
    board_service();  // within the same millisecond
    EXPECT_TRUE(board.brake);
    EXPECT_NE(words().find("brake resistor on"), std::string::npos);
    look_at_link(370.1);
    EXPECT_TRUE(board.brake);
    look_at_link(370.0);
    EXPECT_FALSE(board.brake);
    look_at_link(375.0);
    EXPECT_FALSE(board.brake) << "from below";
  }
}

// A mean over 8.192 s: a share s of the time is reached after -8.192 s ln(1 - s) of braking without a pause.
TEST_F(BoardFunctions, TheBrakeResistorIsNotBurnt) {
  parameters.brake_voltage = raw(380.0, 16);
  for (const int percent : {10, 20}) {
    parameters.brake_share = raw(percent, 16);
    inside::be_in(DRIVE_READY);
    ::board.brake_mean_q30 = 0;
    look_at_link(300.0);
    inside::link_q16() = raw(390.0, 16);
    const int looks = looks_to_fault(5000);
    EXPECT_EQ(inside::fault(), FAULT_BRAKE_RESISTOR);
    EXPECT_NEAR(looks, -8192.0 * std::log(1.0 - percent / 100.0), 10.0) << percent;
  }
}

TEST_F(BoardFunctions, TheGateEnableMustComeThrough) {
  parameters.gate_feedback = 1;
  board.gates_pass = true;
  look(100);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  board.gates_pass = false;
  look(20);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  board.gates_pass = true;
  look();
  board.gates_pass = false;
  EXPECT_EQ(looks_to_fault(100), 21);
  EXPECT_EQ(inside::fault(), FAULT_GATE_ENABLE);
}

TEST_F(BoardFunctions, TheEmergencyStopFaultsRefusesAndExplains) {
  parameters.emergency_stop = 1;
  use_parameters();
  look();
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_EQ(words(), "emergency stop released; current limit 100 %");
  EXPECT_EQ(interlock_why_off(), FAULT_GATES_OFF);
  board.emergency = true;
  EXPECT_EQ(interlock_refusal(), FAULT_EMERGENCY);
  EXPECT_EQ(interlock_why_off(), FAULT_EMERGENCY);
  EXPECT_EQ(words(), "emergency stop pressed; current limit 100 %");
  look();
  EXPECT_EQ(inside::fault(), FAULT_EMERGENCY);
}

// A control interrupt in the middle of it would find a drive that is half in its fault.
TEST_F(BoardFunctions, AFaultIsRaisedWithTheInterruptsHeldOff) {
  parameters.emergency_stop = 1;
  use_parameters();
  board.emergency = true;
  look();
  ASSERT_EQ(inside::fault(), FAULT_EMERGENCY);
  EXPECT_EQ(board.gates_off_calls, 1);
  EXPECT_EQ(board.off_unheld, 0);
  EXPECT_EQ(board.held_off, 0);
}

TEST_F(BoardFunctions, NothingIsJudgedWhileTheDriveBoots) {
  parameters.emergency_stop = 1;
  use_parameters();
  board.emergency = true;
  inside::be_in(DRIVE_BOOT);
  look(10);
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  inside::be_in(DRIVE_CALIBRATE);
  look();
  EXPECT_EQ(inside::fault(), FAULT_EMERGENCY);
}

TEST_F(BoardFunctions, TheConverterAndItsReferenceMayBeOffBySoMuch) {
  parameters.reference_input = 1;
  const struct {
    int ground, off;
    bool good;
  } cases[] = {{0, 0, true}, {81, 81, true}, {0, -81, true}, {82, 0, false}, {0, 82, false}, {0, -82, false}};
  for (const auto& c : cases) {
    selftest_reset();
    selftest.ground = static_cast<std::uint16_t>(c.ground);
    selftest.reference = static_cast<std::uint16_t>(BOARD_REFERENCE_CODE + c.off);
    EXPECT_EQ(selftest_service(), c.good ? FAULT_NONE : FAULT_SELF_TEST) << c.ground << " " << c.off;
  }
  selftest_reset();
  inside::loading() = true;  // what is wired is not known yet
  EXPECT_EQ(selftest_service(), FAULT_NONE);
  EXPECT_EQ(selftest.failed, 0);
  inside::loading() = false;  // an edition without a store has nobody who ends it
}

}  // namespace
}  // namespace stillspin::test
