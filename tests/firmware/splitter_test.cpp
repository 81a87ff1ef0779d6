// How text and records are told apart, whatever is lost or damaged between them.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/firmware/link_octets.hpp"

extern "C" {
#include "firmware/link/record.h"
#include "firmware/link/splitter.h"
}

namespace {

using namespace stillspin::test;

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
