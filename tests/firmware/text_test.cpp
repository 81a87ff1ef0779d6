// Numbers to text and back, in fixed point.

#include "firmware/text/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace {

TEST(Text, SpacesEndAtTheColumnOrWithTheBlock) {
  for (const std::uint16_t room : {6, 20}) {
    std::uint16_t block[20];
    octet_writer_t w = octet_writer(block, room);
    put_text(&w, "abc");
    put_spaces_to(&w, 9);
    EXPECT_EQ(std::string(block, block + w.count), std::string("abc      ").substr(0, room));
    EXPECT_EQ(w.full, room < 9);
  }
}

std::string fixed(std::int32_t raw, std::uint16_t q, std::uint16_t decimals) {
  std::uint16_t block[40];
  octet_writer_t w = octet_writer(block, 40);
  put_fixed(&w, raw, q, decimals);
  return std::string(block, block + w.count);
}

struct Read {
  std::uint16_t length;
  std::int32_t digits;
  std::uint16_t decimals;
};

Read number(const std::string& text) {
  const std::vector<std::uint16_t> octets(text.begin(), text.end());
  decimal_t d = {};
  const std::uint16_t length = text_number(octets.data(), static_cast<std::uint16_t>(octets.size()), &d);
  return {length, d.digits, d.decimals};
}

constexpr std::int32_t kNoFit = INT32_MIN;

std::int32_t raw(const std::string& text, std::uint16_t q) {
  const Read r = number(text);
  const decimal_t d = {r.digits, r.decimals};
  std::int32_t value = 0;
  return decimal_raw(&d, q, &value) ? value : kNoFit;
}

// Digits that end where a number does, at it and beyond it.
TEST(Text, NumbersAtTheEndOfTheirFormat) {
  EXPECT_EQ(number("2147483647").digits, INT32_MAX);
  EXPECT_EQ(number("2147483648").digits, 2147483640) << "the tenth digit does not fit any more";
  EXPECT_EQ(number("-2147483648").digits, -2147483640);
  EXPECT_EQ(number("3147483650").digits, INT32_MAX) << "too many";
  EXPECT_EQ(number("21474836470").digits, INT32_MAX) << "too many";
  EXPECT_EQ(number("21474836.48").digits, 214748364) << "a decimal that does not fit is left out";
  EXPECT_EQ(number("21474836.48").decimals, 1);
  EXPECT_EQ(number("21474836.47").decimals, 2);
}

TEST(Text, FixedPointToDecimals) {
  EXPECT_EQ(fixed(0, 16, 2), "0.00");
  EXPECT_EQ(fixed(65536 * 3 / 2, 16, 0), "2");
  EXPECT_EQ(fixed(-65536 * 5 / 4, 16, 1), "-1.3") << "halves away from zero";
  EXPECT_EQ(fixed(65535, 16, 2), "1.00") << "the fraction carries";
  EXPECT_EQ(fixed(-1, 16, 2), "0.00") << "no minus before nothing";
  EXPECT_EQ(fixed(INT32_MIN, 0, 0), "-2147483648");
  EXPECT_EQ(fixed(INT32_MIN, 32, 4), "-0.5000") << "binary angles";
  EXPECT_EQ(fixed(INT32_MAX, 31, 9), "1.000000000");
}

// Against the host's floating point, wherever that is exact enough to be right.
TEST(Text, EveryFormatAgreesWithTheHost) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 200000; ++trial) {
    const auto q = static_cast<std::uint16_t>(random() % 33);
    const auto decimals = static_cast<std::uint16_t>(random() % 7);
    const auto value = static_cast<std::int32_t>(random()) >> (random() % 32);
    const double real = std::ldexp(value, -q);
    const double scaled = std::fabs(real) * std::pow(10.0, decimals);
    if (std::fabs(scaled - std::floor(scaled) - 0.5) < 1e-6) continue;  // halves go another way in printf
    char expected[64];
    std::snprintf(expected, sizeof expected, "%.*f", decimals, real);
    std::string wanted = expected;
    if (wanted.find_first_not_of("-0.") == std::string::npos && wanted[0] == '-') wanted.erase(0, 1);
    ASSERT_EQ(fixed(value, q, decimals), wanted) << value << " q" << q;
  }
}

