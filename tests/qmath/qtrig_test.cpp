// Sine, cosine and arctangent against long double (64 bits of mantissa: its own error is 1e-19).

#include "hal/qmath/qtrig.h"

#include <algorithm>
#include <cstdlib>

#include "tests/qmath/worst.hpp"

namespace {

using stillspin::test::edges;
using stillspin::test::RandomInt32;
using stillspin::test::Worst;

constexpr long double kTurnRad = 6.283185307179586476925286766559L;
constexpr long double kBamPerTurn = 4294967296.0L;
constexpr double kOneQ30 = 1073741824.0;
constexpr std::int32_t kUnit = std::int32_t{1} << 30;

struct SineErrors {
  Worst sine{"sin"};
  Worst cosine{"cos"};
  Worst length{"sin^2 + cos^2 - 1"};

  void add(std::uint32_t angle_bam) {
    std::int32_t s = 0;
    std::int32_t c = 0;
    q_sincos(angle_bam, &s, &c);
    const long double angle_rad = angle_bam * (kTurnRad / kBamPerTurn);
    ASSERT_LE(std::max(std::abs(s), std::abs(c)), kUnit) << angle_bam;
    sine.add(static_cast<double>(s / static_cast<long double>(kOneQ30) - std::sin(angle_rad)), angle_bam);
    cosine.add(static_cast<double>(c / static_cast<long double>(kOneQ30) - std::cos(angle_rad)), angle_bam);
    length.add((s / kOneQ30) * (s / kOneQ30) + (c / kOneQ30) * (c / kOneQ30) - 1.0, angle_bam);
  }
};

// Half an LSB of Q30 is 4.7e-10, the neglected d^4/24 up to 9.4e-10, the product's rounding the rest.
constexpr double kSineBound = 2.0e-9;

TEST(QSincos, AllAnglesOf16Bits) {
  SineErrors errors;
  for (std::uint32_t a = 0; a <= 0xFFFFu; ++a) errors.add(a << 16);
  EXPECT_LT(errors.sine.error(), kSineBound);
  EXPECT_LT(errors.cosine.error(), kSineBound);
}

TEST(QSincos, DenseAndAroundNodes) {
  SineErrors errors;
  for (std::uint64_t a = 0; a < (std::uint64_t{1} << 32); a += 2999) errors.add(static_cast<std::uint32_t>(a));
  // nodes, and the middles between them where the expansion is worst
  for (std::uint32_t half_node = 0; half_node < 512; ++half_node) {
    for (std::uint32_t offset = 0; offset < 200; ++offset) errors.add((half_node << 23) + offset - 100);
  }
  EXPECT_LT(errors.sine.error(), kSineBound);
  EXPECT_LT(errors.cosine.error(), kSineBound);
  EXPECT_LT(errors.length.error(), 2 * kSineBound);
  EXPECT_GT(errors.sine.error(), kSineBound / 1.5);  // the bound is tight
}

// At the 64 nodes of a quadrant the table alone speaks, so each of its entries has to be the rounded sine.
TEST(QSincos, CorrectlyRoundedAtNodes) {
  for (std::uint32_t node = 0; node <= 64; ++node) {
    std::int32_t s = 0;
    std::int32_t c = 0;
    q_sincos(node << 24, &s, &c);
    EXPECT_EQ(s, std::lround(kOneQ30 * std::sin(node / 256.0L * kTurnRad))) << node;
    EXPECT_EQ(c, std::lround(kOneQ30 * std::cos(node / 256.0L * kTurnRad))) << node;
  }
}

TEST(QSincos, ExactOnTheAxes) {
  const std::int32_t expected[4][2] = {{0, kUnit}, {kUnit, 0}, {0, -kUnit}, {-kUnit, 0}};
  for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
    std::int32_t s = 1;
    std::int32_t c = 1;
    q_sincos(quarter << 30, &s, &c);
    EXPECT_EQ(s, expected[quarter][0]);
    EXPECT_EQ(c, expected[quarter][1]);
  }
}

