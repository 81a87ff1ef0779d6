// The bus: length of frames, arbitration, acknowledgment, errors and what unplugged or shorted wires do.

#include "sim_host/devices/can_bus.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "sim_host/devices/can_frame.hpp"
#include "sim_host/devices/can_host.hpp"

namespace stillspin::devices {
namespace {

constexpr std::uint32_t kRate = 500'000;
constexpr Tick kBit = 200;

CanFrame frame_of(std::uint32_t id, std::initializer_list<std::uint8_t> data, bool extended = false) {
  CanFrame frame;
  frame.id = id;
  frame.extended = extended;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

class Bus : public ::testing::Test {
 protected:
  CanBus bus;
  CanHost a{bus, 0}, b{bus, 0}, c{bus, 0};
  Tick now = 0;

  void SetUp() override {
    for (CanHost* host : {&a, &b, &c}) host->set_bit_rate(kRate, 0);
  }
  void run(Tick ticks) {
    const Tick end = now + ticks;
    while (bus.next_event() <= end) {
      ASSERT_GE(bus.next_event(), now) << "events in order";
      now = bus.next_event();
      bus.run_event(now);
    }
    now = end;
  }
};

TEST(CanFrame, shortest_and_longest_have_the_bits_that_the_standard_gives_them) {
  // Without data 44 bits plus stuffing; identifier 0x555 and a length of 0 stuff little: counted by hand with the CRC.
  CanFrame empty = frame_of(0x555, {});
  EXPECT_GE(can_frame_bits(empty), 44);
  EXPECT_LE(can_frame_bits(empty), 44 + 8);
  // Worst case of ISO 11898: 8 n + 44 + (34 + 8 n - 1) / 4 bits, 8 n + 64 + (54 + 8 n - 1) / 4 when extended.
  for (unsigned seed = 0; seed < 20'000; ++seed) {
    CanFrame f;
    std::uint64_t x = (seed + 1) * 0x9E3779B97F4A7C15ull;
    f.extended = (x & 1) != 0;
    f.length = static_cast<std::uint8_t>(x >> 1 & 7u) + (x >> 4 & 1u);
    f.id = static_cast<std::uint32_t>(x >> 8) & (f.extended ? 0x1FFFFFFFu : 0x7FFu);
    for (unsigned i = 0; i < f.length; ++i) f.data[i] = seed % 3 == 0 ? 0 : static_cast<std::uint8_t>(x >> 7 * i);
    const int n = f.length;
    const int least = (f.extended ? 64 : 44) + 8 * n;
    const int most = least + ((f.extended ? 54 : 34) + 8 * n - 1) / 4;
    ASSERT_GE(can_frame_bits(f), least);
    ASSERT_LE(can_frame_bits(f), most);
  }
}

// The CRC of a known frame (Bosch CAN 2.0: id 0x000, no data) is 0: 1 + 11 + 3 + 4 + 15 zeros, a stuff bit after every
// five equal bits, itself counted for the next run.
TEST(CanFrame, a_frame_of_zeros_is_stuffed_by_rule) {
  // 34 dominant bits: 5 d, r, then 5 d, r, ...: a stuff bit after each full five, six of them.
  EXPECT_EQ(can_frame_bits(frame_of(0, {})), 34 + 6 + kCanTailBits);
}

TEST(CanFrame, arbitration_prefers_small_identifiers_data_and_standard_frames) {
  CanFrame remote = frame_of(0x100, {});
  remote.remote = true;
  EXPECT_LT(can_arbitration_key(frame_of(0x0FF, {})), can_arbitration_key(frame_of(0x100, {})));
  EXPECT_LT(can_arbitration_key(frame_of(0x100, {})), can_arbitration_key(remote));
  EXPECT_LT(can_arbitration_key(remote), can_arbitration_key(frame_of(0x100u << 18, {}, true)));
  EXPECT_LT(can_arbitration_key(frame_of(0x100u << 18 | 5, {}, true)), can_arbitration_key(frame_of(0x101, {})));
}

TEST_F(Bus, a_frame_arrives_everywhere_at_its_last_bit) {
  const CanFrame frame = frame_of(0x123, {1, 2, 3});
  a.send(frame, 1000);
  run(100'000);
  const Tick end = 1000 + can_frame_bits(frame) * kBit;
  for (CanHost* host : {&b, &c}) {
    const auto heard = host->take_heard(now);
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(heard[0].frame, frame);
    EXPECT_EQ(heard[0].t, end);
  }
  EXPECT_TRUE(a.take_heard(now).empty()) << "nobody hears himself";
  EXPECT_EQ(a.sent(), 1u);
}

TEST_F(Bus, the_smaller_identifier_goes_first_and_nothing_is_lost) {
  a.send(frame_of(0x300, {}), 0);
  b.send(frame_of(0x200, {}), 0);
  c.send(frame_of(0x100, {}), 0);
  run(200'000);
  std::vector<std::uint32_t> order;
  for (const auto& heard : a.take_heard(now)) order.push_back(heard.frame.id);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0x100, 0x200}));
  EXPECT_EQ(bus.frames(), 3u);
  EXPECT_EQ(bus.broken_frames(), 0u);
}

TEST_F(Bus, three_bits_lie_between_frames) {
  const CanFrame frame = frame_of(0x7, {0xFF});
  a.send(frame, 0);
  a.send(frame, 0);
  run(100'000);
  const auto heard = b.take_heard(now);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[1].t - heard[0].t, (can_frame_bits(frame) + kCanIntermissionBits) * kBit);
}

TEST_F(Bus, alone_it_becomes_passive_and_never_bus_off) {
  b.set_bit_rate(0, 0);
  c.set_bit_rate(0, 0);
  a.send(frame_of(1, {}), 0);
  run(chip::kTicksPerSecond / 10);
  EXPECT_EQ(a.errors().transmit(), chip::CanErrorCounters::kPassive);
  EXPECT_EQ(a.sent(), 0u);
  b.set_bit_rate(kRate, now);
  run(100'000);
  EXPECT_EQ(a.sent(), 1u) << "somebody listens now";
  EXPECT_EQ(a.errors().transmit(), chip::CanErrorCounters::kPassive - 1);
}

TEST_F(Bus, listening_is_not_acknowledging) {
  b.set_listening_only(true);
  c.set_bit_rate(0, 0);
  a.send(frame_of(1, {}), 0);
  run(200'000);
  EXPECT_EQ(a.sent(), 0u);
  c.set_bit_rate(kRate, now);
  run(200'000);
  EXPECT_EQ(a.sent(), 1u);
  EXPECT_EQ(b.take_heard(now).size(), 1u) << "heard once it was acknowledged by another";
}

TEST_F(Bus, two_with_the_same_identifier_and_other_data_destroy_each_other) {
  a.send(frame_of(0x10, {1}), 0);
  b.send(frame_of(0x10, {2}), 0);
  run(10'000);
  EXPECT_GT(a.errors().transmit(), 0u);
  EXPECT_GT(b.errors().transmit(), 0u);
  EXPECT_GT(bus.broken_frames(), 0u);
}

TEST_F(Bus, a_node_of_another_rate_destroys_frames_until_it_is_passive) {
  c.set_bit_rate(250'000, 0);
  a.send(frame_of(0x10, {1}), 0);
  run(chip::kTicksPerSecond / 10);
  EXPECT_EQ(a.sent(), 1u);
  EXPECT_GT(bus.broken_frames(), 10u);
  EXPECT_TRUE(c.errors().passive());
  EXPECT_TRUE(c.take_heard(now).empty());
}

TEST_F(Bus, destroyed_frames_are_repeated) {
  bus.destroy_frames(3);
  a.send(frame_of(0x10, {1}), 0);
  run(200'000);
  EXPECT_EQ(bus.broken_frames(), 3u);
  EXPECT_EQ(b.take_heard(now).size(), 1u);
  EXPECT_EQ(a.errors().transmit(), 23u) << "three times eight, one off for the success";
  EXPECT_EQ(b.errors().receive(), 2u);
}

TEST_F(Bus, too_many_errors_are_bus_off_and_it_comes_back) {
  bus.destroy_frames(32);
  a.send(frame_of(0x10, {1}), 0);
  run(32 * 60 * kBit);
  EXPECT_EQ(a.bus_offs(), 1u);
  EXPECT_EQ(a.sent(), 0u);
  run(200 * 11 * kBit);
  a.send(frame_of(0x11, {}), now);
  run(200'000);
  EXPECT_EQ(a.sent(), 2u);
}

TEST_F(Bus, an_unplugged_node_hears_nobody_and_nobody_hears_it) {
  bus.set_plugged(a, false, 0);
  a.send(frame_of(1, {}), 0);
  b.send(frame_of(2, {}), 0);
  run(200'000);
  EXPECT_EQ(a.sent(), 0u);
  EXPECT_TRUE(a.take_heard(now).empty());
  EXPECT_EQ(c.take_heard(now).size(), 1u);
  bus.set_plugged(a, true, now);
  run(200'000);
  EXPECT_EQ(a.sent(), 1u);
  EXPECT_EQ(c.take_heard(now).size(), 1u);
}

TEST_F(Bus, pulled_in_the_middle_of_a_frame) {
  a.send(frame_of(1, {1, 2, 3, 4}), 0);
  run(5'000);
  bus.set_plugged(a, false, now);
  run(100'000);
  EXPECT_EQ(b.errors().receive(), 1u);
  EXPECT_TRUE(b.take_heard(now).empty());
  b.send(frame_of(2, {1, 2, 3, 4}), now);
  run(5'000);
  bus.set_plugged(c, false, now);
  run(100'000);
  EXPECT_EQ(b.sent(), 0u) << "the only one who would have acknowledged has gone";
}

TEST_F(Bus, a_short_drives_senders_off_the_bus) {
  a.send(frame_of(1, {}), 0);
  run(1'000);
  bus.short_wires(true, now);
  run(chip::kTicksPerSecond / 50);
  EXPECT_GE(a.bus_offs(), 1u);
  EXPECT_EQ(b.bus_offs(), 0u) << "who does not send never goes bus-off";
  EXPECT_TRUE(b.errors().passive());
  bus.short_wires(false, now);
  run(chip::kTicksPerSecond / 100);
  a.send(frame_of(3, {}), now);
  run(chip::kTicksPerSecond / 100);
  EXPECT_EQ(a.sent(), 2u);
}

TEST_F(Bus, a_flood_fills_the_bus_and_yields_to_smaller_identifiers) {
  c.flood(frame_of(0x100, {0, 0, 0, 0, 0, 0, 0, 0}), 0);
  a.send(frame_of(0x0FF, {}), 1'000);
  b.send(frame_of(0x101, {}), 1'000);
  run(chip::kTicksPerSecond / 10);
  EXPECT_EQ(a.sent(), 1u);
  EXPECT_EQ(b.sent(), 0u);
  EXPECT_GT(double(bus.busy_ticks()) / double(now), 0.99);
  c.stop_flood(now);
  run(200'000);
  EXPECT_EQ(b.sent(), 1u);
}

}  // namespace
}  // namespace stillspin::devices
