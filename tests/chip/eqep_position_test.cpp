// Encoder module: position with its wrap and index, and the unit timer's latch.

#include <gtest/gtest.h>

#include "hal/f2808/registers.h"
#include "sim_host/chip/eqep.hpp"
#include "tests/chip/peripheral.hpp"

namespace stillspin::chip::testing {
namespace {

constexpr unsigned kOnIndex = 0, kOnMaximum = 1, kOnUnitTimer = 3;
constexpr unsigned position_reset(unsigned mode) { return mode << EQEP_QEPCTL_PCRM_LSB; }

class EQepPosition : public ::testing::Test {
 protected:
  RecordingServices services;
  EQep eqep{services, 1};
  Tick now = 0;

  void SetUp() override { eqep.reset(0); }

  void write(std::uint16_t offset, unsigned value) { eqep.write(offset, static_cast<std::uint16_t>(value), now); }
  void write_wide(std::uint16_t offset, std::uint32_t value) {
    write(offset, value & 0xFFFFu);
    write(static_cast<std::uint16_t>(offset + 1), value >> 16);
  }
  std::uint32_t read_wide(std::uint16_t offset) {
    const std::uint32_t low = eqep.read(offset, now);
    return low | (static_cast<std::uint32_t>(eqep.read(static_cast<std::uint16_t>(offset + 1), now)) << 16);
  }
  std::uint32_t position_after(std::int64_t edges) {
    services.encoder = edges;
    ++now;
    return read_wide(EQEP_QPOSCNT);
  }
  void enable(unsigned mode, std::uint32_t maximum = 4095) {
    write_wide(EQEP_QPOSMAX, maximum);
    write(EQEP_QEPCTL, EQEP_QEPCTL_QPEN_MASK | position_reset(mode));
  }
};

TEST_F(EQepPosition, WrapsForwardAndBackward) {
  enable(kOnMaximum);
  EXPECT_EQ(position_after(5), 5u);
  EXPECT_EQ(position_after(4095), 4095u);
  EXPECT_EQ(position_after(4096), 0u);
  EXPECT_TRUE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_PCO_MASK);
  EXPECT_EQ(position_after(4095), 4095u);
  EXPECT_TRUE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_PCU_MASK);
  EXPECT_EQ(position_after(-1), 4095u);
  EXPECT_EQ(position_after(-3 * 4096 + 7), 7u) << "several turns between two looks";
}

TEST_F(EQepPosition, CountsFromWhereItWasEnabled) {
  services.encoder = 1000;
  enable(kOnMaximum);
  EXPECT_EQ(position_after(1003), 3u) << "the counter does not know the shaft before it was switched on";
  write_wide(EQEP_QPOSCNT, 0x10u);
  EXPECT_EQ(position_after(1004), 0x11u);
}

TEST_F(EQepPosition, WidePositionUsesBothWords) {
  enable(kOnMaximum, 0xFFFFFFFFu);
  EXPECT_EQ(position_after(0x12345678), 0x12345678u);
  EXPECT_EQ(position_after(-1), 0xFFFFFFFFu);
}

TEST_F(EQepPosition, IndexSetsItRight) {
  services.encoder = 1000;
  enable(kOnIndex);
  EXPECT_EQ(position_after(2000), 1000u);
  EXPECT_FALSE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_IEL_MASK);
  EXPECT_EQ(position_after(4100), 4u) << "the index lies at 4096";
  EXPECT_TRUE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_IEL_MASK);
  EXPECT_TRUE(eqep.read(EQEP_QEPSTS, now) & EQEP_QEPSTS_FIMF_MASK);
  EXPECT_EQ(read_wide(EQEP_QPOSILAT), 3096u) << "what it read as the index passed";
  EXPECT_EQ(position_after(4090), 4090u) << "backward over the index to QPOSMAX";
}

