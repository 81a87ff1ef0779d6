// One PWM period looked at tick by tick, without the modulator's own arithmetic.

#ifndef STILLSPIN_TESTS_SVPWM_PERIOD_HPP
#define STILLSPIN_TESTS_SVPWM_PERIOD_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/control/quantities.hpp"

extern "C" {
#include "svpwm/edges.h"
#include "svpwm/modulator.h"
}

namespace stillspin::test {

inline int rise(const svpwm_pulses_t& p, int leg) { return p.at[leg]; }
inline int fall(const svpwm_pulses_t& p, int leg) { return p.at[SVPWM_LEGS + leg]; }

/// The same pulses with the order of their edges, which a layout would know.
inline svpwm_pulses_t ordered(svpwm_pulses_t p) {
  std::array<std::pair<int, unsigned>, SVPWM_EDGES> edges;  // rises before the falls of the same tick
  for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) edges[edge] = {p.at[edge], edge};
  std::sort(edges.begin(), edges.end());
  for (unsigned k = 0; k < SVPWM_EDGES; ++k) p.order[k] = static_cast<std::uint16_t>(edges[k].second);
  return p;
}

/// A walk along the order visits all edges, none before another that comes later; a leg rises before it falls.
inline void expect_ordered(const svpwm_pulses_t& p) {
  int before = 0;
  unsigned seen = 0;
  for (unsigned k = 0; k < SVPWM_EDGES; ++k) {
    const unsigned edge = p.order[k];
    ASSERT_LT(edge, SVPWM_EDGES);
    if (edge >= SVPWM_LEGS) {
      ASSERT_NE(seen >> (edge - SVPWM_LEGS) & 1u, 0u);
    }
    seen |= 1u << edge;
    ASSERT_GE(p.at[edge], before) << k;
    before = p.at[edge];
  }
  ASSERT_EQ(seen, 63u);
}

/// On-times at a DC-link voltage that nothing is known of.
inline svpwm_on_time_t on_time(ab_t voltage_q16, std::int32_t link_q16) {
  return svpwm_on_time(voltage_q16, svpwm_ticks_per_volt_q20(link_q16, 0));
}

/// When edges come at the motor, by their numbers: both are the instant wanted where that is certain.
struct Arrival {
  std::int32_t earliest, latest;
};
using Arrivals = std::array<Arrival, SVPWM_EDGES>;

/// Every edge comes when it is wanted.
inline Arrivals certain(const svpwm_pulses_t& p) {
  Arrivals a;
  for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) a[edge] = {p.at[edge], p.at[edge]};
  return a;
}

/// The finder's walk with edges that come then.
inline void find_windows(const sampling_config_t& c, const Arrivals& arrivals, svpwm_pattern_t* p) {
  svpwm_finder_t finder = svpwm_finder(&c, p);
  for (const std::uint16_t edge : p->pulses.order) {
    const auto [earliest, latest] = arrivals[edge];
    svpwm_finder_beware(&finder, &c, p, earliest);
    svpwm_finder_pass(&finder, &c, p, edge, earliest, latest);
  }
  svpwm_finder_finish(&finder, &c, p);
}

/// The compensation of all edges.
struct Sent {
  svpwm_pulses_t command;
  Arrivals arrivals;
};

inline Sent sent(const dead_time_config_t& c, const svpwm_pulses_t& wanted, const svpwm_carried_t& carried) {
  svpwm_ripple_legs_t legs;
  svpwm_ripple_walk_t walk = svpwm_ripple_walk(&wanted, carried.shares_q12, carried.inverse_inductance_q30,
                                               carried.link_q16, c.per_band_q24, &legs);
  Sent s = {};
  for (const std::uint16_t edge : wanted.order) {
    const std::int32_t tick = wanted.at[edge];
    const std::int32_t blocking = svpwm_ripple_blocking(&walk, &legs, edge, tick);
    const std::int32_t at = tick - dead_time_delay_ticks(&c, blocking);
    s.command.at[edge] = static_cast<std::int16_t>(at);
    s.arrivals[edge] = {tick, tick};
    if (dead_time_is_in_doubt(&c, blocking)) s.arrivals[edge] = {at + c.turn_off_ticks, at + c.turn_on_ticks};
  }
  return s;
}

/// What the drive's one walk along the edges makes of a pattern: commands and windows.
inline svpwm_pulses_t send(const dead_time_config_t& c, const sampling_config_t& sampling,
                           const svpwm_carried_t& carried, svpwm_pattern_t* pattern) {
  std::uint16_t edges[SVPWM_EDGES];
  svpwm_compensate_edges(&c, &sampling, &carried, pattern, edges);
  svpwm_pulses_t command = pattern->pulses;
  for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) command.at[edge] = static_cast<std::int16_t>(edges[edge]);
  return command;
}

