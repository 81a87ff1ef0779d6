// The I2C module under the memory's driver: its clock, its set-up, and the registers of a transfer.

#include "tests/hal/nvm_bus.hpp"

namespace stillspin::test {

using I2c = Nvm;

// 24LC256 at 400 kHz: low 1.3 us at least, high 0.6 us; the module's clock has to be 7 to 12 MHz.
TEST_F(I2c, the_clock_is_400_kHz_as_the_memory_and_the_module_want_it) {
  const double mhz = 100.0 / (bus.words[I2C_BASE + I2C_PSC] + 1);
  EXPECT_GE(mhz, 7.0);
  EXPECT_LE(mhz, 12.0);
  const double low = (bus.words[I2C_BASE + I2C_CLKL] + 5) / mhz, high = (bus.words[I2C_BASE + I2C_CLKH] + 5) / mhz;
  EXPECT_NEAR(low + high, 2.5, 1e-6);
  EXPECT_GE(low, 1.3);
  EXPECT_GE(high, 0.6);
}

TEST_F(I2c, the_module_is_set_up_in_reset_before_it_gets_its_pins) {
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

TEST_F(I2c, a_read_sends_the_address_and_starts_again_to_receive) {
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

TEST_F(I2c, a_write_keeps_the_fifo_full_and_then_asks_until_it_is_stored) {
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

}  // namespace stillspin::test
