// What a drive looks at before it trusts itself: memory, watchdog, gates.

#include <functional>
#include <set>

#include "hal/f2808/registers.h"
#include "hal/hal_selftest.h"
#include "tests/hal/bus.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kRam = 0x8000;
constexpr std::uint32_t kPasswords = 0x3F7FF8;
constexpr std::uint16_t kPair = 7;
constexpr std::uint32_t kFirst = kRam + 2 * kPair, kSecond = kFirst + 1;
}  // namespace

class SelfTest : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    bus.words[kFirst] = 0x1234;
    bus.words[kSecond] = 0xABCD;
  }
  std::set<std::uint32_t> reached(Op op) const {
    std::set<std::uint32_t> addresses;
    for (const Step& step : bus.steps) {
      if (step.op == op) addresses.insert(step.address);
    }
    return addresses;
  }
  /// What the test says of a memory in which `fault` acts behind every write, told where it went.
  bool passes_with(const std::function<void(std::uint32_t)>& fault) {
    bus.words[kFirst] = 0x1234;
    bus.words[kSecond] = 0xABCD;
    bus.between = [&] { fault(bus.steps.back().address); };
    const bool kept = hal_selftest_ram(kPair);
    bus.between = nullptr;
    return kept;
  }
  void set(std::uint32_t address, unsigned bit, bool level) {
    std::uint16_t& word = bus.words[address];
    word = static_cast<std::uint16_t>(level ? word | 1u << bit : word & ~(1u << bit));
  }
  bool is_set(std::uint32_t address, unsigned bit) { return (bus.words[address] >> bit & 1u) != 0; }
};

TEST_F(SelfTest, each_pair_is_its_own_two_words) {
  for (const std::uint16_t pair : {1, 7, 4096, 8191}) {
    bus.forget_steps();
    EXPECT_TRUE(hal_selftest_ram(pair));
    const std::uint32_t first = kRam + 2u * pair;
    EXPECT_EQ(reached(Op::kWrite), (std::set<std::uint32_t>{first, first + 1})) << "pair " << pair;
    EXPECT_EQ(reached(Op::kRead), reached(Op::kWrite));
  }
}

// The secured memories read as zero until the eight passwords have been read.
TEST_F(SelfTest, the_first_pair_opens_the_memory) {
  EXPECT_TRUE(hal_selftest_ram(0));
  std::set<std::uint32_t> expected{kRam, kRam + 1};
  for (std::uint32_t n = 0; n < 8; ++n) expected.insert(kPasswords + n);
  EXPECT_EQ(reached(Op::kRead), expected);
  EXPECT_EQ(bus.steps.at(0).address, kPasswords) << "before it is tested";
}

// An interrupt would find its variables on the checkerboard.
TEST_F(SelfTest, interrupts_are_held_off_while_the_words_are_others) {
  bus.ier = 0x0005;
  hal_selftest_ram(kPair);
  EXPECT_EQ(bus.ier, 0x0005);
  EXPECT_EQ(bus.steps.front().op, Op::kWriteIer);
  EXPECT_EQ(bus.steps.front().value, 0u);
  EXPECT_EQ(bus.steps.back().op, Op::kWriteIer);
}

TEST_F(SelfTest, bits_that_are_stuck_are_found) {
  for (const std::uint32_t word : {kFirst, kSecond}) {
    for (unsigned bit = 0; bit < 16; ++bit) {
      for (const bool level : {false, true}) {
        EXPECT_FALSE(passes_with([&](std::uint32_t) { set(word, bit, level); })) << word - kFirst << '.' << bit;
      }
    }
  }
  EXPECT_TRUE(passes_with([](std::uint32_t) {})) << "and a good memory is not";
}

TEST_F(SelfTest, bits_that_change_one_way_alone_are_found) {
  for (const std::uint32_t word : {kFirst, kSecond}) {
    for (unsigned bit = 0; bit < 16; ++bit) {
      for (const bool level : {false, true}) {
        bool was = !level;
        EXPECT_FALSE(passes_with([&](std::uint32_t) {
          if (was == level) set(word, bit, level);  // never left again
          was = is_set(word, bit);
        })) << word - kFirst
            << '.' << bit;
      }
    }
  }
}

// Either word's change, up or down, sets, clears or turns over a bit of the other.
TEST_F(SelfTest, bits_that_follow_a_neighbours_are_found) {
  for (const std::uint32_t aggressor : {kFirst, kSecond}) {
    const std::uint32_t victim = kFirst + kSecond - aggressor;
    for (const unsigned bit : {0u, 5u, 15u}) {
      for (const unsigned other : {0u, 5u, 6u, 15u}) {
        for (const bool up : {false, true}) {
          for (int effect = 0; effect < 3; ++effect) {
            bool was = up;
            EXPECT_FALSE(passes_with([&](std::uint32_t address) {
              const bool is = is_set(aggressor, bit);
              if (address == aggressor && is == up && was != up) {
                set(victim, other, effect == 2 ? !is_set(victim, other) : effect == 1);
              }
              was = is;
            })) << aggressor - kFirst
                << '.' << bit << (up ? " up" : " down") << " acts on " << other << ", effect " << effect;
          }
        }
      }
    }
  }
}

TEST_F(SelfTest, the_watchdogs_count_has_eight_bits) {
  bus.words[REG_WDCNTR] = 0xFF37;
  EXPECT_EQ(hal_selftest_watchdog_count(), 0x37);
}

// A memory that gives one word wrong, once: whichever of the test's reads it is.
TEST_F(SelfTest, every_read_of_the_memory_test_counts) {
  const std::uint32_t a = kRam + 2 * 7;
  bus.words[a] = 0x1234;
  bus.words[a + 1] = 0xABCD;
  int read = 0, wrong = 0;
  bus.spoils = [&](std::uint16_t word) { return static_cast<std::uint16_t>(word ^ (read++ == wrong ? 0x0040 : 0)); };
  const auto passes = [&](int n) {
    read = 0;
    wrong = n;
    return hal_selftest_ram(7);
  };
  EXPECT_TRUE(passes(-1));
  const int reads = read;
  ASSERT_EQ(reads, 12) << "two to be kept, two of each of four passes, two at the end";
  for (int n = 2; n < reads; ++n) EXPECT_FALSE(passes(n)) << "read " << n;
  EXPECT_TRUE(passes(-1));
  EXPECT_EQ(bus.words[a], 0x1234) << "what was there is there again";
  EXPECT_EQ(bus.words[a + 1], 0xABCD);
}

TEST_F(SelfTest, gates_are_off_when_every_one_of_their_pins_is_low) {
  bus.words[REG_GPADAT] = 0xFFC0;
  EXPECT_TRUE(hal_selftest_gates_are_off());
  for (unsigned pin = 0; pin < 6; ++pin) {
    bus.words[REG_GPADAT] = static_cast<std::uint16_t>(0xFFC0u | 1u << pin);
    EXPECT_FALSE(hal_selftest_gates_are_off()) << "GPIO" << pin;
  }
}

}  // namespace stillspin::test
