// Sample instants, results and preemption of the measuring windows on the virtual chip.

#include <algorithm>
#include <iterator>
#include <vector>

#include "tests/hal/on_chip.hpp"

namespace stillspin::test {

class OnChipSampling : public OnChip {
 protected:
  struct Period {
    Tick start;
    std::size_t first;  // of its windows
  };

  // The first whole one after the start.
  Period one_period() {
    board.run_until(kStarted);
    const Tick start = period_start() + kPeriod;
    board.run_until(start - 1);
    const std::size_t first = fw.windows.size();
    board.run_until(start + kPeriod - 1);
    EXPECT_EQ(fw.windows.size(), first + 3);
    return {start, first};
  }
};

TEST_F(OnChipSampling, samples_are_taken_at_the_published_instants) {
  const Tick start = one_period().start;
  std::vector<BenchWorld::Sample> got;
  std::copy_if(world.samples.begin(), world.samples.end(), std::back_inserter(got),
               [&](const BenchWorld::Sample& s) { return s.t >= start; });
  ASSERT_EQ(got.size(), 3u * 16u);
  std::size_t i = 0;
  for (int window = 0; window < 3; ++window) {
    Tick sum_start = 0;
    Tick sum_end = 0;
    for (int pair = 0; pair < 8; ++pair) {
      const bool last_burst = pair >= 4;
      const Tick trigger = last_burst ? fw.frame.burst_end_tick[window] : fw.frame.burst_start_tick[window];
      const Tick expected = start + trigger + HAL_ADC_HOLD_TICKS + (pair % 4) * Tick{HAL_ADC_PAIR_TICKS};
      const bool slow = pair == 7;
      EXPECT_EQ(got[i].channel, slow ? 1 : 0);
      EXPECT_EQ(got[i].t, expected) << "window " << window << ", pair " << pair;
      EXPECT_EQ(got[i + 1].channel, slow ? 9 : 8);
      EXPECT_EQ(got[i + 1].t, expected) << "both channels at one instant";
      sum_start += last_burst ? 0 : got[i].t - start - trigger;
      sum_end += last_burst && !slow ? got[i].t - start - trigger : 0;
      i += 2;
    }
    EXPECT_EQ(sum_start, HAL_ADC_START_SAMPLES * Tick{HAL_ADC_START_DELAY_TICKS});
    EXPECT_EQ(sum_end, HAL_ADC_END_SAMPLES * Tick{HAL_ADC_END_DELAY_TICKS});
  }
}

TEST_F(OnChipSampling, window_holds_the_samples_of_its_own_bursts) {
  const Period period = one_period();
  ASSERT_FALSE(HasFailure());
  for (std::size_t n = 0; n < 3; ++n) {
    const auto sum = [&](Tick trigger, unsigned pairs, int channel) {
      unsigned out = 0;
      for (unsigned k = 0; k < pairs; ++k) {
        out += BenchWorld::code_at(period.start + trigger + HAL_ADC_HOLD_TICKS + k * Tick{HAL_ADC_PAIR_TICKS}, channel);
      }
      return out;
    };
    const hal_adc_window_t& w = fw.windows[period.first + n];
    const Tick begin = fw.frame.burst_start_tick[n];
    const Tick end = fw.frame.burst_end_tick[n];
    EXPECT_EQ(w.start_a, sum(begin, HAL_ADC_START_SAMPLES, 0));
    EXPECT_EQ(w.start_b, sum(begin, HAL_ADC_START_SAMPLES, 8));
    EXPECT_EQ(w.end_a, sum(end, HAL_ADC_END_SAMPLES, 0));
    EXPECT_EQ(w.end_b, sum(end, HAL_ADC_END_SAMPLES, 8));
    const Tick slow = HAL_ADC_END_SAMPLES * Tick{HAL_ADC_PAIR_TICKS};
    EXPECT_EQ(w.link, sum(end + slow, 1, 1));
    EXPECT_EQ(w.aux, sum(end + slow, 1, 9));
  }
}

// Each code of the erratum's share is a whole number, of their sum it is not.
TEST_F(OnChipSampling, crosstalk_of_early_silicon_is_taken_off) {
  board.set_revision(2);
  const auto [start, first] = one_period();
  ASSERT_FALSE(HasFailure());
  unsigned shares = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const hal_adc_window_t& w = fw.windows[first + n];
    unsigned b = 0;
    for (unsigned k = 0; k < HAL_ADC_START_SAMPLES; ++k) {
      const Tick hold = start + fw.frame.burst_start_tick[n] + HAL_ADC_HOLD_TICKS + k * Tick{HAL_ADC_PAIR_TICKS};
      b += BenchWorld::code_at(hold, 8);
      shares += BenchWorld::code_at(hold, 0) / 256;
    }
    EXPECT_NEAR(w.start_b, b, HAL_ADC_START_SAMPLES);
  }
  EXPECT_GT(shares, 3 * 2 * HAL_ADC_START_SAMPLES) << "or nothing has been tried";
}

TEST_F(OnChipSampling, windows_as_close_as_published_lose_nothing) {
  const auto gap = static_cast<std::uint16_t>(HAL_ADC_WINDOW_GAP_TICKS);
  const auto burst = static_cast<std::uint16_t>(HAL_ADC_BURST_TICKS);
  // The second window's interrupt falls into the time in which hal_pwm_write holds interrupts off, or close to it.
  for (std::uint16_t i = 0; i < 3; ++i) {
    fw.frame.burst_start_tick[i] = static_cast<std::uint16_t>(1000 + i * (gap + burst));
    fw.frame.burst_end_tick[i] = static_cast<std::uint16_t>(fw.frame.burst_start_tick[i] + burst);
  }
  board.run_until(kStarted);
  for (std::uint16_t write_at = 1100; write_at < 2600; write_at = static_cast<std::uint16_t>(write_at + 13)) {
    fw.write_at_tick = write_at;
    board.run_until(period_start() + kPeriod - 1);
    const std::size_t before = fw.windows.size();
    board.run_until(board.now() + kPeriod);
    ASSERT_EQ(fw.windows.size(), before + 3) << "frame written at " << write_at;
    for (int n = 0; n < 3; ++n) {
      const Tick hold = board.now() + 1 - kPeriod + fw.frame.burst_end_tick[n] + HAL_ADC_HOLD_TICKS;
      EXPECT_EQ(fw.windows[before + static_cast<std::size_t>(n)].link,
                BenchWorld::code_at(hold + 3 * Tick{HAL_ADC_PAIR_TICKS}, 1));
    }
  }
}

TEST_F(OnChipSampling, window_interrupt_preempts_a_long_control_interrupt) {
  fw.control_cycles = 4000;  // the first two windows end meanwhile
  board.run_until(kStarted);
  const std::size_t periods = fw.control_ticks.size();
  const int preemptions = fw.preemptions;
  board.run_until(kStarted + 10 * kPeriod);
  EXPECT_EQ(fw.control_ticks.size(), periods + 10);
  EXPECT_GE(fw.preemptions, preemptions + 9) << "the window at 700 in each period but perhaps the first";
  for (const std::uint16_t tick : fw.control_ticks) {
    EXPECT_LT(tick, 60u) << "14 cycles of latency, the saving of registers and the read itself";
  }
  expect_clean();
}

}  // namespace stillspin::test
