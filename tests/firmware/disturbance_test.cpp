// Any octets on the serial port, from a generator with a fixed seed: `make fuzz` looks further.

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "tests/fuzz/play.hpp"

namespace {

using stillspin::test::play;

std::string judged(const std::vector<std::uint8_t>& octets) { return play(octets.data(), octets.size()); }

TEST(Disturbance, AnyOctets) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<std::uint8_t> octets(random() % 300);
    for (auto& o : octets) o = static_cast<std::uint8_t>(random());
    ASSERT_EQ(judged(octets), "") << trial;
  }
}

TEST(Disturbance, WordsAndRecordsInAnyOrder) {
  std::mt19937 random(12);
  const char* const words[] = {"list\r",       "help ",
                               "set ",         "speed_ramp ",
                               "get ",         "start free\r",
                               "start hold\r", "commission start free\r",
                               "stop\r",       "ref ",
                               "600 ",         "rpm\r",
                               "\r",           "watch\r",
                               "faults\r",     "\x03",
                               "scope ",       "channels speed\r",
                               "trigger",      " now",
                               "arm ",         "print 1\r",
                               "commission ",  "\x1B[A",
                               "-1.5",         "status\r"};
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<std::uint8_t> octets;
    for (unsigned n = random() % 60; n > 0; --n) {
      const char* const word = words[random() % std::size(words)];
      octets.insert(octets.end(), word, word + std::strlen(word));
      if (random() % 3 == 0) {
        const auto length = static_cast<std::uint8_t>(2 + random() % 20);
        octets.insert(octets.end(), {0xFD, length, static_cast<std::uint8_t>(random() % 0x18)});
        for (int k = 1; k < length; ++k)
          octets.push_back(static_cast<std::uint8_t>(random() % 4 ? random() % 16 : random()));
      }
      if (random() % 5 == 0) octets.insert(octets.end(), {0xFE, static_cast<std::uint8_t>(random() % 120)});
      if (random() % 9 == 0) octets.insert(octets.end(), {0xFC, static_cast<std::uint8_t>(random())});
      if (random() % 9 == 0) octets.push_back(static_cast<std::uint8_t>(random()));
    }
    ASSERT_EQ(judged(octets), "") << trial;
  }
}

}  // namespace
