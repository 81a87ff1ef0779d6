// Start-up, encoder, safety line and watchdog on the virtual chip.

#include <algorithm>

#include "hal/hal_time.h"
#include "tests/hal/on_chip.hpp"

namespace stillspin::test {

class OnChipBoard : public OnChip {};

TEST_F(OnChipBoard, start_up_breaks_no_rule_and_takes_its_time) {
  board.run_until(kStarted);
  expect_clean();
  EXPECT_FALSE(fw.control_ticks.empty()) << "running after 15 ms: PLL 6.6 ms, ADC 5 ms, the rest is set-up";
  EXPECT_TRUE(fw.gates_ok);
}

TEST_F(OnChipBoard, encoder_follows_the_shaft_both_ways) {
  for (const int edges : {7, -7}) {
    BenchWorld shaft;
    shaft.edges_per_100_us = edges;
    chip::Chip drive{shaft, image};
    drive.run_until(kStarted + 100 * kMillisecond);  // 7000 edges: past the wrap
    const std::uint32_t before = fw.encoder_count;
    EXPECT_LT(before, 4096u);
    drive.run_until(drive.now() + 10 * kPeriod);
    EXPECT_EQ((fw.encoder_count - before) % 4096u, (10u * static_cast<std::uint32_t>(edges)) % 4096u);
  }
}

TEST_F(OnChipBoard, gate_enable_toggles_once_a_period) {
  board.run_until(kStarted);
  world.outputs.clear();
  board.run_until(kStarted + 10 * kPeriod);
  const auto toggles =
      std::count_if(world.outputs.begin(), world.outputs.end(), [](const auto& o) { return o.pin == 34; });
  EXPECT_EQ(toggles, 10);
}

TEST_F(OnChipBoard, watchdog_resets_a_drive_that_does_not_service_it) {
  fw.watchdog = true;
  board.run_until(kStarted);
  EXPECT_EQ(board.statistics().resets, 0u);
  board.run_until(kStarted + (HAL_WATCHDOG_PERIOD_US + 1000) * 100);
  EXPECT_EQ(board.statistics().resets, 1u);
}

TEST_F(OnChipBoard, serviced_watchdog_keeps_quiet) {
  fw.watchdog = true;
  fw.service_watchdog = true;
  board.run_until(kStarted + 3 * Tick{HAL_WATCHDOG_PERIOD_US} * 100);
  EXPECT_EQ(board.statistics().resets, 0u);
  expect_clean();
}

}  // namespace stillspin::test
