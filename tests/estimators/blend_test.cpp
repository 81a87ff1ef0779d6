// The hand-over between two estimators.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/blend.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

constexpr double kLowRpm = 60.0, kHighRpm = 100.0;

std::int32_t rpm(double x) { return bpp(Motor{}.electrical(x)); }

blend_config_t config() {
  blend_config_t c = {};
  EXPECT_TRUE(blend_design(&c, rpm(kLowRpm), rpm(kHighRpm)));
  return c;
}

estimator_output_t output(double angle, double speed_rpm) { return {bam(angle), rpm(speed_rpm), 0, 32767}; }

// Both estimators at this speed until the share stands still.
void settle(blend_t* s, const blend_config_t& c, double speed_rpm) {
  const estimator_output_t o = output(0.0, speed_rpm);
  for (int n = 0; n < 200; ++n) (void)blend_step(s, &c, &o, &o);
}

double share(const blend_t& s) { return s.share_q15 / 32767.0; }

TEST(Blend, DesignRefusesAnEmptyRegion) {
  blend_config_t c = {};
  EXPECT_FALSE(blend_design(&c, 1000, 1000));
  EXPECT_FALSE(blend_design(&c, 1000, 999));
  EXPECT_FALSE(blend_design(&c, 0, 1000));
  EXPECT_TRUE(blend_design(&c, 1000, 1001));
}

// Eq (44): the share falls linearly between the two mechanical speeds, whatever their sign.
TEST(Blend, WeightsOfTheRegion) {
  const blend_config_t c = config();
  for (const double sign : {1.0, -1.0}) {
    blend_t s;
    blend_reset(&s);
    settle(&s, c, sign * 80.0);  // in
    for (double speed = 60.5; speed < 100.0; speed += 0.5) {
      settle(&s, c, sign * speed);
      ASSERT_EQ(s.region, BLEND_BOTH) << speed;
      // Q15 and the rounded speeds: 1e-4
      ASSERT_NEAR(share(s), (kHighRpm - speed) / (kHighRpm - kLowRpm), 1e-4) << speed;
    }
  }
}

// A shaft that was caught turning begins where a settled blend would be at its speed.
TEST(Blend, BeginsAtAKnownSpeed) {
  const blend_config_t c = config();
  for (const double speed : {0.0, 50.0, 80.0, 150.0, -80.0, -600.0}) {
    blend_t s;
    blend_preset(&s, &c, rpm(speed));
    const std::int32_t began = s.share_q15;
    EXPECT_EQ(blend_is_low(&s), std::fabs(speed) < kLowRpm) << speed;
    EXPECT_EQ(blend_is_high(&s), std::fabs(speed) > kHighRpm) << speed;
    settle(&s, c, speed);
    EXPECT_EQ(s.share_q15, began) << speed;
  }
}

TEST(Blend, OneEstimatorAloneOutsideTheRegion) {
  const blend_config_t c = config();
  blend_t s;
  blend_reset(&s);
  estimator_output_t low = output(1.0, 20.0), high = output(1.4, 25.0);
  low.load_accel_q8 = 111;
  high.load_accel_q8 = 222;
  high.quality_q15 = 5;
  estimator_output_t out = blend_step(&s, &c, &low, &high);
  EXPECT_EQ(out.angle_bam, low.angle_bam);  // exactly: a share of 32767 / 32768 would leave a trace of the other
  EXPECT_EQ(out.speed_bpp, low.speed_bpp);
  EXPECT_EQ(out.load_accel_q8, 111);
  EXPECT_EQ(out.quality_q15, 32767);
  settle(&s, c, 500.0);
  low.speed_bpp = rpm(500.0);
  high.speed_bpp = rpm(510.0);
  out = blend_step(&s, &c, &low, &high);
  EXPECT_EQ(out.angle_bam, high.angle_bam);
  EXPECT_EQ(out.speed_bpp, high.speed_bpp);
  EXPECT_EQ(out.load_accel_q8, 222);
  EXPECT_EQ(out.quality_q15, 5);
}

TEST(Blend, ShortestArc) {
  Random random(50);
  const blend_config_t c = config();
  blend_t s;
  blend_reset(&s);
  settle(&s, c, 80.0);
  const double weight = share(s);
  for (int n = 0; n < 5000; ++n) {
    const double high = (n % 2 == 0) ? kPi + random.between(-0.1, 0.1) : random.between(-kPi, kPi);
    const double apart = random.between(-0.99, 0.99) * kPi;
    const estimator_output_t o_low = output(high + apart, 80.0), o_high = output(high, 80.0);
    blend_t copy = s;
    const estimator_output_t out = blend_step(&copy, &c, &o_low, &o_high);
    // a share in Q15 of up to half a turn
    ASSERT_NEAR(wrapped(rad(out.angle_bam) - (high + weight * apart)), 0.0, 1.5e-4) << high << ", " << apart;
    ASSERT_NEAR(rad(copy.disagreement_bam), apart, 1e-8);
  }
}

