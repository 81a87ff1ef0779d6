// eCAN: what the mailboxes send and take.

#include "tests/chip/ecan.hpp"

namespace stillspin::chip::testing {
namespace {

// ---- transmission ------------------------------------------------------------------------------------------

TEST_F(ECanTest, sends_octets_in_the_order_that_dbo_gives) {
  configure();
  start();
  set_up(0, standard(0x123), false, 5);
  write(REG_CANMDL(0), 0x01020304);
  write(REG_CANMDH(0), 0x05060708);
  write(REG_CANTRS, 1);
  ASSERT_NE(can.can_offer(), nullptr);
  EXPECT_EQ(*can.can_offer(), frame(0x123, {1, 2, 3, 4, 5}));
  write(REG_CANMC, CANMC_SCB_MASK | CANMC_DBO_MASK);
  EXPECT_EQ(*can.can_offer(), frame(0x123, {4, 3, 2, 1, 8}));
  transmit();
  EXPECT_EQ(read(REG_CANTRS), 0u);
  EXPECT_EQ(read(REG_CANTA), 1u);
  EXPECT_EQ(can.can_offer(), nullptr);
  write(REG_CANTA, 1);
  EXPECT_EQ(read(REG_CANTA), 0u);
}

TEST_F(ECanTest, priority_then_number_decide_what_goes_first) {
  configure();
  start();
  set_up(4, standard(4), false, 0);
  set_up(9, standard(9), false, 0);
  set_up(2, standard(2), false, 7u << CANMSGCTRL_TPL_LSB);
  write(REG_CANTRS, 1u << 2 | 1u << 4 | 1u << 9);
  for (const std::uint32_t id : {2u, 9u, 4u}) {
    ASSERT_NE(can.can_offer(), nullptr);
    EXPECT_EQ(can.can_offer()->id, id);
    transmit();
  }
}

TEST_F(ECanTest, a_request_is_taken_back_at_once_unless_it_is_being_sent) {
  configure();
  start();
  set_up(4, standard(4), false);
  set_up(5, standard(5), false);
  write(REG_CANTRS, 0x30);
  can.can_busy(now, true);
  write(REG_CANTRR, 0x30);
  EXPECT_EQ(read(REG_CANTRS), 0x20u) << "5 is on the wire";
  EXPECT_EQ(read(REG_CANAA), 0x10u);
  can.can_failed(CanError::kBit, true, now);
  EXPECT_EQ(read(REG_CANTRS), 0u) << "and is not tried again";
  EXPECT_EQ(read(REG_CANAA), 0x30u);
  EXPECT_EQ(read(REG_CANTA), 0u);
}

TEST_F(ECanTest, a_receive_mailbox_cannot_be_asked_to_send) {
  configure();
  start();
  set_up(4, standard(4), true);
  write(REG_CANTRS, 1u << 4);
  EXPECT_EQ(read(REG_CANTRS), 0u);
}

TEST_F(ECanTest, erratum_sending_stops_until_ccr_has_been_set_and_cleared) {
  configure();
  start();
  set_up(4, standard(4), false);
  set_up(8, standard(8), true);
  can.stop_transmission(now);
  write(REG_CANTRS, 1u << 4);
  pass(100'000);
  EXPECT_EQ(can.can_offer(), nullptr);
  EXPECT_EQ(read(REG_CANTRS), 1u << 4) << "the request stays";
  EXPECT_EQ(read(REG_CANTEC), 0u) << "and nothing else shows it";
  hear(frame(8));
  EXPECT_EQ(read(REG_CANRMP), 1u << 8) << "reception goes on";
  write(REG_CANMC, CANMC_SCB_MASK | CANMC_CCR_MASK);
  ASSERT_TRUE(status(CANES_CCE_MASK));
  start();
  EXPECT_NE(can.can_offer(), nullptr);
}

// ---- reception -----------------------------------------------------------------------------------------------

TEST_F(ECanTest, the_highest_mailbox_that_fits_takes_a_frame) {
  configure();
  start();
  set_up(3, standard(0x40), true);
  set_up(7, standard(0x40), true);
  set_up(9, standard(0x41), true);
  hear(frame(0x40, {0xAA, 0xBB}));
  EXPECT_EQ(read(REG_CANRMP), 1u << 7);
  EXPECT_EQ(read(REG_CANMDL(7)), 0xAABB0000u);
  EXPECT_EQ(read(REG_CANMSGCTRL(7)) & CANMSGCTRL_DLC_MASK, 2u);
}

TEST_F(ECanTest, masks_say_which_bits_do_not_matter) {
  configure();
  start();
  write(REG_CANLAM(6), standard(0x0F));
  set_up(6, CANMSGID_AME_MASK | standard(0x120), true);
  hear(frame(0x12B));
  EXPECT_EQ(read(REG_CANRMP), 1u << 6);
  EXPECT_EQ(read(REG_CANMSGID(6)) & ~CANMSGID_AME_MASK, standard(0x12B)) << "the identifier that came";
  write(REG_CANRMP, 1u << 6);
  hear(frame(0x130));
  hear(frame(0x120u << 18, {}, true));
  EXPECT_EQ(read(REG_CANRMP), 0u) << "another identifier; an extended frame";
  write(REG_CANLAM(6), standard(0x7FF) | CANLAM_LAMI_MASK | 0x3FFFF);
  hear(frame(0x1ABCDEF0, {}, true));
  EXPECT_EQ(read(REG_CANRMP), 1u << 6) << "either format";
  EXPECT_TRUE(read(REG_CANMSGID(6)) & CANMSGID_IDE_MASK);
}

TEST_F(ECanTest, without_ame_the_mask_is_not_used) {
  configure();
  start();
  write(REG_CANLAM(6), 0xFFFFFFFF);
  set_up(6, standard(0x120), true);
  hear(frame(0x121));
  EXPECT_EQ(read(REG_CANRMP), 0u);
}

TEST_F(ECanTest, a_protected_mailbox_passes_the_next_frame_on_an_open_one_loses_its_own) {
  configure();
  start();
  set_up(20, standard(0x40), true);
  set_up(19, standard(0x40), true);
  write(REG_CANOPC, 1u << 20);
  hear(frame(0x40, {1}));
  hear(frame(0x40, {2}));
  EXPECT_EQ(read(REG_CANRML), 0u);
  hear(frame(0x40, {3}));
  EXPECT_EQ(read(REG_CANMDL(20)) >> 24, 1u);
  EXPECT_EQ(read(REG_CANMDL(19)) >> 24, 3u);
  EXPECT_EQ(read(REG_CANRML), 1u << 19) << "and says so";
  EXPECT_TRUE(read(REG_CANGIF0) & CANGIF_RMLIF_MASK);
  write(REG_CANRMP, 1u << 19);
  EXPECT_EQ(read(REG_CANRML), 0u);
  write(REG_CANOPC, 1u << 20 | 1u << 19);
  hear(frame(0x40, {4}));
  hear(frame(0x40, {5}));
  EXPECT_EQ(read(REG_CANMDL(19)) >> 24, 4u) << "all protected: the new one is lost";
  EXPECT_EQ(read(REG_CANRML), 0u) << "without a word";
}

TEST_F(ECanTest, time_stamps_count_bits) {
  configure();
  start();
  set_up(8, standard(8), true);
  hear(frame(8));
  const std::uint32_t first = read(REG_CANMOTS(8));
  write(REG_CANRMP, 1u << 8);
  pass(947 * kCanBit);
  hear(frame(8));
  EXPECT_EQ(read(REG_CANMOTS(8)) - first, 1000u);
  EXPECT_EQ(read(REG_CANTSC) - read(REG_CANMOTS(8)), 3u);
}

TEST_F(ECanTest, a_remote_frame_is_marked_as_one) {
  configure();
  start();
  set_up(8, standard(8), true);
  CanFrame remote = frame(8);
  remote.remote = true;
  remote.length = 4;
  hear(remote);
  EXPECT_EQ(read(REG_CANRFP), 1u << 8);
  EXPECT_TRUE(read(REG_CANMSGCTRL(8)) & CANMSGCTRL_RTR_MASK);
}

}  // namespace
}  // namespace stillspin::chip::testing
