// The CAN driver on the virtual chip and a bus: configuration, order, loss, error states, the erratum.

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "hal/f2808/registers.h"
#include "hal/hal_can.h"
#include "hal/hal_clock.h"
#include "hal/hal_profile.h"
#include "hal/hal_time.h"
#include "sim_host/chip/chip.hpp"
#include "sim_host/devices/can_bus.hpp"
#include "sim_host/devices/can_frame.hpp"
#include "sim_host/devices/can_host.hpp"

namespace stillspin::test {
namespace {

using chip::CanFrame;
using chip::Tick;

constexpr std::uint32_t kRate = 500'000;
constexpr Tick kBit = 200;
constexpr Tick kMillisecond = 100'000;
constexpr Tick kStarted = 8 * kMillisecond;  // 6.6 ms PLL

class CanWorld final : public chip::World {
 public:
  devices::CanBus bus;
  std::vector<std::pair<Tick, int>> outputs;

  void on_pwm_pins(Tick, int, bool, bool) override {}
  std::uint16_t adc_sample(Tick, int) override { return 0; }
  bool pin_level(Tick, int) override { return true; }
  void on_output_pin(Tick, int, bool) override {}
  std::int64_t encoder_edges(Tick) override { return 0; }
  chip::CanLine* can_line() override { return &bus; }
  Tick next_call() const override { return bus.next_event(); }
  void call(Tick t) override { bus.run_event(t); }
};

// The firmware: C functions, so its state is global. It runs `step` in its background loop.
struct Firmware {
  std::uint32_t rate = kRate;
  bool accepted = false;
  std::vector<hal_can_frame_t> heard[2];
  bool reads = true;
  std::function<void()> step;
  bool drop_step = false;
  unsigned loops = 0;
};
Firmware fw;

constexpr hal_can_group_t kGroups[] = {{0x101, 0x7FF, false, 3}, {0x400, 0x700, false, 4}};

void image() {
  (void)hal_clock_init();
  hal_time_init();
  fw.accepted = hal_can_init(fw.rate, kGroups, 2);
  for (;;) {
    hal_can_service();
    hal_can_frame_t frame;
    for (std::uint16_t group = 0; fw.reads && group < 2; ++group) {
      if (hal_can_receive(group, &frame)) fw.heard[group].push_back(frame);
    }
    if (fw.step) fw.step();
    if (fw.drop_step) fw.step = nullptr;
    fw.drop_step = false;
    ++fw.loops;
    hal_profile_step(1000);
  }
}

class OnChipCan : public ::testing::Test {
 protected:
  CanWorld world;
  chip::Chip board{world, image};
  devices::CanHost host{world.bus, 0}, other{world.bus, 0};

