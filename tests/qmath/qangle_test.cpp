// Binary angles: wrap-around and the conversions.

#include "hal/qmath/qangle.h"

#include "tests/qmath/worst.hpp"

namespace {

using stillspin::test::RandomInt32;
using stillspin::test::Worst;

constexpr double kTurnRad = 6.283185307179586;
constexpr double kBamPerTurn = 4294967296.0;

TEST(QAngle, DifferenceTakesTheShortestWay) {
  EXPECT_EQ(angle_diff_bam(5, 3), 2);
  EXPECT_EQ(angle_diff_bam(3, 0xFFFFFFFEu), 5);
  EXPECT_EQ(angle_diff_bam(0xFFFFFFFEu, 3), -5);
  EXPECT_EQ(angle_diff_bam(ANGLE_BAM_HALF_TURN, 1), INT32_MAX);
  EXPECT_EQ(angle_diff_bam(ANGLE_BAM_HALF_TURN, 0), INT32_MIN);
  RandomInt32 random(10);
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t a = random.bits();
    const std::uint32_t b = random.bits();
    ASSERT_EQ(angle_add_bam(b, angle_diff_bam(a, b)), a);
  }
}

TEST(QAngle, DegreesAreWithinOneLsb) {
  Worst worst("ANGLE_BAM_DEGREES [bam]");
  for (int degrees = -1080; degrees <= 1080; ++degrees) {
    const double exact = degrees / 360.0 * kBamPerTurn;
    const double error = ANGLE_BAM_DEGREES(degrees) - exact;
    worst.add(error - kBamPerTurn * std::round(error / kBamPerTurn), degrees);
  }
  EXPECT_LT(worst.error(), 1.0);  // the fraction 32 / 45 is truncated
  EXPECT_EQ(ANGLE_BAM_DEGREES(90), ANGLE_BAM_QUARTER_TURN);
  EXPECT_EQ(ANGLE_BAM_DEGREES(45), ANGLE_BAM_EIGHTH_TURN);
  EXPECT_EQ(ANGLE_BAM_DEGREES(-180), ANGLE_BAM_HALF_TURN);
  EXPECT_EQ(ANGLE_BAM_DEGREES(360), 0u);
}

TEST(QAngle, PolePairs) {
  EXPECT_EQ(angle_times(ANGLE_BAM_QUARTER_TURN, 3), 3 * ANGLE_BAM_QUARTER_TURN);
  EXPECT_EQ(angle_times(ANGLE_BAM_HALF_TURN, 4), 0u);
}

TEST(QAngle, Turns) {
  EXPECT_EQ(angle_from_turn_q15(0x2000), ANGLE_BAM_QUARTER_TURN);
  EXPECT_EQ(angle_from_turn_q15(-0x2000), 3 * ANGLE_BAM_QUARTER_TURN);
  EXPECT_EQ(angle_from_turn_q15(0x8000 + 0x2000), ANGLE_BAM_QUARTER_TURN);
  EXPECT_EQ(angle_from_turn_q30(INT32_C(1) << 28), ANGLE_BAM_QUARTER_TURN);
  EXPECT_EQ(angle_to_turn_q15(3 * ANGLE_BAM_QUARTER_TURN), -0x2000);
  EXPECT_EQ(angle_to_turn_q30(3 * ANGLE_BAM_QUARTER_TURN), -(INT32_C(1) << 28));
  EXPECT_EQ(angle_to_turn_q15(INT32_MAX), 0x4000);
  for (std::int32_t turn_q15 = INT16_MIN / 2; turn_q15 < -(INT16_MIN / 2); ++turn_q15) {
    ASSERT_EQ(angle_to_turn_q15(angle_from_turn_q15(turn_q15)), turn_q15);
  }
}

TEST(QAngle, Radians) {
  Worst to("bam -> rad Q28 [LSB]");
  Worst from("rad Q28 -> bam [LSB]");
  const double q28 = 268435456.0;
  const auto compare = [&](std::int32_t value) {
    to.add(angle_bam_to_rad_q28(value) - value / kBamPerTurn * kTurnRad * q28, value);
    const double exact = value / q28 / kTurnRad * kBamPerTurn;
    const double error = angle_from_rad_q28(value) - exact;
    from.add(error - kBamPerTurn * std::round(error / kBamPerTurn), value);
  };
  for (std::int64_t value = INT32_MIN; value <= INT32_MAX; value += 1511) compare(static_cast<std::int32_t>(value));
  compare(INT32_MAX);
  EXPECT_LT(to.error(), 0.6);    // half an LSB of rounding, and the constant's rounding times 2^31
  EXPECT_LT(from.error(), 1.3);  // the same; here the constant, 0.15 LSB off in Q29, is worth 0.6 LSB
}

}  // namespace
