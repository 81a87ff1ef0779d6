// A slot of the store as it lies in the memory: its octets, its order, and what is blank.

#include <algorithm>
#include <iterator>

#include "tests/firmware/store.hpp"

namespace {

using namespace stillspin::test;

TEST(Slot, SequenceIsComparedAcrossTheWrap) {
  EXPECT_TRUE(slot_is_newer(2, 1));
  EXPECT_FALSE(slot_is_newer(1, 2));
  EXPECT_FALSE(slot_is_newer(7, 7));
  EXPECT_TRUE(slot_is_newer(0, 0xFFFFFFFFu));
  EXPECT_FALSE(slot_is_newer(0xFFFFFFFFu, 0));
  for (const std::uint32_t from : {0u, 5u, 0x80000000u, 0xFFFFFFFEu}) {
    EXPECT_TRUE(slot_is_newer(from + 0x7FFFFFFFu, from)) << "half of the circle is ahead";
    EXPECT_FALSE(slot_is_newer(from + 0x80000001u, from)) << "the other half behind";
  }
}

// Other firmwares and the host's tools read it: the octets, not only what the drive reads back.
TEST(Slot, ItsOctetsAreTheDocumentedOnes) {
  const slot_header_t header = {SLOT_MAGIC, 0x0102, 0x0304, 0x05060708, 0x0304};
  std::uint16_t octets[SLOT_HEADER];
  slot_pack_header(&header, octets);
  const std::vector<std::uint16_t> expected = {'S', 'S', 'P', '1', 2, 1, 4, 3, 8, 7, 6, 5, 4, 3, 0, 0};
  EXPECT_EQ(std::vector<std::uint16_t>(octets, octets + SLOT_HEADER), expected);
  const slot_entry_t entry = {0x0102, 31, -2};
  slot_pack_entry(&entry, octets);
  const std::vector<std::uint16_t> packed = {2, 1, 31, 0, 0xFE, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(std::vector<std::uint16_t>(octets, octets + SLOT_ENTRY), packed);
}

TEST(Slot, OnlyErasedOctetsAreBlank) {
  std::uint16_t octets[SLOT_HEADER];
  std::fill(std::begin(octets), std::end(octets), 0xFF);
  EXPECT_TRUE(slot_is_blank(octets));
  for (std::uint16_t& octet : octets) {
    octet = 0xFE;
    EXPECT_FALSE(slot_is_blank(octets));
    octet = 0xFF;
  }
}

}  // namespace
