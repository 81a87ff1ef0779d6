// How long the memory's driver waits and how often it asks, and what it does to a bus that hangs.

#include "tests/hal/nvm_bus.hpp"

namespace stillspin::test {

using NvmWaits = Nvm;

// 10 ms without progress, and every progress gives another 10 ms.
TEST_F(NvmWaits, time_runs_from_the_last_progress_of_a_read) {
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

TEST_F(NvmWaits, time_runs_from_the_last_progress_of_a_write) {
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

TEST_F(NvmWaits, time_runs_from_a_refusal_too) {
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

TEST_F(NvmWaits, a_refused_write_that_has_stopped_is_not_told_to_stop_again) {
  ASSERT_TRUE(hal_nvm_write(0, octets, 2));
  module(I2C_MDR, 0);
  bus.forget_steps();
  EXPECT_EQ(step_with(I2C_STR_NACK_MASK), NVM_BUSY);
  EXPECT_TRUE(written(I2C_MDR).empty()) << "it would be a start";
}

TEST_F(NvmWaits, a_lost_arbitration_clears_the_bus_at_once) {
  ASSERT_TRUE(hal_nvm_read(0, octets, 4));
  EXPECT_EQ(step_with(I2C_STR_AL_MASK), NVM_BUSY);
  EXPECT_TRUE(is_clearing());
}

TEST_F(NvmWaits, who_does_not_answer_is_asked_three_times) {
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
TEST_F(NvmWaits, a_memory_that_stores_is_asked_for_20_ms) {
  ASSERT_TRUE(hal_nvm_write(0, octets, 2));
  ASSERT_EQ(hal_nvm_step(), NVM_BUSY);
  module(I2C_MDR, 0);
  ASSERT_EQ(hal_nvm_step(), NVM_BUSY);
  for (int k = 0; k < 19; ++k) {
    bus.cycles += kMillisecond;
    ASSERT_EQ(refuse(), NVM_BUSY) << "after " << k + 1 << " ms";
  }
  bus.cycles += 2 * kMillisecond;
  const std::ptrdiff_t before = starts();
  EXPECT_EQ(refuse(), NVM_BUSY);
  EXPECT_EQ(starts(), before + 1) << "once more";
  EXPECT_EQ(refuse(), NVM_FAILED);
  EXPECT_EQ(hal_nvm_fault(), NVM_NO_ANSWER);
  EXPECT_EQ(starts(), before + 1);
}

TEST_F(NvmWaits, lines_that_are_low_have_a_millisecond_to_rise) {
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
