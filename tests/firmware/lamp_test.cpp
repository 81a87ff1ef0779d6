// The first program for a new board, on the virtual chip.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hal/hal_board.h"
#include "sim_host/chip/chip.hpp"
#include "tests/hal/bench_world.hpp"

extern "C" {
#include "firmware/lamp/lamp.h"
}

namespace stillspin::test {
namespace {

using chip::Tick;

constexpr Tick kHalf = 50'000'000;   // half a second
constexpr Tick kClock = kHalf / 50;  // more than crystal and PLL take
constexpr double kPoll = 100.0;      // the program looks at its clock that often

TEST(Lamp, BlinksOnceASecondAndTouchesNothingElse) {
  BenchWorld world;
  chip::Chip chip(world, lamp_main);
  chip.run_until(2 * kHalf + 2 * kClock);
  std::vector<Tick> turns;
  bool lit = false;
  for (const BenchWorld::Output& c : world.outputs) {
    if (c.pin != BOARD_PIN_FAULT_LAMP) {
      EXPECT_EQ(c.pin, BOARD_PIN_GATE_ENABLE);
      EXPECT_FALSE(c.level);
    } else if ((c.level == (BOARD_LAMP_ON_LEVEL != 0)) != lit) {
      lit = !lit;
      turns.push_back(c.t);
    }
  }
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_GT(turns[0], kHalf);
  EXPECT_LT(turns[0], kHalf + kClock);
  EXPECT_NEAR(static_cast<double>(turns[1] - turns[0]), kHalf, kPoll);
  EXPECT_TRUE(std::none_of(world.pins.begin(), world.pins.end(), [](const auto& p) { return p.a || p.b; }));
  EXPECT_EQ(chip.statistics().resets, 0u);
  EXPECT_EQ(chip.statistics().protected_writes_lost, 0u);
  EXPECT_EQ(chip.statistics().gated_accesses, 0u);
}

}  // namespace
}  // namespace stillspin::test
