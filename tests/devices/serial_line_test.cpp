// The far end of the serial port: when octets lie on the wire, and what it reads from the chip's frames.

#include "sim_host/devices/serial_line.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stillspin::devices {
namespace {

using chip::kNever;
using chip::SerialFrame;

/// An 8N1 frame as the chip reports it.
SerialFrame frame_of(unsigned octet, Tick bit) { return SerialFrame{0, bit, 10, octet << 1 | 1u << 9}; }

class SerialLineTest : public ::testing::Test {
 protected:
  void SetUp() override { line.set_rate(100000); }  // 1000 ticks a bit

  /// Ticks at which the level changes, from a high line on.
  std::vector<Tick> edges(Tick from) {
    std::vector<Tick> found;
    bool level = true;
    for (Tick t = line.reaches(from, false); t != kNever; t = line.reaches(t, !level)) {
      found.push_back(t);
      level = !level;
      if (level && line.reaches(t, false) == kNever) break;
    }
    return found;
  }

  SerialLine line;
};

TEST_F(SerialLineTest, RestsHigh) {
  EXPECT_EQ(line.reaches(5, true), 5);
  EXPECT_EQ(line.reaches(5, false), kNever);
  EXPECT_TRUE(line.level(5));
}

TEST_F(SerialLineTest, OctetLiesOnTheLineFromItsTickOn) {
  line.send({0x55}, 700);
  EXPECT_EQ(edges(0), (std::vector<Tick>{700, 1700, 2700, 3700, 4700, 5700, 6700, 7700, 8700, 9700}))
      << "start bit, then 1 0 1 0 1 0 1 0 and the stop bit";
}

TEST_F(SerialLineTest, LevelAndEdgesAgreeAtOddRates) {
  line.set_rate(115200);  // 868.06 ticks a bit
  line.send({0x55, 0xAA, 0x00, 0xFF, 0x31}, 13);
  SerialLine asked = line;
  bool level = true;
  Tick edge = asked.reaches(0, false);
  for (Tick t = 0; t < 45000; ++t) {
    if (t == edge) {
      level = !level;
      edge = asked.reaches(t, !level);
    }
    ASSERT_EQ(line.level(t), level) << t;
  }
}

TEST_F(SerialLineTest, OctetsFollowEachOtherWithoutAGapAndWithoutDrift) {
  line.set_rate(115200);
  const std::vector<std::uint8_t> octets(1000, 0xFF);
  line.send(octets, 0);
  EXPECT_EQ(line.sent_until(0), 8680556) << "10000 bits of 868.0556 ticks";
  line.send({0}, 100);
  EXPECT_EQ(line.reaches(8680000, false), 8680556);
}

TEST_F(SerialLineTest, BreakIsLowForItsLength) {
  line.send_break(25, 100);
  EXPECT_EQ(line.reaches(0, false), 100);
  EXPECT_EQ(line.reaches(100, true), 25100);
}

TEST_F(SerialLineTest, FramesFromTheChipArrive) {
  line.receive(frame_of('h', 1000));
  line.receive(frame_of('i', 1010));
  EXPECT_EQ(line.take(), (std::vector<std::uint8_t>{'h', 'i'}));
  EXPECT_TRUE(line.take().empty());
  EXPECT_EQ(line.counts().received, 2u);
  EXPECT_NEAR(line.chip_rate(), 1e8 / 1010, 1e-6);
}

TEST_F(SerialLineTest, RateUpToFourPercentOffIsRead) {
  // The stop bit's middle lies 9.5 bits behind the edge: half a bit of 9.5 is 5.3 %.
  for (const Tick bit : {960, 1040}) line.receive(frame_of(0xA5, bit));
  EXPECT_EQ(line.take(), (std::vector<std::uint8_t>{0xA5, 0xA5}));
  line.receive(frame_of(0x00, 1100));
  EXPECT_EQ(line.counts().framing_errors, 1u) << "the last data bit stands where the stop bit is looked for";
  EXPECT_TRUE(line.take().empty());
}

TEST_F(SerialLineTest, NoiseIsSeeded) {
  const auto levels = [](std::uint64_t seed) {
    SerialLine noisy;
    noisy.set_noise(0.1, seed);
    noisy.send(std::vector<std::uint8_t>(50, 0x5A), 0);
    std::vector<bool> bits;
    for (Tick t = 434; t < noisy.sent_until(0); t += 868) bits.push_back(noisy.level(t));
    return bits;
  };
  EXPECT_EQ(levels(1), levels(1));
  EXPECT_NE(levels(1), levels(2));
}

TEST_F(SerialLineTest, ImpossibleRatesAreRefused) {
  EXPECT_THROW(line.set_rate(0), std::invalid_argument);
  EXPECT_THROW(line.set_noise(1.5, 1), std::invalid_argument);
}

}  // namespace
}  // namespace stillspin::devices
