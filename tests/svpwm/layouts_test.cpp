// The centred, the extended and the long-zero layout: means, valid pulses, the order of vectors, the promised lengths.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/extended.h"
#include "svpwm/pattern.h"
}

namespace {

using namespace stillspin::test;

constexpr double kLink = 300.0;

svpwm_pulses_t extended(const extended_config_t& c, Vector v, double link = kLink) {
  const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
  svpwm_pulses_t p;
  svpwm_extended(&c, &t, &p);
  return p;
}

svpwm_pulses_t centred(Vector v, double link = kLink) {
  const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
  svpwm_pulses_t p;
  svpwm_centred(&t, &p);
  return p;
}

TEST(Centred, MeanVoltageAndPulses) {
  Random random(70);
  for (int n = 0; n < 3000; ++n) {
    const double link = random.between(40.0, 420.0);
    const Vector v = any_voltage(random, link, 0.94);
    const svpwm_pulses_t p = centred(v, link);
    ASSERT_NO_FATAL_FAILURE(expect_valid(p));
    ASSERT_NO_FATAL_FAILURE(expect_mean(p, v, link)) << v.x << ", " << v.y;
  }
}

TEST(Centred, PulsesShareTheirMiddleAndZeroVectorsAreEqual) {
  Random random(71);
  for (int n = 0; n < 500; ++n) {
    const svpwm_pulses_t p = centred(any_voltage(random, kLink, 0.94));
    for (int leg = 1; leg < 3; ++leg) ASSERT_NEAR(rise(p, leg) + fall(p, leg), rise(p, 0) + fall(p, 0), 1);
    // 000 is split between the two ends of the period, which are not equally long
    const int zeros = lasts(p, 0) - (SVPWM_PERIOD_TICKS - SVPWM_ROOM_TICKS);
    // near the limit the shortest pulse moves the share
    if (lasts(p, 7) > SVPWM_PULSE_MIN_TICKS + 2) {
      ASSERT_NEAR(zeros, lasts(p, 7), 2);
    }
  }
}

TEST(Centred, ShortestPulseSurvivesAtTheLimit) {
  for (int degree = 0; degree < 360; ++degree) {
    const double angle = degree * kDegree;
    for (const double length : {longest_vector(angle, kLink) - 1e-3, 400.0}) {
      expect_valid(centred(Vector{length, 0.0}.turned(angle)));
    }
  }
}

TEST(LongZero, MeanVoltagePulsesAndOneZeroVectorInOnePiece) {
  Random random(78);
  for (int n = 0; n < 3000; ++n) {
    const double link = random.between(40.0, 420.0);
    const Vector v = any_voltage(random, link, 0.94);
    const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
    svpwm_pulses_t p;
    svpwm_long_zero(&t, &p);
    ASSERT_NO_FATAL_FAILURE(expect_valid(p));
    ASSERT_NO_FATAL_FAILURE(expect_mean(p, v, link)) << v.x << ", " << v.y;
    // 111 is no longer than the shortest pulse: all the rest of the zero vector is 000, behind the last edge
    ASSERT_EQ(lasts(p, 7), SVPWM_PULSE_MIN_TICKS);
    for (int leg = 0; leg < 3; ++leg) ASSERT_EQ(rise(p, leg), SVPWM_FIRST_TICK);
  }
}

TEST(Extended, MeanVoltageAndPulses) {
  Random random(72);
  for (int n = 0; n < 20000; ++n) {
    const double link = random.between(40.0, 420.0);
    const Vector v = any_voltage(random, link, 1.0);
    const auto least = static_cast<std::int16_t>(random.between(500.0, 3000.0));
    const auto most = static_cast<std::int16_t>(random.between(least, 4000.0));
    const extended_config_t c = {least, most, static_cast<std::int16_t>(random.between(0.0, 5000.0))};
    const svpwm_pulses_t p = extended(c, v, link);
    const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
    ASSERT_NO_FATAL_FAILURE(expect_valid(p)) << v.x << ", " << v.y;
    ASSERT_NO_FATAL_FAILURE(expect_mean(p, real(t.realised_q16, 16), link)) << v.x << ", " << v.y;
  }
}

/// What the layout should be, found the slow way: every window length tried, the pulses laid out, the result looked at.
struct Best {
  int window = 0;  // longest window with which everything fits
  bool with_zero = false;
};

// With hi rising first, mid after `first`, lo after `second`: does it fit, and are both vectors that long?
bool possible(const std::array<int, 3>& sorted, int window, int zero_ticks) {
  const int t1 = sorted[0] - sorted[1];
  const int t2 = sorted[1] - sorted[2];
  const int first = std::max(t1, window);
  const int second = std::max(t2, window);
  for (int low_on = SVPWM_PULSE_MIN_TICKS; low_on + first + second <= SVPWM_ROOM_TICKS - zero_ticks; ++low_on) {
    // pulses: hi [0, t1 + t2 + low), mid [first, first + t2 + low), lo [first + second, ... + low)
    if (t1 + t2 + low_on >= first + second && t2 + low_on >= second) return true;
  }
  return false;
}

Best best(const extended_config_t& c, const svpwm_on_time_t& t) {
  std::array<int, 3> sorted = {t.leg[0], t.leg[1], t.leg[2]};
  std::sort(sorted.rbegin(), sorted.rend());
  for (const int zero : {static_cast<int>(c.zero_ticks), 0}) {
    for (int window = c.window_max_ticks; window > c.window_min_ticks; window -= 8) {
      if (possible(sorted, window, zero)) return {window, zero == c.zero_ticks};
    }
    if (possible(sorted, c.window_min_ticks, zero)) return {c.window_min_ticks, zero == c.zero_ticks};
  }
  return {};
}

TEST(Extended, BothVectorsAreAsLongAsFits) {
  Random random(73);
  const extended_config_t c = {1500, 3600, 1500};
  int with_zero = 0, without_zero = 0, none = 0;
  for (int n = 0; n < 1500; ++n) {
    const Vector v = any_voltage(random, kLink, 1.0);
    const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(kLink, 16));
    const svpwm_pulses_t p = extended(c, v);
    const std::vector<Interval> list = intervals(p);
    const Best wanted = best(c, t);
    const std::array<int, 2> own = {t.leg[t.hi] - t.leg[t.mid], t.leg[t.mid] - t.leg[t.lo]};
    if (wanted.window == 0) {
      none++;
      continue;
    }
    (wanted.with_zero ? with_zero : without_zero)++;
    // 000 first, then two neighbouring active vectors: one leg, two legs
    ASSERT_GE(list.size(), 4u);
    ASSERT_EQ(list[0].state, 0);
    ASSERT_EQ(__builtin_popcount(list[1].state), 1);
    ASSERT_EQ(__builtin_popcount(list[2].state), 2);
    ASSERT_EQ(list[1].state & list[2].state, list[1].state);
    ASSERT_GE(list[1].end - list[1].begin, wanted.window) << v.x << ", " << v.y;
    ASSERT_GE(list[2].end - list[2].begin, wanted.window) << v.x << ", " << v.y;
    // and not longer than fits: the search here steps by 8
    const int shorter = std::min(list[1].end - list[1].begin, list[2].end - list[2].begin);
    ASSERT_LE(shorter, std::max(wanted.window + 7, *std::min_element(own.begin(), own.end()))) << v.x << ", " << v.y;
    if (wanted.with_zero) {
      ASSERT_GE(SVPWM_LAST_TICK - std::max({fall(p, 0), fall(p, 1), fall(p, 2)}), c.zero_ticks);
    }
  }
  // every case has occurred
  EXPECT_GT(with_zero, 200);
  EXPECT_GT(without_zero, 100);
  EXPECT_GT(none, 20);
}

