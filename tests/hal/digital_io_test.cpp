// The board's own lines: relay, brake, emergency stop, run switch, gates.

#include "hal/f2808/registers.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_replay.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kEmergency = 1u << 13;
}  // namespace

class DigitalIo : public BusTest {
 protected:
  void SetUp() override { bus.power_all(); }
  void TearDown() override {
    hal_replay_start(REPLAY_OFF, nullptr);
    BusTest::TearDown();
  }
};

TEST_F(DigitalIo, emergency_stop_trips_the_legs_and_not_the_witness) {
  for (unsigned module = 1; module <= 4; ++module) bus.words[EPWM_BASE(module) + EPWM_TZSEL] = EPWM_TZSEL_OSHT1_MASK;
  hal_digital_io_wire_emergency();
  for (unsigned module = 1; module <= 3; ++module) {
    EXPECT_EQ(bus.words[EPWM_BASE(module) + EPWM_TZSEL], EPWM_TZSEL_OSHT1_MASK | EPWM_TZSEL_OSHT1_MASK << 1)
        << "ePWM" << module << ": beside the comparator";
  }
  EXPECT_EQ(bus.words[EPWM_BASE(4) + EPWM_TZSEL], EPWM_TZSEL_OSHT1_MASK);
  EXPECT_EQ(bus.word32(REG_GPAPUD) & kEmergency, 0u) << "a broken wire must not float";
  expect_before(bus.first_write(REG_GPAMUX1), bus.first_write(EPWM_BASE(1) + EPWM_TZSEL), "the pin before it trips");
}

TEST_F(DigitalIo, emergency_stop_is_pressed_when_its_line_is_low) {
  EXPECT_FALSE(hal_digital_io_emergency());
  bus.words[REG_GPADAT] = static_cast<std::uint16_t>(~kEmergency);
  EXPECT_TRUE(hal_digital_io_emergency());
}

// What hangs on the lines of a board in the loop is no simulation's.
TEST_F(DigitalIo, emergency_stop_of_a_recording_is_the_recordings) {
  hal_replay_start(REPLAY_RECORDS, nullptr);
  EXPECT_FALSE(hal_digital_io_emergency());
  EXPECT_EQ(hal_replay_period.inputs[0], 0);
  hal_replay_start(REPLAY_PLAYS, [] {});
  hal_replay_period.input_count = 2;
  hal_replay_period.inputs[0] = 1;
  hal_replay_period.inputs[1] = 0;
  bus.forget_steps();
  EXPECT_TRUE(hal_digital_io_emergency());
  EXPECT_FALSE(hal_digital_io_emergency());
  EXPECT_TRUE(bus.steps.empty()) << "no register is reached";
}

// The board is off until it is told otherwise, and each line is told alone.
TEST_F(DigitalIo, relay_and_brake_begin_off_and_follow_one_by_one) {
  const std::uint32_t relay = 1u << 16, brake = 1u << 17;
  hal_digital_io_init();
  for (const std::uint32_t line : {relay, brake}) {
    expect_before(bus.first_write(REG_GPACLEAR, line), bus.first_write(REG_GPADIR, line), "level before direction");
  }
  EXPECT_EQ(bus.word32(REG_GPADIR), relay | brake);
  EXPECT_EQ(bus.word32(REG_GPAMUX2), 0u) << "both are their own";
  EXPECT_EQ(bus.first_write(REG_GPASET), FakeBus::npos);
  const auto does = [this](void (*act)(bool), bool on, std::uint32_t line) {
    bus.forget_steps();
    act(on);
    ASSERT_EQ(bus.steps.size(), 1u);
    EXPECT_EQ(bus.steps.at(0).address, on ? REG_GPASET : REG_GPACLEAR);
    EXPECT_EQ(bus.steps.at(0).value, line) << "and no other line";
  };
  for (const bool on : {true, false}) {
    does(hal_digital_io_relay, on, relay);
    does(hal_digital_io_brake, on, brake);
  }
}

TEST_F(DigitalIo, run_switch_is_on_when_its_line_is_low_and_gates_pass_when_theirs_is_high) {
  const auto only = [this](unsigned pin, bool level) { bus.set32(REG_GPADAT, level ? 1u << pin : ~(1u << pin)); };
  only(25, false);
  EXPECT_TRUE(hal_digital_io_run());
  only(25, true);
  EXPECT_FALSE(hal_digital_io_run());
  only(24, true);
  EXPECT_TRUE(hal_digital_io_gates_pass());
  only(24, false);
  EXPECT_FALSE(hal_digital_io_gates_pass());
}

}  // namespace stillspin::test
