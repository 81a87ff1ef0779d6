// Edges at the pins of the virtual chip: where a frame puts them, when it takes effect, and what switches them off.

#include <algorithm>
#include <iterator>
#include <vector>

#include "hal/hal_replay.h"
#include "tests/hal/on_chip.hpp"

namespace stillspin::test {

class OnChipPwm : public OnChip {};

TEST_F(OnChipPwm, no_device_is_ever_on_before_the_gates_are) {
  fw.gates_on = false;
  board.run_until(kStarted + 10 * kPeriod);
  expect_clean();
  ASSERT_GE(fw.in_time.size(), 10u) << "frames are being written";
  for (const BenchWorld::Pins& p : world.pins) {
    EXPECT_FALSE(p.a || p.b) << "module " << p.module << " at " << p.t;
  }
}

// Host in the loop: what the drive asks of the gates is played and noted, never done.
TEST_F(OnChipPwm, no_device_is_ever_on_while_a_recording_plays) {
  hal_replay_start(REPLAY_PLAYS, [] {});
  replay_period_t& period = hal_replay_period;
  period.input_count = REPLAY_INPUTS;
  std::fill(std::begin(period.inputs), std::end(period.inputs), std::uint16_t{1});  // all that is asked for is done
  fw.gates_on = true;
  board.run_until(kStarted + 10 * kPeriod);
  EXPECT_TRUE(fw.gates_ok);
  const std::vector<std::uint16_t> told(period.outputs, period.outputs + period.output_count);
  EXPECT_NE(std::find(told.begin(), told.end(), REPLAY_GATES_ON), told.end()) << "asked for";
  for (const BenchWorld::Pins& p : world.pins) {
    EXPECT_FALSE(p.a || p.b) << "module " << p.module << " at " << p.t;
  }
  hal_replay_start(REPLAY_OFF, nullptr);
}

TEST_F(OnChipPwm, pulses_stand_where_the_frame_puts_them) {
  board.run_until(kStarted);
  const Tick start = period_start() + kPeriod;
  board.run_until(start + 5 * kPeriod - 1);
  expect_clean();
  for (int leg = 0; leg < 3; ++leg) {
    const Tick rise = fw.frame.edge_tick[leg];
    const Tick fall = fw.frame.edge_tick[HAL_PWM_LEGS + leg];
    for (Tick n = 0; n < 5; ++n) {
      const auto at = [&](bool upper, bool rising) {
        const std::vector<Tick> all = edges(leg, upper, rising, start);
        return all.size() == 5 ? all[static_cast<std::size_t>(n)] : Tick{-1};
      };
      EXPECT_EQ(at(false, false), n * kPeriod + rise) << "lower off at the rise tick, leg " << leg;
      EXPECT_EQ(at(true, true), n * kPeriod + rise + kDeadBand) << "upper on a dead band later";
      EXPECT_EQ(at(true, false), n * kPeriod + fall) << "upper off at the fall tick";
      EXPECT_EQ(at(false, true), n * kPeriod + fall + kDeadBand) << "lower on a dead band later";
    }
  }
}

TEST_F(OnChipPwm, leg_without_a_pulse_keeps_its_lower_device_on) {
  fw.frame.edge_tick[1] = HAL_PWM_NONE;
  board.run_until(kStarted);
  const Tick start = period_start();
  board.run_until(start + 5 * kPeriod);
  EXPECT_TRUE(edges(1, true, true, 0).empty());
  EXPECT_TRUE(edges(1, false, false, start).empty());
  EXPECT_EQ(edges(1, false, true, 0).size(), 1u) << "on with the gates, and for good";
}

TEST_F(OnChipPwm, both_devices_of_a_leg_are_never_on) {
  fw.frame.edge_tick[0] = 1;
  fw.frame.edge_tick[HAL_PWM_LEGS + 0] = 9999;  // the shortest pause that a frame can ask for
  board.run_until(kStarted + 10 * kPeriod);
  for (const BenchWorld::Pins& p : world.pins) {
    EXPECT_FALSE(p.a && p.b) << "module " << p.module << " at " << p.t;
  }
}

TEST_F(OnChipPwm, frame_takes_effect_at_the_next_period_start) {
  board.run_until(kStarted);
  const Tick start = period_start() + kPeriod;
  board.run_until(start - 1);
  fw.frame.edge_tick[0] = 1500;  // read by the control interrupt of the period that begins at `start`
  board.run_until(start + 2 * kPeriod - 1);
  const std::vector<Tick> lower_off = edges(0, false, false, start);
  ASSERT_EQ(lower_off.size(), 2u);
  EXPECT_EQ(lower_off[0], 1000);
  EXPECT_EQ(lower_off[1], kPeriod + 1500);
}

TEST_F(OnChipPwm, frame_is_written_within_the_published_time) {
  board.run_until(kStarted + 5 * kPeriod);
  ASSERT_EQ(fw.preemptions, 0) << "nothing else ran while the time was taken";
  // The model counts the accesses only; the published time leaves room for the instructions between them.
  EXPECT_LE(*std::max_element(fw.write_ticks.begin(), fw.write_ticks.end()), HAL_PWM_WRITE_TICKS);
}

TEST_F(OnChipPwm, late_frame_repeats_the_last_one) {
  board.run_until(kStarted);
  const Tick start = period_start() + kPeriod;
  board.run_until(start - 1);
  fw.frame.edge_tick[0] = 1500;
  fw.write_at_tick = 9900;
  fw.deadline = 9800;
  const std::size_t before = fw.in_time.size();
  board.run_until(start + kPeriod + 500);
  fw.write_at_tick = 0;
  ASSERT_GT(fw.in_time.size(), before);
  EXPECT_FALSE(fw.in_time[before]);
  board.run_until(start + 2 * kPeriod - 1);
  const std::vector<Tick> lower_off = edges(0, false, false, start);
  ASSERT_EQ(lower_off.size(), 2u);
  EXPECT_EQ(lower_off[1], kPeriod + 1000) << "the old one again";
}

TEST_F(OnChipPwm, frame_of_an_overrun_control_interrupt_is_late) {
  board.run_until(kStarted);
  const Tick start = period_start() + kPeriod;
  board.run_until(start - 1);
  fw.control_cycles = 10500;  // writes at tick 500 of the next period, where the counter alone looks early
  const std::size_t before = fw.in_time.size();
  board.run_until(start + 5000);
  fw.control_cycles = 0;
  board.run_until(start + 2 * kPeriod);
  ASSERT_GT(fw.in_time.size(), before + 1);
  EXPECT_FALSE(fw.in_time[before]);
  EXPECT_TRUE(fw.in_time[before + 1]) << "the interrupt that had to wait comes then, and is in time";
}

TEST_F(OnChipPwm, frame_at_the_last_moment_is_written_as_a_whole) {
  fw.deadline = HAL_PWM_LAST_TICK - HAL_PWM_WRITE_TICKS;
  // A window ends just then, and its long interrupt would carry the writes into the next period.
  fw.frame.burst_end_tick[2] = static_cast<std::uint16_t>(fw.deadline - HAL_ADC_BURST_TICKS);
  fw.window_cycles = 300;
  board.run_until(kStarted);
  for (std::uint16_t write_at = static_cast<std::uint16_t>(fw.deadline - 20); write_at < fw.deadline + 20; ++write_at) {
    const Tick start = period_start() + kPeriod;
    board.run_until(start - 1);
    const int shift = write_at - fw.deadline + 21;  // a frame unlike all before
    const std::uint16_t rise = static_cast<std::uint16_t>(1000 + 10 * shift);
    fw.frame.edge_tick[0] = rise;
    fw.frame.edge_tick[2] = static_cast<std::uint16_t>(3000 + 10 * shift);
    fw.write_at_tick = write_at;
    const std::size_t n = fw.in_time.size();
    board.run_until(start + kPeriod + 1000);
    fw.write_at_tick = 0;
    board.run_until(start + 2 * kPeriod - 1);
    ASSERT_GT(fw.in_time.size(), n);
    const bool new_a = edges(0, false, false, start + kPeriod).at(0) == rise;
    const bool new_c = edges(2, false, false, start + kPeriod).at(0) == fw.frame.edge_tick[2];
    EXPECT_EQ(new_a, fw.in_time[n]) << "written at " << write_at;
    EXPECT_EQ(new_c, fw.in_time[n]) << "written at " << write_at;
  }
  EXPECT_GT(std::count(fw.in_time.begin(), fw.in_time.end(), false), 10) << "both sides of the deadline were tried";
}

TEST_F(OnChipPwm, over_current_switches_everything_off_in_the_same_tick) {
  const Tick trip = kStarted + 4321;
  world.over_current_from = trip;
  world.over_current_to = trip + 50;  // half a microsecond is enough for the latch
  board.run_until(trip);
  EXPECT_TRUE(std::any_of(world.pins.begin(), world.pins.end(), [&](const auto& p) { return p.t == trip; }));
  const std::size_t pins_at_trip = world.pins.size();
  board.run_until(trip + 10 * kPeriod);
  EXPECT_EQ(world.pins.size(), pins_at_trip) << "no edge afterwards, although the pin is high again";
  bool on[3] = {};
  for (const BenchWorld::Pins& p : world.pins) {
    on[p.module] = p.a || p.b;
  }
  EXPECT_FALSE(on[0] || on[1] || on[2]);
  EXPECT_NE(board.inspect(EPWM_BASE(4) + EPWM_TZFLG) & EPWM_TZFLG_OST_MASK, 0) << "the witness has seen the pin";
  EXPECT_FALSE(edges(0, true, true, kStarted - kPeriod).empty()) << "it was switching before";
}

TEST_F(OnChipPwm, gates_come_back_only_after_the_over_current_has_gone) {
  const Tick trip = kStarted + 4321;
  const Tick gone = trip + 5 * kPeriod;
  world.over_current_from = trip;
  world.over_current_to = gone;
  fw.retry_gates = true;  // the background loop asks after each interrupt
  board.run_until(trip);
  const std::size_t pins_at_trip = world.pins.size();
  board.run_until(gone);
  EXPECT_EQ(world.pins.size(), pins_at_trip) << "not a moment on while the comparator says stop";
  EXPECT_FALSE(fw.gates_ok);
  board.run_until(gone + 2 * kPeriod);
  EXPECT_GT(world.pins.size(), pins_at_trip);
  EXPECT_TRUE(fw.gates_ok);
}

}  // namespace stillspin::test
