// Samples keep off the edges whose instant is not certain.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/dead_time.h"
}

namespace {

using namespace stillspin::test;

constexpr std::int16_t kTurnOn = 230, kTurnOff = 60;

dead_time_config_t dead_time() {
  dead_time_config_t c = {};
  c.turn_on_ticks = kTurnOn;
  c.turn_off_ticks = kTurnOff;
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
  c.windows = SVPWM_WINDOWS;
  return c;
}

// Leg a alone first, then b and c: the alternating layout.
svpwm_pulses_t alternating() { return ordered({{260, 5700, 5700, 4460, 9900, 9900}, 0}); }

ab_t phases(double a, double b) {
  return frame_clarke2(static_cast<std::int32_t>(a * 1048576), static_cast<std::int32_t>(b * 1048576));
}

Sent sent_at(const svpwm_pulses_t& wanted, ab_t current) {
  const dead_time_config_t c = dead_time();
  return sent(c, wanted, {dead_time_shares_q12(&c, current), 17179869L, 300L * 65536L});  // 0.016 A per V
}

svpwm_pattern_t guarded(const sampling_config_t& s, const svpwm_pulses_t& wanted, const Arrivals& arrivals) {
  svpwm_pattern_t p = {};
  p.pulses = wanted;
  find_windows(s, arrivals, &p);
  return p;
}

TEST(Guard, CertainEdgesLeaveTheWindowsAlone) {
  const svpwm_pulses_t wanted = alternating();
  const Arrivals arrivals = sent_at(wanted, phases(8.0, -4.0)).arrivals;
  for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) {
    EXPECT_EQ(arrivals[edge].earliest, wanted.at[edge]);
    EXPECT_EQ(arrivals[edge].latest, wanted.at[edge]);
  }
  const svpwm_pattern_t p = guarded(sampling(), wanted, arrivals);
  ASSERT_EQ(p.window_count, 2);
  const sampling_config_t s = sampling();
  EXPECT_EQ(p.windows[0].start, 260 + s.settle_ticks);
  EXPECT_EQ(p.windows[0].end, 4460 - s.burst_ticks);
  EXPECT_EQ(p.windows[1].start, 5700 + s.settle_ticks);
  EXPECT_EQ(p.windows[1].end, std::min<int>(9900 - s.burst_ticks, s.last_tick));
}

// Whatever the sign of the current turns out to be, the motor's edge is outside of the samples.
void expect_clear(const svpwm_pattern_t& p, const svpwm_pulses_t& command, const Arrivals& arrivals) {
  const sampling_config_t s = sampling();
  for (int k = 0; k < p.window_count; ++k) {
    const int first = p.windows[k].start, last = p.windows[k].end;
    ASSERT_GE(last - first, s.span_min_ticks);
    for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) {
      const bool open = arrivals[edge].earliest != arrivals[edge].latest;
      const int early = open ? command.at[edge] + kTurnOff : p.pulses.at[edge];
      const int late = open ? command.at[edge] + kTurnOn : p.pulses.at[edge];
      const bool before = late + s.settle_ticks <= first, after = early >= last + s.burst_ticks;
      ASSERT_TRUE(before || after) << "edge " << edge << ", window " << k;
    }
  }
}

TEST(Guard, WhateverTheSignTheSamplesAreInsideTheWindow) {
  int guarded_edges = 0;
  const svpwm_pulses_t wanted = alternating();
  for (double a = -3.0; a <= 3.0; a += 0.05) {
    for (double b = -3.0; b <= 3.0; b += 0.25) {
      const auto [command, arrivals] = sent_at(wanted, phases(a, b));
      for (unsigned k = 0; k < SVPWM_EDGES; ++k) guarded_edges += arrivals[k].earliest != arrivals[k].latest;
      const svpwm_pattern_t p = guarded(sampling(), wanted, arrivals);
      ASSERT_GE(p.window_count, 2);
      ASSERT_NO_FATAL_FAILURE(expect_clear(p, command, arrivals)) << a << ", " << b << " A";
    }
  }
  EXPECT_GT(guarded_edges, 500);
}

// The drive's one walk along the edges gives what compensation and finder give one after the other.
void expect_sent(const svpwm_pulses_t& wanted, ab_t current, const Sent& pieces, const svpwm_pattern_t& found) {
  const dead_time_config_t c = dead_time();
  const sampling_config_t s = sampling();
  const svpwm_carried_t carried = {dead_time_shares_q12(&c, current), 17179869L, 300L * 65536L};
  svpwm_pattern_t p = {};
  p.pulses = wanted;
  const svpwm_pulses_t command = send(c, s, carried, &p);
  for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) ASSERT_EQ(command.at[edge], pieces.command.at[edge]) << edge;
  ASSERT_EQ(p.window_count, found.window_count);
  for (int k = 0; k < p.window_count; ++k) {
    ASSERT_EQ(p.windows[k].start, found.windows[k].start) << k;
    ASSERT_EQ(p.windows[k].end, found.windows[k].end) << k;
    ASSERT_EQ(p.windows[k].state, found.windows[k].state) << k;
  }
}

// Edges of one instant, each of which may be the first or the last; and any others.
TEST(Guard, SamplesKeepOffEdgesThatMayChangePlaces) {
  Random random(140);
  int open = 0;
  for (int n = 0; n < 3000; ++n) {
    svpwm_pulses_t wanted;
    for (int leg = 0; leg < SVPWM_LEGS; ++leg) {
      wanted.at[leg] = static_cast<std::int16_t>(260 + 100 * random.below(60));
      wanted.at[SVPWM_LEGS + leg] = static_cast<std::int16_t>(wanted.at[leg] + 300 + 100 * random.below(30));
    }
    wanted = ordered(wanted);
    const ab_t current = phases(random.between(-2.0, 2.0), 0.3);
    const Sent pieces = sent_at(wanted, current);
    const svpwm_pattern_t p = guarded(sampling(), wanted, pieces.arrivals);
    open += p.window_count > 0;
    ASSERT_NO_FATAL_FAILURE(expect_clear(p, pieces.command, pieces.arrivals)) << n;
    ASSERT_NO_FATAL_FAILURE(expect_sent(wanted, current, pieces, p)) << n;
  }
  EXPECT_GT(open, 2000);
}

TEST(Guard, AWindowThatBecomesTooShortGoes) {
  const svpwm_pulses_t wanted = alternating();
  sampling_config_t s = sampling();
  s.span_min_ticks = 2880;  // certain, 3020 and 2890 ticks lie between the bursts
  EXPECT_EQ(guarded(s, wanted, certain(wanted)).window_count, 2);
  const Arrivals arrivals = sent_at(wanted, phases(0.0, 0.0)).arrivals;
  EXPECT_LT(guarded(s, wanted, arrivals).window_count, 2);
}

}  // namespace
