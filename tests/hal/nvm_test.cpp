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

}  // namespace stillspin::test
