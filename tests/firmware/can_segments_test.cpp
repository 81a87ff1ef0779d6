// Records in pieces: whole, broken, and arbitrary frames.

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <vector>

#include "tests/firmware/can_frames.hpp"

namespace stillspin::test {
namespace {

std::vector<std::uint16_t> record_of(unsigned octets, unsigned seed = 1) {
  std::vector<std::uint16_t> record;
  for (unsigned k = 0; k < octets; ++k) record.push_back(static_cast<std::uint16_t>((seed + 7) * (k + 3) & 0xFF));
  return record;
}

class CanSegments : public ::testing::Test {
 protected:
  segment_joiner_t joiner = {};

  /// What comes out, one after the other.
  std::vector<std::vector<std::uint16_t>> join(const std::vector<hal_can_frame_t>& frames, std::uint32_t now = 0) {
    std::vector<std::vector<std::uint16_t>> records;
    for (const hal_can_frame_t& frame : frames) {
      if (segment_join(&joiner, &frame, now)) records.emplace_back(joiner.octets, joiner.octets + joiner.count);
    }
    return records;
  }
};

TEST_F(CanSegments, EveryLengthArrivesAsItWas) {
  for (unsigned octets = 2; octets <= RECORD_MAX - 2; ++octets) {
    const auto record = record_of(octets, octets);
    const auto frames = pieces_of(record);
    EXPECT_EQ(frames.size(), (octets + 2 + 6) / 7);
    const auto records = join(frames);
    ASSERT_EQ(records.size(), 1u) << octets;
    EXPECT_EQ(records[0], record);
  }
  EXPECT_EQ(joiner.dropped, 0u);
}

// The other end is another program: the two must not only agree with each other.
TEST_F(CanSegments, PiecesAreNumberedAndTheFirstAndTheLastAreMarked) {
  const auto frames = pieces_of(record_of(20));
  ASSERT_EQ(frames.size(), 4u);
  const std::uint16_t heads[] = {0x80, 0x01, 0x02, 0x43}, lengths[] = {8, 8, 8, 2};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(frames[k].data[0], heads[k]);
    EXPECT_EQ(frames[k].length, lengths[k]);
  }
  EXPECT_EQ(pieces_of(record_of(2)).at(0).data[0], 0xC0) << "the only one is both";
}

TEST_F(CanSegments, APieceStaysInItsFrame) {
  segment_splitter_t s = {};
  std::fill(std::begin(s.octets), std::end(s.octets), 0x5A);
  segment_split_begin(&s, 20, 0);
  hal_can_frame_t frames[2] = {};
  ASSERT_TRUE(segment_split_peek(&s, frames));
  EXPECT_EQ(frames[0].length, 8);
  EXPECT_EQ(frames[1].id, 0u) << "what lies behind it";
}

TEST_F(CanSegments, AnEmptyFrameIsNoPiece) {
  auto frames = pieces_of(record_of(30));
  frames.insert(frames.begin() + 2, hal_can_frame_t{0, false, 0, {SEGMENT_FIRST}});
  EXPECT_EQ(join(frames).size(), 1u);
}

TEST_F(CanSegments, ARecordThatIsBegunAnewIsDroppedAndCounted) {
  const auto good = pieces_of(record_of(30));
  EXPECT_TRUE(join({good[0], good[1]}).empty());
  EXPECT_EQ(join(good).size(), 1u);
  EXPECT_EQ(joiner.dropped, 1u);
  EXPECT_TRUE(join({good[1], good[2]}).empty());
  EXPECT_EQ(joiner.dropped, 1u) << "pieces of no record: which it was has been counted";
}

TEST_F(CanSegments, TheCountOfWhatWasDroppedStaysAtItsEnd) {
  const auto first = pieces_of(record_of(30))[0];
  for (std::uint32_t n = 0; n < 65'600; ++n) {
    ASSERT_EQ(joiner.dropped, std::min(n == 0 ? 0 : n - 1, 65'535u));
    (void)segment_join(&joiner, &first, 0);
  }
}

TEST_F(CanSegments, MissingRepeatedAndExchangedPiecesDropTheRecordAndNoMore) {
  const auto good = pieces_of(record_of(60, 5));
  for (std::size_t k = 0; k + 1 < good.size(); ++k) {
    for (int fault = 0; fault < 3; ++fault) {
      joiner = {};
      auto frames = good;
      if (fault == 0) frames.erase(frames.begin() + static_cast<long>(k));
      if (fault == 1) frames.insert(frames.begin() + static_cast<long>(k), frames[k]);
      if (fault == 2) std::swap(frames[k], frames[k + 1]);
      const auto broken = join(frames);
      if (fault == 1 && k == 0) {
        EXPECT_EQ(broken.size(), 1u) << "a first piece begins anew";
      } else {
        EXPECT_TRUE(broken.empty()) << "fault " << fault << " at " << k;
      }
      EXPECT_EQ(join(good).size(), 1u) << "the next record arrives";
    }
  }
}

TEST_F(CanSegments, ADamagedOctetIsFoundByTheRecordsCheckSum) {
  const auto good = pieces_of(record_of(30));
  for (std::size_t k = 0; k < good.size(); ++k) {
    auto frames = good;
    frames[k].data[1] ^= 0x10;
    EXPECT_TRUE(join(frames).empty());
  }
  EXPECT_EQ(joiner.dropped, good.size());
}

TEST_F(CanSegments, AnUnfinishedRecordIsForgotten) {
  auto frames = pieces_of(record_of(30));
  const auto last = frames.back();
  frames.pop_back();
  EXPECT_TRUE(join(frames, 1000).empty());
  segment_join_rest(&joiner, 1000 + SEGMENTS_REST_MS);
  EXPECT_EQ(joiner.dropped, 0u);
  segment_join_rest(&joiner, 1001 + SEGMENTS_REST_MS);
  EXPECT_EQ(joiner.dropped, 1u);
  EXPECT_TRUE(join({last}).empty());
}

TEST_F(CanSegments, AnEndlessRecordIsDroppedWithTheFirstOctetTooMany) {
  for (unsigned octets = 1; octets <= SEGMENT_OCTETS; ++octets) {
    joiner = {};
    hal_can_frame_t frame = {0, false, static_cast<std::uint16_t>(octets + 1), {SEGMENT_FIRST}};
    for (unsigned k = 0; k < RECORD_MAX + 10; ++k) {
      EXPECT_FALSE(segment_join(&joiner, &frame, 0));
      frame.data[0] = (k + 1) & SEGMENT_NUMBER;
      ASSERT_LE(joiner.count, RECORD_MAX);
      ASSERT_EQ(joiner.dropped, octets * (k + 1) > RECORD_MAX ? 1u : 0u) << octets;
    }
  }
}

TEST_F(CanSegments, AnyFramesLeaveItReadyForARecord) {
  std::mt19937 random(7);
  const auto good = pieces_of(record_of(100));
  for (int round = 0; round < 20'000; ++round) {
    std::vector<hal_can_frame_t> noise(random() % 60);
    for (hal_can_frame_t& frame : noise) {
      frame.length = static_cast<std::uint16_t>(random() % 9);
      for (auto& octet : frame.data) octet = random() & 0xFF;
      if (random() % 2 == 0) frame.data[0] = random() % 4;  // looks like a piece
    }
    (void)join(noise);
    ASSERT_LE(joiner.count, RECORD_MAX);
    ASSERT_EQ(join(good).size(), 1u);
  }
}

}  // namespace
}  // namespace stillspin::test
