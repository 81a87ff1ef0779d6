// The boot ROM: mode pins, autobaud, the serial loader octet by octet.

#include "sim_host/chip/boot_rom.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "sim_host/chip/memory.hpp"
#include "tests/chip/core.hpp"
#include "tests/chip/sci.hpp"

namespace {

using core_bench::Chip;
using core_bench::kNever;
using core_bench::Tick;
using stillspin::chip::boot_rom;
using stillspin::chip::kErased;
using stillspin::chip::SerialFrame;
using stillspin::chip::testing::EdgeLine;

constexpr Tick kRate38400 = 2604;

class BootWorld final : public stillspin::chip::World {
 public:
  void on_pwm_pins(Tick, int, bool, bool) override {}
  std::uint16_t adc_sample(Tick, int) override { return 0; }
  bool pin_level(Tick, int pin) override {
    return (pin == 18 && (mode & 4u) != 0) || (pin == 29 && (mode & 2u) != 0) || (pin == 34 && (mode & 1u) != 0);
  }
  void on_output_pin(Tick, int, bool) override {}
  std::int64_t encoder_edges(Tick) override { return 0; }
  Tick serial_reaches(Tick t, bool level) override { return line.reaches(t, level); }
  void on_serial_frame(Tick, const SerialFrame& frame) override {
    echoed.push_back(frame.levels >> 1 & 0xFFu);
    bit = frame.bit;
  }
  Tick next_call() const override { return kNever; }
  void call(Tick) override {}

  unsigned mode = 7;
  EdgeLine line;
  std::vector<unsigned> echoed;
  Tick bit = 0;
};

void stay() { core_bench::sleep_for_ever(); }

class BootRom : public ::testing::Test {
 protected:
  BootWorld world;
  Chip chip{world, boot_rom};
  std::optional<std::uint32_t> entry;
  Tick sent_until = 1'000'000;
  std::vector<unsigned> sent;
  Tick bit = kRate38400;

  void SetUp() override {
    chip.on_jump([this](std::uint32_t to) {
      entry = to;
      return &stay;
    });
  }
  void send(std::initializer_list<unsigned> octets) {
    for (const unsigned octet : octets) {
      sent.push_back(octet);
      sent_until = world.line.frame(octet, sent_until, bit);
    }
  }
  void send_head() {
    send({'A', 0xAA, 0x08});
    for (int n = 0; n < 16; ++n) send({0});
    send({0x3F, 0x00, 0x10, 0xA0});  // entry 0x3FA010
  }
  void finish() { chip.run_until(sent_until + 1'000'000); }
};

TEST_F(BootRom, JumpsWhereThePinsSay) {
  const std::pair<unsigned, std::uint32_t> table[] = {{7, 0x3F7FF6}, {2, 0x000000}, {1, 0x3D7800}};
  for (const auto& [mode, to] : table) {
    world.mode = mode;
    Chip other(world, boot_rom);
    std::uint32_t jumped = 1;
    other.on_jump([&](std::uint32_t where) {
      jumped = where;
      return &stay;
    });
    other.run_until(100'000);
    EXPECT_EQ(jumped, to) << mode;
    EXPECT_FALSE(other.memory().locked());
    other.run_until(2'000'000);
    EXPECT_GT(other.statistics().resets, 0u) << "the watchdog runs";
  }
}

TEST_F(BootRom, EndsTheRunWhereNoLoaderIsModelled) {
  world.mode = 4;
  EXPECT_THROW(chip.run_until(100'000), std::runtime_error);
}

TEST_F(BootRom, LoadsBlocksEchoesEveryOctetAndJumps) {
  world.mode = 6;
  send_head();
  send({2, 0, 0x3F, 0, 0x00, 0xA0, 0x34, 0x12, 0x78, 0x56});  // two words to 0x3FA000
  send({1, 0, 0x00, 0, 0x80, 0x04, 0xCD, 0xAB});              // one to 0x000480
  send({0, 0});
  finish();
  EXPECT_EQ(world.echoed, sent);
  ASSERT_TRUE(entry.has_value());
  EXPECT_EQ(*entry, 0x3FA010u);
  EXPECT_EQ(chip.inspect(0x3FA000), 0x1234);
  EXPECT_EQ(chip.inspect(0x00A001), 0x5678);
  EXPECT_EQ(chip.inspect(0x000480), 0xABCD);
}

TEST_F(BootRom, LocksToTheRatesThatItsClockCanMake) {
  world.mode = 6;
  bit = 10'417;  // 9600
  send({'a'});
  finish();
  EXPECT_EQ(world.echoed, std::vector<unsigned>{'a'});
  EXPECT_EQ(world.bit, 8 * 33 * 40) << "LSPCLK is 2.5 MHz";
}

TEST_F(BootRom, PassesOverWhatIsNotTheLetter) {
  world.mode = 6;
  send({0x00, 0x55, 0xFF, 'B'});
  sent_until += 10'000'000;
  send({'A', 0xAA, 0x08, 7});
  finish();
  EXPECT_EQ(world.echoed, (std::vector<unsigned>{'A', 0xAA, 0x08, 7}));
  EXPECT_FALSE(entry.has_value());
}

TEST_F(BootRom, RateBeyondItsClockIsNotUnderstood) {
  world.mode = 6;
  bit = 868;  // 115200 at 2.5 MHz is 10 % off
  send_head();
  finish();
  EXPECT_NE(world.echoed, sent);
}

TEST_F(BootRom, WrongKeyGoesToTheFlash) {
  world.mode = 6;
  send({'A', 0xAB, 0x08});
  finish();
  ASSERT_TRUE(entry.has_value());
  EXPECT_EQ(*entry, 0x3F7FF6u);
}

TEST_F(BootRom, WaitsForEverInTheMiddleOfTheStream) {
  world.mode = 6;
  send_head();
  send({9});
  chip.run_until(sent_until + 500'000'000);
  EXPECT_FALSE(entry.has_value());
  EXPECT_EQ(chip.statistics().resets, 0u) << "the watchdog is off";
}

}  // namespace
