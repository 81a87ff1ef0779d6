// CPU timers: counting, reload, prescaler, interrupts at exact ticks, and their three lines to the CPU.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
std::vector<Tick> ticks;
Tick start = 0;
std::uint32_t count[4];
std::uint16_t seen[4];

class Timer : public ::testing::Test {
 protected:
  void run(Chip::Firmware firmware, Tick until = 2'000'000) {
    ticks.clear();
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
    device->run_until(until);
  }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

constexpr Tick kEntry = 14 + 8;  // cycles from the flag to the ISR's first statement

void arm(unsigned n, std::uint32_t period, std::uint16_t divider, std::uint16_t extra) {
  target_write16(CPUTIMER_BASE(n) + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK);
  target_write32(CPUTIMER_BASE(n) + CPUTIMER_PRD, period);
  target_write16(CPUTIMER_BASE(n) + CPUTIMER_TPR, divider & 0xFFu);
  target_write16(CPUTIMER_BASE(n) + CPUTIMER_TPRH, static_cast<std::uint16_t>(divider >> 8));
  target_write16(CPUTIMER_BASE(n) + CPUTIMER_TCR, static_cast<std::uint16_t>(CPUTIMER_TCR_TRB_MASK | extra));
  start = chip->now();
}

TEST_F(Timer, InterruptsComeEveryPeriodPlusOneCycles) {
  run([] {
    start_clock();
    install(VECTOR_TINT0, [] {
      ticks.push_back(chip->now());
      target_write16(REG_PIEACK, group_bit(1));
    });
    enable_pie();
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    arm(0, 999, 0, CPUTIMER_TCR_TIE_MASK);
    for (;;) target_idle();
  });
  ASSERT_GT(ticks.size(), 100u);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i], start + 999 + 1000 * static_cast<Tick>(i) + kEntry);
  }
}

TEST_F(Timer, PrescalerDivides) {
  run([] {
    start_clock();
    install(VECTOR_TINT0, [] {
      ticks.push_back(chip->now());
      target_write16(REG_PIEACK, group_bit(1));
    });
    enable_pie();
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    arm(0, 9, 0x0103, CPUTIMER_TCR_TIE_MASK);  // 260 cycles a count
    for (;;) target_idle();
  });
  ASSERT_GT(ticks.size(), 10u);
  EXPECT_EQ(ticks[0], start + 9 * 260 + kEntry);
  EXPECT_EQ(ticks[1] - ticks[0], 10 * 260);
}

TEST_F(Timer, TimersOneAndTwoHaveTheirOwnLines) {
  static std::vector<int> order;
  order.clear();
  run(
      [] {
        start_clock();
        install(13, [] { order.push_back(1); });
        install(VECTOR_TINT2, [] { order.push_back(2); });
        enable_pie();
        target_write_ier(0x3000);  // INT13, INT14
        target_enable_interrupts();
        arm(2, 500, 0, CPUTIMER_TCR_TIE_MASK);
        arm(1, 1'000'000, 0, CPUTIMER_TCR_TIE_MASK);
        for (;;) target_idle();
      },
      700'000);
  ASSERT_GE(order.size(), 3u);
  for (int n : order) EXPECT_EQ(n, 2);
  device->run_until(1'800'000);
  EXPECT_EQ(std::count(order.begin(), order.end(), 1), 1);
}

TEST_F(Timer, FreeRunningTimeBase) {
  run([] {
    start_clock();
    arm(2, 0xFFFFFFFFu, 0, 0);
    count[0] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    target_elapse(12'345);
    count[1] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    target_elapse(60'000);
    target_elapse(60'000);
    count[2] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    sleep_for_ever();
  });
  EXPECT_EQ(count[0], 0xFFFFFFFFu - 1);  // the read itself takes a cycle
  EXPECT_EQ(count[0] - count[1], 12'345u + 1);
  EXPECT_EQ(count[1] - count[2], 120'000u + 1);  // a borrow from the high word
}

TEST_F(Timer, StoppedTimerStands) {
  run([] {
    start_clock();
    arm(2, 5000, 0, 0);
    target_elapse(100);
    target_write16(CPUTIMER_BASE(2) + CPUTIMER_TCR, CPUTIMER_TCR_TSS_MASK);
    count[0] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    target_elapse(100);
    count[1] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    target_write16(CPUTIMER_BASE(2) + CPUTIMER_TCR, 0);
    target_elapse(100);
    count[2] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
    sleep_for_ever();
  });
  EXPECT_EQ(count[0], 5000u - 101);
  EXPECT_EQ(count[1], count[0]);
  EXPECT_EQ(count[2], count[1] - 101);
}

TEST_F(Timer, FlagIsSetAtZeroAndClearedByWritingOne) {
  run([] {
    start_clock();
    arm(1, 100, 0, CPUTIMER_TCR_TIF_MASK);
    target_elapse(98);
    seen[0] = target_read16(CPUTIMER_BASE(1) + CPUTIMER_TCR);
    seen[1] = target_read16(CPUTIMER_BASE(1) + CPUTIMER_TCR);
    target_write16(CPUTIMER_BASE(1) + CPUTIMER_TCR, CPUTIMER_TCR_TIF_MASK);
    seen[2] = target_read16(CPUTIMER_BASE(1) + CPUTIMER_TCR);
    target_elapse(101);
    seen[3] = target_read16(CPUTIMER_BASE(1) + CPUTIMER_TCR);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0] & CPUTIMER_TCR_TIF_MASK, 0);  // 99 cycles after the start
  EXPECT_NE(seen[1] & CPUTIMER_TCR_TIF_MASK, 0);  // 100
  EXPECT_EQ(seen[2] & CPUTIMER_TCR_TIF_MASK, 0);
  EXPECT_NE(seen[3] & CPUTIMER_TCR_TIF_MASK, 0);  // once more around
}

TEST_F(Timer, CountSurvivesAChangeOfClock) {
  run(
      [] {
        disable_watchdog();
        arm(2, 0xFFFFFFFFu, 0, 0);
        target_elapse(1000);
        count[0] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
        write_protected(REG_PLLSTS, PLLSTS_CLKINDIV_MASK);  // from 10 to 20 MHz
        target_elapse(1000);
        count[1] = target_read32(CPUTIMER_BASE(2) + CPUTIMER_TIM);
        sleep_for_ever();
      },
      100'000);
  EXPECT_EQ(0xFFFFFFFFu - count[0], 1001u);
  EXPECT_EQ(count[0] - count[1], 1000u + 4);  // cycles, whatever their length: EALLOW, write, EDIS, read
}

}  // namespace
