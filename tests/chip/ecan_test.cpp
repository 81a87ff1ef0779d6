// eCAN: configuration, accesses, interrupts.

#include "tests/chip/ecan.hpp"

namespace stillspin::chip::testing {
namespace {

// ---- configuration -----------------------------------------------------------------------------------------

TEST_F(ECanTest, starts_in_configuration_and_takes_part_after_eleven_recessive_bits) {
  EXPECT_TRUE(status(CANES_CCE_MASK));
  EXPECT_EQ(can.can_bit_time(), 0);
  configure();
  EXPECT_TRUE(status(CANES_CCE_MASK)) << "CCR is still set";
  write(REG_CANMC, CANMC_SCB_MASK);
  EXPECT_FALSE(status(CANES_CCE_MASK));
  pass(11 * kCanBit - 1);
  EXPECT_EQ(can.can_bit_time(), 0);
  pass(1);
  EXPECT_EQ(can.can_bit_time(), kCanBit);
}

TEST_F(ECanTest, does_not_leave_configuration_without_a_bit_timing) {
  write(REG_CANMC, CANMC_SCB_MASK);
  pass(1000 * kCanBit);
  EXPECT_TRUE(status(CANES_CCE_MASK));
  write(REG_CANBTC, kTiming);
  EXPECT_FALSE(status(CANES_CCE_MASK));
}

TEST_F(ECanTest, bit_timing_needs_cce) {
  configure();
  start();
  write(REG_CANBTC, 0);
  EXPECT_EQ(read(REG_CANBTC), kTiming);
}

TEST_F(ECanTest, configuration_waits_for_the_end_of_a_frame) {
  configure();
  start();
  can.can_busy(now, false);
  write(REG_CANMC, CANMC_SCB_MASK | CANMC_CCR_MASK);
  pass(1000 * kCanBit);
  EXPECT_FALSE(status(CANES_CCE_MASK)) << "a line that stays dominant never lets it in";
  can.can_quiet(now, now);
  EXPECT_TRUE(status(CANES_CCE_MASK));
  EXPECT_EQ(can.can_bit_time(), 0);
}

TEST_F(ECanTest, the_mode_with_sixteen_mailboxes_ends_the_run) {
  write(REG_CANMC, CANMC_CCR_MASK);
  write(REG_CANBTC, kTiming);
  write(REG_CANMC, 0);
  EXPECT_EQ(services.errors.size(), 1u);
}

TEST_F(ECanTest, without_pins_it_takes_no_part) {
  can.set_routed(false, now);
  configure();
  start();
  EXPECT_EQ(can.can_bit_time(), 0);
}

TEST_F(ECanTest, a_line_that_does_not_answer_leads_to_bus_off) {
  can.set_routed(false, now);
  configure();
  start();
  set_up(3, standard(0x7F), false);
  write(REG_CANTRS, 1u << 3);
  pass(100'000);
  EXPECT_TRUE(status(CANES_BO_MASK));
  EXPECT_TRUE(status(CANES_BE_MASK));
}

// ---- accesses ------------------------------------------------------------------------------------------------

TEST_F(ECanTest, narrow_accesses_to_control_registers_do_harm) {
  write(REG_CANME, 0x12345678);
  EXPECT_EQ(can.read16(0, now), 0u) << "not what is in it";
  can.write16(0, 0x00FF, now);
  EXPECT_EQ(read(REG_CANME), 0x00FF00FFu) << "the other half is gone";
  EXPECT_EQ(can.narrow_accesses(), 2u);
  can.write16(static_cast<std::uint16_t>(REG_CANMDL(2) - 0x6000 + 1), 0xABCD, now);
  EXPECT_EQ(read(REG_CANMDL(2)) >> 16, 0xABCDu) << "mailbox memory takes them";
  EXPECT_EQ(can.narrow_accesses(), 2u);
}

TEST_F(ECanTest, the_identifier_of_an_enabled_mailbox_is_not_written) {
  set_up(1, standard(0x10), true);
  write(REG_CANMSGID(1), standard(0x20));
  EXPECT_EQ(read(REG_CANMSGID(1)), standard(0x10));
  EXPECT_TRUE(read(REG_CANGIF0) & CANGIF_WDIF_MASK);
}

TEST_F(ECanTest, messages_are_undefined_after_reset) {
  EXPECT_NE(read(REG_CANMSGCTRL(5)), 0u) << "firmware that does not clear it sends remote requests";
}

// ---- interrupts ----------------------------------------------------------------------------------------------

TEST_F(ECanTest, interrupts_go_to_the_line_that_is_chosen) {
  configure();
  start();
  set_up(4, standard(4), false);
  set_up(8, standard(8), true);
  write(REG_CANMIM, 1u << 4 | 1u << 8);
  write(REG_CANMIL, 1u << 8);
  write(REG_CANGIM, CANGIM_I0EN_MASK | CANGIM_I1EN_MASK | CANGIF_EPIF_MASK | CANGIM_GIL_MASK);
  write(REG_CANTRS, 1u << 4);
  transmit();
  hear(frame(8));
  ASSERT_EQ(services.interrupts.size(), 2u);
  EXPECT_EQ(services.interrupts[0].what, VECTOR_ECAN0INTA);
  EXPECT_EQ(services.interrupts[1].what, VECTOR_ECAN1INTA);
  EXPECT_EQ(read(REG_CANGIF0) & (CANGIF_GMIF_MASK | CANGIF_MIV_MASK), CANGIF_GMIF_MASK | 4u);
  EXPECT_EQ(read(REG_CANGIF1) & (CANGIF_GMIF_MASK | CANGIF_MIV_MASK), CANGIF_GMIF_MASK | 8u);
  services.forget();
  for (int i = 0; i < 130; ++i) fail(CanError::kStuff, false);
  ASSERT_EQ(services.interrupts.size(), 1u) << "the warning level is masked, passive is not";
  EXPECT_EQ(services.interrupts[0].what, VECTOR_ECAN1INTA);
  write(REG_CANGIF1, CANGIF_EPIF_MASK);
  EXPECT_FALSE(read(REG_CANGIF1) & CANGIF_EPIF_MASK);
}

TEST_F(ECanTest, a_software_reset_leaves_the_bus) {
  configure();
  start();
  EXPECT_NE(can.can_bit_time(), 0);
  write(REG_CANMC, CANMC_SRES_MASK);
  EXPECT_EQ(can.can_bit_time(), 0);
  EXPECT_TRUE(status(CANES_CCE_MASK));
  EXPECT_EQ(read(REG_CANMC), CANMC_CCR_MASK);
}

}  // namespace
}  // namespace stillspin::chip::testing
