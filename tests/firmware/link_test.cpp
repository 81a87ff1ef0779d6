// Records on the wire: check sums, stuffing, lengths. How text and records are told apart is splitter_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/firmware/link_octets.hpp"

extern "C" {
#include "firmware/base/crc.h"
#include "firmware/base/octets.h"
#include "firmware/link/cobs.h"
#include "firmware/link/record.h"
}

namespace {

using namespace stillspin::test;

std::uint32_t crc32(const Octets& octets) {
  std::uint32_t crc = CRC32_BEGIN;
  for (const std::uint16_t octet : octets) crc = crc32_add(crc, octet);
  return crc32_end(crc);
}

TEST(Crc, TheCataloguesCheckValues) {
  const Octets check = from_text("123456789");
  EXPECT_EQ(crc16(check.data(), 9), 0x29B1u);
  EXPECT_EQ(crc32(check), 0xCBF43926u);
  EXPECT_EQ(crc16(check.data(), 0), 0xFFFFu);
  EXPECT_EQ(crc32({}), 0u);
}

// Bit by bit, as the polynomials are written down.
TEST(Crc, AgreesWithTheDefinitionBitByBit) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    Octets octets(random() % 300);
    for (auto& o : octets) o = static_cast<std::uint16_t>(random() % 256);
    std::uint32_t crc = 0xFFFF, wide = 0xFFFFFFFF;
    for (const std::uint16_t o : octets) {
      for (int bit = 7; bit >= 0; --bit) {
        const bool out = ((crc >> 15) & 1u) != ((o >> bit) & 1u);
        crc = ((crc << 1) ^ (out ? 0x1021u : 0u)) & 0xFFFFu;
      }
      for (int bit = 0; bit < 8; ++bit) {
        const bool out = (wide & 1u) != ((o >> bit) & 1u);
        wide = (wide >> 1) ^ (out ? 0xEDB88320u : 0u);
      }
    }
    EXPECT_EQ(crc16(octets.data(), length(octets)), crc);
    EXPECT_EQ(crc32(octets), ~wide);
  }
}

TEST(Crc, WhatLiesAboveAnOctetDoesNotCount) {
  EXPECT_EQ(crc32_add(CRC32_BEGIN, 0xAB12), crc32_add(CRC32_BEGIN, 0x12));
  EXPECT_EQ(crc16_add(CRC16_BEGIN, 0xAB12), crc16_add(CRC16_BEGIN, 0x12));
}

Octets encoded(const Octets& data) {
  Octets to(COBS_SIZE(data.size()) + 1, 0xBEEF);
  const std::uint16_t n = cobs_encode(data.data(), length(data), to.data());
  EXPECT_LE(n, COBS_SIZE(data.size()));
  EXPECT_EQ(to[COBS_SIZE(data.size())], 0xBEEF) << "written behind the end";
  to.resize(n);
  if (data.size() <= 254u) {
    Octets in_place = data;
    in_place.insert(in_place.begin(), 0xBEEF);
    in_place.resize(COBS_SIZE(data.size()));
    EXPECT_EQ(cobs_encode(&in_place[1], length(data), in_place.data()), n);
    in_place.resize(n);
    EXPECT_EQ(in_place, to) << "in place";
  }
  return to;
}

// The examples of the encoding's authors and of its usual descriptions.
TEST(Cobs, KnownEncodings) {
  EXPECT_EQ(encoded({}), (Octets{1}));
  EXPECT_EQ(encoded({0}), (Octets{1, 1}));
  EXPECT_EQ(encoded({0, 0}), (Octets{1, 1, 1}));
  EXPECT_EQ(encoded({0x11, 0x22, 0, 0x33}), (Octets{3, 0x11, 0x22, 2, 0x33}));
  EXPECT_EQ(encoded({0x11, 0, 0, 0}), (Octets{2, 0x11, 1, 1, 1}));
  Octets run(254);
  for (std::uint16_t k = 0; k < 254; ++k) run[k] = static_cast<std::uint16_t>(k + 1);
  Octets expected = run;
  expected.insert(expected.begin(), 0xFF);
  EXPECT_EQ(encoded(run), expected) << "254 octets without a zero make one full block and nothing behind it";
  run.push_back(0);
  expected.insert(expected.end(), {1, 1});
  EXPECT_EQ(encoded(run), expected);
  run.back() = 0x42;
  expected.resize(255);
  expected.insert(expected.end(), {2, 0x42});
  EXPECT_EQ(encoded(run), expected);
}

