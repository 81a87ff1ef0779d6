// What takes the current down: a hot heat sink, and an overload that has lasted.

#include "tests/firmware/board_functions.hpp"

namespace stillspin::test {

int32_t& inside::heat_sink_q8() { return ::board.heat_sink_q8; }

namespace {

class Derating : public BoardFunctions {};

// The table's points, and half-way between them; once in eight milliseconds.
TEST_F(Derating, TheHeatSinksTemperatureIsThatOfTheTable) {
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

TEST_F(Derating, AHotHeatSinkTakesHalfTheCurrentAndThenAll) {
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

TEST_F(Derating, ABrokenSensorIsAFaultOnceTheDriveIsCalibrated) {
  parameters.temperature_limit = raw(130.0, 8);
  for (const int code : {3937 + 33, 159 - 33}) {
    inside::be_in(DRIVE_CALIBRATE);
    inside::fault() = FAULT_NONE;
    convert(static_cast<std::uint16_t>(code));
    look(8);
    EXPECT_EQ(inside::state(), DRIVE_CALIBRATE);
    inside::be_in(DRIVE_READY);
    look(8);
    EXPECT_EQ(inside::fault(), FAULT_TEMPERATURE) << code;
  }
  inside::be_in(DRIVE_READY);
  convert(3937 + 32);  // colder than the table, but a sensor
  look(8);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

// I^2 t: from rest, the mean square of i reaches q of i^2 after -T ln(1 - q).
TEST_F(Derating, OverloadIsBorneForItsTime) {
  parameters.overload_current = raw(10.0, 20);
  parameters.overload_time = 1000;
  use_parameters();
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {raw(-6.0, 20), raw(10.3923, 20)};  // 12 A
  const int looks = looks_to_fault(5000);
  EXPECT_EQ(inside::fault(), FAULT_OVERLOAD);
  EXPECT_NEAR(looks, -1000.0 * std::log(1.0 - 110.0 / 144.0), 20.0);
}

// By default the motor's rated current is what may flow for ever; the time constant is a winding's.
TEST_F(Derating, WithoutAnotherCurrentTheMotorsRatedOneCounts) {
  parameters.rated_current = raw(4.0, 20);
  use_parameters();
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {0, raw(8.0, 20)};
  const int looks = looks_to_fault(60000);
  EXPECT_EQ(inside::fault(), FAULT_OVERLOAD);
  EXPECT_NEAR(looks, -60000.0 * std::log(1.0 - 1.1 / 4.0), 400.0);
}

// Where no rated current is told, half of the limit is what hardly a motor does not bear; status says so.
TEST_F(Derating, WithoutARatedCurrentHalfOfTheLimitCounts) {
  parameters_reset(&parameters);
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

TEST_F(Derating, AnOverloadCurrentOfZeroWatchesNothing) {
  parameters.overload_current = 0;
  use_parameters();
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {0, raw(30.0, 20)};
  look(200000);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  EXPECT_EQ(share(), 1.0);
}

// Small motors and long times: nothing of the mean square is lost in its rounding.
TEST_F(Derating, TheMeanSquareIsAsFineForASmallMotor) {
  parameters.rated_current = raw(0.1, 20);
  parameters.overload_time = 600000;
  use_parameters();
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {0, raw(0.12, 20)};
  const int looks = looks_to_fault(1200000);
  EXPECT_EQ(inside::fault(), FAULT_OVERLOAD);
  EXPECT_NEAR(looks, -600000.0 * std::log(1.0 - 1.1 / 1.44), 20000.0);
}

TEST_F(Derating, TheLimitFallsToWhatMayFlowForEver) {
  parameters.overload_current = raw(10.0, 20);
  parameters.overload_time = 1000;
  use_parameters();
  inside::be_in(DRIVE_RUN);
  const std::pair<double, double> cases[] = {{8.8, 1.0}, {9.5, 0.5 * (1.0 + 10.0 / 14.0)}, {10.1, 10.0 / 14.0}};
  for (const auto& [amps, expected] : cases) {
    inside::current_dq_q20() = {0, raw(amps, 20)};
    look(12000);
    EXPECT_NEAR(share(), expected, 0.02) << amps;
  }
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  inside::be_in(DRIVE_READY);  // no current flows, whatever was measured last
  look(3000);
  EXPECT_NEAR(share(), 1.0, 1e-3);
  parameters.overload_current = raw(20.0, 20);  // above the limit in use: nothing falls
  use_parameters();
  inside::be_in(DRIVE_RUN);
  inside::current_dq_q20() = {0, raw(19.5, 20)};
  look(12000);
  EXPECT_NEAR(share(), 1.0, 1e-3);
}

TEST_F(Derating, TheHotterOfTheTwoRules) {
  parameters.temperature_limit = raw(100.0, 8);
  parameters.temperature_derating = raw(60.0, 8);
  parameters.overload_current = raw(10.0, 20);
  parameters.overload_time = 1000;
  use_parameters();
  inside::be_in(DRIVE_RUN);
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

}  // namespace
}  // namespace stillspin::test