TEST(Extended, TwentyMicrosecondsUpTo110VoltsInEveryDirection) {
  const extended_config_t c = {2000, 3000, 0};
  for (int degree = 0; degree < 360; ++degree) {
    for (const double volts : {0.0, 5.0, 60.0, 110.0}) {
      // at a sector's edge 2000 + 2000 + 5000 v / 100 V of 9700 ticks are needed: 114 V
      const svpwm_pulses_t p = extended(c, Vector{volts, 0.0}.turned(degree * kDegree));
      const std::vector<Interval> list = intervals(p);
      ASSERT_GE(list[1].end - list[1].begin, 2000) << degree << ", " << volts;
      ASSERT_GE(list[2].end - list[2].begin, 2000) << degree << ", " << volts;
    }
  }
}

svpwm_pulses_t cheapest(const extended_config_t& c, const svpwm_on_time_t& t) {
  svpwm_pulses_t p;
  svpwm_cheapest_pair(&c, &t, &p);
  return p;
}

TEST(CheapestPair, MeanVoltageAndPulses) {
  Random random(75);
  for (int n = 0; n < 20000; ++n) {
    const double link = random.between(40.0, 420.0);
    const auto least = static_cast<std::int16_t>(random.between(500.0, 3000.0));
    const auto most = static_cast<std::int16_t>(random.between(least, 4000.0));
    const svpwm_on_time_t t = on_time(raw_ab(any_voltage(random, link, 1.0), 16), raw(link, 16));
    const svpwm_pulses_t p = cheapest({least, most, 0}, t);
    ASSERT_NO_FATAL_FAILURE(expect_valid(p)) << n;
    ASSERT_NO_FATAL_FAILURE(expect_mean(p, real(t.realised_q16, 16), link)) << n;
  }
}

