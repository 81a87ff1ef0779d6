// The EEPROM on two lines that the test moves: pages, write cycles, wear, what a power cut leaves, a held line.

#include "sim_host/devices/eeprom.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stillspin::devices {
namespace {

class EepromLines : public ::testing::Test {
 protected:
  void lines(bool sda, bool scl) {
    now += 60;
    sda_ = sda;
    memory.drive(now, sda, scl);
  }
  bool sda() const { return sda_ && memory.lets_sda_go(); }

  void start() {
    lines(true, false);
    lines(true, true);
    lines(false, true);
    lines(false, false);
  }
  void stop() {
    lines(false, false);
    lines(false, true);
    lines(true, true);
  }
  bool clock(bool bit) {
    lines(bit, false);
    lines(bit, true);
    const bool level = sda();
    lines(bit, false);
    return level;
  }
  bool send(unsigned octet) {
    for (int n = 7; n >= 0; --n) (void)clock((octet >> n & 1u) != 0);
    return !clock(true);
  }
  unsigned receive(bool acknowledge) {
    unsigned octet = 0;
    for (int n = 0; n < 8; ++n) octet = octet << 1 | (clock(true) ? 1u : 0u);
    (void)clock(!acknowledge);
    return octet;
  }
  bool address(unsigned where) { return send(0xA0) && send(where >> 8) && send(where & 0xFF); }
  void write(unsigned where, const std::vector<unsigned>& octets) {
    start();
    ASSERT_TRUE(address(where));
    for (const unsigned octet : octets) ASSERT_TRUE(send(octet));
    stop();
  }
  void rest(Tick t = Eeprom::kWriteCycle) {
    now += t;
    memory.drive(now, true, true);
  }
  static std::vector<unsigned> ramp(unsigned count, unsigned first) {
    std::vector<unsigned> octets(count);
    for (unsigned n = 0; n < count; ++n) octets[n] = (first + n) & 0xFF;
    return octets;
  }

  Eeprom memory;
  Tick now = 0;
  bool sda_ = true;
};

TEST_F(EepromLines, AnswersToItsAddressAlone) {
  start();
  EXPECT_TRUE(send(0xA0));
  for (const unsigned other : {0xA2u, 0xAEu, 0x50u, 0x00u}) {
    start();
    EXPECT_FALSE(send(other)) << other;
    EXPECT_FALSE(send(0)) << "and not to what follows";
  }
  stop();
}

TEST_F(EepromLines, WritesAPageAtTheStop) {
  write(0x100, {1, 2, 3});
  EXPECT_EQ(memory.memory()[0x100], 0xFF) << "not before the write cycle is over";
  rest();
  EXPECT_EQ(memory.memory()[0x100], 1);
  EXPECT_EQ(memory.memory()[0x102], 3);
  EXPECT_EQ(memory.memory()[0x103], 0xFF);
  EXPECT_EQ(memory.wear(4), 1u);
  EXPECT_EQ(memory.wear(5), 0u);
}

TEST_F(EepromLines, WrapsInsideThePage) {
  write(0x13E, ramp(66, 0));
  rest();
  EXPECT_EQ(memory.memory()[0x13E], 64);  // overwritten by the second round
  EXPECT_EQ(memory.memory()[0x13F], 65);
  EXPECT_EQ(memory.memory()[0x100], 2);
  EXPECT_EQ(memory.memory()[0x13D], 63);
  EXPECT_EQ(memory.memory()[0x140], 0xFF);
}

TEST_F(EepromLines, DoesNotAnswerWhileItWrites) {
  write(0, {1});
  rest(Eeprom::kWriteCycle - 3000);
  start();
  EXPECT_FALSE(send(0xA0));
  stop();
  rest(4000);
  start();
  EXPECT_TRUE(send(0xA0));
  stop();
}

TEST_F(EepromLines, AStartBeforeTheStopWritesNothing) {
  start();
  ASSERT_TRUE(address(0));
  ASSERT_TRUE(send(0x12));
  start();
  stop();
  rest();
  EXPECT_EQ(memory.write_cycles(), 0u);
  EXPECT_EQ(memory.memory()[0], 0xFF);
}

TEST_F(EepromLines, ReadsOnRoundTheMemory) {
  for (unsigned n = 0; n < Eeprom::kSize; ++n) memory.memory()[n] = static_cast<std::uint8_t>(n * 37 + n / 256);
  start();
  ASSERT_TRUE(address(Eeprom::kSize - 2));
  start();
  ASSERT_TRUE(send(0xA1));
  for (const unsigned at : {Eeprom::kSize - 2, Eeprom::kSize - 1, 0u, 1u})
    EXPECT_EQ(receive(at != 1u), memory.memory()[at]);
  stop();
  start();
  ASSERT_TRUE(send(0xA1));
  EXPECT_EQ(receive(false), memory.memory()[2]) << "the counter stays where it was";
  stop();
}

TEST_F(EepromLines, WhatAPowerCutLeaves) {
  struct Case {
    Eeprom::Torn torn;
    unsigned first, last;  // of a page that was 1..64 and becomes 101..164
  };
  for (const Case& c :
       {Case{Eeprom::Torn::kOld, 1, 64}, Case{Eeprom::Torn::kNew, 101, 164}, Case{Eeprom::Torn::kFirstHalf, 101, 64},
        Case{Eeprom::Torn::kLastHalf, 1, 164}, Case{Eeprom::Torn::kErased, 0xFF, 0xFF}}) {
    for (unsigned n = 0; n < 64; ++n) memory.memory()[n] = static_cast<std::uint8_t>(1 + n);
    memory.cut_in_write_cycle(1, c.torn);
    write(0, ramp(64, 101));
    EXPECT_FALSE(memory.is_on());
    EXPECT_EQ(memory.memory()[0], c.first);
    EXPECT_EQ(memory.memory()[63], c.last);
    start();
    EXPECT_FALSE(send(0xA0)) << "without power";
    stop();
    memory.power_on();
  }
  EXPECT_EQ(memory.wear(0), 5u);
}

TEST_F(EepromLines, AMixedPageIsTheSameForTheSameSeed) {
  std::vector<std::uint8_t> pages[3];
  for (int n = 0; n < 3; ++n) {
    memory.memory().assign(Eeprom::kSize, 0);
    memory.cut_in_write_cycle(1, Eeprom::Torn::kMixed, n < 2 ? 7 : 8);
    write(0, ramp(64, 101));
    memory.power_on();
    pages[n].assign(memory.memory().begin(), memory.memory().begin() + 64);
    const auto old = std::count(pages[n].begin(), pages[n].end(), 0);
    EXPECT_GT(old, 5);
    EXPECT_LT(old, 60);
  }
  EXPECT_EQ(pages[0], pages[1]);
  EXPECT_NE(pages[0], pages[2]);
}

TEST_F(EepromLines, PowerCutBetweenOctetsWritesNothing) {
  for (unsigned cut = 1; cut <= 6; ++cut) {
    memory.cut_after_octets(cut);
    start();
    (void)address(0);
    for (unsigned n = 0; n < 4; ++n) (void)send(n);
    stop();
    EXPECT_FALSE(memory.is_on()) << cut;
    memory.power_on();
    rest();
  }
  EXPECT_EQ(memory.write_cycles(), 0u);
}

TEST_F(EepromLines, AHeldLineComesFreeWithTheClock) {
  memory.hold_sda(3);
  EXPECT_FALSE(sda());
  EXPECT_FALSE(clock(true));
  EXPECT_FALSE(clock(true));
  EXPECT_TRUE(clock(true));
}

}  // namespace
}  // namespace stillspin::devices
