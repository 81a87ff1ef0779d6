// Which writes reach a register: EALLOW protection, clock gates, addresses without a register.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
std::uint16_t seen[8];

class Protection : public ::testing::Test {
 protected:
  void run(Chip::Firmware firmware) {
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
    device->run_until(100'000);
  }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

TEST_F(Protection, WriteWithoutEallowIsLostAndCounted) {
  run([] {
    target_write16(REG_HISPCP, 3);
    seen[0] = target_read16(REG_HISPCP);
    write_protected(REG_HISPCP, 4);
    seen[1] = target_read16(REG_HISPCP);
    target_write16(REG_LOSPCP, 5);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0], 1);  // the reset value
  EXPECT_EQ(seen[1], 4);
  EXPECT_EQ(device->statistics().protected_writes_lost, 2u);
  EXPECT_EQ(device->statistics().last_protected_address, REG_LOSPCP);
}

TEST_F(Protection, EveryProtectedFrameAsksForEallow) {
  static const std::uint32_t addresses[] = {REG_PLLCR,
                                            REG_WDCR,
                                            REG_PCLKCR1,
                                            REG_FBANKWAIT,
                                            REG_GPAMUX1,
                                            REG_GPADIR,
                                            REG_GPBPUD,
                                            REG_GPIOXINT1SEL,
                                            REG_DEVICECNF,
                                            EPWM_BASE(2) + EPWM_TZSEL,
                                            EPWM_BASE(6) + EPWM_TZCLR,
                                            EPWM_BASE(1) + EPWM_TZFRC};
  run([] {
    write_protected(REG_PCLKCR1, 0x3F);  // so that the ePWM registers are not stopped by their gates
    for (const std::uint32_t address : addresses) target_write16(address, 0);
    sleep_for_ever();
  });
  EXPECT_EQ(device->statistics().protected_writes_lost, std::size(addresses));
  EXPECT_EQ(device->statistics().gated_accesses, 0u);
}

TEST_F(Protection, OrdinaryRegistersNeedNoEallow) {
  run([] {
    target_write16(CPUTIMER_BASE(0) + CPUTIMER_PRD, 0x1234);
    seen[0] = target_read16(CPUTIMER_BASE(0) + CPUTIMER_PRD);
    target_write16(REG_PIEIER(3), 0x81);
    seen[1] = target_read16(REG_PIEIER(3));
    target_write32(REG_GPASET, 1);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0], 0x1234);
  EXPECT_EQ(seen[1], 0x81);
  EXPECT_EQ(device->statistics().protected_writes_lost, 0u);
}

TEST_F(Protection, GatedPeripheralLosesWritesAndReadsZero) {
  run([] {
    target_write16(EPWM_BASE(2) + EPWM_TBPRD, 777);
    seen[0] = target_read16(EPWM_BASE(2) + EPWM_TBPRD);
    write_protected(REG_PCLKCR1, PCLKCR1_EPWM2ENCLK_MASK);
    target_write16(EPWM_BASE(2) + EPWM_TBPRD, 778);
    seen[1] = target_read16(EPWM_BASE(2) + EPWM_TBPRD);
    target_write16(REG_ADCMAXCONV, 3);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0], 0);
  EXPECT_EQ(seen[1], 778);
  EXPECT_EQ(device->statistics().gated_accesses, 3u);
  EXPECT_EQ(device->statistics().last_gated_address, REG_ADCMAXCONV);
}

TEST_F(Protection, AddressesWithoutModelAreCounted) {
  run([] {
    seen[0] = target_read16(0x7040);  // SPI-A
    target_write16(0x123456, 1);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0], 0);
  EXPECT_EQ(device->statistics().unmodelled_accesses, 2u);
  EXPECT_EQ(device->statistics().last_unmodelled_address, 0x123456u);
}

TEST_F(Protection, VectorNeedsEallow) {
  run([] {
    target_set_vector(VECTOR_TINT0, [] {});
    sleep_for_ever();
  });
  EXPECT_EQ(device->statistics().protected_writes_lost, 1u);
}

TEST_F(Protection, InterruptClearsEallowAndReturnRestoresIt) {
  run([] {
    install(VECTOR_SEQ1INT, [] {
      target_write16(REG_HISPCP, 7);  // must be lost
      target_write16(REG_PIEACK, 0xFFFF);
    });
    enable_pie();
    target_write_ier(group_bit(1));
    target_enable_interrupts();
    target_eallow();
    raise_by_hand(VECTOR_SEQ1INT);
    seen[0] = target_read16(REG_HISPCP);
    target_write16(REG_HISPCP, 6);  // still allowed
    seen[1] = target_read16(REG_HISPCP);
    sleep_for_ever();
  });
  EXPECT_EQ(device->statistics().interrupts, 1u);
  EXPECT_EQ(seen[0], 1);
  EXPECT_EQ(seen[1], 6);
}

TEST_F(Protection, Identification) {
  run([] {
    seen[0] = target_read16(REG_PARTID);
    sleep_for_ever();
  });
  EXPECT_EQ(seen[0] & PARTID_PARTNO_MASK, 0x3C);  // TMS320F2808
}

}  // namespace
