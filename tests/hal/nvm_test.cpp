// The memory's driver on a register bus: a module and lines that do what no memory makes them do. Transfers and
// memories are on_chip_nvm_test.cpp.

#include "hal/f2808/registers.h"
#include "hal/hal_nvm.h"
#include "hal/hal_time.h"
#include "tests/hal/bus_test.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint64_t kStandstill = 1'100'000;  // cycles, beyond the 10 ms that a device may stretch
constexpr std::uint64_t kHalfClock = 1'000;
constexpr std::uint64_t kMillisecond = 100'000;
constexpr std::uint64_t kAlmost = 99 * kMillisecond / 10;  // of 10 ms
}  // namespace

class Nvm : public BusTest {
 protected:
  void SetUp() override {
    bus.power_all();
    lines(true);
    bus.between = [this] { module(I2C_STR, 0); };  // its flags are cleared by writing ones to them
    ASSERT_TRUE(hal_nvm_init());
  }
  void lines(bool high) { bus.words[REG_GPBDAT] = high ? 0xFFFF : 0; }
  void set_port_b(std::uint32_t address, unsigned value) { bus.words[address] = static_cast<std::uint16_t>(value); }
  void module(std::uint32_t offset, unsigned value) {
    bus.words[I2C_BASE + offset] = static_cast<std::uint16_t>(value);
  }
  int starts() const {
    int n = 0;
    for (const Step& s : bus.steps) {
      n += s.op == Op::kWrite && s.address == I2C_BASE + I2C_MDR && (s.value & I2C_MDR_STT_MASK) != 0 ? 1 : 0;
    }
    return n;
  }
  /// The pins are taken from the module, to clock the bus free.
  bool is_clearing() const { return (bus.word32(REG_GPBMUX1) & 0xFu) == 0; }
  /// The module says something of the transfer, and is asked.
  hal_nvm_state_t step_with(unsigned status) {
    module(I2C_STR, status);
    return hal_nvm_step();
  }
  std::vector<std::uint32_t> written(std::uint32_t offset) const {
    std::vector<std::uint32_t> values;
    for (const Step& s : bus.steps) {
      if (s.op == Op::kWrite && s.address == I2C_BASE + offset) values.push_back(s.value);
    }
    return values;
  }
  /// Nobody acknowledges, and the module has stopped.
  hal_nvm_state_t refuse() {
    EXPECT_EQ(step_with(I2C_STR_NACK_MASK), NVM_BUSY);
    module(I2C_MDR, 0);
    return hal_nvm_step();
  }
  hal_nvm_state_t step_after(std::uint64_t cycles) {
    bus.cycles += cycles;
    return hal_nvm_step();
  }
  std::uint16_t octets[4] = {9, 9, 9, 9};
};

TEST_F(Nvm, one_job_at_a_time) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 2));
  bus.forget_steps();
  EXPECT_FALSE(hal_nvm_read(64, octets, 1));
  EXPECT_FALSE(hal_nvm_write(64, octets, 1));
  EXPECT_TRUE(bus.steps.empty()) << "the one that is under way is not touched";
}

TEST_F(Nvm, nothing_is_done_without_a_job) {
  bus.forget_steps();
  EXPECT_EQ(hal_nvm_step(), NVM_IDLE);
  EXPECT_TRUE(bus.steps.empty());
}

TEST_F(Nvm, no_more_octets_are_taken_than_were_asked_for) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 2));
  module(I2C_STR, I2C_STR_ARDY_MASK);
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY) << "the address is out";
  module(I2C_FFRX, 5u << I2C_FFRX_RXFFST_LSB);
  module(I2C_DRR, 0x77);
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY);
  EXPECT_EQ(octets[1], 0x77);
  EXPECT_EQ(octets[2], 9);
  module(I2C_MDR, 0);
  EXPECT_EQ(hal_nvm_step(), NVM_DONE) << "the module has stopped";
}