TEST(Cobs, WhatIsEncodedComesBack) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 3000; ++trial) {
    Octets data(random() % 600);
    const unsigned zeros = 1 + random() % 400;  // one in so many
    for (auto& o : data) o = (random() % zeros == 0) ? 0 : static_cast<std::uint16_t>(1 + random() % 255);
    Octets wire = encoded(data);
    EXPECT_EQ(std::count(wire.begin(), wire.end(), 0), 0);
    const std::uint16_t n = cobs_decode(wire.data(), length(wire));
    ASSERT_EQ(n, data.size());
    wire.resize(n);
    EXPECT_EQ(wire, data);
  }
}

TEST(Cobs, WhatIsNoEncodingIsRefused) {
  for (Octets wire : {Octets{}, Octets{0}, Octets{2}, Octets{3, 1}, Octets{2, 0}, Octets{1, 5, 1}, Octets{0xFF, 1}}) {
    EXPECT_EQ(cobs_decode(wire.data(), length(wire)), COBS_MALFORMED);
  }
}

TEST(Octets, NumbersAreLittleEndianAndEndsAreNoticed) {
  Octets block(9, 0xEEEE);
  octet_writer_t w = octet_writer(block.data(), 8);
  put_u8(&w, 0x1FE);
  put_u16(&w, 0x1234);
  put_i32(&w, -2);
  EXPECT_FALSE(w.full);
  put_text(&w, "ab");
  EXPECT_TRUE(w.full);
  EXPECT_EQ(block, (Octets{0xFE, 0x34, 0x12, 0xFE, 0xFF, 0xFF, 0xFF, 'a', 0xEEEE}));
  octet_reader_t r = octet_reader(block.data(), 8);
  EXPECT_EQ(take_u8(&r), 0xFE);
  EXPECT_EQ(take_u16(&r), 0x1234);
  EXPECT_EQ(take_i32(&r), -2);
  EXPECT_FALSE(octets_fit(&r)) << "one is left";
  EXPECT_EQ(take_u8(&r), 'a');
  EXPECT_TRUE(octets_fit(&r));
  EXPECT_EQ(take_u32(&r), 0u);
  EXPECT_FALSE(octets_fit(&r));
}

TEST(Record, NoneIsLongerThanItsRoom) {
  Octets longest(RECORD_MAX + 1u, 7);
  ASSERT_EQ(record_seal(longest.data(), RECORD_MAX - 2u), RECORD_MAX);
  EXPECT_EQ(record_open(longest.data(), RECORD_MAX), RECORD_MAX - 2u);
  ASSERT_EQ(record_seal(longest.data(), RECORD_MAX - 1u), RECORD_MAX + 1u);
  EXPECT_EQ(record_open(longest.data(), RECORD_MAX + 1u), 0u) << "although its check sum is right";
}

TEST(Record, NoneIsShorterThanTypeAndTag) {
  Octets shortest = {0x08, 0x21, 0, 0};
  ASSERT_EQ(record_seal(shortest.data(), 1), 3);
  EXPECT_EQ(record_open(shortest.data(), 3), 0) << "although its check sum is right";
  ASSERT_EQ(record_seal(shortest.data(), 2), 4);
  EXPECT_EQ(record_open(shortest.data(), 4), 2);
}

TEST(Record, OneFlippedBitIsAlwaysNoticed) {
  Octets record = {0x08, 0x21, 1, 2, 3, 0, 0};
  ASSERT_EQ(record_seal(record.data(), 5), 7);
  EXPECT_EQ(record_open(record.data(), 7), 5);
  for (std::size_t at = 0; at < record.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Octets damaged = record;
      damaged[at] = static_cast<std::uint16_t>(damaged[at] ^ (1u << bit));
      EXPECT_EQ(record_open(damaged.data(), 7), 0) << at << ", bit " << bit;
    }
  }
  EXPECT_EQ(record_open(record.data(), 3), 0);
}

}  // namespace
