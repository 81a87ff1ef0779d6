// What the CAN driver says of the bus and does about it, on a register bus: errors, bus-off, mailboxes that do not
// empty.

#include "tests/hal/can_bus.hpp"

namespace stillspin::test {

using CanStates = CanOnBus;

TEST_F(CanStates, its_state_is_what_the_controllers_errors_say) {
  const auto state_of = [this](std::uint32_t errors) {
    set(REG_CANES, errors);
    return hal_can_status().state;
  };
  EXPECT_EQ(state_of(CANES_EW_MASK), HAL_CAN_WARNING);
  EXPECT_EQ(state_of(CANES_EW_MASK | CANES_EP_MASK), HAL_CAN_PASSIVE);
  EXPECT_EQ(state_of(CANES_EW_MASK | CANES_EP_MASK | CANES_BO_MASK), HAL_CAN_BUS_OFF);
  EXPECT_EQ(
      state_of(CANES_ACKE_MASK | CANES_SE_MASK | CANES_CRCE_MASK | CANES_SA1_MASK | CANES_BE_MASK | CANES_FE_MASK),
      HAL_CAN_ACTIVE)
      << "errors that have been";
  set(REG_CANTEC, 0xFFFFFF81);
  set(REG_CANREC, 0xFFFFFF42);
  EXPECT_EQ(hal_can_status().transmit_errors, 0x81);
  EXPECT_EQ(hal_can_status().receive_errors, 0x42);
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  EXPECT_EQ(state_of(CANES_EP_MASK), HAL_CAN_STARTING);
  hal_can_off();
  EXPECT_EQ(state_of(CANES_BO_MASK), HAL_CAN_OFF);
}

TEST_F(CanStates, each_bus_off_is_counted_once_and_takes_back_what_waits) {
  for (std::uint16_t times = 1; times < 4; ++times) {
    for (std::uint16_t priority = 0; priority < HAL_CAN_PRIORITIES; ++priority) {
      const hal_can_frame_t frame = message();
      ASSERT_TRUE(hal_can_send(&frame, priority));
    }
    set(REG_CANTRS, 0x07FFFFFF);  // nothing has left its mailbox
    set(REG_CANTRR, 0);
    set(REG_CANES, CANES_BO_MASK);
    hal_can_service();
    hal_can_service();
    EXPECT_EQ(hal_can_status().bus_offs, times);
    EXPECT_EQ(bus.word32(REG_CANTRR), 0x07FFFFFFu) << "all that send";
    for (std::uint16_t priority = 0; priority < HAL_CAN_PRIORITIES; ++priority) {
      EXPECT_EQ(hal_can_waiting(priority), 0) << "it must not go when the bus is back";
    }
    hal_can_recover();
    EXPECT_EQ(bus.word32(REG_CANMC) & CANMC_CCR_MASK, 0u);
    set(REG_CANTRS, 0);
    set(REG_CANES, 0);
    hal_can_service();
    EXPECT_EQ(hal_can_status().state, HAL_CAN_ACTIVE);
  }
}

class CanThatStalls : public CanOnBus {
 protected:
  static constexpr std::uint64_t kMillisecond = 100'000;  // cycles
  static constexpr std::uint64_t kStall = 100 * kMillisecond;

  /// A frame that does not leave its mailbox.
  void stall() {
    const hal_can_frame_t frame = message();
    ASSERT_TRUE(hal_can_send(&frame, 0));
    ASSERT_TRUE(hal_can_send(&frame, 1));
    set(REG_CANTRS, 3u << (kSends - 1));
  }
  bool restarts() {
    const bool asked = (bus.word32(REG_CANMC) & CANMC_CCR_MASK) != 0;
    EXPECT_EQ(hal_can_status().state == HAL_CAN_STARTING, asked);
    return asked;
  }
};

TEST_F(CanThatStalls, restarts_after_a_tenth_of_a_second_and_keeps_what_waits) {
  stall();
  service_after(kStall - kMillisecond);
  EXPECT_FALSE(restarts());
  service_after(2 * kMillisecond);
  EXPECT_TRUE(restarts());
  EXPECT_EQ(hal_can_status().restarts, 1);
  bus.forget_steps();
  start();
  EXPECT_FALSE(restarts());
  EXPECT_EQ(bus.first_write(REG_CANME), FakeBus::npos) << "its mailboxes are as they were";
  EXPECT_EQ(hal_can_waiting(0) + hal_can_waiting(1), 2);
  service_after(kStall - kMillisecond);
  EXPECT_FALSE(restarts()) << "the time begins again";
  service_after(2 * kMillisecond);
  EXPECT_TRUE(restarts());
  EXPECT_EQ(hal_can_status().restarts, 2);
}

TEST_F(CanThatStalls, the_time_counts_from_being_back_on_the_bus) {
  stall();
  service_after(kStall + kMillisecond);
  configuration(true);
  hal_can_service();
  bus.cycles += kStall;  // 11 recessive bits are long in coming
  configuration(false);
  hal_can_service();
  service_after(kMillisecond);
  EXPECT_EQ(hal_can_status().restarts, 1);
}

TEST_F(CanThatStalls, bus_offs_and_restarts_are_counted_from_each_start) {
  stall();
  service_after(kStall + kMillisecond);
  EXPECT_EQ(hal_can_status().restarts, 1);
  start();
  set(REG_CANES, CANES_BO_MASK);
  hal_can_service();
  EXPECT_EQ(hal_can_status().bus_offs, 1);
  ASSERT_TRUE(hal_can_init(500'000, kGroups, 2));
  EXPECT_EQ(hal_can_status().bus_offs, 0);
  EXPECT_EQ(hal_can_status().restarts, 0);
  start();
  const hal_can_frame_t frame = message();
  EXPECT_TRUE(hal_can_send(&frame, 0)) << "it is not off any more";
}

TEST_F(CanThatStalls, not_while_frames_leave_one_by_one) {
  stall();
  service_after(kStall - kMillisecond);
  set(REG_CANTRS, 1u << kSends);  // the other one has gone
  hal_can_service();
  service_after(kStall - kMillisecond);
  EXPECT_FALSE(restarts());
  EXPECT_EQ(hal_can_waiting(0), 1);
  EXPECT_EQ(hal_can_waiting(1), 0);
  service_after(2 * kMillisecond);
  EXPECT_TRUE(restarts());
}

TEST_F(CanThatStalls, not_where_nothing_waits) {
  for (int k = 0; k < 3; ++k) service_after(kStall + kMillisecond);
  EXPECT_FALSE(restarts());
  stall();
  service_after(kMillisecond);
  EXPECT_FALSE(restarts()) << "the time counts from when something waits";
}

// Errors tell why nothing goes, and the controller sends again by itself.
TEST_F(CanThatStalls, not_on_a_bus_with_errors) {
  stall();
  for (const std::uint32_t errors : {CANES_EW_MASK, CANES_EP_MASK}) {
    set(REG_CANES, errors);
    service_after(2 * kStall);
    EXPECT_EQ(hal_can_status().restarts, 0);
  }
  set(REG_CANES, 0);
  service_after(kStall - kMillisecond);
  EXPECT_FALSE(restarts()) << "the time counts from the last error";
}

}  // namespace stillspin::test
