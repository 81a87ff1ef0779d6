// The CAN driver on a register bus, with two groups and on the bus; what the controller says is the test's.

#ifndef STILLSPIN_TESTS_HAL_CAN_BUS_HPP
#define STILLSPIN_TESTS_HAL_CAN_BUS_HPP

#include <vector>

#include "hal/f2808/registers.h"
#include "hal/hal_can.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

inline constexpr hal_can_group_t kGroups[] = {{0x101, 0x7FF, false, 3}, {0x1ABCDE00, 0x1FFFFF00, true, 2}};
// Mailboxes: the first group's ends, the second's, and the uppermost of those that send.
inline constexpr unsigned kFirst = 31, kOpen = 29, kExtended = 28, kSends = 26;

class CanOnBus : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
    start();
    ASSERT_EQ(hal_can_status().state, HAL_CAN_ACTIVE);
  }
  /// The controller goes into configuration and out of it.
  void start() {
    configuration(true);
    hal_can_service();
    configuration(false);
    hal_can_service();
  }
  /// What the controller says of its change into and out of configuration.
  void configuration(bool on) { set(REG_CANES, on ? CANES_CCE_MASK : 0u); }
  void set(std::uint32_t address, std::uint32_t value) { bus.set32(address, value); }
  void service_after(std::uint64_t cycles) {
    bus.cycles += cycles;
    hal_can_service();
  }
  /// What was written to a register last.
  std::uint32_t last_written(std::uint32_t address) {
    const std::vector<std::uint32_t> values = bus.written(address);
    EXPECT_FALSE(values.empty()) << std::hex << address << " is not written";
    return values.empty() ? 0 : values.back();
  }
  static hal_can_frame_t message(std::uint16_t length = 8) { return {0x181, false, length, {1, 2, 3, 4, 5, 6, 7, 8}}; }
};

}  // namespace stillspin::test

#endif
