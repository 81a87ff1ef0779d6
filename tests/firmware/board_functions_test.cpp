// What the board does beside the gates, on a board that the test describes: each function at its threshold, on both
// sides of it, and nothing while it is off.

#include <cmath>
#include <string>

#include "firmware/board/functions.h"
#include "firmware/board/selftest.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/states.h"
#include "hal/hal_board.h"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/steps.h"
}

namespace stillspin::test {
namespace {

class BoardFunctions : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    inside::state() = DRIVE_READY;
    inside::loading() = false;
    parameters.rated_current = raw(10.89, 20);
    use_parameters();
    inside::link_q16() = raw(300.0, 16);
  }

  /// The next milliseconds of the background level.
  static void look(int times = 1) {
    for (int n = 0; n < times; ++n) {
      inside::time_ms()++;
      board_service();
    }
  }
  static void look_at_link(double volts, int times = 1) {
    inside::link_q16() = raw(volts, 16);
    look(times);
  }
  /// How many more looks until the drive faults, at most `most`.
  static int looks_to_fault(int most) {
    int n = 0;
    for (; n < most && inside::state() != DRIVE_FAULT; ++n) look();
    return n;
  }
  /// A code of the converter's last place in a window, as a period leaves it.
  static void convert(std::uint16_t code) {
    hal_adc_window_t w = still_window();
    w.aux = code;
    for (int n = 0; n < 2; ++n) {  // both buffers
      board.adc.push_back(w);
      drive_window_interrupt();
      (void)sampling_swap();
    }
  }
  static std::string words() {
    std::uint16_t octets[400];
    octet_writer_t w = octet_writer(octets, 400);
    board_line.put(&w);
    return {octets, octets + w.count};
  }
  static double share() { return interlock_share_q15 / 32768.0; }
};

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
  inside::state() = DRIVE_READY;
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
  inside::state() = DRIVE_RUN;
  look_at_link(149.0);
  EXPECT_TRUE(board.relay) << "a relay is not opened under current";
  inside::state() = DRIVE_READY;
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
    inside::state() = DRIVE_READY;
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
  inside::state() = DRIVE_BOOT;
  look(10);
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  inside::state() = DRIVE_CALIBRATE;
  look();
  EXPECT_EQ(inside::fault(), FAULT_EMERGENCY);
}

// The table's points, and half-way between them; once in eight milliseconds.
TEST_F(BoardFunctions, TheHeatSinksTemperatureIsThatOfTheTable) {
  const int codes[] = BOARD_NTC_CODES;
  parameters.temperature_limit = raw(140.0, 8);
  parameters.temperature_derating = raw(140.0, 8);
  for (unsigned k = 0; k + 1 < BOARD_NTC_POINTS; ++k) {
    for (const double part : {0.0, 0.5}) {
      const int code = static_cast<int>(std::lround(codes[k] + part * (codes[k + 1] - codes[k])));
      convert(static_cast<std::uint16_t>(code));
      look(8);
      const double between = double(codes[k] - code) / (codes[k] - codes[k + 1]);
      EXPECT_NEAR(drive_signals().temperature / 256.0, BOARD_NTC_FIRST + BOARD_NTC_STEP * (k + between), 0.1) << code;
    }
  }
  EXPECT_EQ(drive_known(&drive) & KNOWN_HEAT_SINK, KNOWN_HEAT_SINK);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_NE(words().find("heat sink 130 C"), std::string::npos) << words();
  convert(codes[3]);
  inside::time_ms() = 8;
  look(7);  // 9 .. 15
  EXPECT_NE(words().find("heat sink 130 C"), std::string::npos) << "not yet";
  look();
  EXPECT_NE(words().find("heat sink 20 C"), std::string::npos) << words();
}

TEST_F(BoardFunctions, AHotHeatSinkTakesHalfTheCurrentAndThenAll) {
  parameters.temperature_limit = raw(100.0, 8);
  parameters.temperature_derating = raw(60.0, 8);
  const struct {
    std::uint16_t code;
    double share;
  } cases[] = {{1497, 1.0}, {941, 1.0}, {763, 0.875}, {584, 0.75}, {480, 0.63}};  // 40, 60, 70, 80, 90 degrees C
  for (const auto& c : cases) {
    convert(c.code);
    look(8);
    EXPECT_NEAR(share(), c.share, 0.01) << c.code;
    EXPECT_NEAR(real(interlock_current_limit(), 20), 14.0 * c.share, 0.15);
    EXPECT_EQ(inside::current_limit_q20(), interlock_current_limit());
  }
  EXPECT_NE(words().find("current limit 6"), std::string::npos) << words();
  convert(369);
  look(8);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  convert(360);
  look(8);
  EXPECT_EQ(inside::fault(), FAULT_TEMPERATURE);
}