  void SetUp() override {
    fw = Firmware{};
    host.set_bit_rate(kRate, 0);
  }
  void TearDown() override {
    const chip::Statistics s = board.statistics();
    EXPECT_EQ(s.protected_writes_lost, 0u) << std::hex << s.last_protected_address;
    EXPECT_EQ(s.gated_accesses, 0u) << std::hex << s.last_gated_address;
    EXPECT_EQ(s.unmodelled_accesses, 0u) << std::hex << s.last_unmodelled_address;
    EXPECT_EQ(s.narrow_can_accesses, 0u) << "16-bit access to a control register of the eCAN";
    EXPECT_EQ(s.resets, 0u);
  }
  void run(Tick ticks) { board.run_until(board.now() + ticks); }
  void start() {
    board.run_until(kStarted);
    ASSERT_TRUE(fw.accepted);
  }
  /// The host may be given the word in the middle of a step: only the firmware can end it.
  void end_step() {
    fw.drop_step = true;
    while (fw.drop_step) run(kMillisecond / 10);
  }
  hal_can_status_t status() {
    hal_can_status_t seen{};
    bool done = false;
    fw.step = [&] {
      seen = hal_can_status();
      done = true;
    };
    while (!done) run(kMillisecond / 10);
    end_step();
    return seen;
  }
  /// Offers frames to the driver in its loop until all are taken; gives up after a while.
  bool send(const std::vector<hal_can_frame_t>& frames, std::uint16_t priority) {
    std::size_t next = 0;
    fw.step = [&] {
      while (next < frames.size() && hal_can_send(&frames[next], priority)) ++next;
    };
    for (int i = 0; i < 200 && next < frames.size(); ++i) run(kMillisecond);
    end_step();
    return next == frames.size();
  }
  static hal_can_frame_t message(std::uint32_t id, std::uint16_t first = 0, std::uint16_t length = 8) {
    return hal_can_frame_t{id, false, length, {first, 1, 2, 3, 4, 5, 6, 7}};
  }
  static CanFrame frame(std::uint32_t id, std::uint8_t first = 0) {
    CanFrame f;
    f.id = id;
    f.length = 8;
    f.data = {first, 1, 2, 3, 4, 5, 6, 7};
    return f;
  }
};

TEST_F(OnChipCan, starts_up_and_talks_both_ways) {
  start();
  EXPECT_EQ(status().state, HAL_CAN_ACTIVE);
  host.send(frame(0x101, 0x5A), board.now());
  run(kMillisecond);
  ASSERT_EQ(fw.heard[0].size(), 1u);
  EXPECT_EQ(fw.heard[0][0].id, 0x101u);
  EXPECT_EQ(fw.heard[0][0].length, 8u);
  for (unsigned i = 0; i < 8; ++i) EXPECT_EQ(fw.heard[0][0].data[i], i == 0 ? 0x5A : i);
  ASSERT_TRUE(send({message(0x181, 0xC3)}, 0));
  run(kMillisecond);
  const auto heard = host.take_heard(board.now());
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].frame, frame(0x181, 0xC3));
}

TEST_F(OnChipCan, extended_and_short_frames_keep_their_shape) {
  start();
  ASSERT_TRUE(send({hal_can_frame_t{0x1ABCDEF0, true, 3, {9, 8, 7}}, hal_can_frame_t{0x7FF, false, 0, {}}}, 0));
  run(2 * kMillisecond);
  const auto heard = host.take_heard(board.now());
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_TRUE(heard[0].frame.extended);
  EXPECT_EQ(heard[0].frame.id, 0x1ABCDEF0u);
  EXPECT_EQ(heard[0].frame.length, 3u);
  EXPECT_EQ(heard[0].frame.data[2], 7u);
  EXPECT_EQ(heard[1].frame.length, 0u);
}

TEST_F(OnChipCan, groups_take_what_their_mask_says_and_nothing_else) {
  start();
  for (const std::uint32_t id : {0x100u, 0x101u, 0x102u, 0x4FFu, 0x500u, 0x400u}) host.send(frame(id), board.now());
  CanFrame remote = frame(0x101);
  remote.remote = true;
  host.send(remote, board.now());
  run(5 * kMillisecond);
  ASSERT_EQ(fw.heard[0].size(), 1u) << "the remote frame is dropped";
  ASSERT_EQ(fw.heard[1].size(), 2u);
  EXPECT_EQ(fw.heard[1][0].id, 0x4FFu);
  EXPECT_EQ(fw.heard[1][1].id, 0x400u);
}

// A reader that comes and goes leaves every pattern of full and empty mailboxes behind.
TEST_F(OnChipCan, frames_are_given_out_in_the_order_in_which_they_came) {
  start();
  std::uint8_t sent = 0;
  for (unsigned round = 0; round < 60; ++round) {
    const unsigned burst = 1 + round * 7 % 4;  // no more than the group holds
    fw.reads = false;
    for (unsigned i = 0; i < burst; ++i) host.send(frame(0x400, sent++), board.now());
    run((burst + 1) * 150 * kBit);
    fw.reads = true;
    if (round % 3 == 0) {  // more arrive while the reader empties
      host.send(frame(0x400, sent++), board.now());
      host.send(frame(0x400, sent++), board.now());
    }
    run(4 * 150 * kBit);
  }
  ASSERT_EQ(fw.heard[1].size(), sent);
  for (unsigned i = 0; i < sent; ++i) ASSERT_EQ(fw.heard[1][i].data[0], i) << "frame " << i;
  EXPECT_EQ(status().lost, 0u);
}

