// Pins by number: two ports, halves of them, one bit or two a pin, and what the neighbours keep.

#include "hal/f2808/registers.h"
#include "tests/hal/bus.hpp"

extern "C" {
#include "hal/f2808/gpio.h"
}

namespace stillspin::test {

namespace {

// The first and the last of a register each.
constexpr std::uint16_t kPins[] = {0, 15, 16, 31, 32, 34};

// From the register list of the chip, written down a second time here on purpose.
struct Port {
  std::uint32_t select, mux, direction, pull_up_off, data, set, clear, toggle;
};
Port port_of(unsigned pin) {
  if (pin < 16) return {0x6F82, 0x6F86, 0x6F8A, 0x6F8C, 0x6FC0, 0x6FC2, 0x6FC4, 0x6FC6};
  if (pin < 32) return {0x6F84, 0x6F88, 0x6F8A, 0x6F8C, 0x6FC0, 0x6FC2, 0x6FC4, 0x6FC6};
  return {0x6F92, 0x6F96, 0x6F9A, 0x6F9C, 0x6FC8, 0x6FCA, 0x6FCC, 0x6FCE};
}
constexpr std::uint32_t kSettings[] = {0x6F82, 0x6F84, 0x6F86, 0x6F88, 0x6F8A, 0x6F8C,
                                       0x6F92, 0x6F94, 0x6F96, 0x6F98, 0x6F9A, 0x6F9C};

}  // namespace

class Gpio : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    all_settings(0x5A5A5A5A);
  }
  void all_settings(std::uint32_t value) {
    for (const std::uint32_t address : kSettings) bus.set32(address, value);
    bus.forget_steps();
  }
  /// Of the settings those that are not as all_settings has left them.
  std::map<std::uint32_t, std::uint32_t> changed(std::uint32_t from) const {
    std::map<std::uint32_t, std::uint32_t> found;
    for (const std::uint32_t address : kSettings) {
      if (bus.word32(address) != from) found[address] = bus.word32(address) ^ from;
    }
    return found;
  }
  using Changes = std::map<std::uint32_t, std::uint32_t>;
  static std::uint32_t bit(unsigned pin) { return 1u << (pin % 32); }
  static std::uint32_t pair(unsigned pin, unsigned value) { return value << (2 * (pin % 16)); }
};

TEST_F(Gpio, a_peripheral_gets_its_pin_and_no_other) {
  for (const std::uint16_t pin : kPins) {
    const Port port = port_of(pin);
    all_settings(0);
    gpio_give_to_peripheral(pin, 1, 3, false);
    EXPECT_EQ(changed(0),
              (Changes{{port.select, pair(pin, 3)}, {port.mux, pair(pin, 1)}, {port.pull_up_off, bit(pin)}}))
        << "GPIO" << pin;
    EXPECT_EQ(bus.last_write_of_all(), bus.last_write(port.mux)) << "the multiplexer last";
    all_settings(0xFFFFFFFF);
    gpio_give_to_peripheral(pin, 2, 0, true);
    EXPECT_EQ(changed(0xFFFFFFFF),
              (Changes{{port.select, pair(pin, 3)}, {port.mux, pair(pin, 1)}, {port.pull_up_off, bit(pin)}}))
        << "GPIO" << pin;
  }
}

TEST_F(Gpio, an_output_begins_with_its_level) {
  for (const std::uint16_t pin : kPins) {
    const Port port = port_of(pin);
    for (const bool level : {false, true}) {
      all_settings(0);
      bus.set32(port.mux, 0xFFFFFFFF);
      gpio_make_output(pin, level);
      EXPECT_EQ(bus.word32(port.mux), ~pair(pin, 3)) << "GPIO" << pin;
      EXPECT_EQ(bus.word32(port.direction), bit(pin));
      expect_before(bus.first_write(level ? port.set : port.clear, bit(pin)), bus.first_write(port.mux),
                    "the level before the pin has one");
      EXPECT_EQ(bus.first_write(level ? port.clear : port.set), FakeBus::npos);
    }
  }
}

// Its latch is low, and the line is let go before the pin is the port's.
TEST_F(Gpio, an_open_drain_lets_go_and_pulls_by_its_direction) {
  for (const std::uint16_t pin : kPins) {
    const Port port = port_of(pin);
    all_settings(0xFFFFFFFF);
    gpio_make_open_drain(pin);
    EXPECT_EQ(changed(0xFFFFFFFF), (Changes{{port.mux, pair(pin, 3)}, {port.direction, bit(pin)}})) << "GPIO" << pin;
    expect_before(bus.first_write(port.clear, bit(pin)), bus.first_write(port.mux), "a latch that is low");
    expect_before(bus.first_write(port.direction), bus.first_write(port.mux), "let go first");
    bus.forget_steps();
    gpio_pull_low(pin, true);
    EXPECT_EQ(bus.word32(port.direction), 0xFFFFFFFFu);
    gpio_pull_low(pin, false);
    EXPECT_EQ(bus.word32(port.direction), ~bit(pin));
    EXPECT_EQ(bus.count_writes(), 2u) << "by nothing else";
  }
}

TEST_F(Gpio, levels_are_written_and_read_by_the_pins_own_bit) {
  for (const std::uint16_t pin : kPins) {
    const Port port = port_of(pin);
    const auto writes = [&](std::uint32_t address) {
      EXPECT_EQ(bus.count_writes(), 1u) << "GPIO" << pin;
      EXPECT_EQ(bus.steps.back().address, address) << "GPIO" << pin;
      EXPECT_EQ(bus.steps.back().value, bit(pin)) << "GPIO" << pin;
      bus.forget_steps();
    };
    bus.forget_steps();
    gpio_write(pin, true);
    writes(port.set);
    gpio_write(pin, false);
    writes(port.clear);
    gpio_toggle(pin);
    writes(port.toggle);
    bus.set32(0x6FC0, 0);
    bus.set32(0x6FC8, 0);
    EXPECT_FALSE(gpio_read(pin)) << "GPIO" << pin;
    bus.set32(port.data, bit(pin));
    EXPECT_TRUE(gpio_read(pin)) << "GPIO" << pin;
    bus.set32(0x6FC0, 0xFFFFFFFF);
    bus.set32(0x6FC8, 0xFFFFFFFF);
    bus.set32(port.data, ~bit(pin));
    EXPECT_FALSE(gpio_read(pin)) << "GPIO" << pin;
  }
}

}  // namespace stillspin::test