TEST_F(Nvm, a_transfer_that_stands_still_is_tried_again_three_times) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 2));
  EXPECT_EQ(step_after(kStandstill / 2), NVM_BUSY);
  EXPECT_EQ(starts(), 1) << "a device may stretch its clock";
  int steps = 0;
  while (step_after(kStandstill) == NVM_BUSY && ++steps < 100) {
  }
  EXPECT_EQ(hal_nvm_step(), NVM_FAILED);
  EXPECT_EQ(hal_nvm_fault(), NVM_BUS_HUNG);
  EXPECT_EQ(starts(), 4);
}

TEST_F(Nvm, lines_that_fall_while_they_are_cleared_are_a_failure) {
  for (int late = 0; late < 7; ++late) {
    lines(true);
    ASSERT_TRUE(hal_nvm_read(0, octets, 2));
    EXPECT_EQ(step_after(kStandstill), NVM_BUSY) << "the lines are cleared";
    for (int k = 0; k < late; ++k) ASSERT_EQ(step_after(kHalfClock), NVM_BUSY) << late;
    lines(false);
    int steps = 0;
    while (step_after(kHalfClock) == NVM_BUSY && ++steps < 100) {
    }
    EXPECT_EQ(hal_nvm_fault(), NVM_BUS_HUNG) << late;
    EXPECT_EQ(bus.word32(REG_GPBMUX1) & 0xFu, 0x5u) << "the pins are the module's again";
  }
}

using Values = std::vector<std::uint32_t>;

// 24LC256 at 400 kHz: low 1.3 us at least, high 0.6 us; the module's clock has to be 7 to 12 MHz.
TEST_F(Nvm, the_clock_is_400_kHz_as_the_memory_and_the_module_want_it) {
  const double mhz = 100.0 / (bus.words[I2C_BASE + I2C_PSC] + 1);
  EXPECT_GE(mhz, 7.0);
  EXPECT_LE(mhz, 12.0);
  const double low = (bus.words[I2C_BASE + I2C_CLKL] + 5) / mhz, high = (bus.words[I2C_BASE + I2C_CLKH] + 5) / mhz;
  EXPECT_NEAR(low + high, 2.5, 1e-6);
  EXPECT_GE(low, 1.3);
  EXPECT_GE(high, 0.6);
}

TEST_F(Nvm, the_module_is_set_up_in_reset_before_it_gets_its_pins) {
  bus.forget_steps();
  module(I2C_IER, 0xFF);
  set_port_b(REG_GPBPUD, 0xFF);
  set_port_b(REG_GPBQSEL1, 0);
  EXPECT_TRUE(hal_nvm_init());
  EXPECT_EQ(written(I2C_MDR), (Values{0, I2C_MDR_IRS_MASK | I2C_MDR_FREE_MASK}));
  for (const std::uint32_t setting : {I2C_PSC, I2C_CLKL, I2C_CLKH, I2C_IER}) {
    expect_before(bus.first_write(I2C_BASE + I2C_MDR), bus.first_write(I2C_BASE + setting), "in reset");
    expect_before(bus.first_write(I2C_BASE + setting), bus.last_write(I2C_BASE + I2C_MDR), "then let go");
  }
  EXPECT_EQ(written(I2C_IER), Values{0}) << "no interrupts";
  EXPECT_EQ(written(I2C_FFTX), (Values{0x4000, 0x6000})) << "FIFO in reset, then running, without interrupts";
  EXPECT_EQ(written(I2C_FFRX), (Values{0, 0x2000}));
  expect_before(bus.last_write(I2C_BASE + I2C_FFRX), bus.first_write(REG_GPBMUX1), "the module before its pins");
  EXPECT_EQ(bus.word32(REG_GPBMUX1) & 0xFu, 0x5u);
  EXPECT_EQ(bus.word32(REG_GPBQSEL1) & 0xFu, 0xFu) << "not sampled";
  EXPECT_EQ(bus.word32(REG_GPBPUD) & 3u, 0u) << "an open line is high";
}

