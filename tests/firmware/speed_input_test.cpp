// A drive without a host: a switch at the board starts and stops it, a voltage is its speed.

#include "firmware/board/functions.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/api/comm_watchdog.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
}

namespace stillspin::test {
namespace {

class SpeedInput : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    use_source(0);
    parameters.polarity_check = 0;
    parameters.speed_input = 1;
    use_parameters();
    drive_parameters_changed();
    background_step(&drive);
    make_ready();
  }

  /// Turns of eight milliseconds with a switch and a code of the speed command.
  void turns(int count, bool on, std::uint16_t code) {
    hal_adc_window_t w = still_window();
    w.aux = code;
    board.run = on;
    for (int ms = 0; ms < 8 * count; ++ms) {
      for (int n = 0; n < 10; ++n) period(w);
      board_service();
      if (inside::state() != DRIVE_RUN) continue;
      inside::config().synchronism.bad_periods = 1000000;  // no machine behind these windows
      parameters.divergence_time = 1000;
      use_parameters();
    }
  }
  static double asked_rpm() { return drive_commanded_speed() / 65536.0; }
};

TEST_F(SpeedInput, ASwitchClosedAtPowerOnStartsNothing) {
  turns(3, true, 2048);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_EQ(asked_rpm(), 0.0);
  turns(1, false, 2048);
  EXPECT_EQ(::board.input, SPEED_INPUT_WAITS);
  turns(1, true, 0);
  EXPECT_EQ(inside::state(), DRIVE_START);
  EXPECT_EQ(::board.input, SPEED_INPUT_RUNS);
  EXPECT_FALSE(comm_watchdog_release()) << "the switch watches over its motor";
  for (const std::uint32_t holder : {0u, 1u}) EXPECT_FALSE(comm_watchdog_is_of(holder)) << "and no client does";
}

TEST_F(SpeedInput, TheConverterIsChosenForThreeMillisecondsInEight) {
  for (int n = 0; n < 10; ++n) period();
  while (inside::time_ms() % 8 != 0) {
    for (int n = 0; n < 10; ++n) period();
    board_service();
  }
  for (int ms = 1; ms <= 16; ++ms) {
    for (int n = 0; n < 10; ++n) period();
    board_service();
    const int at = ms % 8;
    EXPECT_EQ(board.slow_is_speed, at >= 1 && at < 4) << ms;
  }
}

TEST_F(SpeedInput, TheVoltageIsTheSpeed) {
  turns(1, false, 0);
  turns(1, true, 0);
  ASSERT_EQ(::board.input, SPEED_INPUT_RUNS);
  const struct {
    std::uint16_t code;
    double rpm;
  } cases[] = {{0, 0.0}, {82, 0.0}, {2048, 979.8}, {4095, 2000.0}, {1024, 469.5}};  // 2 % at the lower end is nothing
  for (const auto& c : cases) {
    turns(1, true, c.code);
    EXPECT_NEAR(asked_rpm(), c.rpm, 0.2) << c.code;
  }
  for (const std::uint16_t code : {std::uint16_t{0}, std::uint16_t{81}}) {
    turns(1, true, code);
    EXPECT_EQ(drive_commanded_speed(), 0) << "nothing is nothing at all";
  }
  turns(1, true, 4095);
  EXPECT_EQ(drive_commanded_speed(), raw(2000.0, 16)) << "and all of it is all";
  parameters.speed_input = 2;  // 10 % .. 90 %
  const struct {
    std::uint16_t code;
    double rpm;
  } live[] = {{410, 0.0}, {300, 0.0}, {2048, 979.6}, {3686, 2000.0}, {3800, 2000.0}};
  for (const auto& c : live) {
    turns(1, true, c.code);
    EXPECT_NEAR(asked_rpm(), c.rpm, 0.2) << c.code;
  }
}

TEST_F(SpeedInput, OpeningTheSwitchStops) {
  turns(1, false, 0);
  turns(6, true, 0);
  ASSERT_EQ(inside::state(), DRIVE_RUN);
  turns(2, false, 0);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_FALSE(board.gates_on);
}

