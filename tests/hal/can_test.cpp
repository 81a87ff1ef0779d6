// The CAN driver on a register bus: what it refuses, and what a controller may say that no other node makes it say.
// Mailboxes are can_mailboxes_test.cpp, states can_states_test.cpp, frames and buses can_on_chip_test.cpp.

#include "tests/hal/can_bus.hpp"

namespace stillspin::test {

using Can = CanOnBus;

TEST_F(Can, rates_that_cannot_be_met_are_refused) {
  for (const std::uint32_t rate : {0u, 9'999u, 10'000u, 333'000u, 1'000'001u}) {
    EXPECT_FALSE(hal_can_init(rate, kGroups, 2)) << rate;
    EXPECT_EQ(hal_can_status().state, HAL_CAN_OFF);
  }
  EXPECT_TRUE(hal_can_init(1'000'000, kGroups, 2));
}

TEST_F(Can, rates_are_made_of_as_many_quanta_as_divide_the_clock) {
  struct {
    std::uint32_t rate, prescaler, before, after;
  } const rates[] = {{1'000'000, 5, 15, 4}, {20'000, 250, 15, 4}, {781'250, 8, 12, 3}, {80'000, 125, 7, 2}};
  for (const auto& r : rates) {
    ASSERT_TRUE(hal_can_init(r.rate, kGroups, 2)) << r.rate;
    configuration(true);
    hal_can_service();
    EXPECT_EQ(bus.word32(REG_CANBTC), (r.prescaler - 1) << CANBTC_BRPREG_LSB | (r.after - 1) << CANBTC_SJWREG_LSB |
                                          (r.before - 1) << CANBTC_TSEG1REG_LSB | (r.after - 1) << CANBTC_TSEG2REG_LSB)
        << r.rate;
  }
}

TEST_F(Can, groups_leave_a_mailbox_to_send_from) {
  const auto fits = [](std::uint16_t first, std::uint16_t second) {
    const hal_can_group_t groups[] = {{0x101, 0x7FF, false, first}, {0x201, 0x7FF, false, second}};
    return hal_can_init(500'000, groups, 2);
  };
  EXPECT_TRUE(fits(16, 15));
  EXPECT_FALSE(fits(16, 16));
  EXPECT_FALSE(fits(16, 0)) << "a group that hears nothing";
  const std::vector<hal_can_group_t> many(HAL_CAN_GROUPS_MAX + 1, hal_can_group_t{0x101, 0x7FF, false, 1});
  EXPECT_TRUE(hal_can_init(500'000, many.data(), HAL_CAN_GROUPS_MAX));
  EXPECT_FALSE(hal_can_init(500'000, many.data(), HAL_CAN_GROUPS_MAX + 1));
}

TEST_F(Can, a_node_that_hears_nobody_sends_from_every_mailbox) {
  ASSERT_TRUE(hal_can_init(500'000, nullptr, 0));
  configuration(true);
  hal_can_service();
  EXPECT_EQ(bus.word32(REG_CANMD), 0u) << "none receives";
  configuration(false);
  hal_can_service();
  const hal_can_frame_t frame = {0x123, false, 0, {}};
  for (unsigned n = 0; n < HAL_CAN_MAILBOXES; ++n) EXPECT_TRUE(hal_can_send(&frame, 0)) << n;
}

TEST_F(Can, groups_have_identifiers_of_either_length) {
  EXPECT_EQ(bus.word32(REG_CANMSGID(kFirst)), CANMSGID_AME_MASK | 0x101u << CANMSGID_STANDARD_LSB);
  EXPECT_EQ(bus.word32(REG_CANMSGID(kExtended)), CANMSGID_IDE_MASK | CANMSGID_AME_MASK | 0x1ABCDE00u);
  EXPECT_EQ(bus.word32(REG_CANLAM(kExtended)), 0xFFu);
  set(REG_CANRMP, 1u << kExtended);
  set(REG_CANMSGID(kExtended), CANMSGID_IDE_MASK | 0x1ABCDE07u);
  hal_can_frame_t frame = {};
  ASSERT_TRUE(hal_can_receive(1, &frame));
  EXPECT_TRUE(frame.extended);
  EXPECT_EQ(frame.id, 0x1ABCDE07u);
  set(REG_CANRMP, 1u << kFirst);
  set(REG_CANMSGID(kFirst), 0x101u << CANMSGID_STANDARD_LSB);
  ASSERT_TRUE(hal_can_receive(0, &frame));
  EXPECT_FALSE(frame.extended);
  EXPECT_EQ(frame.id, 0x101u);
}

// DLC has four bits: 9 to 15 mean eight octets, too.
TEST_F(Can, frames_have_eight_octets_at_most) {
  hal_can_frame_t frame = {};
  for (const std::uint16_t length : {0, 7, 8, 9, 15}) {
    set(REG_CANRMP, 1u << kFirst);
    set(REG_CANMSGCTRL(kFirst), length);
    ASSERT_TRUE(hal_can_receive(0, &frame));
    EXPECT_EQ(frame.length, std::min<std::uint16_t>(length, 8));
  }
}

// A mailbox that was emptied may hold a younger frame than those below it.
TEST_F(Can, the_oldest_frame_goes_first_wherever_it_lies) {
  const auto first_of = [this](std::uint32_t upper, std::uint32_t lower) {
    set(REG_CANRMP, 3u << (kFirst - 1));
    set(REG_CANMOTS(kFirst), upper);
    set(REG_CANMOTS(kFirst - 1), lower);
    set(REG_CANMDL(kFirst), 0x55000000);
    set(REG_CANMDL(kFirst - 1), 0xAA000000);
    hal_can_frame_t frame = {};
    EXPECT_TRUE(hal_can_receive(0, &frame));
    return frame.data[0];
  };
  EXPECT_EQ(first_of(10, 20), 0x55);
  EXPECT_EQ(first_of(20, 10), 0xAA);
  EXPECT_EQ(first_of(5, 0xFFFFFFF0), 0xAA) << "the stamps have begun again";
}

// The open mailbox, overwritten while it is read, is read again, but not for ever.
TEST_F(Can, a_mailbox_that_is_overwritten_all_the_time_is_given_up) {
  hal_can_frame_t frame = {};
  set(REG_CANRMP, 1u << kOpen);  // and stays so, on this bus
  ASSERT_TRUE(hal_can_receive(0, &frame));
  EXPECT_EQ(hal_can_status().lost, 3) << "frames that were overwritten";
  set(REG_CANRMP, 1u << kOpen);
  bus.between = [this] { set(REG_CANRMP, 0); };
  ASSERT_TRUE(hal_can_receive(0, &frame));
  bus.between = nullptr;
  EXPECT_EQ(hal_can_status().lost, 3) << "a quiet one is read once";
}

TEST_F(Can, lost_frames_are_counted_to_the_end_of_a_word) {
  hal_can_frame_t frame = {};
  set(REG_CANRMP, 1u << kOpen);
  set(REG_CANRML, 1u << kOpen);
  for (unsigned k = 0; k < 65536 / 6 + 1; ++k) {
    (void)hal_can_receive(0, &frame);
    bus.forget_steps();
  }
  EXPECT_EQ(hal_can_status().lost, 65535) << "none is no count to come back to";
}

TEST_F(Can, what_does_not_exist_is_refused) {
  hal_can_frame_t frame = message();
  set(REG_CANRMP, 0xFFFFFFFF);
  EXPECT_FALSE(hal_can_receive(2, &frame)) << "there are two groups";
  const hal_can_frame_t whole = message(8), longer = message(9);
  bus.forget_steps();
  EXPECT_FALSE(hal_can_send(&whole, HAL_CAN_PRIORITIES));
  EXPECT_FALSE(hal_can_send(&longer, 0));
  hal_can_cancel(HAL_CAN_PRIORITIES);
  EXPECT_EQ(bus.count_writes(), 0u);
  EXPECT_EQ(hal_can_waiting(HAL_CAN_PRIORITIES), 0);
  EXPECT_TRUE(hal_can_send(&whole, HAL_CAN_PRIORITIES - 1));
  EXPECT_EQ(hal_can_waiting(HAL_CAN_PRIORITIES - 1), 1);
  hal_can_cancel(HAL_CAN_PRIORITIES - 1);
  EXPECT_EQ(bus.word32(REG_CANTRR), 1u << 26) << "the uppermost of those that send";
}

// 11 recessive bits lie between the two.
TEST_F(Can, it_takes_part_when_the_controller_has_left_configuration) {
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  configuration(false);
  hal_can_service();
  for (int k = 0; k < 3; ++k) {
    configuration(true);
    hal_can_service();
    EXPECT_EQ(hal_can_status().state, HAL_CAN_STARTING);
    const hal_can_frame_t frame = message();
    EXPECT_FALSE(hal_can_send(&frame, 0));
  }
  configuration(false);
  hal_can_service();
  EXPECT_EQ(hal_can_status().state, HAL_CAN_ACTIVE);
}

TEST_F(Can, only_a_bus_that_is_off_is_recovered) {
  bus.forget_steps();
  hal_can_recover();
  EXPECT_EQ(bus.count_writes(), 0u);
  set(REG_CANES, CANES_BO_MASK);
  hal_can_service();
  bus.forget_steps();
  hal_can_recover();
  EXPECT_NE(bus.first_write(REG_CANMC), FakeBus::npos);
  hal_can_off();
  bus.forget_steps();
  hal_can_recover();
  EXPECT_EQ(bus.count_writes(), 0u) << "it was switched off";
}

}  // namespace stillspin::test
