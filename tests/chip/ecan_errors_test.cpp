// eCAN: errors, error counters, bus-off.

#include "tests/chip/ecan.hpp"

namespace stillspin::chip::testing {
namespace {

// ---- errors --------------------------------------------------------------------------------------------------

TEST_F(ECanTest, missing_acknowledgment_makes_it_passive_and_no_more) {
  configure();
  start();
  set_up(4, standard(4), false);
  write(REG_CANTRS, 1u << 4);
  for (int i = 0; i < 12; ++i) fail(CanError::kAcknowledge, true);
  EXPECT_EQ(read(REG_CANTEC), 96u);
  EXPECT_TRUE(status(CANES_EW_MASK));
  EXPECT_FALSE(status(CANES_EP_MASK));
  for (int i = 0; i < 100; ++i) fail(CanError::kAcknowledge, true);
  EXPECT_EQ(read(REG_CANTEC), 128u);
  EXPECT_TRUE(can.can_error_passive());
  EXPECT_TRUE(status(CANES_EP_MASK) && status(CANES_ACKE_MASK));
  EXPECT_FALSE(status(CANES_BO_MASK));
  transmit();
  EXPECT_EQ(read(REG_CANTEC), 127u);
  EXPECT_FALSE(status(CANES_EP_MASK));
  write(REG_CANES, CANES_ACKE_MASK);
  EXPECT_FALSE(status(CANES_ACKE_MASK));
}

TEST_F(ECanTest, receive_errors_count_up_and_a_good_frame_takes_them_down) {
  configure();
  start();
  for (int i = 0; i < 200; ++i) fail(CanError::kStuff, false);
  EXPECT_EQ(read(REG_CANREC), 128u);
  EXPECT_TRUE(status(CANES_EP_MASK) && status(CANES_SE_MASK));
  hear(frame(1));
  EXPECT_EQ(read(REG_CANREC), 119u);
  hear(frame(1));
  EXPECT_EQ(read(REG_CANREC), 118u);
}

TEST_F(ECanTest, who_finds_an_error_first_pays_more) {
  configure();
  start();
  fail(CanError::kForm, false);
  EXPECT_EQ(read(REG_CANREC), 9u);
  EXPECT_TRUE(status(CANES_FE_MASK));
}

TEST_F(ECanTest, bus_off_sets_ccr_and_ends_after_128_quiet_times_once_ccr_is_cleared) {
  configure();
  start();
  set_up(4, standard(4), false);
  write(REG_CANTRS, 1u << 4);
  for (int i = 0; i < 32; ++i) fail(CanError::kBit, true);
  ASSERT_TRUE(status(CANES_BO_MASK));
  EXPECT_EQ(can.can_bit_time(), 0);
  EXPECT_TRUE(read(REG_CANMC) & CANMC_CCR_MASK);
  EXPECT_TRUE(status(CANES_CCE_MASK));
  pass(300 * 11 * kCanBit);
  EXPECT_TRUE(status(CANES_BO_MASK)) << "not by itself";
  EXPECT_EQ(read(REG_CANREC), 128u) << "counts the quiet times";
  write(REG_CANMC, CANMC_SCB_MASK);
  pass(11 * kCanBit);
  EXPECT_FALSE(status(CANES_BO_MASK));
  EXPECT_EQ(read(REG_CANTEC), 0u);
  EXPECT_NE(can.can_offer(), nullptr) << "what waited is sent";
}

TEST_F(ECanTest, clearing_ccr_at_once_does_not_shorten_bus_off) {
  configure();
  start();
  set_up(4, standard(4), false);
  write(REG_CANTRS, 1u << 4);
  for (int i = 0; i < 32; ++i) fail(CanError::kBit, true);
  const Tick off = now;
  write(REG_CANMC, CANMC_SCB_MASK);
  while (status(CANES_BO_MASK) && now < off + 1'000'000) pass(kCanBit);
  EXPECT_NEAR(double(now - off), 128.0 * 11 * kCanBit, 11 * kCanBit)
      << "the first of them ends with the error delimiter";
}

TEST_F(ECanTest, traffic_of_others_counts_as_quiet_times) {
  configure(CANMC_ABO_MASK);
  start(CANMC_ABO_MASK);
  set_up(4, standard(4), false);
  write(REG_CANTRS, 1u << 4);
  for (int i = 0; i < 32; ++i) fail(CanError::kBit, true);
  ASSERT_TRUE(status(CANES_BO_MASK));
  EXPECT_FALSE(read(REG_CANMC) & CANMC_CCR_MASK) << "ABO: back by itself";
  for (int i = 0; i < 126; ++i) {
    can.can_busy(now, false);
    pass(50 * kCanBit);
    can.can_quiet(now - 8 * kCanBit, now);
    pass(3 * kCanBit);
  }
  EXPECT_TRUE(status(CANES_BO_MASK));
  pass(2 * 11 * kCanBit);
  EXPECT_FALSE(status(CANES_BO_MASK));
}

}  // namespace
}  // namespace stillspin::chip::testing