TEST_F(EQepPosition, DirectionAndItsChange) {
  enable(kOnMaximum);
  position_after(10);
  EXPECT_TRUE(eqep.read(EQEP_QEPSTS, now) & EQEP_QEPSTS_QDF_MASK);
  EXPECT_FALSE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_QDC_MASK);
  position_after(9);
  EXPECT_FALSE(eqep.read(EQEP_QEPSTS, now) & EQEP_QEPSTS_QDF_MASK);
  EXPECT_TRUE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_QDC_MASK);
  write(EQEP_QCLR, EQEP_QFLG_QDC_MASK);
  EXPECT_FALSE(eqep.read(EQEP_QFLG, now) & EQEP_QFLG_QDC_MASK);
}

TEST_F(EQepPosition, SwappedPinsCountBackward) {
  write(EQEP_QDECCTL, EQEP_QDECCTL_SWAP_MASK);
  enable(kOnMaximum);
  EXPECT_EQ(position_after(10), 4086u);
}

TEST_F(EQepPosition, DisabledCounterStandsStill) {
  enable(kOnMaximum);
  EXPECT_EQ(position_after(10), 10u);
  write(EQEP_QEPCTL, position_reset(kOnMaximum));
  EXPECT_EQ(position_after(500), 10u);
  write(EQEP_QEPCTL, EQEP_QEPCTL_QPEN_MASK | position_reset(kOnMaximum));
  EXPECT_EQ(position_after(501), 11u);
}

TEST_F(EQepPosition, SecondModuleHasNoEncoder) {
  EQep second(services, 2);
  second.reset(0);
  second.write(EQEP_QPOSMAX, 4095, 0);
  second.write(EQEP_QEPCTL, EQEP_QEPCTL_QPEN_MASK | position_reset(kOnMaximum), 0);
  services.encoder = 77;
  EXPECT_EQ(second.read(EQEP_QPOSCNT, 1), 0);
}

TEST_F(EQepPosition, UnitTimerLatchesInItsTick) {
  enable(kOnMaximum);
  write_wide(EQEP_QUPRD, 10000);
  now = 300;
  write(EQEP_QEINT, EQEP_QEINT_UTO_MASK);
  write(EQEP_QEPCTL, EQEP_QEPCTL_QPEN_MASK | EQEP_QEPCTL_UTE_MASK | EQEP_QEPCTL_QCLM_MASK | position_reset(kOnMaximum));
  EXPECT_EQ(eqep.next_event(), 10300);
  services.encoder = 42;
  run_until(eqep, 10300);
  services.encoder = 99;
  now = 15300;
  EXPECT_EQ(read_wide(EQEP_QPOSLAT), 42u);
  EXPECT_EQ(read_wide(EQEP_QPOSCNT), 99u);
  EXPECT_EQ(read_wide(EQEP_QUTMR), 5000u);
  ASSERT_EQ(services.interrupts.size(), 1u);
  EXPECT_EQ(services.interrupts[0], (Stamped<unsigned>{VECTOR_EQEP1_INT, 10300}));
  run_until(eqep, 20300);
  EXPECT_EQ(services.interrupts.size(), 1u) << "QFLG.INT was not cleared";
  now = 20300;
  write(EQEP_QCLR, EQEP_QCLR_INT_MASK | EQEP_QCLR_UTO_MASK);
  run_until(eqep, 30300);
  EXPECT_EQ(services.interrupts.size(), 2u);
}

TEST_F(EQepPosition, UnitTimerCanResetThePosition) {
  enable(kOnUnitTimer);
  write_wide(EQEP_QUPRD, 1000);
  write(EQEP_QEPCTL,
        EQEP_QEPCTL_QPEN_MASK | EQEP_QEPCTL_UTE_MASK | EQEP_QEPCTL_QCLM_MASK | position_reset(kOnUnitTimer));
  services.encoder = 42;
  run_until(eqep, 1000);
  now = 1000;
  EXPECT_EQ(read_wide(EQEP_QPOSLAT), 42u);
  EXPECT_EQ(read_wide(EQEP_QPOSCNT), 0u);
}

TEST_F(EQepPosition, ReadLatchesWhenTheTimerDoesNot) {
  enable(kOnMaximum);
  position_after(321);
  services.encoder = 400;
  EXPECT_EQ(read_wide(EQEP_QPOSLAT), 321u);
}

}  // namespace
}  // namespace stillspin::chip::testing
