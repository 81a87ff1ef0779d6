// Division against 128-bit integers: correctly rounded everywhere, so every comparison is for equality.

#include "hal/qmath/qdiv.h"

#include <algorithm>

#include "tests/qmath/worst.hpp"

namespace {

using stillspin::test::edges;
using stillspin::test::RandomInt32;
using stillspin::test::Worst;
using Wide = __int128;

std::int32_t reference(std::int32_t num, std::int32_t den, unsigned shift) {
  if (den == 0) return num == 0 ? 0 : (num < 0 ? INT32_MIN : INT32_MAX);
  const Wide scaled = Wide{num} * (Wide{1} << shift);
  const Wide size = scaled < 0 ? -scaled : scaled;
  const Wide by = den < 0 ? -Wide{den} : Wide{den};
  const Wide rounded = (2 * size + by) / (2 * by);
  const Wide result = ((num < 0) != (den < 0)) ? -rounded : rounded;
  return static_cast<std::int32_t>(std::clamp<Wide>(result, INT32_MIN, INT32_MAX));
}

void check(std::int32_t num, std::int32_t den, unsigned shift) {
  ASSERT_EQ(q_div(num, den, shift), reference(num, den, shift)) << num << " * 2^" << shift << " / " << den;
}

TEST(QDiv, LeadingZeros) {
  EXPECT_EQ(q_clz32(0), 32u);
  for (unsigned bit = 0; bit < 32; ++bit) {
    const std::uint32_t lowest = std::uint32_t{1} << bit;
    EXPECT_EQ(q_clz32(lowest), 31 - bit);
    EXPECT_EQ(q_clz32(lowest | (lowest - 1)), 31 - bit);
  }
}

// The estimate must never be above the true reciprocal, and at most 2 LSB below: q_div's correction relies on both.
TEST(QDiv, ReciprocalIsBelowAndWithinTwoLsb) {
  Worst worst("q_reciprocal_q31 [LSB]");
  const auto try_divisor = [&worst](std::uint32_t divisor) {
    const long double exact = 9223372036854775808.0L / divisor;
    const long double below = exact - q_reciprocal_q31(divisor);
    ASSERT_GE(below, 0.0L) << divisor;
    worst.add(static_cast<double>(below), divisor);
  };
  for (std::uint64_t divisor = std::uint64_t{1} << 31; divisor < (std::uint64_t{1} << 32); divisor += 1009) {
    try_divisor(static_cast<std::uint32_t>(divisor));
  }
  // the seed's error is greatest at the ends of the 128 intervals, where two steps leave most
  for (std::uint32_t index = 128; index < 256; ++index) {
    for (std::uint32_t offset = 0; offset < 4096; ++offset) {
      try_divisor((index << 24) + offset);
      try_divisor((index << 24) + 0xFFFFFFu - offset);
    }
  }
  EXPECT_LT(worst.error(), 2.0);  // two steps of correction in q_div
  EXPECT_GT(worst.error(), 1.0);  // this bound is sharp; a smaller error would mean that one step is enough
}

// Below by less than 2^-28 of the quotient, besides half an LSB of rounding; a divisor that is too small saturates.
TEST(QDiv, InverseOfADivisorThatIsShared) {
  RandomInt32 random(8);
  Worst worst("q_over [2^-28]");
  for (int n = 0; n < 300000; ++n) {
    const std::int32_t den = std::max(1, random() & INT32_MAX);
    const std::int32_t num = random();
    const unsigned shift = static_cast<unsigned>(n) % 31;
    const long double exact = static_cast<long double>(num) * (1u << shift) / den;
    const std::int32_t got = q_over(num, q_invert(den), shift);
    if (std::fabs(exact) >= 2147483647.0L) {
      ASSERT_LT(std::fabs(got - std::clamp(exact, -2147483648.0L, 2147483647.0L)), 9.0L) << num << " / " << den;
      continue;
    }
    const long double below = std::fabs(exact) - std::fabs(static_cast<long double>(got));
    ASSERT_GE(below, -0.5L) << num << " * 2^" << shift << " / " << den;
    const long double relative = (below - 0.5L) / std::max(std::fabs(exact), 1.0L) * 268435456.0L;
    worst.add(static_cast<double>(std::max(relative, 0.0L)), num, den);
  }
  EXPECT_LT(worst.error(), 1.0);
  EXPECT_EQ(q_over(1, q_invert(0), 30), q_over(1, q_invert(1), 30));
}

// The mantissa keeps 30 bits, whatever the divisor, and the exponent is the one that makes it so.
TEST(QDiv, InverseHasItsRange) {
  for (const std::int32_t divisor : edges()) {
    const q_inverse_t inverse = q_invert(divisor);
    ASSERT_GE(inverse.value, 1 << 30) << divisor;
    ASSERT_GE(inverse.exponent, 31u) << divisor;
    ASSERT_LE(inverse.exponent, 61u) << divisor;
    const long double one =
        std::ldexp(static_cast<long double>(inverse.value), -static_cast<int>(inverse.exponent)) * std::max(divisor, 1);
    ASSERT_LE(one, 1.0L) << divisor;
    ASSERT_GT(one, 1.0L - std::ldexp(1.0L, -28)) << divisor;
  }
}

TEST(QDiv, ZeroDivisorSaturatesWithTheSignOfTheNumerator) {
  EXPECT_EQ(q_div(0, 0, 10), 0);
  EXPECT_EQ(q_div(1, 0, 0), INT32_MAX);
  EXPECT_EQ(q_div(-1, 0, 31), INT32_MIN);
}

TEST(QDiv, RoundsHalvesAwayFromZero) {
  EXPECT_EQ(q_div(1, 2, 0), 1);
  EXPECT_EQ(q_div(-1, 2, 0), -1);
  EXPECT_EQ(q_div(5, -2, 0), -3);
  EXPECT_EQ(q_div(1, 3, 0), 0);
}

TEST(QDiv, SaturatesBothWays) {
  EXPECT_EQ(q_div(INT32_MIN, -1, 0), INT32_MAX);
  EXPECT_EQ(q_div(INT32_MIN, 1, 0), INT32_MIN);
  EXPECT_EQ(q_div(INT32_MAX, 1, 1), INT32_MAX);
  EXPECT_EQ(q_div(-3, 1, 31), INT32_MIN);
}

TEST(QDiv, EdgesAtEveryShift) {
  for (const std::int32_t num : edges()) {
    for (const std::int32_t den : edges()) {
      for (const unsigned shift : {0u, 1u, 2u, 15u, 16u, 20u, 29u, 30u, 31u}) check(num, den, shift);
    }
  }
}

TEST(QDiv, AllNumeratorsOf16Bits) {
  for (const std::int32_t den : {1, -1, 2, 3, 7, -10, 255, 256, 1000, -4095, 32767, -32768}) {
    for (std::int32_t num = INT16_MIN; num <= INT16_MAX; ++num) check(num, den, 15);
  }
}

TEST(QDiv, RandomOfEveryMagnitude) {
  RandomInt32 random(4);
  for (int i = 0; i < 2000000; ++i) check(random(), random(), random.below(32));
}

// Quotients that are all but a half: the hardest to round. num / den just beside (2 k + 1) / 2.
TEST(QDiv, QuotientsNextToAHalf) {
  RandomInt32 random(5);
  for (int i = 0; i < 500000; ++i) {
    const auto den = static_cast<std::int32_t>((random.bits() >> 1) | 1u);
    const std::int64_t numerator_range = (std::int64_t{INT32_MAX} << 1) / den;
    const auto odd = static_cast<std::int64_t>(random.bits()) % (numerator_range + 1) | 1;
    const std::int64_t num = (odd * den) / 2;
    for (std::int64_t near = num - 1; near <= num + 1; ++near) {
      if (near <= INT32_MAX) check(static_cast<std::int32_t>(near), den, 0);
    }
  }
}

}  // namespace
