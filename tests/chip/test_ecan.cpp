// eCAN: registers, mailboxes, configuration, error states; the test is the bus.

#include <gtest/gtest.h>

#include <initializer_list>

#include "hal/f2808/registers.h"
#include "sim_host/chip/ecan.hpp"
#include "tests/chip/peripheral_bench.hpp"

namespace stillspin::chip::testing {
namespace {

// 100 MHz / 10 / (1 + 7 + 2): 1 Mbit/s, a bit is 100 ticks.
constexpr std::uint32_t kTiming = 9u << CANBTC_BRPREG_LSB | 6u << CANBTC_TSEG1REG_LSB | 1u << CANBTC_TSEG2REG_LSB;
constexpr Tick kBit = 100;

class Wire final : public CanLine {
 public:
  void attach(CanNode& n, std::int64_t) override { node = &n; }
  void detach(CanNode&) override { node = nullptr; }
  void changed(CanNode&, std::int64_t) override { ++changes; }
  CanNode* node = nullptr;
  int changes = 0;
};

class ECanTest : public ::testing::Test {
 protected:
  RecordingServices services;
  Wire wire;
  ECan can{services, &wire};
  Tick now = 0;

  void SetUp() override {
    can.reset(0);
    can.set_routed(true, 0);
  }

  std::uint32_t read(std::uint32_t address) { return can.read32(static_cast<std::uint16_t>(address - 0x6000), now); }
  void write(std::uint32_t address, std::uint32_t value) {
    can.write32(static_cast<std::uint16_t>(address - 0x6000), value, now);
  }
  bool status(std::uint32_t mask) { return (read(REG_CANES) & mask) != 0; }
  void pass(Tick ticks) {
    run_until(can, now + ticks);
    now += ticks;
  }
  void configure(std::uint32_t extra = 0) {
    write(REG_CANMC, CANMC_CCR_MASK | CANMC_SCB_MASK | extra);
    write(REG_CANBTC, kTiming);
  }
  void start(std::uint32_t extra = 0) {
    write(REG_CANMC, CANMC_SCB_MASK | extra);
    pass(11 * kBit);
  }
  void set_up(unsigned n, std::uint32_t id, bool receives, std::uint32_t control = 0) {
    write(REG_CANME, read(REG_CANME) & ~(1u << n));
    write(REG_CANMSGID(n), id);
    write(REG_CANMSGCTRL(n), control);
    write(REG_CANMD, receives ? read(REG_CANMD) | 1u << n : read(REG_CANMD) & ~(1u << n));
    write(REG_CANME, read(REG_CANME) | 1u << n);
  }
  static constexpr std::uint32_t standard(std::uint32_t id) { return id << CANMSGID_STANDARD_LSB; }

  static CanFrame frame(std::uint32_t id, std::initializer_list<std::uint8_t> data = {}, bool extended = false) {
    CanFrame f;
    f.id = id;
    f.extended = extended;
    f.length = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), f.data.begin());
    return f;
  }
  void hear(const CanFrame& f) {
    can.can_busy(now, false);
    pass(50 * kBit);
    can.can_received(f, now);
    can.can_quiet(now - 8 * kBit, now);
    pass(3 * kBit);
  }
  /// A frame of the module's own: sent, or ended by an error.
  void transmit() {
    ASSERT_NE(can.can_offer(), nullptr);
    can.can_busy(now, true);
    pass(50 * kBit);
    can.can_sent(now);
    can.can_quiet(now - 8 * kBit, now);
    pass(3 * kBit);
  }
  void fail(CanError error, bool mine) {
    can.can_busy(now, mine);
    pass(30 * kBit);
    can.can_failed(error, mine, now);
    can.can_quiet(now - 8 * kBit, now);
    pass(3 * kBit);
  }
};

// ---- configuration -----------------------------------------------------------------------------------------

TEST_F(ECanTest, starts_in_configuration_and_takes_part_after_eleven_recessive_bits) {
  EXPECT_TRUE(status(CANES_CCE_MASK));
  EXPECT_EQ(can.can_bit_time(), 0);
  configure();
  EXPECT_TRUE(status(CANES_CCE_MASK)) << "CCR is still set";
  write(REG_CANMC, CANMC_SCB_MASK);
  EXPECT_FALSE(status(CANES_CCE_MASK));
  pass(11 * kBit - 1);
  EXPECT_EQ(can.can_bit_time(), 0);
  pass(1);
  EXPECT_EQ(can.can_bit_time(), kBit);
}

TEST_F(ECanTest, does_not_leave_configuration_without_a_bit_timing) {
  write(REG_CANMC, CANMC_SCB_MASK);
  pass(1000 * kBit);
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
  pass(1000 * kBit);
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
  pass(947 * kBit);
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
  pass(300 * 11 * kBit);
  EXPECT_TRUE(status(CANES_BO_MASK)) << "not by itself";
  EXPECT_EQ(read(REG_CANREC), 128u) << "counts the quiet times";
  write(REG_CANMC, CANMC_SCB_MASK);
  pass(11 * kBit);
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
  while (status(CANES_BO_MASK) && now < off + 1'000'000) pass(kBit);
  EXPECT_NEAR(double(now - off), 128.0 * 11 * kBit, 11 * kBit) << "the first of them ends with the error delimiter";
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
    pass(50 * kBit);
    can.can_quiet(now - 8 * kBit, now);
    pass(3 * kBit);
  }
  EXPECT_TRUE(status(CANES_BO_MASK));
  pass(2 * 11 * kBit);
  EXPECT_FALSE(status(CANES_BO_MASK));
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
