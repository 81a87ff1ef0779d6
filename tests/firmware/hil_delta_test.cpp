// Words against those before: what they become, and that they come back.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "firmware/hil/delta.h"

namespace {

using Words = std::vector<std::uint16_t>;

Words put(const Words& words, const Words& before) {
  Words octets(4 * words.size() + 1);
  octet_writer_t w = octet_writer(octets.data(), static_cast<std::uint16_t>(octets.size()));
  delta_put(&w, words.data(), before.data(), static_cast<std::uint16_t>(words.size()));
  EXPECT_FALSE(w.full);
  octets.resize(w.count);
  return octets;
}

Words take(const Words& octets, const Words& before, bool* fits = nullptr) {
  Words words(before.size());
  octet_reader_t r = octet_reader(octets.data(), static_cast<std::uint16_t>(octets.size()));
  delta_take(&r, words.data(), before.data(), static_cast<std::uint16_t>(before.size()));
  if (fits != nullptr) *fits = octets_fit(&r);
  return words;
}

TEST(HilDelta, NothingNewIsAnOctetForEightWords) {
  EXPECT_EQ(put(Words(8, 4711), Words(8, 4711)), Words({0}));
  EXPECT_EQ(put(Words(9, 4711), Words(9, 4711)), Words({0, 0}));
  EXPECT_EQ(put({}, {}), Words());
}

TEST(HilDelta, SmallDifferencesOfEitherSignAreOneOctet) {
  EXPECT_EQ(put({101, 99, 100, 163, 36}, Words(5, 100)), Words({0b11011, 2, 1, 126, 127}));
  EXPECT_EQ(put({164, 36 - 1}, Words(2, 100)), Words({3, 0x80, 1, 0x81, 1}));
}

TEST(HilDelta, TheWidestDifferenceIsThreeOctets) {
  EXPECT_EQ(put({0x8000}, {0}), Words({1, 0xFF, 0xFF, 3}));
  EXPECT_EQ(put({0}, {1}), Words({1, 1})) << "modulo 65536";
  EXPECT_EQ(put({0}, {65535}), Words({1, 2}));
}

TEST(HilDelta, EveryDifferenceComesBack) {
  for (std::uint32_t difference = 0; difference < 65536; difference++) {
    const Words before{40000}, words{static_cast<std::uint16_t>(40000 + difference)};
    ASSERT_EQ(take(put(words, before), before), words) << difference;
  }
}

TEST(HilDelta, ListsComeBackAsAWhole) {
  std::mt19937 random(1);
  for (int k = 0; k < 2000; k++) {
    Words before(random() % 40), words;
    for (auto& word : before) word = static_cast<std::uint16_t>(random());
    for (const auto word : before)
      words.push_back(static_cast<std::uint16_t>(word + (random() % 3 - 1) * (random() % 9000)));
    bool fits = false;
    ASSERT_EQ(take(put(words, before), before, &fits), words);
    ASSERT_TRUE(fits);
  }
}

TEST(HilDelta, WhatIsCutOffOrEndlessIsNoticed) {
  bool fits = true;
  (void)take({1, 0xFF, 0xFF}, {0}, &fits);
  EXPECT_FALSE(fits) << "the third octet is missing";
  (void)take({1, 0xFF, 0xFF, 0xFF, 0xFF}, {0}, &fits);
  EXPECT_FALSE(fits) << "an octet is left";
  (void)take({}, {0}, &fits);
  EXPECT_FALSE(fits);
}

}  // namespace
