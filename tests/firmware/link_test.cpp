// Records on the wire: check sums, stuffing, and how text and records are told apart.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

extern "C" {
#include "firmware/link/cobs.h"
#include "firmware/link/crc.h"
#include "firmware/link/octets.h"
#include "firmware/link/record.h"
#include "firmware/link/splitter.h"
}

namespace {

using Octets = std::vector<std::uint16_t>;

Octets from_text(const std::string& text) { return Octets(text.begin(), text.end()); }

std::uint16_t length(const Octets& o) { return static_cast<std::uint16_t>(o.size()); }

TEST(Crc, TheCataloguesCheckValues) {
  const Octets check = from_text("123456789");
  EXPECT_EQ(crc16(check.data(), 9), 0x29B1u);
  EXPECT_EQ(crc32(check.data(), 9), 0xCBF43926u);
  EXPECT_EQ(crc16(check.data(), 0), 0xFFFFu);
  EXPECT_EQ(crc32(check.data(), 0), 0u);
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
    EXPECT_EQ(crc32(octets.data(), length(octets)), ~wide);
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

/// What comes out of a splitter: text as it is, records in brackets, their octets in hexadecimal.
class Splitter : public testing::Test {
 protected:
  void SetUp() override { splitter_reset(&s); }

  void note(std::int16_t found) {
    if (found == SPLITTER_RECORD) {
      static const char digits[] = "0123456789ABCDEF";
      seen += '[';
      for (int k = 0; k < s.count; ++k) {
        seen += digits[(s.octets[k] >> 4) & 15];
        seen += digits[s.octets[k] & 15];
      }
      seen += ']';
    }
    for (int k = 0; k < found; ++k) seen += static_cast<char>(s.octets[k]);
  }

  void feed(const Octets& octets) {
    for (const std::uint16_t o : octets) note(splitter_octet(&s, o, now));
  }
  void feed(const std::string& text) { feed(from_text(text)); }

  void rest(std::uint32_t ms) {
    now += ms;
    note(splitter_rest(&s, now));
  }

  static Octets wire(Octets record) {
    const std::uint16_t n = length(record);
    record.resize(RECORD_MAX);
    Octets out(RECORD_ENCODED_MAX + 2);
    out.resize(record_to_wire(record.data(), n, out.data()));
    return out;
  }

  splitter_t s;
  std::uint32_t now = 0xFFFFFFC0u;  // the clock wraps in these tests
  std::string seen;
};

TEST_F(Splitter, TextAndRecordsMixed) {
  feed("get speed\r");
  feed(wire({0x08, 0x01}));
  feed("x");
  feed(wire({0x08, 0x00, 0x00}));
  feed(wire({0x09, 0x02}));
  feed("y");
  EXPECT_EQ(seen, "get speed\r[0801]x[080000][0902]y");
}

TEST_F(Splitter, ADamagedRecordIsCountedAndTheNextOneTaken) {
  Octets bad = wire({0x08, 0x01, 0x55});
  bad[3] ^= 2;  // not to a zero, which would end it
  feed(bad);
  feed(wire({0x08, 0x02}));
  feed("stop\r");
  EXPECT_EQ(seen, "[0802]stop\r");
  EXPECT_EQ(s.errors.damaged, 1);
}

TEST_F(Splitter, DamagedRecordsAreCountedToTheEndOfAWord) {
  for (int k = 0; k < 65536; ++k) feed(Octets{0, 9, 1, 0});
  EXPECT_EQ(s.errors.damaged, 65535) << "none is no count to come back to";
}

TEST_F(Splitter, AnOctetByItselfIsADamagedRecord) {
  feed(Octets{0, 1, 0});
  EXPECT_EQ(s.errors.damaged, 1);
  EXPECT_EQ(seen, "");
}

// Whichever octet of two records is lost, at most these two are, and text and records stay what they are.
TEST_F(Splitter, ALostOctetDoesNotTurnRecordsIntoTextForLong) {
  Octets both = wire({0x08, 0x01, 0x33});
  const Octets second = wire({0x08, 0x02, 0x44});
  both.insert(both.end(), second.begin(), second.end());
  for (std::size_t lost = 0; lost < both.size(); ++lost) {
    SetUp();
    Octets damaged = both;
    damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(lost));
    feed(damaged);
    rest(SPLITTER_REST_MS);
    seen.clear();
    feed(wire({0x08, 0x03}));
    feed("stop\r");
    EXPECT_EQ(seen, "[0803]stop\r") << lost;
  }
}

TEST_F(Splitter, ARecordThatRestsIsDropped) {
  feed(Octets{0, 5, 1, 2});
  rest(SPLITTER_REST_MS - 1);
  feed(Octets{3});  // it goes on: the time begins anew
  rest(SPLITTER_REST_MS - 1);
  feed(Octets{4});
  EXPECT_EQ(s.errors.broken_off, 0);
  rest(SPLITTER_REST_MS);
  EXPECT_EQ(s.errors.broken_off, 1);
  feed("stop\r");
  EXPECT_EQ(seen, "stop\r");
}

TEST_F(Splitter, TextBehindAStrayZeroIsNotLost) {
  feed(Octets{0});
  feed("stop\r\n");
  EXPECT_EQ(seen, "");
  rest(SPLITTER_REST_MS);
  EXPECT_EQ(seen, "stop\r\n");
  EXPECT_EQ(s.errors.broken_off, 0);
}

// What can be typed is text: everything printable and the ends of lines.
TEST_F(Splitter, OnlyWhatCanBePrintedIsTextBehindAStrayZero) {
  for (std::uint16_t octet = 1; octet < 256; ++octet) {
    SetUp();
    seen.clear();
    const bool text = (octet >= ' ' && octet <= '~') || octet == '\r' || octet == '\n';
    feed(Octets{0, 'a', octet, 'b'});
    rest(SPLITTER_REST_MS);
    EXPECT_EQ(seen, text ? std::string("a") + static_cast<char>(octet) + "b" : "") << octet;
    EXPECT_EQ(s.errors.broken_off, text ? 0 : 1) << octet;
  }
}

TEST_F(Splitter, LongTextBehindAStrayZeroIsNotLostEither) {
  std::string text;
  while (text.size() < 700) text += "set speed_ramp 300\r";
  feed(Octets{0});
  feed(text);
  EXPECT_EQ(seen, text);
}

TEST_F(Splitter, ARecordThatIsTooLongIsSkippedToItsEnd) {
  Octets flood(1000, 0x80);
  feed(Octets{0});
  feed(flood);
  EXPECT_EQ(s.errors.too_long, 1);
  feed(wire({0x08, 0x07}));
  feed("a");
  EXPECT_EQ(seen, "[0807]a");
}

// One that has been counted and is skipped is not broken off on top.
TEST_F(Splitter, ARecordThatIsTooLongIsCountedOnce) {
  feed(Octets{0});
  feed(Octets(1000, 0x80));
  rest(SPLITTER_REST_MS);
  EXPECT_EQ(s.errors.too_long, 1);
  EXPECT_EQ(s.errors.broken_off, 0);
  EXPECT_EQ(s.errors.damaged, 0);
  feed("stop\r");
  EXPECT_EQ(seen, "stop\r") << "and text is expected again";
}

TEST_F(Splitter, ARecordMayHaveSoManyOctetsAndNotOneMore) {
  feed(Octets{0});
  feed(Octets(RECORD_ENCODED_MAX, 0x80));
  EXPECT_EQ(s.errors.too_long, 0);
  feed(Octets{0x80});
  EXPECT_EQ(s.errors.too_long, 1);
}

TEST_F(Splitter, AResetForgetsARecordThatHadBegun) {
  feed(Octets{0, 9, 1, 0});
  feed(Octets(1000, 0x80));
  splitter_reset(&s);
  EXPECT_EQ(s.errors.damaged + s.errors.too_long + s.errors.broken_off, 0);
  feed("a");
  EXPECT_EQ(seen, "a") << "text at once";
  feed(wire({0x08, 0x04}));
  EXPECT_EQ(seen, "a[0804]");
}

TEST_F(Splitter, TheLongestRecordFits) {
  Octets longest(RECORD_MAX - 2, 0xA5);
  feed(wire(longest));
  EXPECT_EQ(s.count, RECORD_MAX - 2);
  EXPECT_EQ(seen.size(), 2 * (RECORD_MAX - 2) + 2);
}

TEST_F(Splitter, OrderIsFoundAgainAfterAnyOctets) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    const unsigned zeros = 1 + random() % 60;
    for (unsigned n = random() % 400; n > 0; --n) {
      feed(Octets{static_cast<std::uint16_t>(random() % zeros == 0 ? 0 : random() % 256)});
      if (random() % 50 == 0) rest(random() % 150);
    }
    rest(SPLITTER_REST_MS);
    seen.clear();
    feed("stop\r");
    feed(wire({0x08, 0x03}));
    ASSERT_EQ(seen, "stop\r[0803]");
  }
}

}  // namespace