// Signed difference of angles, in LSB of the binary angle.
double atan2_error_bam(std::int32_t y, std::int32_t x) {
  const long double exact =
      std::atan2(static_cast<long double>(y), static_cast<long double>(x)) * (kBamPerTurn / kTurnRad);
  long double error = q_atan2(y, x) - exact;
  error -= kBamPerTurn * std::round(error / kBamPerTurn);
  return static_cast<double>(error);
}

constexpr double kAtanBoundBam = 7.0;  // the polynomial 4.2, its rounding and that of the ratio the rest

TEST(QAtan2, ExactOnAxesAndDiagonals) {
  for (const std::int32_t r : {1, 2, 3, 1000, 0x12345678, INT32_MAX}) {
    EXPECT_EQ(q_atan2(0, r), 0u) << r;
    EXPECT_EQ(q_atan2(r, r), 0x20000000u) << r;
    EXPECT_EQ(q_atan2(r, 0), 0x40000000u) << r;
    EXPECT_EQ(q_atan2(r, -r), 0x60000000u) << r;
    EXPECT_EQ(q_atan2(0, -r), 0x80000000u) << r;
    EXPECT_EQ(q_atan2(-r, -r), 0xA0000000u) << r;
    EXPECT_EQ(q_atan2(-r, 0), 0xC0000000u) << r;
    EXPECT_EQ(q_atan2(-r, r), 0xE0000000u) << r;
  }
  EXPECT_EQ(q_atan2(0, 0), 0u);
  EXPECT_EQ(q_atan2(INT32_MIN, INT32_MIN), 0xA0000000u);
  EXPECT_EQ(q_atan2(INT32_MIN, 0), 0xC0000000u);
  EXPECT_EQ(q_atan2(0, INT32_MIN), 0x80000000u);
}

TEST(QAtan2, EveryDirectionAndEveryMagnitude) {
  Worst worst("atan2 [bam]");
  for (std::uint64_t a = 0; a < (std::uint64_t{1} << 32); a += 40009) {
    const double angle_rad = static_cast<double>(a) * static_cast<double>(kTurnRad / kBamPerTurn);
    for (const double radius : {2147483000.0, 70000.0}) {
      const auto x = static_cast<std::int32_t>(radius * std::cos(angle_rad));
      const auto y = static_cast<std::int32_t>(radius * std::sin(angle_rad));
      worst.add(atan2_error_bam(y, x), y, x);
    }
  }
  EXPECT_LT(worst.error(), kAtanBoundBam);
  EXPECT_GT(worst.error(), kAtanBoundBam / 1.5);  // the bound is tight
}

TEST(QAtan2, EveryTinyVector) {
  Worst worst("atan2 of tiny vectors [bam]");
  for (std::int32_t y = -200; y <= 200; ++y) {
    for (std::int32_t x = -200; x <= 200; ++x) worst.add(atan2_error_bam(y, x), y, x);
  }
  EXPECT_LT(worst.error(), kAtanBoundBam);
}

TEST(QAtan2, EdgesAndRandom) {
  Worst worst("atan2 of edges and random vectors [bam]");
  for (const std::int32_t y : edges()) {
    for (const std::int32_t x : edges()) worst.add(atan2_error_bam(y, x), y, x);
  }
  RandomInt32 random(9);
  for (int i = 0; i < 500000; ++i) {
    const std::int32_t y = random();
    const std::int32_t x = random();
    worst.add(atan2_error_bam(y, x), y, x);
  }
  EXPECT_LT(worst.error(), kAtanBoundBam);
}

// There and back: the direction of (cos, sin) is the angle, within the two functions' errors.
TEST(QAtan2, InvertsSincos) {
  Worst worst("atan2(sincos) [bam]");
  for (std::uint64_t a = 0; a < (std::uint64_t{1} << 32); a += 10007) {
    std::int32_t s = 0;
    std::int32_t c = 0;
    const auto angle_bam = static_cast<std::uint32_t>(a);
    q_sincos(angle_bam, &s, &c);
    worst.add(angle_diff_bam(q_atan2(s, c), angle_bam), angle_bam);
  }
  EXPECT_LE(worst.error(), kAtanBoundBam + kSineBound * static_cast<double>(kBamPerTurn / kTurnRad));
}

}  // namespace
