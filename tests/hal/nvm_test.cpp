// The memory's driver on a register bus: a module and lines that do what no memory makes them do. Registers are
// i2c_test.cpp, waits nvm_waits_test.cpp, transfers and memories on_chip_nvm_test.cpp.

#include "tests/hal/nvm_bus.hpp"

namespace stillspin::test {

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

}  // namespace stillspin::test