TEST_F(Nvm, a_read_sends_the_address_and_starts_again_to_receive) {
  bus.forget_steps();
  ASSERT_TRUE(hal_nvm_read(0x1234, octets, 3));
  const std::uint32_t start = I2C_MDR_IRS_MASK | I2C_MDR_FREE_MASK | I2C_MDR_MST_MASK | I2C_MDR_STT_MASK;
  EXPECT_EQ(written(I2C_SAR), Values{0x50});
  EXPECT_EQ(written(I2C_DXR), (Values{0x12, 0x34}));
  EXPECT_EQ(written(I2C_CNT), Values{2});
  EXPECT_EQ(written(I2C_MDR), Values{start | I2C_MDR_TRX_MASK}) << "without a stop";
  EXPECT_EQ(written(I2C_STR), Values{0xFFFF}) << "what the last transfer has left is no answer to this one";
  EXPECT_EQ(step_with(0), NVM_BUSY);
  EXPECT_EQ(written(I2C_CNT).size(), 1u) << "the address is still on its way";
  bus.forget_steps();
  EXPECT_EQ(step_with(I2C_STR_ARDY_MASK), NVM_BUSY);
  EXPECT_EQ(written(I2C_CNT), Values{3});
  EXPECT_EQ(written(I2C_MDR), Values{start | I2C_MDR_STP_MASK});
  module(I2C_FFRX, 3u << I2C_FFRX_RXFFST_LSB);
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY) << "the stop is on its way";
  module(I2C_MDR, 0);
  EXPECT_EQ(hal_nvm_step(), NVM_DONE);
  EXPECT_EQ(hal_nvm_fault(), NVM_NO_FAULT);
}

TEST_F(Nvm, a_write_keeps_the_fifo_full_and_then_asks_until_it_is_stored) {
  std::uint16_t page[20];
  for (std::uint16_t n = 0; n < 20; ++n) page[n] = static_cast<std::uint16_t>(100 + n);
  bus.forget_steps();
  ASSERT_TRUE(hal_nvm_write(0x0540, page, 20));
  EXPECT_EQ(written(I2C_CNT), Values{22});
  EXPECT_EQ(written(I2C_MDR), Values{I2C_MDR_IRS_MASK | I2C_MDR_FREE_MASK | I2C_MDR_MST_MASK | I2C_MDR_STT_MASK |
                                     I2C_MDR_TRX_MASK | I2C_MDR_STP_MASK});
  module(I2C_FFTX, 2u << I2C_FFTX_TXFFST_LSB);
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY);
  ASSERT_EQ(written(I2C_DXR).size(), 16u) << "two of the address and 14 that fit";
  EXPECT_EQ(written(I2C_DXR)[0], 0x05u);
  EXPECT_EQ(written(I2C_DXR)[1], 0x40u);
  module(I2C_FFTX, 15u << I2C_FFTX_TXFFST_LSB);
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY);
  ASSERT_EQ(written(I2C_DXR).size(), 17u);
  module(I2C_FFTX, 0);
  module(I2C_MDR, 0);
  bus.forget_steps();
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY) << "the memory stores it";
  EXPECT_EQ(written(I2C_DXR), (Values{115, 116, 117, 118, 119, 0x05, 0x40})) << "the rest, and the first question";
  EXPECT_EQ(written(I2C_CNT), Values{2}) << "which writes nothing";
  module(I2C_MDR, 0);
  EXPECT_EQ(hal_nvm_step(), NVM_DONE);
}

// 10 ms without progress, and every progress gives another 10 ms.
TEST_F(Nvm, time_runs_from_the_last_progress_of_a_read) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 4));
  bus.cycles += kAlmost;
  EXPECT_EQ(step_with(I2C_STR_ARDY_MASK), NVM_BUSY);
  step_after(kAlmost);
  EXPECT_FALSE(is_clearing()) << "the address has gone out meanwhile";
  module(I2C_FFRX, 1u << I2C_FFRX_RXFFST_LSB);
  step_after(kMillisecond / 2);
  module(I2C_FFRX, 0);
  step_after(kAlmost);
  EXPECT_FALSE(is_clearing()) << "an octet has come meanwhile";
  step_after(kMillisecond / 5);
  EXPECT_TRUE(is_clearing());
}

