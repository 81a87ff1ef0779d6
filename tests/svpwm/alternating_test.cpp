// The layout of two long opposite vectors: rotation over six periods, lengths, means.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/alternating.h"
}

namespace {

using namespace stillspin::test;

constexpr double kLink = 300.0;

TEST(Alternating, SixPeriodsGoRoundThePhasesAndTurnTheOrder) {
  const svpwm_on_time_t t = on_time(raw_ab({6.0, -3.0}, 16), raw(kLink, 16));
  alternating_state_t s = {0, false};
  for (int round = 0; round < 2; ++round) {
    for (int n = 0; n < 6; ++n) {
      svpwm_pulses_t p;
      svpwm_alternating(&s, &t, 4200, &p);
      const auto single = static_cast<std::uint16_t>(1u << (n % 3));
      const auto pair = static_cast<std::uint16_t>(7u ^ single);
      std::vector<std::uint16_t> active;
      for (const Interval& w : intervals(p)) {
        if (w.end - w.begin > 2000) active.push_back(w.state);
      }
      const std::vector<std::uint16_t> expected =
          (n < 3) ? std::vector<std::uint16_t>{single, pair} : std::vector<std::uint16_t>{pair, single};
      EXPECT_EQ(active, expected) << n;
    }
  }
}

TEST(Alternating, MeanVoltageAndPulseLengths) {
  Random random(80);
  for (int n = 0; n < 3000; ++n) {
    const double link = random.between(40.0, 420.0);
    const auto pulse = static_cast<std::int16_t>(random.between(1500.0, 4700.0));
    const Vector v = any_voltage(random, link, 0.4);
    const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
    if (!svpwm_alternating_fits(&t, pulse)) continue;
    alternating_state_t s = {static_cast<std::uint16_t>(random.below(3)), random.below(2) != 0};
    const int x = s.leg;
    const bool pair_first = s.pair_first;
    svpwm_pulses_t p;
    svpwm_alternating(&s, &t, pulse, &p);
    ASSERT_NO_FATAL_FAILURE(expect_valid(p));
    ASSERT_NO_FATAL_FAILURE(expect_mean(p, v, link));
    const int y = (x + 1) % 3, z = (x + 2) % 3;
    ASSERT_NEAR(on_time(p, x) + std::max(on_time(p, y), on_time(p, z)), 2 * pulse, 1);
    // the two pulses do not overlap. The single leg is shorter than the mean by half the spread at most, the part that
    // the pair has in common by all of it; a tick for the halves.
    const auto single = static_cast<std::uint16_t>(1u << x);
    const auto [low, high] = std::minmax({t.leg[0], t.leg[1], t.leg[2]});
    const int spread = high - low;
    ASSERT_LT(spread, 0.7 * pulse);
    ASSERT_GE(lasts(p, single), pulse - spread / 2 - 1);
    ASSERT_GE(lasts(p, static_cast<std::uint16_t>(7u ^ single)), pulse - spread - 1);
    ASSERT_EQ(lasts(p, 7), 0);
    // the room is used to both ends
    ASSERT_EQ(rise(p, pair_first ? y : x), SVPWM_FIRST_TICK);
    ASSERT_EQ(fall(p, pair_first ? x : y), SVPWM_LAST_TICK);
  }
}

TEST(Alternating, FitsUpToSevenTenthsOfAPulseOfSpread) {
  svpwm_on_time_t t = {};
  t.leg[0] = 1840;
  t.leg[2] = -1099;
  t.mid = 1;
  t.lo = 2;
  EXPECT_TRUE(svpwm_alternating_fits(&t, 4200));
  t.leg[2] = -1100;
  EXPECT_FALSE(svpwm_alternating_fits(&t, 4200));
}

}  // namespace
