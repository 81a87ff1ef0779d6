// The serial driver on the virtual chip, with a line that has a far end: echo, full load, noise, breaks, wrong rates.

#include <gtest/gtest.h>

#include <algorithm>

#include "hal/hal_clock.h"
#include "hal/hal_irq.h"
#include "hal/hal_profile.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"
#include "sim_host/chip/chip.hpp"
#include "tests/hal/bench_world.hpp"

namespace stillspin::test {
namespace {

using chip::Tick;
using Octets = std::vector<std::uint8_t>;

constexpr Tick kMillisecond = 100'000;
constexpr Tick kStarted = 10 * kMillisecond;
constexpr std::uint16_t kControlCycles = 6900;

// What the image of this file does and has seen.
struct Image {
  std::uint32_t baud = 115200;
  std::uint32_t next_baud = 0;  // to be changed to while it runs
  bool echo = true;
  bool port_ok = false;
  bool reads = true;
  std::vector<std::uint16_t> to_send;              // by the background, beside the echo
  std::vector<std::uint16_t> got;                  // while nothing is echoed
  std::vector<std::uint32_t> entries;              // cycle count at the start of each control interrupt
  std::vector<std::uint32_t> longest = {0u, ~0u};  // run time of hal_sci_service: most, least
};
Image image;

void control_function() {
  hal_irq_control_begin();
  image.entries.push_back(hal_time_cycles());
  hal_profile_step(kControlCycles);
  const std::uint32_t before = hal_time_cycles();
  hal_sci_service();
  const std::uint32_t took = hal_time_cycles() - before;
  image.longest[0] = std::max(image.longest[0], took);
  image.longest[1] = std::min(image.longest[1], took);
  hal_irq_control_end();
}

void window_function() {}

void serve() {
  if (!image.reads) return;
  if (image.next_baud != 0) image.port_ok = hal_sci_init(image.next_baud);
  image.next_baud = 0;
  std::uint16_t octets[32];
  const std::uint16_t room = image.echo ? std::min<std::uint16_t>(32, hal_sci_room()) : 32;
  const std::uint16_t count = hal_sci_read(octets, room);
  if (image.echo) {
    hal_sci_write(octets, count);
  } else {
    image.got.insert(image.got.end(), octets, octets + count);
  }
  const auto due = static_cast<std::uint16_t>(std::min<std::size_t>(image.to_send.size(), 512));
  const std::uint16_t put = hal_sci_write(image.to_send.data(), due);
  image.to_send.erase(image.to_send.begin(), image.to_send.begin() + put);
}

void serial_image() {
  hal_clock_init();
  hal_time_init();
  hal_pwm_init(100);
  image.port_ok = hal_sci_init(image.baud);
  hal_irq_install(control_function, window_function);
  hal_irq_enable();
  for (;;) {
    hal_idle();
    serve();
  }
}

Octets pattern(std::size_t count) {
  Octets octets(count);
  for (std::size_t k = 0; k < count; ++k) octets[k] = static_cast<std::uint8_t>(k * 7 + k / 256);
  return octets;
}

class OnChipSerial : public ::testing::Test {
 protected:
  void SetUp() override { image = Image{}; }

  void start() {
    board.run_until(kStarted);
    ASSERT_TRUE(image.port_ok);
    EXPECT_EQ(board.statistics().protected_writes_lost, 0u);
    EXPECT_EQ(board.statistics().gated_accesses, 0u);
    EXPECT_EQ(board.statistics().unmodelled_accesses, 0u);
  }
  void run(double milliseconds) { board.run_until(board.now() + static_cast<Tick>(milliseconds * kMillisecond)); }
  void send(const Octets& octets) { world.serial.send(octets, board.now()); }
  void expect_errors(unsigned framing, unsigned overrun, unsigned breaks, unsigned lost) {
    const hal_sci_errors_t e = hal_sci_errors();
    EXPECT_EQ(e.framing, framing);
    EXPECT_EQ(e.overrun, overrun);
    EXPECT_EQ(e.breaks, breaks);
    EXPECT_EQ(e.lost, lost);
  }

