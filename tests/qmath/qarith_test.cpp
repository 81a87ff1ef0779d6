// Arithmetic against 128-bit integers: every result is exact, so every comparison is for equality.

#include "hal/qmath/qarith.h"

#include <algorithm>
#include <vector>

#include "tests/qmath/worst.hpp"

namespace {

using stillspin::test::edges;
using stillspin::test::RandomInt32;
using Wide = __int128;

Wide floor_shift(Wide x, unsigned n) {
  const Wide unit = Wide{1} << n;
  const Wide quotient = x / unit;
  return (x % unit < 0) ? quotient - 1 : quotient;
}

// floor(x / 2^n + 1/2) without using the shift of a negative number
Wide round_shift(Wide x, unsigned n) { return n == 0 ? x : floor_shift(x + (Wide{1} << (n - 1)), n); }

std::int32_t saturate(Wide x) {
  return static_cast<std::int32_t>(std::clamp<Wide>(x, Wide{INT32_MIN}, Wide{INT32_MAX}));
}

bool fits(Wide x) { return x == Wide{saturate(x)}; }

std::vector<std::int32_t> edges_and_random(int count, RandomInt32& random) {
  std::vector<std::int32_t> values = edges();
  for (int n = 0; n < count; ++n) values.push_back(random());
  return values;
}

bool lies_between(std::int32_t x, std::int32_t a, std::int32_t b) { return std::min(a, b) <= x && x <= std::max(a, b); }

void check_product(std::int32_t a, std::int32_t b, unsigned shift) {
  const Wide exact = round_shift(Wide{a} * b, shift);
  ASSERT_EQ(q_mul_sat(a, b, shift), saturate(exact)) << a << " * " << b << " >> " << shift;
  ASSERT_TRUE(Wide{q_mul64(a, b, shift)} == exact) << a << " * " << b << " >> " << shift;
  if (fits(exact)) {
    ASSERT_EQ(q_mul(a, b, shift), static_cast<std::int32_t>(exact)) << a << " * " << b << " >> " << shift;
  }
}

void check_pair(std::int32_t a, std::int32_t b) {
  ASSERT_EQ(q_add_sat(a, b), saturate(Wide{a} + b)) << a << ", " << b;
  ASSERT_EQ(q_sub_sat(a, b), saturate(Wide{a} - b)) << a << ", " << b;
  ASSERT_EQ(q_max(a, b), std::max(a, b));
  ASSERT_EQ(q_min(a, b), std::min(a, b));
  ASSERT_TRUE(Wide{q_mul_hi(a, b)} == floor_shift(Wide{a} * b, 32)) << a << ", " << b;
  const auto ua = static_cast<std::uint32_t>(a);
  const auto ub = static_cast<std::uint32_t>(b);
  ASSERT_TRUE(Wide{q_umul_hi(ua, ub)} == floor_shift(Wide{ua} * ub, 32)) << ua << ", " << ub;
}

void check_one(std::int32_t x) {
  ASSERT_EQ(q_neg_sat(x), saturate(-Wide{x}));
  ASSERT_EQ(q_abs_sat(x), saturate(x < 0 ? -Wide{x} : Wide{x}));
  ASSERT_TRUE(Wide{q_abs_u32(x)} == (x < 0 ? -Wide{x} : Wide{x}));
  for (unsigned n = 0; n < 32; ++n) {
    ASSERT_TRUE(Wide{q_shr(x, n)} == floor_shift(x, n)) << x << " >> " << n;
    ASSERT_TRUE(Wide{q_shr_round(x, n)} == round_shift(x, n)) << x << " >> " << n;
    if (n == 31) continue;
    ASSERT_EQ(q_shl_sat(x, n), saturate(Wide{x} * (Wide{1} << n))) << x << " << " << n;
  }
}

TEST(QArith, OneArgument) {
  for (const std::int32_t x : edges()) check_one(x);
  RandomInt32 random(1);
  for (int i = 0; i < 20000; ++i) check_one(random());
}

TEST(QArith, TwoArguments) {
  for (const std::int32_t a : edges()) {
    for (const std::int32_t b : edges()) check_pair(a, b);
  }
  RandomInt32 random(2);
  for (int i = 0; i < 500000; ++i) check_pair(random(), random());
}

TEST(QArith, Product) {
  for (const std::int32_t a : edges()) {
    for (const std::int32_t b : edges()) {
      for (const unsigned shift : {1u, 15u, 16u, 20u, 30u, 31u, 32u, 61u, 62u}) check_product(a, b, shift);
    }
  }
  RandomInt32 random(3);
  for (int i = 0; i < 500000; ++i) check_product(random(), random(), 1 + random.below(62));
}

TEST(QArith, TwoProductsAreRoundedOnce) {
  RandomInt32 random(7);
  for (int n = 0; n < 200000; ++n) {
    const std::int32_t a = random() / 2, b = random(), c = random() / 2, d = random();
    const unsigned shift = 1 + static_cast<unsigned>(n) % 62;
    const Wide sum = round_shift(Wide{a} * b + Wide{c} * d, shift);
    const Wide difference = round_shift(Wide{a} * b - Wide{c} * d, shift);
    ASSERT_EQ(q_mul_add_sat(a, b, c, d, shift), saturate(sum)) << n;
    ASSERT_EQ(q_mul_sub_sat(a, b, c, d, shift), saturate(difference)) << n;
    if (fits(sum)) {
      ASSERT_EQ(q_mul_add(a, b, c, d, shift), saturate(sum)) << n;
    }
    if (fits(difference)) {
      ASSERT_EQ(q_mul_sub(a, b, c, d, shift), saturate(difference)) << n;
    }
    ASSERT_TRUE(Wide{q_mac(std::int64_t{a} * b, c, d)} == Wide{a} * b + Wide{c} * d) << n;
  }
}

// What is cheaper is the floor of the same sums.
TEST(QArith, FloorsOfProductsRoundDown) {
  RandomInt32 random(12);
  for (int n = 0; n < 200000; ++n) {
    const std::int32_t a = random() / 2, b = random(), c = random() / 2, d = random();
    const unsigned shift = 1 + static_cast<unsigned>(n) % 62;
    const Wide product = floor_shift(Wide{a} * b, shift);
    const Wide sum = floor_shift(Wide{a} * b + Wide{c} * d, shift);
    const Wide difference = floor_shift(Wide{a} * b - Wide{c} * d, shift);
    if (fits(product)) {
      ASSERT_EQ(q_mul_floor(a, b, shift), saturate(product)) << n;
    }
    if (fits(sum)) {
      ASSERT_EQ(q_mul_add_floor(a, b, c, d, shift), saturate(sum)) << n;
    }
    if (fits(difference)) {
      ASSERT_EQ(q_mul_sub_floor(a, b, c, d, shift), saturate(difference)) << n;
    }
  }
}

TEST(QArith, ProductRoundsHalvesUp) {
  EXPECT_EQ(q_mul(3, 1, 1), 2);    // 1.5
  EXPECT_EQ(q_mul(-3, 1, 1), -1);  // -1.5
  EXPECT_EQ(q_mul(1, -1, 1), 0);   // -0.5
  EXPECT_EQ(q_shr_round(-3, 1), -1);
}

TEST(QArith, Saturate64) {
  EXPECT_EQ(q_sat64(INT64_MAX), INT32_MAX);
  EXPECT_EQ(q_sat64(INT64_MIN), INT32_MIN);
  EXPECT_EQ(q_sat64(std::int64_t{INT32_MAX} + 1), INT32_MAX);
  EXPECT_EQ(q_sat64(std::int64_t{INT32_MIN} - 1), INT32_MIN);
  for (const std::int32_t x : edges()) EXPECT_EQ(q_sat64(x), x);
  for (unsigned n = 0; n < 64; ++n) {
    EXPECT_TRUE(Wide{q_shr64(INT64_MIN, n)} == floor_shift(INT64_MIN, n));
    EXPECT_TRUE(Wide{q_shr64(-3, n)} == floor_shift(-3, n));
  }
}

TEST(QArith, SaturateToBits) {
  for (const unsigned bits : {3u, 29u, 30u}) {
    const unsigned n = 33u - bits;
    for (const std::int32_t x : edges()) {
      const std::int64_t end = std::int64_t{1} << bits;
      for (const std::int64_t wide : {std::int64_t{x}, std::int64_t{x} << 20, (end << n) - 1, end << n, -(end << n),
                                      -(end << n) - 1, INT64_MAX, INT64_MIN}) {
        EXPECT_EQ(q_sat_bits(wide, n, bits), std::clamp<std::int64_t>(wide >> n, -end, end - 1)) << wide;
      }
    }
  }
}

TEST(QArith, LimitIsAClamp) {
  for (const std::int32_t x : edges()) {
    for (const std::int32_t edge : edges()) {
      const std::int32_t limit = (edge == INT32_MIN) ? INT32_MAX : std::abs(edge);
      EXPECT_EQ(q_limit(x, limit), std::clamp(x, -limit, limit)) << x << " " << limit;
      EXPECT_EQ(q_limit(limit, limit), limit);
      EXPECT_EQ(q_limit(-limit, limit), -limit);
    }
  }
}

// Both ends included: what Frama-C takes for granted where they are called (tests/prove/qmath_ranges.h).
TEST(QArith, WhatFollowsLiesBetween) {
  RandomInt32 random(7);
  const std::vector<std::int32_t> values = edges_and_random(200, random);
  for (const std::int32_t a : values) {
    for (const std::int32_t b : values) {
      for (unsigned n = 1; n < 32; ++n) {
        const std::int32_t got = q_follow(a, b, n);
        ASSERT_TRUE(lies_between(got, a, b)) << a << ", " << b << ", " << n;
        ASSERT_TRUE(Wide{got} == a + floor_shift(saturate(Wide{b} - a), n)) << a << ", " << b << ", " << n;
        const Wide halves = floor_shift(Wide{b}, 1) - floor_shift(Wide{a}, 1);
        const std::int32_t by_halves = q_follow_halves(a, b, n);
        ASSERT_TRUE(lies_between(by_halves, a, b)) << a << ", " << b << ", " << n;
        ASSERT_TRUE(Wide{by_halves} == a + floor_shift(halves, n - 1)) << a << ", " << b << ", " << n;
        if (!fits(Wide{b} - a)) continue;
        ASSERT_EQ(q_follow_near(a, b, n), got) << a << ", " << b << ", " << n;
      }
    }
  }
}

// All of the difference is in the number and in what is left, and the number lies between.
TEST(QArith, WhatFollowsWithARestLosesNothing) {
  RandomInt32 random(8);
  const std::vector<std::int32_t> values = edges_and_random(100, random);
  for (const std::int32_t twice_a : values) {
    for (const std::int32_t twice_b : values) {
      const std::int32_t a = twice_a / 2;
      const std::int32_t b = twice_b / 2;
      const Wide difference = Wide{b} - a;
      for (unsigned n = 2; n <= 24; ++n) {
        const Wide one = Wide{1} << n;
        for (const Wide before : {Wide{0}, Wide{1}, one / 2, one - 1}) {
          std::uint32_t rest = static_cast<std::uint32_t>(before);
          const std::int32_t got = q_follow_remainder(a, b, n, &rest);
          ASSERT_TRUE(lies_between(got, a, b)) << a << ", " << b << ", " << n;
          ASSERT_LT(rest, one);
          ASSERT_TRUE(Wide{got} * one + rest == Wide{a} * one + before + difference) << a << ", " << b << ", " << n;
        }
      }
    }
  }
}

TEST(QArith, ASquareIsSaturatedAndNeverNegative) {
  for (const std::int32_t x : edges()) {
    ASSERT_TRUE(Wide{q_square(x)} == Wide{x} * x) << x;
    for (unsigned n = 2; n <= 32; ++n) {
      const std::int32_t got = q_square_sat(x, n);
      ASSERT_GE(got, 0);
      ASSERT_TRUE(Wide{got} == std::min(floor_shift(Wide{x} * x, n), Wide{(1 << 30) - 1})) << x << ", " << n;
    }
  }
}

TEST(QArith, AMixtureOfAnyTwoLiesBetween) {
  RandomInt32 random(9);
  const std::vector<std::int32_t> values = edges_and_random(100, random);
  for (const std::int32_t a : values) {
    for (const std::int32_t b : values) {
      for (const unsigned bits : {1u, 2u, 15u, 24u, 30u}) {
        const std::int32_t one = std::int32_t{1} << bits;
        for (const std::int32_t share : {0, 1, one / 2, one - 1, one, random() & (one - 1)}) {
          const std::int32_t got = q_mix_sat(a, b, share, bits);
          ASSERT_TRUE(lies_between(got, a, b)) << a << ", " << b << ", " << share;
          if (!fits(Wide{b} - a)) continue;
          ASSERT_EQ(got, q_mix(a, b, share, bits)) << a << ", " << b << ", " << share;
        }
      }
    }
  }
}

TEST(QArith, AMixtureLiesBetween) {
  RandomInt32 random(8);
  const std::vector<std::int32_t> values = edges_and_random(100, random);
  for (const std::int32_t a : values) {
    for (const std::int32_t b : values) {
      if (!fits(Wide{b} - a)) continue;
      for (const unsigned bits : {1u, 2u, 15u, 24u, 30u}) {
        const std::int32_t one = std::int32_t{1} << bits;
        EXPECT_EQ(q_mix(a, b, 0, bits), a);
        EXPECT_EQ(q_mix(a, b, one, bits), b);
        for (const std::int32_t share : {1, one / 2, one - 1, random() & (one - 1)}) {
          const std::int32_t got = q_mix(a, b, share, bits);
          ASSERT_TRUE(lies_between(got, a, b)) << a << ", " << b << ", " << share;
          ASSERT_TRUE(Wide{got} == a + round_shift((Wide{b} - a) * share, bits)) << a << ", " << b << ", " << share;
        }
      }
    }
  }
}

TEST(QArith, Clamp) {
  EXPECT_EQ(q_clamp(5, -2, 3), 3);
  EXPECT_EQ(q_clamp(-5, -2, 3), -2);
  EXPECT_EQ(q_clamp(1, -2, 3), 1);
  EXPECT_EQ(q_clamp(INT32_MIN, INT32_MIN, INT32_MAX), INT32_MIN);
  EXPECT_EQ(q_clamp(7, 4, 4), 4);
}

// At both ends, beside them, and where lower and upper end are one.
TEST(QArith, RangesHaveBothTheirEnds) {
  for (const std::int32_t lo : edges()) {
    for (const std::int32_t hi : edges()) {
      if (lo > hi) continue;
      for (const std::int64_t near : {std::int64_t{lo} - 1, std::int64_t{lo}, std::int64_t{lo} + 1,
                                      std::int64_t{hi} - 1, std::int64_t{hi}, std::int64_t{hi} + 1}) {
        const std::int32_t x = saturate(near);
        ASSERT_EQ(q_in_range(x, lo, hi), lo <= x && x <= hi) << x << " in " << lo << ".." << hi;
        ASSERT_EQ(q_clamp(x, lo, hi), std::clamp(x, lo, hi)) << x << " in " << lo << ".." << hi;
      }
    }
  }
}

// Every pair with one argument over all 2^16 values and the other over a stride that is coprime with the word.
TEST(QArith, SixteenBits) {
  const auto saturate16 = [](std::int64_t x) { return std::clamp<std::int64_t>(x, INT16_MIN, INT16_MAX); };
  std::vector<std::int32_t> others = {INT16_MIN, INT16_MIN + 1, -1, 0, 1, INT16_MAX - 1, INT16_MAX};
  for (std::int32_t b = INT16_MIN; b <= INT16_MAX; b += 331) others.push_back(b);
  long mismatches = 0;
  for (std::int32_t a = INT16_MIN; a <= INT16_MAX; ++a) {
    for (const std::int32_t b : others) {
      const auto a16 = static_cast<std::int16_t>(a);
      const auto b16 = static_cast<std::int16_t>(b);
      const auto product = static_cast<std::int64_t>(std::floor((a * static_cast<double>(b)) / 32768.0 + 0.5));
      mismatches += q15_mul(a16, b16) != saturate16(product);
      mismatches += q15_add_sat(a16, b16) != saturate16(std::int64_t{a} + b);
      mismatches += q15_sub_sat(a16, b16) != saturate16(std::int64_t{a} - b);
      mismatches += q_max16(a16, b16) != std::max(a, b);
      mismatches += q_min16(a16, b16) != std::min(a, b);
    }
  }
  EXPECT_EQ(mismatches, 0);
  for (const std::int32_t x : edges()) EXPECT_EQ(q15_sat(x), saturate16(x)) << x;
}

TEST(QArith, AShiftByNothingRoundsNothing) {
  for (const std::int32_t x : {INT32_MIN, -1, 0, 1, INT32_MAX}) EXPECT_EQ(q_shr_round(x, 0), x);
}

}  // namespace