TEST_F(Nvm, time_runs_from_the_last_progress_of_a_write) {
  std::uint16_t page[40] = {};
  ASSERT_TRUE(hal_nvm_write(0, page, 40));
  module(I2C_FFTX, 16u << I2C_FFTX_TXFFST_LSB);
  step_after(kAlmost);
  step_after(kAlmost);
  EXPECT_FALSE(is_clearing()) << "the FIFO had another level";
  module(I2C_FFTX, 15u << I2C_FFTX_TXFFST_LSB);
  step_after(kMillisecond / 2);
  module(I2C_FFTX, 16u << I2C_FFTX_TXFFST_LSB);
  step_after(kAlmost);
  EXPECT_FALSE(is_clearing()) << "an octet has gone meanwhile";
  step_after(kMillisecond / 5);
  EXPECT_TRUE(is_clearing());
}

TEST_F(Nvm, time_runs_from_a_refusal_too) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 4));
  bus.cycles += kAlmost;
  bus.forget_steps();
  EXPECT_EQ(step_with(I2C_STR_NACK_MASK), NVM_BUSY);
  EXPECT_EQ(written(I2C_STR), Values{I2C_STR_NACK_MASK});
  EXPECT_EQ(written(I2C_MDR), Values{I2C_MDR_IRS_MASK | I2C_MDR_FREE_MASK | I2C_MDR_STP_MASK | I2C_MDR_MST_MASK})
      << "a stop";
  EXPECT_EQ(written(I2C_FFTX), (Values{0x4000, 0x6000})) << "what was to be sent is dropped";
  step_after(kAlmost);
  EXPECT_FALSE(is_clearing());
  step_after(kMillisecond / 5);
  EXPECT_TRUE(is_clearing()) << "the stop does not come";
}

TEST_F(Nvm, a_refused_write_that_has_stopped_is_not_told_to_stop_again) {
  ASSERT_TRUE(hal_nvm_write(0, octets, 2));
  module(I2C_MDR, 0);
  bus.forget_steps();
  EXPECT_EQ(step_with(I2C_STR_NACK_MASK), NVM_BUSY);
  EXPECT_TRUE(written(I2C_MDR).empty()) << "it would be a start";
}

TEST_F(Nvm, a_lost_arbitration_clears_the_bus_at_once) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 4));
  EXPECT_EQ(step_with(I2C_STR_AL_MASK), NVM_BUSY);
  EXPECT_TRUE(is_clearing());
}

TEST_F(Nvm, who_does_not_answer_is_asked_three_times) {
  for (int job = 0; job < 2; ++job) {
    bus.forget_steps();
    ASSERT_TRUE(hal_nvm_read(0, octets, 4));
    EXPECT_EQ(hal_nvm_fault(), NVM_NO_FAULT) << "of this job";
    EXPECT_EQ(refuse(), NVM_BUSY);
    EXPECT_EQ(refuse(), NVM_BUSY);
    EXPECT_EQ(refuse(), NVM_FAILED);
    EXPECT_EQ(hal_nvm_fault(), NVM_NO_ANSWER);
    EXPECT_EQ(starts(), 3);
  }
}

// A page takes 5 ms at most; the patience is four times that, and a try comes behind its end however late the steps.
TEST_F(Nvm, a_memory_that_stores_is_asked_for_20_ms) {
  ASSERT_TRUE(hal_nvm_write(0, octets, 2));
  ASSERT_EQ(hal_nvm_step(), NVM_BUSY);
  module(I2C_MDR, 0);
  ASSERT_EQ(hal_nvm_step(), NVM_BUSY);
  for (int k = 0; k < 19; ++k) {
    bus.cycles += kMillisecond;
    ASSERT_EQ(refuse(), NVM_BUSY) << "after " << k + 1 << " ms";
  }
  bus.cycles += 2 * kMillisecond;
  const int before = starts();
  EXPECT_EQ(refuse(), NVM_BUSY);
  EXPECT_EQ(starts(), before + 1) << "once more";
  EXPECT_EQ(refuse(), NVM_FAILED);
  EXPECT_EQ(hal_nvm_fault(), NVM_NO_ANSWER);
  EXPECT_EQ(starts(), before + 1);
}