// 000 and the longer of the active vectors are both long, and no pair needs less added to it.
TEST(CheapestPair, IsLongAndNeedsTheLeastExtension) {
  Random random(76);
  int zero_pairs = 0, active_pairs = 0, untouched = 0;
  for (int n = 0; n < 4000; ++n) {
    const auto most = static_cast<std::int16_t>(n % 2 == 0 ? 3000 : 4000);
    const extended_config_t c = {1800, most, 0};
    const svpwm_on_time_t t = on_time(raw_ab(any_voltage(random, kLink, 1.0), 16), raw(kLink, 16));
    const int t1 = t.leg[t.hi] - t.leg[t.mid], t2 = t.leg[t.mid] - t.leg[t.lo];
    const svpwm_pulses_t p = cheapest(c, t);
    const std::vector<Interval> list = intervals(p);
    const int added = (on_time(p, t.lo) - SVPWM_PULSE_MIN_TICKS);
    const int zero = SVPWM_PERIOD_TICKS - SVPWM_FIRST_TICK - SVPWM_PULSE_MIN_TICKS - t1 - t2;  // with nothing extended
    if (zero < c.window_min_ticks) {
      active_pairs++;
      svpwm_pulses_t both;
      svpwm_extended(&c, &t, &both);
      for (unsigned edge = 0; edge < SVPWM_EDGES; ++edge) ASSERT_EQ(p.at[edge], both.at[edge]);
      continue;
    }
    zero_pairs++;
    ASSERT_EQ(list.back().state, 0);
    // the extension leaves 000 as long as it may be of use
    ASSERT_GE(list.back().end - list.back().begin, std::min<int>(zero, c.window_max_ticks)) << t1 << ", " << t2;
    const auto active = static_cast<std::uint16_t>((t1 >= t2) ? 1u << t.hi : 7u ^ (1u << t.lo));
    const int longer = std::max(t1, t2);
    ASSERT_GE(lasts(p, active), std::min<int>(longer, c.window_max_ticks));
    ASSERT_GE(lasts(p, active), (t1 + t2 < 5500) ? c.window_min_ticks : longer) << t1 << ", " << t2;
    ASSERT_LE(added, std::max(0, c.window_max_ticks - longer));
    untouched += added <= 0;
  }
  EXPECT_GT(zero_pairs, 2000);
  EXPECT_GT(active_pairs, 200);
  EXPECT_GT(untouched, 500);
}

