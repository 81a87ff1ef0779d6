// hal_nvm on the virtual chip with the EEPROM on its I2C lines: content, pages, write cycles, and what goes wrong.

#include <gtest/gtest.h>

#include <deque>
#include <numeric>
#include <vector>

#include "hal/f2808/registers.h"
#include "hal/hal_clock.h"
#include "hal/hal_nvm.h"
#include "hal/hal_profile.h"
#include "hal/hal_time.h"
#include "sim_host/chip/chip.hpp"
#include "sim_host/devices/eeprom.hpp"

namespace stillspin::test {
namespace {

using chip::Tick;
using devices::Eeprom;

constexpr Tick kUs = 100;
constexpr Tick kMs = 1000 * kUs;

// The firmware: does one job after the other, a step every `pause` cycles.
struct Job {
  bool write;
  std::uint16_t address;
  std::vector<std::uint16_t> octets;
};
struct Nvm {
  std::uint16_t pause = 100;
  std::deque<Job> jobs;
  bool free_at_start = false;
  std::vector<hal_nvm_state_t> results;
  std::vector<hal_nvm_fault_t> faults;
  std::vector<double> ms;
  std::vector<std::uint16_t> last;
  std::uint32_t longest_step = 0;  // cycles, of register accesses
};
Nvm nvm;

void do_job(Job job) {
  const std::uint32_t begin = hal_time_cycles();
  const auto count = static_cast<std::uint16_t>(job.octets.size());
  const bool taken = job.write ? hal_nvm_write(job.address, job.octets.data(), count)
                               : hal_nvm_read(job.address, job.octets.data(), count);
  if (!taken) {
    nvm.results.push_back(NVM_IDLE);
    return;
  }
  for (;;) {
    const std::uint32_t before = hal_time_cycles();
    const hal_nvm_state_t state = hal_nvm_step();
    nvm.longest_step = std::max(nvm.longest_step, hal_time_cycles() - before);
    if (state != NVM_BUSY) {
      nvm.results.push_back(state);
      break;
    }
    hal_profile_step(nvm.pause);
  }
  nvm.faults.push_back(hal_nvm_fault());
  nvm.ms.push_back(double(hal_time_cycles() - begin) * 1e-5);
  nvm.last = job.octets;
}

void image() {
  hal_clock_init();
  hal_time_init();
  nvm.free_at_start = hal_nvm_init();
  for (;;) {
    if (nvm.jobs.empty()) {
      hal_profile_step(100);
      continue;
    }
    const Job job = nvm.jobs.front();
    nvm.jobs.pop_front();
    do_job(job);
  }
}

class Lines final : public chip::World {
 public:
  Eeprom memory;
  bool fitted = true;
  bool scl_stuck = false;

  void on_pwm_pins(Tick, int, bool, bool) override {}
  std::uint16_t adc_sample(Tick, int) override { return 0; }
  bool pin_level(Tick, int pin) override {
    if (pin == 33) return scl_ && !scl_stuck;
    return pin != 32 || (sda_ && (!fitted || memory.lets_sda_go()));
  }
  void on_output_pin(Tick, int, bool) override {}
  std::int64_t encoder_edges(Tick) override { return 0; }
  Tick next_call() const override { return chip::kNever; }
  void call(Tick) override {}
  void on_i2c_pins(Tick t, bool sda, bool scl) override {
    sda_ = sda;
    scl_ = scl;
    if (fitted) memory.drive(base_ + t, sda, scl);
  }

  /// The chip is replaced at its tick t by one that begins to count again; its pins let go.
  void lost_chip(Tick t) {
    on_i2c_pins(t, sda_, true);
    on_i2c_pins(t, true, true);
    base_ += t;
  }

 private:
  bool sda_ = true, scl_ = true;
  Tick base_ = 0;
};

class OnChipNvm : public ::testing::Test {
 protected:
  void SetUp() override { nvm = Nvm{}; }

  static std::vector<std::uint16_t> ramp(unsigned count, unsigned first = 0) {
    std::vector<std::uint16_t> octets(count);
    for (unsigned n = 0; n < count; ++n) octets[n] = static_cast<std::uint16_t>((first + 7 * n) & 0xFF);
    return octets;
  }

  void run(std::vector<Job> jobs, Tick limit = 300 * kMs) {
    nvm.results.clear();
    nvm.faults.clear();
    nvm.ms.clear();
    nvm.jobs.assign(jobs.begin(), jobs.end());
    const Tick end = board.now() + limit;
    while (nvm.results.size() < jobs.size() && board.now() < end) board.run_until(board.now() + kMs);
    ASSERT_EQ(nvm.results.size(), jobs.size()) << "a job did not end";
  }
  void read(std::uint16_t address, unsigned count) { run({{false, address, std::vector<std::uint16_t>(count)}}); }
  void write(std::uint16_t address, std::vector<std::uint16_t> octets) { run({{true, address, std::move(octets)}}); }