  BenchWorld world;
  chip::Chip board{world, serial_image};
};

TEST_F(OnChipSerial, octets_come_back) {
  start();
  send({'h', 'e', 'l', 'l', 'o', 0, 255});
  run(5);
  EXPECT_EQ(world.serial.take(), (Octets{'h', 'e', 'l', 'l', 'o', 0, 255}));
  expect_errors(0, 0, 0, 0);
}

TEST_F(OnChipSerial, silence_is_silence) {
  start();
  run(20);
  EXPECT_TRUE(world.serial.take().empty());
  expect_errors(0, 0, 0, 0);
}

TEST_F(OnChipSerial, full_load_both_ways_loses_nothing) {
  for (const std::uint32_t baud : {115200u, 230400u}) {
    image = Image{};
    image.baud = baud;
    BenchWorld line;
    line.serial.set_rate(baud);
    chip::Chip chip{line, serial_image};
    chip.run_until(kStarted);
    const Octets octets = pattern(2000);
    line.serial.send(octets, chip.now());
    chip.run_until(line.serial.sent_until(chip.now()) + 5 * kMillisecond);
    EXPECT_EQ(line.serial.take(), octets) << baud;
    expect_errors(0, 0, 0, 0);
  }
}

// The entry of the control interrupt is set by the PWM alone, and what the port costs at its end is bounded.
TEST_F(OnChipSerial, control_interrupt_keeps_its_beat_under_full_load) {
  image.baud = 230400;
  world.serial.set_rate(230400);
  start();
  run(20);
  const std::uint32_t idle_cost = image.longest[0];
  image.entries.clear();
  image.to_send.assign(1000, 0x55);
  send(pattern(1000));
  run(45);
  ASSERT_GT(image.entries.size(), 400u);
  for (std::size_t k = 1; k < image.entries.size(); ++k) {
    ASSERT_EQ(image.entries[k] - image.entries[k - 1], 10000u) << "jitter in period " << k;
  }
  EXPECT_LT(idle_cost, 15u) << "cycles of register accesses with nothing to do";
  EXPECT_LT(image.longest[0], 40u) << "four octets in, four out, and the status registers";
}

TEST_F(OnChipSerial, octets_beyond_the_ring_are_lost_and_counted) {
  image.reads = false;
  start();
  send(pattern(600));
  run(60);
  expect_errors(0, 0, 0, 600 - HAL_SCI_RECEIVE_RING);
  image.reads = true;
  run(30);
  Octets first = pattern(600);
  first.resize(HAL_SCI_RECEIVE_RING);
  EXPECT_EQ(world.serial.take(), first);
}

TEST_F(OnChipSerial, port_lives_on_after_a_break) {
  start();
  world.serial.send_break(30, board.now());
  run(4);
  send({'x'});
  run(2);
  EXPECT_EQ(world.serial.take(), (Octets{'x'}));
  expect_errors(1, 0, 1, 0);
}

TEST_F(OnChipSerial, line_held_low_is_one_break_and_does_not_stop_sending) {
  image.echo = false;
  start();
  world.serial.send_break(2000, board.now());  // 17 ms
  run(5);
  image.to_send.assign(20, 'y');
  run(10);
  EXPECT_EQ(world.serial.take(), Octets(20, 'y'));
  expect_errors(1, 0, 1, 0);
  run(5);
  send({'z'});
  run(3);
  EXPECT_EQ(image.got, (std::vector<std::uint16_t>{'z'}));
}

TEST_F(OnChipSerial, recovery_from_a_break_does_not_cut_what_is_being_sent) {
  image.echo = false;
  start();
  image.to_send.assign(300, 'y');
  run(1);
  world.serial.send_break(12, board.now());
  world.serial.send_break(25, board.now() + kMillisecond);
  run(40);
  EXPECT_EQ(world.serial.take(), Octets(300, 'y'));
  EXPECT_EQ(hal_sci_errors().breaks, 1u) << "the first is a framing error and no break: ten bits and a stop bit";
}

TEST_F(OnChipSerial, wrong_rate_is_seen_and_survived) {
  start();
  world.serial.set_rate(9600);
  send({0x00, 0x55, 0x33});
  run(6);
  EXPECT_GT(hal_sci_errors().framing + hal_sci_errors().breaks, 0);
  world.serial.set_rate(115200);
  run(2);
  world.serial.take();
  send({'o', 'k'});
  run(3);
  EXPECT_EQ(world.serial.take(), (Octets{'o', 'k'}));
}

TEST_F(OnChipSerial, noise_never_stops_the_port) {
  start();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    world.serial.set_noise(0.2, seed);
    send(pattern(100));
    world.serial.send_break(static_cast<double>(seed) / 3.0, board.now());
    run(20);
    world.serial.set_noise(0, 0);
    world.serial.take();
    send({'o', 'k'});
    run(3);
    EXPECT_EQ(world.serial.take(), (Octets{'o', 'k'})) << "after the noise of seed " << seed;
  }
  EXPECT_GT(hal_sci_errors().framing, 100u);
}

TEST_F(OnChipSerial, rate_may_be_changed_while_it_runs) {
  start();
  send({'a'});
  run(2);
  for (const std::uint32_t baud : {9600u, 230400u, 19200u}) {
    image.next_baud = baud;
    run(1);
    world.serial.take();
    EXPECT_TRUE(image.port_ok);
    world.serial.set_rate(baud);
    send({'b', 'c'});
    run(6);
    EXPECT_EQ(world.serial.take(), (Octets{'b', 'c'})) << baud;
  }
}

}  // namespace
}  // namespace stillspin::test
