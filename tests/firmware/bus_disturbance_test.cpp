// Any frames on the CAN bus, from a generator with a fixed seed: `make fuzz` looks further.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/fuzz/play_bus.hpp"

namespace {

TEST(BusDisturbance, AnyFrames) {
  std::mt19937 random(13);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<std::uint8_t> octets(random() % 400);
    for (auto& o : octets) o = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : random() % 8);
    ASSERT_EQ(stillspin::test::play_bus(octets.data(), octets.size()), "") << trial;
  }
}

// Found by the search: a whole STOP whose alive counter is that of the command that comes next.
TEST(BusDisturbance, AStopThatIsNoChange) {
  const std::uint8_t octets[] = {0x04, 0x00, 0x00, 0x00, 0x00, 0x04, 0x2D, 0x24, 0x2D, 0x0C};
  EXPECT_EQ(stillspin::test::play_bus(octets, sizeof octets), "");
}

}  // namespace