  void expect(hal_nvm_state_t state, hal_nvm_fault_t fault = NVM_NO_FAULT) {
    EXPECT_EQ(nvm.results.back(), state);
    EXPECT_EQ(nvm.faults.back(), fault);
  }
  bool holds(unsigned address, const std::vector<std::uint16_t>& octets) {
    return std::equal(octets.begin(), octets.end(), lines.memory.memory().begin() + address);
  }

  Lines lines;
  chip::Chip board{lines, image};
};

TEST_F(OnChipNvm, WritesAndReadsBack) {
  write(0x1240, ramp(64));
  expect(NVM_DONE);
  EXPECT_TRUE(nvm.free_at_start);
  EXPECT_TRUE(holds(0x1240, ramp(64)));
  EXPECT_EQ(lines.memory.wear(0x1240 / 64), 1u);
  EXPECT_EQ(lines.memory.write_cycles(), 1u);
  read(0x1240, 64);
  expect(NVM_DONE);
  EXPECT_EQ(nvm.last, ramp(64));
  const chip::Statistics s = board.statistics();
  EXPECT_EQ(s.protected_writes_lost, 0u);
  EXPECT_EQ(s.gated_accesses, 0u);
  EXPECT_EQ(s.unmodelled_accesses, 0u);
}

TEST_F(OnChipNvm, OneOctetAndManyPages) {
  for (unsigned n = 0; n < Eeprom::kSize; ++n) lines.memory.memory()[n] = static_cast<std::uint8_t>(n * 31 + n / 256);
  for (const unsigned count : {1u, 2u, 15u, 16u, 17u, 18u, 4096u}) {
    read(100, count);
    expect(NVM_DONE);
    ASSERT_EQ(nvm.last.size(), count);
    EXPECT_TRUE(holds(100, nvm.last)) << count;
  }
  write(77, {0xA5});
  expect(NVM_DONE);
  EXPECT_TRUE(holds(77, {0xA5}));
}

// 400 kbit/s: 9 bits of 2.5 us an octet, whatever the pace of the steps, as long as the FIFO does not run empty.
TEST_F(OnChipNvm, TakesItsTimeAndNoMore) {
  read(0, 1000);
  EXPECT_NEAR(nvm.ms.back(), 1004 * 22.5e-3, 0.1);
  write(0, ramp(64));
  EXPECT_GT(nvm.ms.back(), 5.0 + 67 * 22.5e-3);
  EXPECT_LT(nvm.ms.back(), 5.0 + 67 * 22.5e-3 + 0.3);
  EXPECT_LT(nvm.longest_step, 500u) << "cycles of register accesses in one step";
}

TEST_F(OnChipNvm, AnyPaceOfSteps) {
  for (const std::uint16_t pause : {1, 1000, 36000, 60000}) {  // 10 ns .. 0.6 ms
    nvm.pause = pause;
    write(128, ramp(64, pause));
    expect(NVM_DONE);
    EXPECT_TRUE(holds(128, ramp(64, pause)));
    read(120, 80);
    expect(NVM_DONE);
    EXPECT_TRUE(holds(120, nvm.last));
  }
}

TEST_F(OnChipNvm, WhatDoesNotFitIsRefused) {
  run({{true, 60, ramp(5)},
       {true, 0, ramp(65)},
       {true, 0, {}},
       {false, 32767, std::vector<std::uint16_t>(2)},
       {false, 32768, std::vector<std::uint16_t>(1)},
       {false, 0, {}}});
  for (const hal_nvm_state_t r : nvm.results) EXPECT_EQ(r, NVM_IDLE);
  EXPECT_EQ(lines.memory.octets(), 0u);
  read(32767, 1);
  expect(NVM_DONE);
  write(60, ramp(4));
  expect(NVM_DONE);
}

TEST_F(OnChipNvm, NoMemoryIsFoundOutQuickly) {
  lines.fitted = false;
  read(0, 16);
  expect(NVM_FAILED, NVM_NO_ANSWER);
  EXPECT_LT(nvm.ms.back(), 0.2);
}

TEST_F(OnChipNvm, WaitsForTheWriteCycle) {
  run({{true, 0, ramp(64)}, {true, 64, ramp(64, 9)}, {false, 0, std::vector<std::uint16_t>(128)}});
  for (const hal_nvm_state_t r : nvm.results) EXPECT_EQ(r, NVM_DONE);
  EXPECT_TRUE(holds(64, ramp(64, 9)));
  EXPECT_TRUE(holds(0, nvm.last));
}

// The firmware is reset while the memory sends a zero: it holds SDA until it has been clocked.
TEST_F(OnChipNvm, HungBusIsClockedFree) {
  for (const unsigned clocks : {1u, 4u, 9u}) {
    lines.memory.hold_sda(clocks);
    write(0, ramp(64, clocks));
    expect(NVM_DONE);
    EXPECT_TRUE(holds(0, ramp(64, clocks))) << clocks;
  }
}

TEST_F(OnChipNvm, HungBusAtStartIsReported) {
  lines.memory.hold_sda(3);
  read(0, 4);
  EXPECT_FALSE(nvm.free_at_start);
  expect(NVM_DONE);
}

TEST_F(OnChipNvm, LinesThatStayLowAreAFailure) {
  lines.memory.hold_sda(1000);
  read(0, 4);
  expect(NVM_FAILED, NVM_BUS_HUNG);
  EXPECT_LT(nvm.ms.back(), 5.0);
  lines.memory.hold_sda(0);
  read(0, 4);
  expect(NVM_DONE);
  lines.scl_stuck = true;
  read(0, 4);
  expect(NVM_FAILED, NVM_BUS_HUNG);
  EXPECT_LT(nvm.ms.back(), 5.0);
  lines.scl_stuck = false;
  read(0, 4);
  expect(NVM_DONE);
}

// In the middle of a job: SDA low is a lost arbitration or a wrong octet, SCL low stands still until the time-out.
TEST_F(OnChipNvm, LinesThatHangInTheMiddle) {
  for (const Tick delay : {30 * kUs, 300 * kUs, 700 * kUs}) {
    nvm.results.clear();
    nvm.faults.clear();
    board.run_until(std::max(board.now(), 10 * kMs));
    nvm.jobs.push_back({true, 0, ramp(64, unsigned(delay))});
    board.run_until(board.now() + delay);
    lines.memory.hold_sda(9);
    board.run_until(board.now() + 60 * kMs);
    ASSERT_EQ(nvm.results.size(), 1u);
    EXPECT_EQ(nvm.results.back(), NVM_DONE);
    EXPECT_TRUE(holds(0, ramp(64, unsigned(delay)))) << delay;
  }
  nvm.results.clear();
  nvm.jobs.push_back({false, 0, std::vector<std::uint16_t>(1000)});
  board.run_until(board.now() + 5 * kMs);
  lines.scl_stuck = true;
  board.run_until(board.now() + 5 * kMs);
  EXPECT_TRUE(nvm.results.empty()) << "stretching is not a failure at once";
  lines.scl_stuck = false;
  board.run_until(board.now() + 60 * kMs);
  ASSERT_EQ(nvm.results.size(), 1u);
  EXPECT_EQ(nvm.results.back(), NVM_DONE);
  EXPECT_TRUE(holds(0, nvm.last));
}

// The power of the memory goes at any octet of a page write: the job fails, and nothing but that page has changed.
TEST_F(OnChipNvm, PowerOfTheMemoryGoesAnywhere) {
  write(0, ramp(64));
  for (unsigned cut = 1; cut <= 67; ++cut) {
    lines.memory.cut_after_octets(cut);
    write(0, ramp(64, 1));
    expect(NVM_FAILED, NVM_NO_ANSWER);
    EXPECT_TRUE(holds(0, ramp(64))) << cut;
    lines.memory.power_on();
  }
  lines.memory.cut_in_write_cycle(1, Eeprom::Torn::kFirstHalf);
  write(0, ramp(64, 1));
  expect(NVM_FAILED, NVM_NO_ANSWER);
  EXPECT_TRUE(holds(0, ramp(32, 1)));
  EXPECT_FALSE(holds(0, ramp(33, 1)));
}

// Cut off by a reset of the chip in the middle of a transfer, the memory is found again in any case.
TEST_F(OnChipNvm, ResetInTheMiddleOfAJob) {
  lines.memory.memory().assign(Eeprom::kSize, 0x00);  // a memory that sends zeros holds SDA
  for (int n = 1; n < 120; ++n) {
    const bool writes = n % 2 == 0;
    chip::Chip before{lines, image};
    nvm = Nvm{};
    nvm.jobs.push_back({writes, 64, std::vector<std::uint16_t>(64, 0)});
    before.run_until(8 * kMs + n * 17 * kUs);
    lines.lost_chip(before.now());
    chip::Chip after{lines, image};
    nvm = Nvm{};
    nvm.jobs.push_back({false, 64, std::vector<std::uint16_t>(64, 1)});
    after.run_until(70 * kMs);
    ASSERT_EQ(nvm.results.size(), 1u) << n;
    ASSERT_EQ(nvm.results.back(), NVM_DONE) << n;
    EXPECT_TRUE(holds(64, nvm.last)) << n;
    lines.lost_chip(after.now());
  }
}

}  // namespace
}  // namespace stillspin::test
