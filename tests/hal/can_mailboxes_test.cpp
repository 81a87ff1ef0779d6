// The CAN driver's mailboxes on a register bus: what each of them is made of, and in which order.

#include <functional>

#include "tests/hal/can_bus.hpp"

namespace stillspin::test {

namespace {
constexpr std::uint32_t kSending = 0x07FFFFFF;  // mailboxes 0 to 26
constexpr std::uint32_t kAll = 0xFFFFFFFF;

std::uint32_t bit(unsigned mailbox) { return 1u << mailbox; }
}  // namespace

using CanMailboxes = CanOnBus;

// The memory of the mailboxes is undefined after a reset, and holds what was before after a change.
TEST_F(CanMailboxes, configuration_leaves_nothing_of_what_was_before) {
  const std::vector<hal_can_group_t> six(HAL_CAN_GROUPS_MAX, hal_can_group_t{0x7F, 0x7FF, false, 4});
  ASSERT_TRUE(hal_can_init(500'000, six.data(), HAL_CAN_GROUPS_MAX));
  start();
  for (unsigned n = 0; n < HAL_CAN_MAILBOXES; ++n) {
    set(REG_CANMSGCTRL(n), kAll);
    set(REG_CANMSGID(n), 0);
    set(REG_CANLAM(n), 0);
  }
  bus.forget_steps();
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  start();
  for (unsigned n = 0; n < HAL_CAN_MAILBOXES; ++n) {
    const bool first = n >= kOpen, second = !first && n > kSends;
    EXPECT_EQ(bus.word32(REG_CANMSGCTRL(n)), 0u) << "mailbox " << n;
    EXPECT_EQ(bus.word32(REG_CANMSGID(n)), first    ? CANMSGID_AME_MASK | 0x101u << CANMSGID_STANDARD_LSB
                                           : second ? CANMSGID_IDE_MASK | CANMSGID_AME_MASK | 0x1ABCDE00u
                                                    : 0u)
        << "mailbox " << n;
    EXPECT_EQ(bus.word32(REG_CANLAM(n)), first ? 0x0003FFFFu : second ? 0xFFu : 0u) << "mailbox " << n;
  }
  EXPECT_EQ(last_written(REG_CANMD), ~kSending);
  EXPECT_EQ(last_written(REG_CANME), ~kSending) << "a mailbox that sends is enabled with its frame";
  EXPECT_EQ(last_written(REG_CANOPC), bit(31) | bit(30) | bit(28)) << "the last of each group is open";
  EXPECT_EQ(last_written(REG_CANTRR), kAll);
  EXPECT_EQ(last_written(REG_CANTA), kAll);
  EXPECT_EQ(last_written(REG_CANAA), kAll);
  EXPECT_EQ(last_written(REG_CANRMP), kAll);
  EXPECT_EQ(last_written(REG_CANES),
            CANES_ACKE_MASK | CANES_SE_MASK | CANES_CRCE_MASK | CANES_SA1_MASK | CANES_BE_MASK | CANES_FE_MASK);
}

TEST_F(CanMailboxes, configuration_has_its_order) {
  bus.forget_steps();
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  hal_can_service();
  EXPECT_EQ(bus.first_write(REG_CANBTC), FakeBus::npos) << "the controller is not in configuration yet";
  EXPECT_EQ(last_written(REG_CANMC) & (CANMC_CCR_MASK | CANMC_SCB_MASK | CANMC_ABO_MASK),
            CANMC_CCR_MASK | CANMC_SCB_MASK)
      << "configuration, 32 mailboxes, no way back from bus-off by itself";
  EXPECT_EQ(last_written(REG_CANTIOC), CANTIOC_TXFUNC_MASK);
  EXPECT_EQ(last_written(REG_CANRIOC), CANRIOC_RXFUNC_MASK);
  start();
  const std::size_t off = bus.first_write(REG_CANME), on = bus.last_write(REG_CANME);
  EXPECT_EQ(bus.steps.at(off).value, 0u);
  expect_before(off, bus.first_write(REG_CANMSGID(kExtended)), "identifiers while their mailbox is disabled");
  expect_before(bus.last_write(REG_CANMSGID(kFirst)), on, "identifiers while their mailbox is disabled");
  expect_before(bus.last_write(REG_CANRMP), on, "what came before is forgotten before more may come");
  expect_before(on, bus.last_write(REG_CANMC), "then onto the bus");
  EXPECT_EQ(last_written(REG_CANMC) & (CANMC_CCR_MASK | CANMC_SCB_MASK | CANMC_SUSP_MASK),
            CANMC_SCB_MASK | CANMC_SUSP_MASK)
      << "and a debugger does not stop it";
}

TEST_F(CanMailboxes, both_pins_are_the_controllers) {
  bus.words[REG_GPAPUD + 1] = 0xFFFF;
  bus.words[REG_GPAQSEL2 + 1] = 0;
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  EXPECT_EQ(bus.word32(REG_GPAMUX2) >> 28, 0x5u) << "GPIO30 and 31";
  EXPECT_EQ(bus.word32(REG_GPAQSEL2) >> 28, 0xFu) << "not sampled, which would be late";
  EXPECT_EQ(bus.word32(REG_GPAPUD) >> 30, 0u) << "an open line is recessive";
}

TEST_F(CanMailboxes, a_frame_goes_into_its_mailbox_while_that_is_disabled) {
  bus.forget_steps();
  const hal_can_frame_t frame = {0x3181, false, 5, {0x181, 2, 3, 4, 5, 6, 7, 8}};
  ASSERT_TRUE(hal_can_send(&frame, 2));
  EXPECT_EQ(last_written(REG_CANMSGID(kSends)), 0x181u << CANMSGID_STANDARD_LSB) << "11 bits";
  EXPECT_EQ(last_written(REG_CANMSGCTRL(kSends)), 5u | 16u << CANMSGCTRL_TPL_LSB);
  EXPECT_EQ(last_written(REG_CANMDL(kSends)), 0x81020304u) << "8 bits an octet";
  EXPECT_EQ(last_written(REG_CANMDH(kSends)), 0x05060708u);
  const std::size_t off = bus.first_write(REG_CANME), on = bus.last_write(REG_CANME);
  EXPECT_EQ(bus.steps.at(off).value, ~kSending) << "the others go on";
  EXPECT_EQ(bus.steps.at(on).value, ~kSending | bit(kSends));
  expect_before(off, bus.first_write(REG_CANMSGID(kSends)), "disabled first");
  expect_before(bus.last_write(REG_CANMDH(kSends)), on, "and enabled when all is there");
  expect_before(on, bus.first_write(REG_CANTRS), "then asked to be sent");
  EXPECT_EQ(last_written(REG_CANTRS), bit(kSends)) << "alone: a one is a request";
  EXPECT_EQ(last_written(REG_CANTA), bit(kSends));

  const hal_can_frame_t extended = {0xFABCDEF1, true, 0, {}};
  ASSERT_TRUE(hal_can_send(&extended, 0));
  EXPECT_EQ(last_written(REG_CANMSGID(kSends - 1)), CANMSGID_IDE_MASK | 0x1ABCDEF1u) << "29 bits";
  EXPECT_EQ(last_written(REG_CANMSGCTRL(kSends - 1)), 0u);
  EXPECT_EQ(last_written(REG_CANME), ~kSending | bit(kSends) | bit(kSends - 1)) << "the first one stays enabled";
}

TEST_F(CanMailboxes, all_that_are_left_send_from_above_down) {
  const hal_can_frame_t frame = message();
  std::uint32_t requested = 0;
  for (unsigned n = kSends + 1; n-- > 0;) {
    ASSERT_TRUE(hal_can_send(&frame, 0)) << "mailbox " << n;
    EXPECT_EQ(last_written(REG_CANTRS), bit(n)) << "of equal priority the higher one goes first";
    requested |= bit(n);
    set(REG_CANTRS, requested);
    EXPECT_EQ(hal_can_waiting(0), kSends + 1 - n);
  }
  EXPECT_FALSE(hal_can_send(&frame, 0)) << "all are full";
  EXPECT_FALSE(hal_can_send(&frame, 1));
  set(REG_CANTRS, requested & ~bit(kSends));
  EXPECT_FALSE(hal_can_send(&frame, 0)) << "it would overtake those below";
  EXPECT_EQ(hal_can_waiting(0), kSends);
  EXPECT_TRUE(hal_can_send(&frame, 1)) << "which another priority may";
  EXPECT_EQ(last_written(REG_CANTRS), bit(kSends));
  hal_can_cancel(0);
  EXPECT_EQ(last_written(REG_CANTRR), kSending & ~bit(kSends)) << "of this priority alone";
}

TEST_F(CanMailboxes, none_overtakes_the_last_of_a_full_house) {
  const hal_can_frame_t frame = message();
  for (unsigned n = 0; n <= kSends; ++n) ASSERT_TRUE(hal_can_send(&frame, 0));
  set(REG_CANTRS, bit(0));  // all others have gone
  EXPECT_EQ(hal_can_waiting(0), 1);
  EXPECT_FALSE(hal_can_send(&frame, 0));
  set(REG_CANTRS, 0);
  EXPECT_TRUE(hal_can_send(&frame, 0));
}

// Cleared, it takes the next frame; the open one is cleared before, so that what overwrites it is seen.
TEST_F(CanMailboxes, a_protected_one_is_cleared_behind_its_reading_and_the_open_one_before) {
  hal_can_frame_t frame = {};
  for (const unsigned n : {kFirst, kOpen}) {
    set(REG_CANRMP, bit(n));
    set(REG_CANMSGCTRL(n), 6);
    set(REG_CANMDL(n), 0x11223344);
    set(REG_CANMDH(n), 0x55667788);
    bus.forget_steps();
    if (n == kOpen) bus.between = [this] { set(REG_CANRMP, 0); };
    ASSERT_TRUE(hal_can_receive(0, &frame));
    bus.between = nullptr;
    EXPECT_EQ(frame.length, 6);
    for (unsigned i = 0; i < 8; ++i) EXPECT_EQ(frame.data[i], 0x11u * (i + 1));
    ASSERT_EQ(bus.count_writes(), 1u);
    EXPECT_EQ(last_written(REG_CANRMP), bit(n));
    const std::size_t cleared = bus.first_write(REG_CANRMP), read = bus.first_read(REG_CANMDL(n));
    EXPECT_EQ(cleared < read, n == kOpen);
  }
  EXPECT_EQ(hal_can_status().lost, 0);
}

TEST_F(CanMailboxes, a_frame_that_was_overwritten_is_counted_once) {
  hal_can_frame_t frame = {};
  for (const unsigned n : {kFirst, kOpen}) {
    set(REG_CANRMP, bit(n));
    set(REG_CANRML, bit(n));
    bus.between = [this] {
      set(REG_CANRMP, 0);
      set(REG_CANRML, 0);
    };
    ASSERT_TRUE(hal_can_receive(0, &frame));
    bus.between = nullptr;
    EXPECT_EQ(hal_can_status().lost, n == kOpen ? 1 : 0) << "a protected one cannot be";
  }
}

TEST_F(CanMailboxes, a_remote_request_is_passed_over) {
  set(REG_CANRMP, bit(kFirst) | bit(kFirst - 1));
  set(REG_CANMOTS(kFirst), 10);
  set(REG_CANMOTS(kFirst - 1), 20);
  set(REG_CANMSGCTRL(kFirst), CANMSGCTRL_RTR_MASK | 8u);
  set(REG_CANMSGCTRL(kFirst - 1), 1);
  bus.forget_steps();
  hal_can_frame_t frame = {};
  ASSERT_TRUE(hal_can_receive(0, &frame));
  EXPECT_EQ(frame.length, 1) << "the one behind it";
  EXPECT_NE(bus.first_write(REG_CANRMP, bit(kFirst)), FakeBus::npos) << "its mailbox is free again";
  set(REG_CANRMP, bit(kFirst));
  EXPECT_FALSE(hal_can_receive(0, &frame)) << "there is no other";
}

TEST_F(CanMailboxes, nothing_is_received_or_sent_once_it_is_off) {
  const hal_can_frame_t sent = message();
  const std::function<void()> ways[] = {hal_can_off, [] { EXPECT_FALSE(hal_can_init(1, kGroups, 2)); }};
  for (const auto& turn_off : ways) {
    ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
    start();
    ASSERT_TRUE(hal_can_send(&sent, 1));
    set(REG_CANRMP, kAll);
    bus.forget_steps();
    turn_off();
    EXPECT_NE(last_written(REG_CANMC) & CANMC_CCR_MASK, 0u);
    EXPECT_EQ(last_written(REG_CANTRR), kAll);
    EXPECT_EQ(last_written(REG_CANME), 0u);
    EXPECT_EQ(hal_can_waiting(1), 0);
    hal_can_frame_t frame = {};
    EXPECT_FALSE(hal_can_receive(0, &frame));
    EXPECT_FALSE(hal_can_send(&sent, 1));
    bus.forget_steps();
    configuration(true);
    hal_can_service();
    EXPECT_EQ(bus.count_writes(), 0u) << "for good";
  }
}

TEST_F(CanMailboxes, a_new_start_waits_for_nothing_and_hears_nothing_before_it_is_configured) {
  const hal_can_frame_t sent = message();
  ASSERT_TRUE(hal_can_send(&sent, 1));
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  set(REG_CANTRS, kAll);
  EXPECT_EQ(hal_can_waiting(1), 0);
  set(REG_CANRMP, kAll);
  hal_can_frame_t frame = {};
  EXPECT_FALSE(hal_can_receive(0, &frame));
}

}  // namespace stillspin::test
