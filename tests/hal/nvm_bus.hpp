// The memory's driver on a register bus: the module and the lines are the test's.

#ifndef STILLSPIN_TESTS_HAL_NVM_BUS_HPP
#define STILLSPIN_TESTS_HAL_NVM_BUS_HPP

#include <algorithm>

#include "hal/f2808/registers.h"
#include "hal/hal_nvm.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

inline constexpr std::uint64_t kStandstill = 1'100'000;  // cycles, beyond the 10 ms that a device may stretch
inline constexpr std::uint64_t kHalfClock = 1'000;
inline constexpr std::uint64_t kMillisecond = 100'000;
inline constexpr std::uint64_t kAlmost = 99 * kMillisecond / 10;  // of 10 ms

class Nvm : public BusTest {
 protected:
  using Values = std::vector<std::uint32_t>;

  void SetUp() override {
    bus.power_all();
    lines(true);
    bus.between = [this] { module(I2C_STR, 0); };  // its flags are cleared by writing ones to them
    ASSERT_TRUE(hal_nvm_init());
  }
  void lines(bool high) { bus.words[REG_GPBDAT] = high ? 0xFFFF : 0; }
  void set_port_b(std::uint32_t address, unsigned value) { bus.words[address] = static_cast<std::uint16_t>(value); }
  void module(std::uint32_t offset, unsigned value) {
    bus.words[I2C_BASE + offset] = static_cast<std::uint16_t>(value);
  }
  std::ptrdiff_t starts() const {
    const Values modes = written(I2C_MDR);
    return std::count_if(modes.begin(), modes.end(), [](std::uint32_t m) { return (m & I2C_MDR_STT_MASK) != 0; });
  }
  /// The pins are taken from the module, to clock the bus free.
  bool is_clearing() const { return (bus.word32(REG_GPBMUX1) & 0xFu) == 0; }
  /// The module says something of the transfer, and is asked.
  hal_nvm_state_t step_with(unsigned status) {
    module(I2C_STR, status);
    return hal_nvm_step();
  }
  Values written(std::uint32_t offset) const { return bus.written(I2C_BASE + offset); }
  /// Nobody acknowledges, and the module has stopped.
  hal_nvm_state_t refuse() {
    EXPECT_EQ(step_with(I2C_STR_NACK_MASK), NVM_BUSY);
    module(I2C_MDR, 0);
    return hal_nvm_step();
  }
  hal_nvm_state_t step_after(std::uint64_t cycles) {
    bus.cycles += cycles;
    return hal_nvm_step();
  }
  std::uint16_t octets[4] = {9, 9, 9, 9};
};

}  // namespace stillspin::test

#endif
