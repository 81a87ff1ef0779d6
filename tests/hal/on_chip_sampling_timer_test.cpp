// Slices on the virtual chip: how often they come, what they sample, and that the pins follow.

#include "tests/hal/on_chip.hpp"

namespace stillspin::test {

class OnChipSlices : public OnChip {
 protected:
  /// Windows first, then slices from a period start on; the start of a period in which they run.
  Tick start_slices(std::uint16_t ticks) {
    board.run_until(kStarted);
    fw.slice_ticks = ticks;
    board.run_until(kStarted + 5 * kPeriod);
    return period_start() + kPeriod;
  }
};

TEST_F(OnChipSlices, ComeEvenlyAndInStepWithThePeriod) {
  const Tick start = start_slices(500);
  board.run_until(start);
  const std::size_t before = fw.slices.size();
  world.samples.clear();
  board.run_until(start + 10 * kPeriod);
  expect_clean();
  EXPECT_EQ(fw.slices.size() - before, 200u);
  Tick last = -1;
  for (const BenchWorld::Sample& s : world.samples) {
    if (s.channel != 0) continue;
    if (last >= 0) {
      ASSERT_EQ(s.t - last, 500);
    }
    last = s.t;
  }
}

TEST_F(OnChipSlices, HandOverBothCurrentsOfOneInstantAndTheLink) {
  const Tick start = start_slices(1000);
  board.run_until(start);
  fw.slices.clear();
  world.samples.clear();
  board.run_until(start + kPeriod - 1);
  ASSERT_EQ(fw.slices.size(), 10u);
  ASSERT_EQ(world.samples.size(), 40u);  // two pairs each
  for (std::size_t n = 0; n < 10; ++n) {
    const BenchWorld::Sample* s = &world.samples[4 * n];
    EXPECT_EQ(s[0].t, s[1].t);
    EXPECT_EQ(fw.slices[n].current_a, BenchWorld::code_at(s[0].t, 0));
    EXPECT_EQ(fw.slices[n].current_b, BenchWorld::code_at(s[1].t, 8));
    EXPECT_EQ(fw.slices[n].link, BenchWorld::code_at(s[2].t, 1));
  }
}

TEST_F(OnChipSlices, PinsFollowWithTheDeadBand) {
  const Tick start = start_slices(1000);
  world.pins.clear();
  board.run_until(start + 3 * kPeriod);
  for (int leg = 0; leg < 3; ++leg) {
    const std::vector<Tick> lower_off = edges(leg, false, false, start);
    const std::vector<Tick> upper_on = edges(leg, true, true, start);
    ASSERT_GE(upper_on.size(), 8u);
    // one leg after the other: every third slice
    for (std::size_t n = 1; n < upper_on.size(); ++n) EXPECT_NEAR(upper_on[n] - upper_on[n - 1], 3000, 20);
    for (std::size_t n = 0; n + 1 < lower_off.size() && n < upper_on.size(); ++n)
      EXPECT_EQ(upper_on[n] - lower_off[n], kDeadBand);
  }
  for (const BenchWorld::Pins& p : world.pins) EXPECT_FALSE(p.a && p.b) << "at " << p.t;
}

TEST_F(OnChipSlices, LeaveTimeForAThousandCyclesOfControl) {
  fw.control_cycles = 4000;
  fw.window_cycles = 150;
  const Tick start = start_slices(500);
  board.run_until(start);
  const std::size_t before = fw.control_ticks.size();
  const std::size_t slices = fw.slices.size();
  board.run_until(start + 10 * kPeriod);
  EXPECT_EQ(fw.control_ticks.size() - before, 10u) << "no control interrupt is lost";
  EXPECT_EQ(fw.slices.size() - slices, 200u) << "and no slice";
}

TEST_F(OnChipSlices, EndGivesPulsesAndWindowsBack) {
  const Tick start = start_slices(500);
  board.run_until(start - 1);
  fw.slice_ticks = 0;
  board.run_until(start + 4 * kPeriod - 1);
  expect_clean();
  const std::size_t windows = fw.windows.size();
  board.run_until(start + 6 * kPeriod - 1);
  EXPECT_EQ(fw.windows.size() - windows, 6u) << "three a period";
  const std::vector<Tick> off = edges(0, false, false, start + 4 * kPeriod);
  ASSERT_EQ(off.size(), 2u);
  EXPECT_EQ(off[0], fw.frame.edge_tick[0]);
}

TEST_F(OnChipSlices, RefusesWhatDoesNotFillThePeriodAndWhatIsTooShort) {
  EXPECT_FALSE(hal_sampling_timer_begin(700));
  EXPECT_FALSE(hal_sampling_timer_begin(400));
}

}  // namespace stillspin::test
