// Samples keep off the edges whose instant is not certain.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/dead_time.h"
}

namespace {

constexpr std::int16_t kBlocked = 230, kReleased = 60;

dead_time_config_t dead_time() {
  dead_time_config_t c = {};
  c.blocked_ticks = kBlocked;
  c.released_ticks = kReleased;
  c.band_q20 = 209715;       // 0.2 A
  c.edge_band_q20 = 734003;  // 0.7 A
  dead_time_design(&c);
  return c;
}

sampling_config_t sampling() {
  sampling_config_t c = {};
  c.settle_ticks = 1050;
  c.burst_ticks = 130;
  c.span_min_ticks = 300;
  c.last_tick = 9640;
  return c;
}

// Leg a alone first, then b and c: the alternating layout.
svpwm_pattern_t pattern() {
  svpwm_pattern_t p = {};
  p.pulses = stillspin::test::ordered({{260, 5700, 5700}, {4460, 9900, 9900}, 0});
  const sampling_config_t c = sampling();
  svpwm_find_windows(&c, &p);
  return p;
}

ab_t phases(double a, double b) {
  return frame_clarke2(static_cast<std::int32_t>(a * 1048576), static_cast<std::int32_t>(b * 1048576));
}

dead_time_edges_t compensate(const svpwm_pattern_t& p, ab_t current, svpwm_pulses_t* command) {
  const dead_time_config_t c = dead_time();
  return dead_time_compensate(&c, &p.pulses, current, 17179869L, 300L * 65536L, command);  // 0.016 A per V
}

TEST(Guard, CertainEdgesLeaveTheWindowsAlone) {
  svpwm_pattern_t p = pattern();
  const svpwm_pattern_t before = p;
  svpwm_pulses_t command;
  const dead_time_edges_t uncertain = compensate(p, phases(8.0, -4.0), &command);
  EXPECT_EQ(uncertain, 0);
  const dead_time_config_t c = dead_time();
  const sampling_config_t s = sampling();
  dead_time_guard_windows(&c, &s, &command, uncertain, &p);
  ASSERT_EQ(p.window_count, before.window_count);
  for (int k = 0; k < p.window_count; ++k) {
    EXPECT_EQ(p.windows[k].begin, before.windows[k].begin);
    EXPECT_EQ(p.windows[k].end, before.windows[k].end);
  }
}

// Whatever the sign of the current turns out to be, the motor's edge is outside of the samples.
TEST(Guard, WhateverTheSignTheSamplesAreInsideTheWindow) {
  int guarded = 0;
  for (double a = -3.0; a <= 3.0; a += 0.05) {
    for (double b = -3.0; b <= 3.0; b += 0.25) {
      svpwm_pattern_t p = pattern();
      const svpwm_pulses_t wanted = p.pulses;
      svpwm_pulses_t command;
      const dead_time_edges_t uncertain = compensate(p, phases(a, b), &command);
      const dead_time_config_t c = dead_time();
      const sampling_config_t s = sampling();
      dead_time_guard_windows(&c, &s, &command, uncertain, &p);
      guarded += uncertain != 0;
      for (int k = 0; k < p.window_count; ++k) {
        const int first = svpwm_burst_start(&s, &p.windows[k]), last = svpwm_burst_end(&s, &p.windows[k]);
        ASSERT_GE(last - first, s.span_min_ticks);
        for (int leg = 0; leg < SVPWM_LEGS; ++leg) {
          for (const bool fall : {false, true}) {
            const int at = fall ? wanted.fall[leg] : wanted.rise[leg];
            const int sent = fall ? command.fall[leg] : command.rise[leg];
            const bool open = (uncertain >> (leg + (fall ? SVPWM_LEGS : 0)) & 1) != 0;
            const int early = open ? sent + kReleased : at, late = open ? sent + kBlocked : at;
            const bool before = late + s.settle_ticks <= first, after = early >= last + s.burst_ticks;
            ASSERT_TRUE(before || after) << "leg " << leg << " at " << a << ", " << b << " A";
          }
        }
      }
    }
  }
  EXPECT_GT(guarded, 500);
}

TEST(Guard, AWindowThatBecomesTooShortGoes) {
  svpwm_pattern_t p = pattern();
  svpwm_pulses_t command;
  const dead_time_edges_t uncertain = compensate(p, phases(0.0, 0.0), &command);
  EXPECT_NE(uncertain, 0);
  const dead_time_config_t c = dead_time();
  sampling_config_t s = sampling();
  s.span_min_ticks = 2950;  // the windows are 4200 ticks long: 3020 between the bursts, less what is uncertain
  const std::uint16_t before = p.window_count;
  dead_time_guard_windows(&c, &s, &command, uncertain, &p);
  EXPECT_LT(p.window_count, before);
}

}  // namespace
