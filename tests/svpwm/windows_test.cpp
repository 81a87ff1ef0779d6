// Windows: constant states, room for settling and bursts, those that tell most, in the order of time.

#include <algorithm>

#include "hal/hal_adc.h"
#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/windows.h"
}

namespace {

using namespace stillspin::test;

void expect_rules(const svpwm_pattern_t& p, const sampling_config_t& c) {
  ASSERT_LE(p.window_count, c.windows);
  const auto s = states(p.pulses);
  for (int k = 0; k < p.window_count; ++k) {
    const svpwm_window_t& w = p.windows[k];
    for (int tick = w.start - c.settle_ticks; tick < w.end + c.burst_ticks; ++tick) {
      ASSERT_EQ(s[static_cast<std::size_t>(tick)], w.state) << tick;
    }
    ASSERT_GE(w.start, 1);
    ASSERT_LE(w.end, c.last_tick);
    ASSERT_GE(w.end - w.start, c.span_min_ticks);
    if (k > 0) {
      // the previous window must have been converted and read before the sequencers start again
      const int gap = w.start - p.windows[k - 1].end;
      ASSERT_GE(gap, static_cast<int>(HAL_ADC_WINDOW_GAP_TICKS));
    }
  }
}

TEST(Windows, ObeyTheRulesForRandomPulses) {
  Random random(90);
  int windows = 0;
  for (int n = 0; n < 3000; ++n) {
    const sampling_config_t c = {static_cast<std::int16_t>(random.between(400.0, 2500.0)), HAL_ADC_BURST_TICKS,
                                 static_cast<std::int16_t>(random.between(100.0, 2000.0)),
                                 static_cast<std::int16_t>(random.between(5000.0, 9800.0)),
                                 static_cast<std::uint16_t>(1 + n % SVPWM_WINDOWS)};
    svpwm_pulses_t pulses;
    for (int leg = 0; leg < 3; ++leg) {
      pulses.at[leg] = static_cast<std::int16_t>(random.between(260.0, 9000.0));
      pulses.at[SVPWM_LEGS + leg] = static_cast<std::int16_t>(random.between(pulses.at[leg] + 1.0, 9960.0));
    }
    const svpwm_pattern_t p = pattern_of(ordered(pulses), c);
    ASSERT_NO_FATAL_FAILURE(expect_rules(p, c)) << n;
    windows += p.window_count;
  }
  EXPECT_GT(windows, 2000);
}

// Every interval looked at; of those with the longest span, of two a zero vector by a quarter of it, as many as
// are wanted.
TEST(Windows, AreThoseThatTellMost) {
  Random random(91);
  sampling_config_t c = default_modulator().sampling;
  int zero_vectors = 0;
  for (int n = 0; n < 1500; ++n) {
    c.windows = static_cast<std::uint16_t>(2 + n % 2);
    const int per_zero = c.windows == 2 ? 4 : 1;
    svpwm_pulses_t pulses;
    for (int leg = 0; leg < 3; ++leg) {
      pulses.at[leg] = static_cast<std::int16_t>(random.between(260.0, 9000.0));
      pulses.at[SVPWM_LEGS + leg] = static_cast<std::int16_t>(random.between(pulses.at[leg] + 1.0, 9960.0));
    }
    std::vector<int> worths;
    for (const Interval& w : intervals(pulses)) {
      const int last = std::min<int>(w.end - c.burst_ticks, c.last_tick);
      const int span = last - (w.begin + c.settle_ticks);
      if (span >= c.span_min_ticks) worths.push_back(svpwm_is_zero_vector(w.state) ? span / per_zero : span);
    }
    std::sort(worths.rbegin(), worths.rend());
    if (worths.size() > c.windows) worths.resize(c.windows);
    const svpwm_pattern_t p = pattern_of(ordered(pulses), c);
    std::vector<int> found;
    for (int k = 0; k < p.window_count; ++k) {
      const bool zero = svpwm_is_zero_vector(p.windows[k].state);
      found.push_back((p.windows[k].end - p.windows[k].start) / (zero ? per_zero : 1));
      zero_vectors += zero ? 1 : 0;
    }
    std::sort(found.rbegin(), found.rend());
    ASSERT_EQ(found, worths) << n;
  }
  EXPECT_GT(zero_vectors, 100);
}

TEST(Windows, NoneInPulsesThatAreAllTooShort) {
  const sampling_config_t c = {2500, 140, 2000, 9640, 2};
  const svpwm_pulses_t pulses = {{1500, 3000, 4500, 6000, 7500, 9000}, 0};
  EXPECT_EQ(pattern_of(ordered(pulses), c).window_count, 0);
}

TEST(Windows, CoincidentEdgesMakeNoEmptyWindow) {
  const sampling_config_t c = {400, 140, 100, 9640, 3};
  const svpwm_pulses_t pulses = {{1000, 1000, 1000, 5000, 5000, 5000}, 0};
  const svpwm_pattern_t p = pattern_of(ordered(pulses), c);
  ASSERT_EQ(p.window_count, 3);
  EXPECT_EQ(p.windows[0].state, 0);
  EXPECT_EQ(p.windows[1].state, 7);
  EXPECT_EQ(p.windows[2].state, 0);
  expect_rules(p, c);
}

// An interval has a window as soon as the two bursts are as far apart as is of use, and not a tick earlier.
TEST(Windows, TheShortestIntervalIsWorthALook) {
  const sampling_config_t c = {400, 140, 100, 9640, 3};
  for (const int length : {639, 640, 641}) {
    const auto to = static_cast<std::int16_t>(1000 + length);
    const svpwm_pulses_t pulses = {{1000, 1000, 1000, to, to, to}, 0};
    const svpwm_pattern_t p = pattern_of(ordered(pulses), c);
    ASSERT_EQ(p.window_count, length < 640 ? 2 : 3) << length;
    if (length < 640) continue;
    EXPECT_EQ(p.windows[1].state, 7);
    EXPECT_EQ(p.windows[1].end - p.windows[1].start, length - 540);
  }
}

// An edge that may come early cuts the last window alone, and only where it lies inside; what is left may be too short.
TEST(Windows, AnUncertainEdgeShortensTheLastOne) {
  const sampling_config_t c = default_modulator().sampling;
  svpwm_pattern_t p = {};
  svpwm_shorten_window(&c, &p, 100);
  EXPECT_EQ(p.window_count, 0);
  const auto shortest = static_cast<std::int16_t>(c.settle_ticks + c.burst_ticks + c.span_min_ticks);
  p.windows[0] = svpwm_window_between(&c, 0, 3000, 1);
  p.windows[1] = svpwm_window_between(&c, 4000, 7000, 2);
  p.window_count = 2;
  svpwm_shorten_window(&c, &p, 7001);
  EXPECT_EQ(p.windows[1].end, 7000 - c.burst_ticks);
  svpwm_shorten_window(&c, &p, 4000 + shortest);
  EXPECT_EQ(p.windows[1].end, 4000 + shortest - c.burst_ticks);
  EXPECT_EQ(p.windows[0].end, 3000 - c.burst_ticks);
  EXPECT_EQ(p.window_count, 2);
  svpwm_shorten_window(&c, &p, 4000 + shortest - 1);
  EXPECT_EQ(p.window_count, 1);
}

}  // namespace
