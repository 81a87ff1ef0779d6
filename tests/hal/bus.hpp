// What every driver test checks besides its own: no rule of the bus broken, no protection left lifted.

#ifndef STILLSPIN_TESTS_HAL_BUS_HPP
#define STILLSPIN_TESTS_HAL_BUS_HPP

#include <gtest/gtest.h>

#include "tests/hal/fake_bus.hpp"

namespace stillspin::test {

class BusTest : public ::testing::Test {
 protected:
  void TearDown() override {
    EXPECT_TRUE(bus.violations.empty()) << bus.violations.front() << " (and " << bus.violations.size() - 1 << " more)";
    EXPECT_FALSE(bus.protection_lifted) << "EALLOW without EDIS";
  }

  /// A pin's two bits of a register that has two for each.
  static std::uint32_t pair_of(std::uint32_t word, unsigned pin) { return (word >> (2 * (pin % 16))) & 3u; }

  /// Step i happened, and before step j.
  void expect_before(std::size_t i, std::size_t j, const char* why) {
    EXPECT_NE(i, FakeBus::npos) << "the earlier step is missing: " << why;
    EXPECT_NE(j, FakeBus::npos) << "the later step is missing: " << why;
    EXPECT_LT(i, j) << why;
  }

  FakeBus bus;
};

}  // namespace stillspin::test

#endif
