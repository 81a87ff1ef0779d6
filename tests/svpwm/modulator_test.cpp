// The modulator as a whole: means over sequences of periods, changes of layout, limits, windows of each layout.

#include "tests/svpwm/period.hpp"

namespace {

using namespace stillspin::test;

constexpr double kLink = 300.0;
constexpr std::array kLayouts = {EXCITATION_CENTRED, EXCITATION_EXTENDED, EXCITATION_ALTERNATING, EXCITATION_LONG_ZERO,
                                 EXCITATION_CHEAPEST};

TEST(Modulator, EveryLayoutGivesTheCommandedMean) {
  Random random(100);
  const modulator_config_t c = default_modulator();
  modulator_t s;
  modulator_reset(&s);
  int limited = 0;
  for (int n = 0; n < 30000; ++n) {
    const excitation_t excitation = kLayouts[static_cast<std::size_t>(n) % kLayouts.size()];
    const double link = random.between(150.0, 420.0);
    const Vector v = any_voltage(random, link, (n % 2 == 0) ? 0.2 : 1.3);
    svpwm_pulses_t pulses;
    const modulator_result_t r = modulator_step(&s, &c, excitation, raw_ab(v, 16), raw(link, 16), &pulses);
    ASSERT_NO_FATAL_FAILURE(expect_valid(pulses));
    const Vector realised = real(r.realised_q16, 16);
    ASSERT_NO_FATAL_FAILURE(expect_mean(pulses, realised, link)) << n;
    ASSERT_NEAR((realised - v).length(), 0.0, r.limited ? 1e9 : 2e-5);
    ASSERT_LT(std::fabs(realised.x * v.y - realised.y * v.x), 1e-4 * (1.0 + v.length()));  // its direction is kept
    limited += r.limited ? 1 : 0;
  }
  EXPECT_GT(limited, 500);
}

TEST(Modulator, AlternatingLeavesAtItsLimitAndReturnsWithAFifthToSpare) {
  const modulator_config_t c = default_modulator();
  modulator_t s;
  modulator_reset(&s);
  svpwm_pulses_t pulses;
  // along phase a the spread is 1.5 v / Vdc: 2940 ticks (0.7 * 4200) are 58.8 V, four fifths of it 47 V
  const auto step = [&](double volts) {
    modulator_step(&s, &c, EXCITATION_ALTERNATING, raw_ab({volts, 0.0}, 16), raw(kLink, 16), &pulses);
    return s.is_alternating;
  };
  EXPECT_TRUE(step(58.0));
  EXPECT_FALSE(step(59.5));
  EXPECT_FALSE(step(47.6));
  EXPECT_TRUE(step(46.5));
  EXPECT_TRUE(step(58.0));
}

TEST(Modulator, AlternatingHasTwoOppositeWindowsOfUsefulLength) {
  Random random(101);
  const modulator_config_t c = default_modulator();
  modulator_t s;
  modulator_reset(&s);
  for (int n = 0; n < 2000; ++n) {
    svpwm_pulses_t pulses;
    const Vector v = random.direction(random.between(0.0, 30.0));
    modulator_step(&s, &c, EXCITATION_ALTERNATING, raw_ab(v, 16), raw(kLink, 16), &pulses);
    ASSERT_TRUE(s.is_alternating);
    const svpwm_pattern_t p = pattern_of(pulses, c.sampling);
    ASSERT_GE(p.window_count, 2);
    std::uint16_t seen = 0;
    for (int k = 0; k < p.window_count; ++k) {
      const svpwm_window_t& w = p.windows[k];
      if (svpwm_is_zero_vector(w.state)) continue;
      const int lasts = w.end + c.sampling.burst_ticks - w.start + c.sampling.settle_ticks;
      if (lasts < c.pulse_ticks / 2) continue;
      seen = static_cast<std::uint16_t>(seen ^ w.state);
    }
    ASSERT_EQ(seen, 7) << n;  // a vector and its complement
  }
}

TEST(Modulator, ExtendedHasTwoDifferentActiveWindowsWhilePossible) {
  Random random(102);
  const modulator_config_t c = default_modulator();
  modulator_t s;
  modulator_reset(&s);
  for (int n = 0; n < 3000; ++n) {
    svpwm_pulses_t pulses;
    const Vector v = random.direction(random.between(0.0, 110.0));
    modulator_step(&s, &c, EXCITATION_EXTENDED, raw_ab(v, 16), raw(kLink, 16), &pulses);
    const svpwm_pattern_t p = pattern_of(pulses, c.sampling);
    std::vector<std::uint16_t> active;
    for (int k = 0; k < p.window_count; ++k) {
      if (!svpwm_is_zero_vector(p.windows[k].state)) active.push_back(p.windows[k].state);
    }
    ASSERT_GE(active.size(), 2u) << v.x << ", " << v.y;
    ASSERT_NE(active[0], active[1]);
  }
}

TEST(Modulator, CentredHasAZeroWindowAtLowVoltage) {
  const modulator_config_t c = default_modulator();
  modulator_t s;
  modulator_reset(&s);
  svpwm_pulses_t pulses;
  modulator_step(&s, &c, EXCITATION_CENTRED, raw_ab({10.0, 4.0}, 16), raw(kLink, 16), &pulses);
  const svpwm_pattern_t p = pattern_of(pulses, c.sampling);
  bool zero = false;
  for (int k = 0; k < p.window_count; ++k) zero = zero || svpwm_is_zero_vector(p.windows[k].state);
  EXPECT_TRUE(zero);
}

// Nothing of what went before is left: neither whose turn it is in the alternating layout nor the DC link.
TEST(Modulator, AfterAResetItBeginsLikeANewOne) {
  const modulator_config_t c = default_modulator();
  const ab_t voltage = raw_ab({40.0, 25.0}, 16);
  modulator_t fresh = {}, used = {};
  modulator_reset(&fresh);
  modulator_reset(&used);
  for (int periods = 1; periods <= 6; ++periods) {
    svpwm_pulses_t p;
    for (int n = 0; n < periods; ++n) {
      (void)modulator_step(&used, &c, EXCITATION_ALTERNATING, raw_ab({-30.0, 80.0}, 16), raw(350.0 - n, 16), &p);
    }
    modulator_reset(&used);
    modulator_t a = fresh, b = used;
    for (int n = 0; n < 6; ++n) {
      svpwm_pulses_t of_a, of_b;
      (void)modulator_step(&a, &c, EXCITATION_ALTERNATING, voltage, raw(300.0, 16), &of_a);
      (void)modulator_step(&b, &c, EXCITATION_ALTERNATING, voltage, raw(300.0, 16), &of_b);
      for (int edge = 0; edge < 2 * SVPWM_LEGS; ++edge) ASSERT_EQ(of_a.at[edge], of_b.at[edge]) << periods << " " << n;
      ASSERT_EQ(a.ticks_per_volt_q20, b.ticks_per_volt_q20);
    }
  }
}

TEST(Modulator, AResetStartsWithTheFirstLegAndPair) {
  modulator_t s;
  s.alternating.leg = 2;
  s.alternating.pair_first = true;
  s.is_alternating = false;
  s.ticks_per_volt_q20 = 77;
  modulator_reset(&s);
  EXPECT_EQ(s.alternating.leg, 0);
  EXPECT_FALSE(s.alternating.pair_first);
  EXPECT_TRUE(s.is_alternating);
  EXPECT_EQ(s.ticks_per_volt_q20, 0);
}

}  // namespace
