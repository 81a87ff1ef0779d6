#include "hal/f2808/registers.h"
#include "hal/hal_clock.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

class Clock : public BusTest {};

TEST_F(Clock, watchdog_is_stopped_before_anything_else) {
  ASSERT_TRUE(hal_clock_init());
  std::size_t first = 0;
  while (bus.steps.at(first).op != Op::kWrite) {
    ++first;
  }
  EXPECT_EQ(bus.steps.at(first).address, REG_WDCR);
  EXPECT_EQ(bus.steps.at(first).value, 0x0068u) << "WDDIS with the check bits 101; any others reset the chip";
}

TEST_F(Clock, pll_is_changed_only_with_the_missing_clock_detector_off) {
  ASSERT_TRUE(hal_clock_init());
  const std::size_t detector_off = bus.first_write(REG_PLLSTS, PLLSTS_MCLKOFF_MASK);
  const std::size_t multiplier = bus.first_write(REG_PLLCR);
  expect_before(detector_off, multiplier, "MCLKOFF before PLLCR");
  expect_before(multiplier, bus.last_write(REG_PLLSTS), "detector back on after locking");
  EXPECT_EQ(bus.words[REG_PLLCR], 10u) << "20 MHz * 10 / 2 = 100 MHz";
  EXPECT_EQ(bus.words[REG_PLLSTS] & PLLSTS_MCLKOFF_MASK, 0u);
  EXPECT_EQ(bus.words[REG_PLLSTS] & PLLSTS_CLKINDIV_MASK, 0u);
}

TEST_F(Clock, detector_stays_off_until_the_pll_has_locked) {
  ASSERT_TRUE(hal_clock_init());
  const std::size_t poll = bus.first_read(REG_PLLSTS, bus.first_write(REG_PLLCR));
  expect_before(poll, bus.last_write(REG_PLLSTS), "PLLLOCKS is read before MCLKOFF is cleared");
}

TEST_F(Clock, dead_crystal_is_reported_and_nothing_is_set_up) {
  bus.words[REG_PLLSTS] = PLLSTS_MCLKSTS_MASK;
  EXPECT_FALSE(hal_clock_init());
  EXPECT_EQ(bus.count_writes(), 1u) << "only the watchdog";
}

TEST_F(Clock, pll_that_never_locks_ends_the_wait) {
  bus.pll_locks = false;
  EXPECT_FALSE(hal_clock_init());
  EXPECT_EQ(bus.first_write(REG_PCLKCR1), FakeBus::npos);
  // 131072 crystal cycles are 65536 CPU cycles at half the crystal's clock; giving up before that would be wrong.
  EXPECT_GT(bus.cycles, 65536u);
}

TEST_F(Clock, running_pll_is_left_alone) {
  bus.words[REG_PLLCR] = 10;
  bus.words[REG_PLLSTS] = PLLSTS_PLLLOCKS_MASK;
  EXPECT_TRUE(hal_clock_init());
  EXPECT_EQ(bus.first_write(REG_PLLCR), FakeBus::npos);
}

TEST_F(Clock, flash_waits_fit_100_MHz) {
  ASSERT_TRUE(hal_clock_init());
  EXPECT_EQ(bus.words[REG_FBANKWAIT], 0x0303u);
  EXPECT_EQ(bus.words[REG_FOTPWAIT], 5u);
  EXPECT_EQ(bus.words[REG_FOPT] & FOPT_ENPIPE_MASK, FOPT_ENPIPE_MASK);
}

TEST_F(Clock, peripherals_have_clocks_and_pwm_counters_stand_still) {
  ASSERT_TRUE(hal_clock_init());
  EXPECT_EQ(bus.words[REG_PCLKCR0] & PCLKCR0_ADCENCLK_MASK, PCLKCR0_ADCENCLK_MASK);
  EXPECT_EQ(bus.words[REG_PCLKCR0] & PCLKCR0_TBCLKSYNC_MASK, 0u);
  EXPECT_EQ(bus.words[REG_PCLKCR1], 0x403Fu) << "ePWM1..6 and eQEP1";
  EXPECT_EQ(bus.words[REG_HISPCP], 4u) << "ADC clock 12.5 MHz";
  EXPECT_EQ(bus.words[REG_LOSPCP], 1u) << "50 MHz";
  EXPECT_EQ(bus.words[REG_PCLKCR0] & PCLKCR0_SCIAENCLK_MASK, PCLKCR0_SCIAENCLK_MASK);
}

// A boot loader may have left the divider on.
TEST_F(Clock, divider_is_off_before_the_pll_is_changed) {
  bus.words[REG_PLLSTS] = PLLSTS_CLKINDIV_MASK;
  ASSERT_TRUE(hal_clock_init());
  EXPECT_EQ(bus.words[REG_PLLSTS] & PLLSTS_CLKINDIV_MASK, 0u);
  const std::size_t off = bus.first_write(REG_PLLSTS);
  EXPECT_EQ(bus.steps.at(off).value & PLLSTS_CLKINDIV_MASK, 0u);
  expect_before(off, bus.first_write(REG_PLLCR), "CLKINDIV before PLLCR");
}

TEST_F(Clock, running_pll_that_has_not_locked_is_waited_for) {
  bus.words[REG_PLLCR] = 10;
  EXPECT_FALSE(hal_clock_init());
  EXPECT_GT(bus.cycles, 65536u);
  EXPECT_EQ(bus.first_write(REG_PCLKCR1), FakeBus::npos);
}

TEST_F(Clock, every_peripheral_in_use_has_its_clock_and_no_other) {
  ASSERT_TRUE(hal_clock_init());
  EXPECT_EQ(bus.words[REG_PCLKCR0],
            PCLKCR0_ADCENCLK_MASK | PCLKCR0_I2CAENCLK_MASK | PCLKCR0_SCIAENCLK_MASK | PCLKCR0_ECANAENCLK_MASK);
}

}  // namespace stillspin::test