TEST_F(OnChipCan, too_many_frames_are_counted_as_lost) {
  start();
  fw.reads = false;
  for (std::uint8_t i = 0; i < 7; ++i) host.send(frame(0x400, i), board.now());
  run(10 * kMillisecond);
  fw.reads = true;
  run(kMillisecond);
  ASSERT_EQ(fw.heard[1].size(), 4u);
  EXPECT_EQ(fw.heard[1][2].data[0], 2u) << "the older ones are kept";
  EXPECT_EQ(fw.heard[1][3].data[0], 6u) << "and the newest";
  EXPECT_GE(status().lost, 1u);
}

TEST_F(OnChipCan, order_within_a_priority_and_overtaking_between_them) {
  start();
  world.bus.set_plugged(host, false, board.now());  // nobody acknowledges: everything waits in the mailboxes
  std::vector<hal_can_frame_t> low, high;
  for (std::uint16_t i = 0; i < 6; ++i) low.push_back(message(0x200, i));
  for (std::uint16_t i = 0; i < 3; ++i) high.push_back(message(0x700, i));
  ASSERT_TRUE(send(low, 0));
  ASSERT_TRUE(send(high, 3));
  run(kMillisecond);
  world.bus.set_plugged(host, true, board.now());
  run(10 * kMillisecond);
  std::vector<unsigned> order;
  for (const auto& heard : host.take_heard(board.now())) order.push_back(heard.frame.id | heard.frame.data[0]);
  EXPECT_EQ(order, (std::vector<unsigned>{0x700, 0x701, 0x702, 0x200, 0x201, 0x202, 0x203, 0x204, 0x205}));
}

TEST_F(OnChipCan, a_long_stream_keeps_its_order_and_the_bus_busy) {
  start();
  std::vector<hal_can_frame_t> stream;
  for (std::uint16_t i = 0; i < 250; ++i) stream.push_back(message(0x481, i));
  const Tick begin = board.now();
  ASSERT_TRUE(send(stream, 0));
  while (host.take_heard(board.now()).empty()) run(kMillisecond);
  run(100 * kMillisecond);
  EXPECT_EQ(world.bus.frames(), 250u);
  // 250 frames of at most 135 + 3 bits.
  EXPECT_LT(world.bus.busy_ticks(), 250 * 138 * kBit);
  EXPECT_GT(board.now() - begin, world.bus.busy_ticks());
}

TEST_F(OnChipCan, unplugged_it_fills_its_mailboxes_and_does_not_restart) {
  start();
  world.bus.set_plugged(host, false, board.now());
  std::vector<hal_can_frame_t> many(40, message(0x181));
  EXPECT_FALSE(send(many, 1)) << "25 mailboxes are left for sending";
  run(1000 * kMillisecond);
  hal_can_status_t s = status();
  EXPECT_EQ(s.state, HAL_CAN_PASSIVE);
  EXPECT_EQ(s.transmit_errors, 128u);
  EXPECT_EQ(s.restarts, 0u) << "missing acknowledgment explains why nothing goes";
  fw.step = [] { hal_can_cancel(1); };
  run(2 * kMillisecond);
  end_step();
  world.bus.set_plugged(host, true, board.now());
  run(20 * kMillisecond);
  EXPECT_LE(host.take_heard(board.now()).size(), 1u) << "what waited was taken back";
  ASSERT_TRUE(send({message(0x182)}, 1));
  run(kMillisecond);
  EXPECT_EQ(host.take_heard(board.now()).size(), 1u);
}