// What is not extended is not touched: along a leg's own direction the second vector has no time, and gets none.
TEST(CheapestPair, AVectorWithoutTimeStaysWithoutIt) {
  const extended_config_t c = {1800, 3000, 0};
  for (int sixth = 0; sixth < 6; ++sixth) {
    const svpwm_on_time_t t = on_time(raw_ab(Vector{20.0, 0.0}.turned(sixth * 60.0 * kDegree), 16), raw(kLink, 16));
    const int t1 = t.leg[t.hi] - t.leg[t.mid], t2 = t.leg[t.mid] - t.leg[t.lo];
    ASSERT_EQ(std::min(t1, t2), 0) << sixth;
    const svpwm_pulses_t p = cheapest(c, t);
    const std::uint16_t one = t1 > 0 ? t.mid : t.hi, other = t1 > 0 ? t.lo : t.mid;
    EXPECT_EQ(rise(p, one), rise(p, other)) << sixth;
    EXPECT_EQ(lasts(p, static_cast<std::uint16_t>(t1 > 0 ? 1u << t.hi : 7u ^ (1u << t.lo))), 3000) << sixth;
  }
}

// Fig. 4: extending 100 is compensated by 011, extending 110 by 001, each by exactly as much.
TEST(Extended, ComplementsGiveBackWhatTheExtensionTook) {
  const extended_config_t c = {2000, 2000, 0};
  Random random(74);
  for (int n = 0; n < 300; ++n) {
    // first sector, both vectors under 20 us: T1 = 10000 v / Vdc (3/2 cos - sqrt3/2 sin), T2 = sqrt 3 sin
    const Vector v = Vector{random.between(4.0, 30.0), 0.0}.turned(random.between(4.0, 56.0) * kDegree);
    const svpwm_pulses_t p = extended(c, v);
    const double t1 = (1.5 * v.x - std::sqrt(3.0) / 2.0 * v.y) / kLink * 10000.0;
    const double t2 = std::sqrt(3.0) * v.y / kLink * 10000.0;
    ASSERT_LT(std::max(t1, t2), 2000.0);
    constexpr std::uint16_t kA = 1, kAB = 3, kBC = 6, kC = 4;
    ASSERT_EQ(lasts(p, kA), 2000);
    ASSERT_EQ(lasts(p, kAB), 2000);
    ASSERT_NEAR(lasts(p, kA) - lasts(p, kBC), t1, 1.01);
    ASSERT_NEAR(lasts(p, kAB) - lasts(p, kC), t2, 1.01);
  }
}

// Bench A13, the paper's Fig. 13b: 110 and 010 are short, extended, and compensated by 001 and 101.
TEST(Extended, PatternOfThePapersFigure13) {
  const extended_config_t c = {2000, 2000, 0};
  const Vector v = Vector{25.0, 0.0}.turned(90.0 * kDegree);  // between 110 (60 degrees) and 010 (120 degrees)
  const svpwm_pulses_t p = extended(c, v);
  std::vector<std::uint16_t> order;
  for (const Interval& w : intervals(p)) order.push_back(w.state);
  constexpr std::uint16_t kB = 2, kAB = 3, kAC = 5, kC = 4;
  ASSERT_GE(order.size(), 6u);
  EXPECT_EQ(order[1], kB);
  EXPECT_EQ(order[2], kAB);
  EXPECT_EQ(order[order.size() - 3], kAC);
  EXPECT_EQ(order[order.size() - 2], kC);
  EXPECT_EQ(order.back(), 0);
  EXPECT_EQ(lasts(p, kB), 2000);
  EXPECT_EQ(lasts(p, kAB), 2000);
  const double short_ticks = 25.0 * std::sqrt(3.0) / 2.0 / kLink * 10000.0;  // both by symmetry: 722, under 20 us
  EXPECT_NEAR(lasts(p, kB) - lasts(p, kAC), short_ticks, 1.01);
  EXPECT_NEAR(lasts(p, kAB) - lasts(p, kC), short_ticks, 1.01);
  expect_mean(p, v, kLink);
}

}  // namespace