// Where the region changes when the speed creeps up and down again; the hysteresis is an eighth of the range, 5 rpm.
TEST(Blend, HysteresisInBothDirections) {
  const blend_config_t c = config();
  for (const double sign : {1.0, -1.0}) {
    blend_t s;
    blend_reset(&s);
    std::vector<std::pair<blend_region_t, double>> changes;
    blend_region_t before = s.region;
    const auto visit = [&](double speed) {
      settle(&s, c, sign * speed);
      if (s.region != before) changes.emplace_back(s.region, speed);
      before = s.region;
    };
    for (double speed = 0.0; speed < 120.0; speed += 0.25) visit(speed);
    for (double speed = 120.0; speed > 0.0; speed -= 0.25) visit(speed);
    ASSERT_EQ(changes.size(), 4u);
    const std::pair<blend_region_t, double> wanted[] = {
        {BLEND_BOTH, 65.0}, {BLEND_HIGH, 100.0}, {BLEND_BOTH, 95.0}, {BLEND_LOW, 60.0}};
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(changes[k].first, wanted[k].first) << k;
      EXPECT_NEAR(changes[k].second, wanted[k].second, 0.3) << k;  // the steps are 0.25 rpm
    }
  }
}

// Noise of +-2 rpm on the border must not make the region chatter.
TEST(Blend, NoChatterOnTheBorders) {
  Random random(51);
  const blend_config_t c = config();
  for (const double border : {60.0, 65.0, 95.0, 100.0}) {
    blend_t s;
    blend_reset(&s);
    settle(&s, c, 80.0);
    int changes = 0;
    blend_region_t before = s.region;
    for (int n = 0; n < 5000; ++n) {
      const estimator_output_t o = output(0.0, border + random.between(-2.0, 2.0));
      (void)blend_step(&s, &c, &o, &o);
      changes += s.region != before;
      before = s.region;
    }
    EXPECT_LE(changes, 1) << border;
  }
}

// A jump of the speed or of one estimate must not become a jump of the result: 1 % of the disagreement per period.
TEST(Blend, TheShareMovesAtABoundedRate) {
  Random random(52);
  const blend_config_t c = config();
  blend_t s;
  blend_reset(&s);
  double before = share(s);
  double angle_before = 1.0;
  bool was_high = false, was_low = false;
  for (int n = 0; n < 20000; ++n) {
    const double speed = (n / 400) % 2 == 0 ? 10.0 : random.between(-300.0, 300.0);
    const estimator_output_t low = output(1.0, speed), high = output(1.5, speed);
    const estimator_output_t out = blend_step(&s, &c, &low, &high);
    ASSERT_LE(std::fabs(share(s) - before), 0.01 + 1e-9);
    ASSERT_GE(share(s), 0.0);
    ASSERT_LE(share(s), 1.0);
    ASSERT_LE(std::fabs(rad(out.angle_bam) - angle_before), 0.5 * 0.0101);
    before = share(s);
    angle_before = rad(out.angle_bam);
    was_high = was_high || share(s) == 0.0;
    was_low = was_low || (n > 1000 && share(s) == 1.0);
  }
  EXPECT_TRUE(was_high);
  EXPECT_TRUE(was_low);
  // all the way takes about a hundred periods, not longer
  blend_reset(&s);
  const estimator_output_t fast = output(0.0, 500.0);
  for (int n = 0; n < 102; ++n) (void)blend_step(&s, &c, &fast, &fast);
  EXPECT_EQ(s.share_q15, 0);
}

// On its way between the two an estimator is still asked though the region is left; alone is who has the whole share.
TEST(Blend, AloneIsWhoHasTheWholeShare) {
  blend_t s;
  blend_reset(&s);
  EXPECT_TRUE(blend_is_low(&s));
  EXPECT_FALSE(blend_is_high(&s));
  s.share_q15 = 32766;
  EXPECT_FALSE(blend_is_low(&s));
  s.region = BLEND_HIGH;
  EXPECT_FALSE(blend_is_high(&s));
  s.share_q15 = 0;
  EXPECT_TRUE(blend_is_high(&s));
  s.region = BLEND_BOTH;
  EXPECT_FALSE(blend_is_high(&s));
  s.share_q15 = 32767;
  EXPECT_FALSE(blend_is_low(&s));
}

}  // namespace
