// PLL, SYSCLKOUT and what depends on it.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
Tick times[8];
std::uint16_t seen[8];

constexpr Tick kLockTicks = 131072 * 5;  // OSCCLK cycles at 20 MHz

class Clock : public ::testing::Test {
 protected:
  void run(Chip::Firmware firmware, Tick until = 2'000'000) {
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
    device->run_until(until);
  }
  std::string error_of(Chip::Firmware firmware) {
    try {
      run(firmware);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return {};
  }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

TEST_F(Clock, StartsAtHalfTheOscillator) {
  run(
      [] {
        times[0] = chip->now();
        target_elapse(100);
        times[1] = chip->now();
        sleep_for_ever();
      },
      5000);
  EXPECT_EQ(times[0], 0);
  EXPECT_EQ(times[1], 1000);  // 100 cycles of 10 MHz
}

TEST_F(Clock, LocksAfter131072OscillatorCycles) {
  run([] {
    disable_watchdog();
    target_eallow();
    target_write16(REG_PLLCR, 10);
    times[0] = chip->now();
    seen[0] = target_read16(REG_PLLSTS);
    times[1] = chip->now();
    while ((target_read16(REG_PLLSTS) & PLLSTS_PLLLOCKS_MASK) == 0) times[2] = chip->now();
    times[3] = chip->now();
    target_elapse(100);
    times[4] = chip->now();
    seen[1] = target_read16(REG_PLLCR);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0] & PLLSTS_PLLLOCKS_MASK, 0);
  EXPECT_EQ(times[1] - times[0], 30);  // a frame 2 read, three cycles, still at 10 MHz
  EXPECT_LT(times[2], times[0] + kLockTicks);
  EXPECT_GE(times[3], times[0] + kLockTicks);
  EXPECT_LE(times[3], times[0] + kLockTicks + 30);
  EXPECT_EQ(times[4] - times[3], 100);  // 100 MHz
  EXPECT_EQ(seen[1], 10);
}

TEST_F(Clock, LockBitRisesInItsTick) {
  run(
      [] {
        disable_watchdog();
        write_protected(REG_PLLCR, 10);
        times[0] = chip->now() - 10;  // EDIS comes after the write
        sleep_for_ever();
      },
      1000);
  device->run_until(times[0] + kLockTicks - 1);
  EXPECT_EQ(device->inspect(REG_PLLSTS) & PLLSTS_PLLLOCKS_MASK, 0);
  device->run_until(times[0] + kLockTicks);
  EXPECT_EQ(device->inspect(REG_PLLSTS) & PLLSTS_PLLLOCKS_MASK, PLLSTS_PLLLOCKS_MASK);
}

TEST_F(Clock, RatioOfFive) {
  run([] {
    disable_watchdog();
    write_protected(REG_PLLCR, 5);
    while ((target_read16(REG_PLLSTS) & PLLSTS_PLLLOCKS_MASK) == 0) {
    }
    times[0] = chip->now();
    target_elapse(100);
    times[1] = chip->now();
    sleep_for_ever();
  });
  EXPECT_EQ(times[1] - times[0], 200);  // 50 MHz
}

TEST_F(Clock, UndividedOscillator) {
  run(
      [] {
        write_protected(REG_PLLSTS, PLLSTS_CLKINDIV_MASK);
        times[0] = chip->now();
        target_elapse(100);
        times[1] = chip->now();
        sleep_for_ever();
      },
      5000);
  EXPECT_EQ(times[1] - times[0], 500);  // 20 MHz
}

TEST_F(Clock, RatioWithoutWholeTicksIsAnError) {
  const std::string error = error_of([] {
    write_protected(REG_PLLCR, 9);  // 90 MHz: 11.1 ns
    sleep_for_ever();
  });
  EXPECT_NE(error.find("PLLCR"), std::string::npos) << error;
  EXPECT_NE(error.find("(9)"), std::string::npos) << error;
}

TEST_F(Clock, MultiplierWithClkindivIsAnError) {
  const std::string error = error_of([] {
    write_protected(REG_PLLSTS, PLLSTS_CLKINDIV_MASK);
    write_protected(REG_PLLCR, 5);
    sleep_for_ever();
  });
  EXPECT_NE(error.find("CLKINDIV"), std::string::npos) << error;
}

TEST_F(Clock, TooFewFlashWaitStatesAreAnError) {
  const std::string error = error_of([] {
    disable_watchdog();
    write_protected(REG_FBANKWAIT, 0x0202);  // enough for 10 MHz, not for 100 MHz: 3 x 10 ns < 36 ns
    write_protected(REG_PLLCR, 10);
    sleep_for_ever();
  });
  EXPECT_NE(error.find("flash"), std::string::npos) << error;
}

TEST_F(Clock, LoweringTheFlashWaitStatesTooFarIsAnError) {
  const std::string error = error_of([] {
    start_clock();
    write_protected(REG_FBANKWAIT, 0x0203);  // paged accesses in 30 ns
    sleep_for_ever();
  });
  EXPECT_NE(error.find("flash"), std::string::npos) << error;
}

TEST_F(Clock, ThreeFlashWaitStatesSufficeAt100MHz) {
  EXPECT_EQ(error_of([] {
              start_clock();
              write_protected(REG_FBANKWAIT, 0x0303);
              write_protected(REG_FOTPWAIT, 5);
              sleep_for_ever();
            }),
            "");
}

TEST_F(Clock, AccessCosts) {
  run([] {
    start_clock();
    write_protected(REG_PCLKCR1, PCLKCR1_EPWM1ENCLK_MASK);
    times[0] = chip->now();
    target_write16(EPWM_BASE(1) + EPWM_CMPA_CMPA, 1);
    times[1] = chip->now();
    target_read16(EPWM_BASE(1) + EPWM_CMPA_CMPA);
    times[2] = chip->now();
    target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    times[3] = chip->now();
    target_read16(REG_ADCST);
    times[4] = chip->now();
    sleep_for_ever();
  });
  EXPECT_EQ(times[1] - times[0], 1);
  EXPECT_EQ(times[2] - times[1], 3);
  EXPECT_EQ(times[3] - times[2], 1);
  EXPECT_EQ(times[4] - times[3], 3);
}

}  // namespace