TEST_F(BoardFunctions, ABrokenSensorIsAFaultOnceTheDriveIsCalibrated) {
  parameters.temperature_limit = raw(130.0, 8);
  for (const int code : {3937 + 33, 159 - 33}) {
    inside::state() = DRIVE_CALIBRATE;
    inside::fault() = FAULT_NONE;
    convert(static_cast<std::uint16_t>(code));
    look(8);
    EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
    inside::state() = DRIVE_READY;
    look(8);
    EXPECT_EQ(inside::fault(), FAULT_TEMPERATURE) << code;
  }
  inside::state() = DRIVE_READY;
  convert(3937 + 32);  // colder than the table, but a sensor
  look(8);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

// I^2 t: from rest, the mean square of i reaches q of i^2 after -T ln(1 - q).
TEST_F(BoardFunctions, OverloadIsBorneForItsTime) {
  parameters.overload_current = raw(10.0, 20);
  parameters.overload_time = 1000;
  use_parameters();
  inside::state() = DRIVE_RUN;
  inside::current_dq_q20() = {raw(-6.0, 20), raw(10.3923, 20)};  // 12 A
  const int looks = looks_to_fault(5000);
  EXPECT_EQ(inside::fault(), FAULT_OVERLOAD);
  EXPECT_NEAR(looks, -1000.0 * std::log(1.0 - 110.0 / 144.0), 20.0);
}

// By default the motor's rated current is what may flow for ever; the time constant is a winding's.
TEST_F(BoardFunctions, WithoutAnotherCurrentTheMotorsRatedOneCounts) {
  parameters.rated_current = raw(4.0, 20);
  use_parameters();
  inside::state() = DRIVE_RUN;
  inside::current_dq_q20() = {0, raw(8.0, 20)};
  const int looks = looks_to_fault(60000);
  EXPECT_EQ(inside::fault(), FAULT_OVERLOAD);
  EXPECT_NEAR(looks, -60000.0 * std::log(1.0 - 1.1 / 4.0), 400.0);
}

// Where no rated current is told, half of the limit is what hardly a motor does not bear; status says so.
TEST_F(BoardFunctions, WithoutARatedCurrentHalfOfTheLimitCounts) {
  parameters_reset();
  ASSERT_EQ(parameters.rated_current, 0) << "nobody has told it";
  parameters.current_limit = raw(9.0, 20);
  use_parameters();
  EXPECT_EQ(board_lasting_current(), raw(4.5, 20));
  EXPECT_NE(words().find("rated_current not set: half of current_limit is used"), std::string::npos);
  parameters.rated_current = raw(6.0, 20);
  use_parameters();
  EXPECT_EQ(board_lasting_current(), raw(6.0, 20));
  EXPECT_EQ(words().find("rated_current"), std::string::npos);
  parameters.overload_current = raw(5.0, 20);
  use_parameters();
  EXPECT_EQ(board_lasting_current(), raw(5.0, 20));
  parameters.rated_current = 0;
  use_parameters();
  EXPECT_EQ(words().find("rated_current"), std::string::npos) << "it is told what may flow";
  parameters.overload_current = 0;
  use_parameters();
  EXPECT_NE(words().find("no overload protection"), std::string::npos);
}

TEST_F(BoardFunctions, AnOverloadCurrentOfZeroWatchesNothing) {
  parameters.overload_current = 0;
  use_parameters();
  inside::state() = DRIVE_RUN;
  inside::current_dq_q20() = {0, raw(30.0, 20)};
  look(200000);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_EQ(share(), 1.0);
}

// Small motors and long times: nothing of the mean square is lost in its rounding.
TEST_F(BoardFunctions, TheMeanSquareIsAsFineForASmallMotor) {
  parameters.rated_current = raw(0.1, 20);
  parameters.overload_time = 600000;
  use_parameters();
  inside::state() = DRIVE_RUN;
  inside::current_dq_q20() = {0, raw(0.12, 20)};
  const int looks = looks_to_fault(1200000);
  EXPECT_EQ(inside::fault(), FAULT_OVERLOAD);
  EXPECT_NEAR(looks, -600000.0 * std::log(1.0 - 1.1 / 1.44), 20000.0);
}

TEST_F(BoardFunctions, TheLimitFallsToWhatMayFlowForEver) {
  parameters.overload_current = raw(10.0, 20);
  parameters.overload_time = 1000;
  use_parameters();
  inside::state() = DRIVE_RUN;
  const std::pair<double, double> cases[] = {{8.8, 1.0}, {9.5, 0.5 * (1.0 + 10.0 / 14.0)}, {10.1, 10.0 / 14.0}};
  for (const auto& [amps, expected] : cases) {
    inside::current_dq_q20() = {0, raw(amps, 20)};
    look(12000);
    EXPECT_NEAR(share(), expected, 0.02) << amps;
  }
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  inside::state() = DRIVE_READY;  // no current flows, whatever was measured last
  look(3000);
  EXPECT_NEAR(share(), 1.0, 1e-3);
  parameters.overload_current = raw(20.0, 20);  // above the limit in use: nothing falls
  use_parameters();
  inside::state() = DRIVE_RUN;
  inside::current_dq_q20() = {0, raw(19.5, 20)};
  look(12000);
  EXPECT_NEAR(share(), 1.0, 1e-3);
}

TEST_F(BoardFunctions, TheHotterOfTheTwoRules) {
  parameters.temperature_limit = raw(100.0, 8);
  parameters.temperature_derating = raw(60.0, 8);
  parameters.overload_current = raw(10.0, 20);
  parameters.overload_time = 1000;
  use_parameters();
  inside::state() = DRIVE_RUN;
  inside::current_dq_q20() = {0, raw(10.1, 20)};
  convert(1497);
  look(12000);
  EXPECT_NEAR(share(), 10.0 / 14.0, 0.01);
  convert(480);
  look(8);
  EXPECT_NEAR(share(), 0.63, 0.01);
  convert(360);
  inside::current_dq_q20() = {0, raw(30.0, 20)};
  ::board.heat_q24 = 2 << 24;
  look(8);
  EXPECT_EQ(inside::fault(), FAULT_TEMPERATURE) << "the first that is found is told";
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
}

}  // namespace
}  // namespace stillspin::test
