// The board's own lines and what a drive looks at before it trusts itself: memory, watchdog, gates.

#include "hal/f2808/registers.h"
#include "hal/hal_lines.h"
#include "hal/hal_selftest.h"
#include "hal/hal_tape.h"
#include "tests/hal/bus_test.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kEmergency = 1u << 13;
constexpr std::uint32_t kRam = 0x8000;
}  // namespace

class Lines : public BusTest {
 protected:
  void SetUp() override { bus.power_all(); }
  void TearDown() override {
    hal_tape_start(TAPE_OFF, nullptr);
    BusTest::TearDown();
  }
};

TEST_F(Lines, emergency_stop_trips_the_legs_and_not_the_witness) {
  for (unsigned module = 1; module <= 4; ++module) bus.words[EPWM_BASE(module) + EPWM_TZSEL] = EPWM_TZSEL_OSHT1_MASK;
  hal_lines_wire_emergency();
  for (unsigned module = 1; module <= 3; ++module) {
    EXPECT_EQ(bus.words[EPWM_BASE(module) + EPWM_TZSEL], EPWM_TZSEL_OSHT1_MASK | EPWM_TZSEL_OSHT1_MASK << 1)
        << "ePWM" << module << ": beside the comparator";
  }
  EXPECT_EQ(bus.words[EPWM_BASE(4) + EPWM_TZSEL], EPWM_TZSEL_OSHT1_MASK);
  EXPECT_EQ(bus.word32(REG_GPAPUD) & kEmergency, 0u) << "a broken wire must not float";
  expect_before(bus.first_write(REG_GPAMUX1), bus.first_write(EPWM_BASE(1) + EPWM_TZSEL), "the pin before it trips");
}

TEST_F(Lines, emergency_stop_is_pressed_when_its_line_is_low) {
  EXPECT_FALSE(hal_lines_emergency());
  bus.words[REG_GPADAT] = static_cast<std::uint16_t>(~kEmergency);
  EXPECT_TRUE(hal_lines_emergency());
}

// What hangs on the lines of a board in the loop is no simulation's.
TEST_F(Lines, emergency_stop_of_a_tape_is_the_tapes) {
  hal_tape_start(TAPE_RECORDS, nullptr);
  EXPECT_FALSE(hal_lines_emergency());
  EXPECT_EQ(hal_tape.period.inputs[0], 0);
  hal_tape_start(TAPE_PLAYS, [] {});
  hal_tape.period.input_count = 2;
  hal_tape.period.inputs[0] = 1;
  hal_tape.period.inputs[1] = 0;
  bus.forget_steps();
  EXPECT_TRUE(hal_lines_emergency());
  EXPECT_FALSE(hal_lines_emergency());
  EXPECT_TRUE(bus.steps.empty()) << "no register is reached";
}

// A memory that gives one word wrong, once: whichever of the test's reads it is.
TEST_F(Lines, every_read_of_the_memory_test_counts) {
  const std::uint32_t a = kRam + 2 * 7;
  bus.words[a] = 0x1234;
  bus.words[a + 1] = 0xABCD;
  int read = 0, wrong = 0;
  bus.spoils = [&](std::uint16_t word) { return static_cast<std::uint16_t>(word ^ (read++ == wrong ? 0x0040 : 0)); };
  const auto passes = [&](int n) {
    read = 0;
    wrong = n;
    return hal_selftest_ram(7);
  };
  EXPECT_TRUE(passes(-1));
  const int reads = read;
  ASSERT_EQ(reads, 12) << "two to be kept, two of each of four passes, two at the end";
  for (int n = 2; n < reads; ++n) EXPECT_FALSE(passes(n)) << "read " << n;
  EXPECT_TRUE(passes(-1));
  EXPECT_EQ(bus.words[a], 0x1234) << "what was there is there again";
  EXPECT_EQ(bus.words[a + 1], 0xABCD);
}

TEST_F(Lines, gates_are_off_when_every_one_of_their_pins_is_low) {
  bus.words[REG_GPADAT] = 0xFFC0;
  EXPECT_TRUE(hal_selftest_gates_are_off());
  for (unsigned pin = 0; pin < 6; ++pin) {
    bus.words[REG_GPADAT] = static_cast<std::uint16_t>(0xFFC0u | 1u << pin);
    EXPECT_FALSE(hal_selftest_gates_are_off()) << "GPIO" << pin;
  }
}

}  // namespace stillspin::test