TEST_F(Nvm, lines_that_are_low_have_a_millisecond_to_rise) {
  lines(false);
  bus.forget_steps();
  ASSERT_TRUE(hal_nvm_read(0, octets, 4));
  step_after(kMillisecond - kHalfClock);
  EXPECT_EQ(starts(), 0);
  EXPECT_FALSE(is_clearing());
  lines(true);
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY);
  EXPECT_EQ(starts(), 1) << "as soon as they are high";
  EXPECT_EQ(refuse(), NVM_BUSY);
  EXPECT_EQ(refuse(), NVM_BUSY);
  EXPECT_EQ(refuse(), NVM_FAILED);
  lines(false);
  ASSERT_TRUE(hal_nvm_read(0, octets, 4));
  step_after(kMillisecond + kHalfClock);
  EXPECT_TRUE(is_clearing());
}

class NvmLines : public Nvm {
 protected:
  static constexpr unsigned kSda = 1, kScl = 2;  // GPIO32, GPIO33 in port B
  /// The bus is being cleared, and a device holds SDA low for so many clocks more.
  void clear(unsigned clocks) {
    ASSERT_TRUE(hal_nvm_read(0, octets, 4));
    EXPECT_EQ(step_after(kStandstill), NVM_BUSY);
    ASSERT_TRUE(is_clearing());
    held = clocks;
    bus.between = [this] {
      const unsigned is = ~bus.words[REG_GPBDIR] & 3u;  // an output pulls low
      if (is == driven) return;
      held -= held > 0 && (is & ~driven & kScl) != 0 ? 1 : 0;
      driven = is;
      course.push_back(is);
      bus.words[REG_GPBDAT] = static_cast<std::uint16_t>(0xFFFCu | (held > 0 ? is & ~kSda : is));
    };
    bus.words[REG_GPBDAT] = static_cast<std::uint16_t>(held > 0 ? 0xFFFE : 0xFFFF);
  }
  unsigned held = 0;
  unsigned driven = kSda | kScl;
  std::vector<unsigned> course;  // of the two lines, as the chip drives them
};

TEST_F(NvmLines, are_clocked_until_sda_rises_and_then_stopped) {
  clear(2);
  EXPECT_EQ(bus.words[I2C_BASE + I2C_MDR], 0) << "the module is off the bus";
  for (int k = 0; k < 20 && is_clearing(); ++k) {
    const std::size_t edges = course.size();
    bus.cycles += kHalfClock - 50;
    hal_nvm_step();
    EXPECT_EQ(course.size(), edges) << "edges are 10 us apart";
    step_after(50);
  }
  const unsigned both = kSda | kScl;
  EXPECT_EQ(course, (std::vector<unsigned>{kSda, both, kSda, both, kSda, 0, kScl, both})) << "two clocks and a stop";
  EXPECT_EQ(bus.word32(REG_GPBMUX1) & 0xFu, 0x5u);
  bus.between = nullptr;
  EXPECT_EQ(hal_nvm_step(), NVM_BUSY);
  EXPECT_EQ(starts(), 2) << "the whole job again";
}

TEST_F(NvmLines, are_clocked_nine_times_at_most) {
  clear(1000);
  for (int k = 0; k < 40 && hal_nvm_step() == NVM_BUSY; ++k) bus.cycles += kHalfClock;
  EXPECT_EQ(course.size(), 18u);
  EXPECT_EQ(hal_nvm_fault(), NVM_BUS_HUNG);
}

}  // namespace stillspin::test