TEST_F(SpeedInput, OpeningTheSwitchClearsAFaultAndClosingItDoesNot) {
  turns(1, false, 0);
  turns(6, true, 0);
  drive_trip(&drive, FAULT_LINK_LOW);
  turns(2, true, 0);
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  turns(8, false, 0);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_EQ(inside::fault(), FAULT_NONE);
  drive_trip(&drive, FAULT_LINK_LOW);
  turns(2, true, 0);
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(::board.input, SPEED_INPUT_WAITS);
}

// Beyond 5 % and 95 % there is no signal; it may be gone for 20 ms.
TEST_F(SpeedInput, ALostLiveZeroStopsAndStaysStopped) {
  parameters.speed_input = 2;
  for (const std::uint16_t code : {std::uint16_t{204}, std::uint16_t{3892}}) {
    for (const int reaction : {1, 2}) {
      parameters.speed_input_loss = reaction;
      turns(2, false, 410);
      turns(6, true, 410);
      ASSERT_EQ(inside::state(), DRIVE_RUN);
      turns(2, true, code);
      EXPECT_EQ(inside::state(), DRIVE_RUN) << "16 ms";
      EXPECT_EQ(::board.input, SPEED_INPUT_RUNS);
      turns(1, true, 410);
      turns(2, true, code);
      EXPECT_EQ(::board.input, SPEED_INPUT_RUNS) << "counted anew";
      turns(2, true, code);
      EXPECT_EQ(::board.input, SPEED_INPUT_LOST);
      EXPECT_EQ(inside::state(), DRIVE_READY);
      EXPECT_FALSE(board.gates_on);
      turns(3, true, 2048);
      EXPECT_EQ(inside::state(), DRIVE_READY) << "the signal alone does not start it again";
    }
  }
  for (const std::uint16_t code : {std::uint16_t{205}, std::uint16_t{3891}}) {
    turns(2, false, 410);
    turns(1, true, 410);
    turns(5, true, code);
    EXPECT_EQ(::board.input, SPEED_INPUT_RUNS) << code;
    turns(8, false, 410);
  }
}

TEST_F(SpeedInput, LossCoastsWhereThatIsWanted) {
  parameters.speed_input = 2;
  parameters.speed_input_loss = 2;
  turns(1, false, 410);
  turns(6, true, 410);
  ASSERT_EQ(inside::state(), DRIVE_RUN);
  inside::ramped_bpp() = raw(0.01, 32);  // a shaft that turns would be brought to rest first
  const int off = board.gates_off_calls;
  turns(3, true, 100);
  EXPECT_GT(board.gates_off_calls, off);
  EXPECT_EQ(inside::state(), DRIVE_READY);
}

TEST_F(SpeedInput, TheBoardsWordsSayWhatItDoes) {
  const auto words = [] {
    std::uint16_t octets[400];
    octet_writer_t w = octet_writer(octets, 400);
    board_line.put(&w);
    return std::string(octets, octets + w.count);
  };
  turns(1, false, 2048);
  const std::string open = words();
  turns(6, true, 2048);
  EXPECT_NE(words(), open);
  EXPECT_NE(words().find("speed input"), std::string::npos) << words();
  parameters.speed_input = 0;
  EXPECT_EQ(words().find("speed input"), std::string::npos) << words();
}

TEST_F(SpeedInput, NotUsedItCommandsNothing) {
  parameters.speed_input = 0;
  turns(1, false, 4000);
  turns(3, true, 4000);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  EXPECT_EQ(::board.input, SPEED_INPUT_OFF);
  parameters.speed_input = 1;
  turns(2, true, 4000);
  EXPECT_EQ(inside::state(), DRIVE_READY) << "closed before it was used";
}

// A switch that is closed when the input comes into use starts nothing, as at power-on.
TEST_F(SpeedInput, ASwitchClosedBeforehandStartsNothing) {
  parameters.speed_input = 0;
  turns(2, false, 0);
  parameters.speed_input = 1;
  turns(2, false, 0);  // it has been seen open,
  parameters.speed_input = 0;
  turns(2, true, 0);  // but not when it was closed
  EXPECT_EQ(::board.input, SPEED_INPUT_OFF);
  parameters.speed_input = 1;
  turns(3, true, 0);
  EXPECT_EQ(inside::state(), DRIVE_READY);
  turns(1, false, 0);
  turns(6, true, 0);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

}  // namespace
}  // namespace stillspin::test
