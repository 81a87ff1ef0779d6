// Square roots against exact integer comparisons: correctly rounded everywhere.

#include "hal/qmath/qsqrt.h"

#include "tests/qmath/worst.hpp"

namespace {

using stillspin::test::edges;
using stillspin::test::RandomInt32;
using Wide = unsigned __int128;

// r is the nearest integer to sqrt(x) exactly when (2 r - 1)^2 < 4 x < (2 r + 1)^2; a root is never half an integer.
bool is_nearest(std::uint64_t x, std::uint64_t r) {
  const Wide four_x = Wide{x} * 4;
  const Wide upper = Wide{2 * r + 1} * (2 * r + 1);
  return four_x < upper && (r == 0 || Wide{2 * r - 1} * (2 * r - 1) < four_x);
}

void check(std::uint64_t x) { ASSERT_TRUE(is_nearest(x, q_sqrt64(x))) << "sqrt(" << x << ") = " << q_sqrt64(x); }

constexpr std::uint64_t kLastNotSaturated = UINT64_MAX - UINT32_MAX;  // (2^32 - 1/2)^2 = 2^64 - 2^32 + 1/4

TEST(QSqrt, EverySmallNumber) {
  for (std::uint64_t x = 0; x < 300000; ++x) check(x);
}

TEST(QSqrt, Saturates) {
  check(kLastNotSaturated);
  EXPECT_EQ(q_sqrt64(kLastNotSaturated), UINT32_MAX);
  EXPECT_EQ(q_sqrt64(kLastNotSaturated + 1), UINT32_MAX);
  EXPECT_EQ(q_sqrt64(UINT64_MAX), UINT32_MAX);
}

// Squares and the two sides of a rounding boundary r^2 + r, where the result turns from r to r + 1.
TEST(QSqrt, AroundSquaresAndBoundaries) {
  RandomInt32 random(6);
  const auto around = [](std::uint64_t r) {
    for (std::uint64_t d = 0; d < 3; ++d) {
      check(r * r + d);
      check(r * r - d);
      check(r * r + r + d);
      check(r * r + r - d);
    }
  };
  for (int i = 0; i < 300000; ++i) around((random.bits() >> random.below(30)) | 2u);
  for (std::uint64_t r = UINT32_MAX - 1000; r < UINT32_MAX; ++r) around(r);
  for (std::uint64_t r = INT32_MAX - 1000; r < INT32_MAX + std::uint64_t{1000}; ++r) around(r);
}

TEST(QSqrt, RandomOfEveryMagnitude) {
  RandomInt32 random(7);
  for (int i = 0; i < 2000000; ++i) {
    const std::uint64_t x = ((std::uint64_t{random.bits()} << 32) | random.bits()) >> random.below(64);
    if (x <= kLastNotSaturated) check(x);
  }
}

// The ends and the middles of the chords of the first guess, at every normalising shift: there it is worst.
TEST(QSqrt, ChordsOfTheFirstGuess) {
  for (std::uint64_t index = 8; index < 32; ++index) {
    for (unsigned shift = 0; shift < 58; ++shift) {
      const std::uint64_t start = index << 59;
      const std::uint64_t end = start + ((std::uint64_t{1} << 59) - 1);
      check(start >> shift);
      if (end <= kLastNotSaturated) check(end >> shift);
    }
  }
}

TEST(QSqrt, ThirtyTwoBits) {
  for (std::uint64_t x = 0; x <= UINT32_MAX; x += 2003) {
    ASSERT_TRUE(is_nearest(x, q_sqrt32(static_cast<std::uint32_t>(x)))) << x;
  }
  EXPECT_EQ(q_sqrt32(UINT32_MAX), 65536u);
}

void check_hypot(std::int32_t a, std::int32_t b) {
  const auto square = [](std::int64_t x) { return static_cast<std::uint64_t>(x * x); };
  const std::uint64_t sum = square(a) + square(b);
  const std::int32_t length = q_hypot(a, b);
  if (length == INT32_MAX) {
    ASSERT_GT(sum, square(INT32_MAX) - INT32_MAX) << a << ", " << b;
  } else {
    ASSERT_TRUE(is_nearest(sum, static_cast<std::uint64_t>(length))) << a << ", " << b << ": " << length;
  }
}

TEST(QHypot, EdgesAndRandom) {
  for (const std::int32_t a : edges()) {
    for (const std::int32_t b : edges()) check_hypot(a, b);
  }
  RandomInt32 random(8);
  for (int i = 0; i < 1000000; ++i) check_hypot(random(), random());
}

TEST(QHypot, KnownTriangles) {
  EXPECT_EQ(q_hypot(3, -4), 5);
  EXPECT_EQ(q_hypot(0, 0), 0);
  EXPECT_EQ(q_hypot(0, INT32_MIN + 1), INT32_MAX);
  EXPECT_EQ(q_hypot(INT32_MIN, INT32_MIN), INT32_MAX);
}

}  // namespace