TEST_F(OnChipCan, bus_off_lasts_until_it_is_asked_to_recover) {
  start();
  world.bus.destroy_frames(1000);
  ASSERT_TRUE(send({message(0x181), message(0x181)}, 0));
  run(20 * kMillisecond);
  world.bus.destroy_frames(0);
  run(50 * kMillisecond);
  EXPECT_EQ(status().state, HAL_CAN_BUS_OFF);
  EXPECT_EQ(status().bus_offs, 1u);
  bool accepted = true;
  fw.step = [&] {
    const hal_can_frame_t frame = message(1);
    accepted = hal_can_send(&frame, 0);
  };
  run(kMillisecond);
  EXPECT_FALSE(accepted);
  fw.step = [] { hal_can_recover(); };
  run(128 * 11 * kBit + kMillisecond);
  end_step();
  EXPECT_EQ(status().state, HAL_CAN_ACTIVE);
  run(10 * kMillisecond);
  EXPECT_TRUE(host.take_heard(board.now()).empty()) << "what was to be sent before is not sent now";
  ASSERT_TRUE(send({message(0x182)}, 0));
  run(kMillisecond);
  EXPECT_EQ(host.take_heard(board.now()).size(), 1u);
}

TEST_F(OnChipCan, transmission_that_stops_is_restarted_and_nothing_is_lost) {
  start();
  board.stop_can_transmission();
  ASSERT_TRUE(send({message(0x181, 1), message(0x181, 2)}, 0));
  run(90 * kMillisecond);
  EXPECT_TRUE(host.take_heard(board.now()).empty());
  host.send(frame(0x101), board.now());
  run(kMillisecond);
  EXPECT_EQ(fw.heard[0].size(), 1u) << "reception goes on";
  run(20 * kMillisecond);
  const auto heard = host.take_heard(board.now());
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].frame.data[0], 1u);
  EXPECT_EQ(status().restarts, 1u);
}

TEST_F(OnChipCan, a_shorted_bus_does_not_hang_the_start) {
  world.bus.short_wires(true, 0);
  start();
  run(100 * kMillisecond);
  EXPECT_GT(fw.loops, 1000u) << "it goes on with its work";
  world.bus.short_wires(false, board.now());
  run(10 * kMillisecond);
  EXPECT_EQ(status().state, HAL_CAN_ACTIVE);
}

TEST_F(OnChipCan, an_impossible_rate_is_refused_and_leaves_it_off) {
  fw.rate = 333'000;
  board.run_until(kStarted);
  EXPECT_FALSE(fw.accepted);
  EXPECT_EQ(status().state, HAL_CAN_OFF);
}

class OnChipCanRate : public OnChipCan, public ::testing::WithParamInterface<std::uint32_t> {};

TEST_P(OnChipCanRate, talks_at_this_rate) {
  fw.rate = GetParam();
  host.set_bit_rate(GetParam(), 0);
  board.run_until(kStarted + 50 * kMillisecond);
  ASSERT_TRUE(fw.accepted);
  host.send(frame(0x101), board.now());
  run(50 * kMillisecond);
  EXPECT_EQ(fw.heard[0].size(), 1u);
  EXPECT_EQ(world.bus.broken_frames(), 0u);
}
INSTANTIATE_TEST_SUITE_P(Rates, OnChipCanRate,
                         ::testing::Values(1'000'000u, 500'000u, 250'000u, 125'000u, 100'000u, 50'000u, 20'000u));

TEST_F(OnChipCan, a_changed_rate_takes_effect_at_run_time) {
  start();
  bool changed = false;
  fw.step = [&] {
    if (!changed) fw.accepted = hal_can_init(250'000, kGroups, 2);
    changed = true;
  };
  run(kMillisecond);
  end_step();
  host.set_bit_rate(250'000, board.now());
  run(kMillisecond);
  host.send(frame(0x101), board.now());
  run(2 * kMillisecond);
  EXPECT_EQ(fw.heard[0].size(), 1u);
}

}  // namespace
}  // namespace stillspin::test
