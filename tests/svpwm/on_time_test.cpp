// On-times of the legs against the voltage vector, in double precision.

#include "tests/svpwm/period.hpp"

extern "C" {
#include "svpwm/on_time.h"
}

namespace {

using namespace stillspin::test;

TEST(OnTime, DifferencesAreTheLineToLineVoltages) {
  Random random(60);
  for (int n = 0; n < 50000; ++n) {
    const double link = random.between(20.0, 900.0);
    const double angle = random.between(-kPi, kPi);
    const Vector v = Vector{0.999 * random.unit() * longest_vector(angle, link), 0.0}.turned(angle);
    const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
    ASSERT_FALSE(t.limited) << v.x << ", " << v.y << ", " << link;
    const auto legs = legs_of(v);
    for (std::size_t k = 0; k < 3; ++k) {
      // half a tick, and 2^-17 V of 20 V; differences are then within one tick
      ASSERT_NEAR(t.leg[k], legs[k] / link * 10000.0, 0.51);
    }
    ASSERT_EQ(t.realised_q16.alpha, raw_ab(v, 16).alpha);
    ASSERT_EQ(t.realised_q16.beta, raw_ab(v, 16).beta);
  }
}

TEST(OnTime, LongVectorsKeepTheirDirection) {
  Random random(61);
  for (int n = 0; n < 50000; ++n) {
    const double link = random.between(20.0, 450.0);
    const double angle = random.between(-kPi, kPi);
    const double length = longest_vector(angle, link) * random.between(1.001, 8.0);
    const Vector v = Vector{length, 0.0}.turned(angle);
    const svpwm_on_time_t t = on_time(raw_ab(v, 16), raw(link, 16));
    ASSERT_TRUE(t.limited);
    const Vector realised = real(t.realised_q16, 16);
    // 2^-17 V in each component of at least 11 V: 1e-6 rad; the shortening has 30 bits
    ASSERT_LT(std::fabs(wrapped(std::atan2(realised.y, realised.x) - angle)), 3e-6);
    // as long as the hexagon allows, to a quarter of a sixteenth of a tick
    ASSERT_NEAR(realised.length() / longest_vector(angle, link), 1.0, 2e-5);
    const auto [lo, hi] = std::minmax({t.leg[0], t.leg[1], t.leg[2]});
    ASSERT_LE(hi - lo, SVPWM_SPREAD_MAX_TICKS + 1);
    ASSERT_GE(hi - lo, SVPWM_SPREAD_MAX_TICKS - 1);
    const auto legs = legs_of(realised);
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(t.leg[k], legs[k] / link * 10000.0, 0.52);
  }
}

TEST(OnTime, LinkBelowTenVoltsIsTakenAsTen) {
  for (const double link : {-5.0, 0.0, 3.0, 10.0}) {
    const svpwm_on_time_t t = on_time(raw_ab({2.0, 0.0}, 16), raw(link, 16));
    EXPECT_EQ(t.leg[0], 2000) << link;
    EXPECT_EQ(t.leg[1], -1000);
    EXPECT_EQ(t.leg[2], -1000);
  }
}

// A link that moves by up to 0.4 % a period is followed by one step of Newton's method, one that jumps at once.
TEST(OnTime, TicksPerVoltFollowTheLink) {
  Random random(132);
  double link = 320.0;
  std::int32_t ticks = 0;
  for (int n = 0; n < 20000; ++n) {
    link = (n % 500 == 0) ? random.between(12.0, 1500.0) : link * random.between(0.9962, 1.0038);
    ticks = svpwm_ticks_per_volt_q20(raw(link, 16), ticks);
    ASSERT_NEAR(real(ticks, 20) * link / 10000.0, 1.0, 2e-5) << link;
  }
  for (int n = 0; n < 3; ++n) ticks = svpwm_ticks_per_volt_q20(raw(320.0, 16), ticks);
  EXPECT_NEAR(real(ticks, 20) * 320.0 / 10000.0, 1.0, 3e-7);
}

// What the layouts take for granted (tests/prove/svpwm.c): sorted legs, a spread that leaves the shortest pulse and
// gap, and no common part but what rounding makes.
TEST(OnTime, TheLegsBelongTogetherWithAnyVoltage) {
  Random random(82);
  for (int n = 0; n < 200000; ++n) {
    const double link = (n % 100 == 0) ? 0.0 : random.log_between(1.0, 2000.0);
    const Vector v = random.direction(random.log_between(1e-4, 8192.0 * std::sqrt(2.0)));
    const svpwm_on_time_t t = svpwm_on_time(raw_ab(v, 16), svpwm_ticks_per_volt_q20(raw(link, 16), 0));
    ASSERT_EQ((1u << t.hi) | (1u << t.mid) | (1u << t.lo), 7u);
    const int t1 = t.leg[t.hi] - t.leg[t.mid], t2 = t.leg[t.mid] - t.leg[t.lo];
    ASSERT_GE(t1, 0);
    ASSERT_GE(t2, 0);
    ASSERT_TRUE(t1 > 0 || t.hi < t.mid) << "between equal ones the first is the longer";
    ASSERT_TRUE(t2 > 0 || t.mid < t.lo);
    ASSERT_LE(t1 + t2, SVPWM_SPREAD_MAX_TICKS + 1) << v.x << ", " << v.y << ", " << link;
    ASSERT_NEAR(t.leg[t.hi], (2.0 * t1 + t2) / 3.0, 1.0);
    ASSERT_NEAR(t.leg[t.mid], (t2 - t1) / 3.0, 1.0);
    ASSERT_NEAR(t.leg[t.lo], -(t1 + 2.0 * t2) / 3.0, 1.0);
  }
}

// Two or three legs of equal on-times have the order of their numbers, whichever of them they are.
TEST(OnTime, BetweenEqualOnesTheFirstIsTheLonger) {
  const struct {
    double degrees;  // of the voltage
    int hi, mid, lo;
  } cases[] = {{0.0, 0, 1, 2}, {60.0, 0, 1, 2}, {120.0, 1, 0, 2}, {180.0, 1, 2, 0}, {240.0, 2, 0, 1}, {300.0, 0, 2, 1}};
  for (const auto& c : cases) {
    // At multiples of 60 degrees two legs' voltages are the same, to less than a tick.
    const svpwm_on_time_t t = on_time(raw_ab(Vector{60.0, 0.0}.turned(c.degrees * kDegree), 16), raw(300.0, 16));
    ASSERT_TRUE(t.leg[t.hi] == t.leg[t.mid] || t.leg[t.mid] == t.leg[t.lo]) << c.degrees;
    EXPECT_EQ(t.hi, c.hi) << c.degrees;
    EXPECT_EQ(t.mid, c.mid) << c.degrees;
    EXPECT_EQ(t.lo, c.lo) << c.degrees;
  }
  const svpwm_on_time_t none = on_time(ab_t{0, 0}, raw(300.0, 16));
  EXPECT_EQ(none.hi, 0);
  EXPECT_EQ(none.mid, 1);
  EXPECT_EQ(none.lo, 2);
}

TEST(OnTime, ZeroIsZero) {
  const svpwm_on_time_t t = on_time(ab_t{0, 0}, raw(300.0, 16));
  EXPECT_FALSE(t.limited);
  for (const int leg : t.leg) EXPECT_EQ(leg, 0);
}

}  // namespace