TEST(Text, ReadsNumbers) {
  EXPECT_EQ(number("600rpm").length, 3);
  EXPECT_EQ(number("-0.50").digits, -50);
  EXPECT_EQ(number("-0.50").decimals, 2);
  for (const char* none : {"1,5", "+1,5", "1,000", "1.2.3", "1e3.5", "1."})
    EXPECT_EQ(number(none).length, none[1] == '.' && none[2] == '\0' ? 2 : 0) << none;
  EXPECT_EQ(number(".5").length, 2);
  for (const char* none : {"", "-", "+", ".", "rpm", "-rpm", "--1"}) EXPECT_EQ(number(none).length, 0) << none;
  EXPECT_EQ(number("99999999999").digits, INT32_MAX);
  EXPECT_EQ(number("-99999999999").digits, -INT32_MAX);
  EXPECT_EQ(number("0.12345678912345").digits, 123456789) << "the tenth decimal and those behind are cut off";
  EXPECT_EQ(number("3000000000.5").decimals, 0);
}

TEST(Text, ValuesAreTheNearestOnes) {
  EXPECT_EQ(raw("1.5", 16), 98304);
  EXPECT_EQ(raw("-1.5", 16), -98304);
  EXPECT_EQ(raw("0.00455", 24), 76336);  // 76336.3
  EXPECT_EQ(raw("40000", 16), kNoFit);
  EXPECT_EQ(raw("-40000", 16), kNoFit);
  EXPECT_EQ(raw("0.5", 32), kNoFit);
  EXPECT_EQ(raw("1e9", 16), kNoFit);
  EXPECT_EQ(raw("-0.25", 32), -1073741824);
  EXPECT_EQ(raw("99999999999", 0), kNoFit);
  EXPECT_EQ(raw("-99999999999", 0), kNoFit);
  EXPECT_EQ(raw("2147483646", 0), 2147483646);
}

TEST(Text, ExponentsAreRead) {
  EXPECT_EQ(raw("1e3", 0), 1000);
  EXPECT_EQ(raw("1E+3", 0), 1000);
  EXPECT_EQ(raw("1.5e3", 16), 1500 * 65536);
  EXPECT_EQ(raw("-25e-1", 16), -163840);
  EXPECT_EQ(raw("1000000000000e-12", 8), 256) << "what is too long alone may fit with its exponent";
  EXPECT_EQ(raw("0e999", 8), 0);
  EXPECT_EQ(raw("1e-999", 8), 0);
  EXPECT_EQ(raw("1e99999999999", 8), kNoFit);
  EXPECT_EQ(number("1e3rpm").length, 3);
  EXPECT_EQ(number("1em").length, 1) << "no exponent: the unit may begin with an e";
  EXPECT_EQ(number("1e").length, 1);
  EXPECT_EQ(number("1e-").length, 1);
  EXPECT_EQ(number("e3").length, 0);
}

TEST(Text, WholeNumbers) {
  const auto whole = [](const std::string& text) {
    const Read r = number(text);
    const decimal_t d = {r.digits, r.decimals};
    return decimal_is_whole(&d);
  };
  for (const char* yes : {"2", "2.0", "1e3", "2.50e1", "-7.000", "0"}) EXPECT_TRUE(whole(yes)) << yes;
  for (const char* no : {"2.5", "25e-1", "0.000000001", "1e-9"}) EXPECT_FALSE(whole(no)) << no;
}

// What is written with enough decimals comes back to the bit.
TEST(Text, WhatIsWrittenIsReadBack) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 100000; ++trial) {
    const auto q = static_cast<std::uint16_t>(random() % 25);
    const auto value = static_cast<std::int32_t>(random()) >> (8 + random() % 24);
    const auto decimals = static_cast<std::uint16_t>(q * 0.302 + 1);
    const std::string text = fixed(value, q, decimals);
    if (text.size() > 10) continue;  // more digits than a number can have
    ASSERT_EQ(raw(text, q), value) << text << " q" << q;
  }
}

}  // namespace