/// A pattern of pulses whose edges are certain.
inline svpwm_pattern_t pattern_of(const svpwm_pulses_t& pulses, const sampling_config_t& c) {
  svpwm_pattern_t p = {};
  p.pulses = pulses;
  find_windows(c, certain(pulses), &p);
  return p;
}

/// Ticks of a period in which leg k is high, from -rise/fall- as the hardware does it: set at rise, clear at fall.
inline std::array<std::uint16_t, SVPWM_PERIOD_TICKS> states(const svpwm_pulses_t& p) {
  std::array<std::uint16_t, SVPWM_PERIOD_TICKS> s{};
  for (int leg = 0; leg < SVPWM_LEGS; ++leg) {
    for (int tick = rise(p, leg); tick < fall(p, leg); ++tick) {
      if (tick >= 0 && tick < SVPWM_PERIOD_TICKS) s[static_cast<std::size_t>(tick)] |= 1u << leg;
    }
  }
  return s;
}

struct Interval {
  int begin, end;
  std::uint16_t state;
};

/// The intervals of constant state, in the order of time.
inline std::vector<Interval> intervals(const svpwm_pulses_t& p) {
  const auto s = states(p);
  std::vector<Interval> list = {{0, 0, s[0]}};
  for (int tick = 0; tick < SVPWM_PERIOD_TICKS; ++tick) {
    if (s[static_cast<std::size_t>(tick)] != list.back().state) {
      list.push_back({tick, tick, s[static_cast<std::size_t>(tick)]});
    }
    list.back().end = tick + 1;
  }
  return list;
}

/// How long a state lasts in all, ticks.
inline int lasts(const svpwm_pulses_t& p, std::uint16_t state) {
  int sum = 0;
  for (const Interval& w : intervals(p)) sum += (w.state == state) ? w.end - w.begin : 0;
  return sum;
}

/// Legs' voltages (V) that give a vector, up to a common part.
inline std::array<double, 3> legs_of(Vector v) {
  const double half = 0.5 * v.x;
  const double side = std::sqrt(3.0) / 2.0 * v.y;
  return {v.x, side - half, -side - half};
}

inline int on_time(const svpwm_pulses_t& p, int leg) { return svpwm_on_ticks(&p, static_cast<std::uint16_t>(leg)); }

/// Each pulse inside the room and long enough for the dead band, as is the gap to the next period's; edges in order.
inline void expect_valid(const svpwm_pulses_t& p) {
  for (int leg = 0; leg < SVPWM_LEGS; ++leg) {
    ASSERT_GE(rise(p, leg), SVPWM_FIRST_TICK) << leg;
    ASSERT_LE(fall(p, leg), SVPWM_LAST_TICK) << leg;
    ASSERT_GE(on_time(p, leg), SVPWM_PULSE_MIN_TICKS) << leg;
    ASSERT_GE(SVPWM_PERIOD_TICKS - on_time(p, leg), SVPWM_PULSE_MIN_TICKS) << leg;
  }
  ASSERT_NO_FATAL_FAILURE(expect_ordered(p));
}

/// Line-to-line on-times against the voltage, within one tick.
inline void expect_mean(const svpwm_pulses_t& p, Vector voltage, double link) {
  const auto v = legs_of(voltage);
  for (int leg = 0; leg < 3; ++leg) {
    const int next = (leg + 1) % 3;
    const double ticks = (v[static_cast<std::size_t>(leg)] - v[static_cast<std::size_t>(next)]) / link * 10000.0;
    // each on-time is rounded to half a tick; 0.01 for the rounding of volts and link
    ASSERT_NEAR(on_time(p, leg) - on_time(p, next), ticks, 1.01) << leg;
  }
}

/// The firmware's defaults on motor A.
inline modulator_config_t default_modulator() {
  modulator_config_t c;
  c.extended = {1800, 3000, 0};
  c.sampling = {1050, 140, 300, 9640, 3};
  c.pulse_ticks = 4200;
  return c;
}

/// A voltage of any direction, up to a share of the hexagon's inner circle Vdc / sqrt 3.
inline Vector any_voltage(Random& random, double link, double share) {
  return random.direction(random.unit() * share * link / std::sqrt(3.0));
}

/// Largest voltage in a direction whose on-times differ by no more than the room lets them.
inline double longest_vector(double angle, double link) {
  const auto v = legs_of({std::cos(angle), std::sin(angle)});
  const double spread = std::max({v[0], v[1], v[2]}) - std::min({v[0], v[1], v[2]});
  return SVPWM_SPREAD_MAX_TICKS / 10000.0 * link / spread;
}

}  // namespace stillspin::test

#endif
