// The synchronisation chain. A pulse takes two SYSCLKOUT from its source to the load of TBPHS, so a target that is to
// run in phase has TBPHS = 2.

#include "tests/chip/epwm.hpp"

namespace stillspin::chip::testing {
namespace {

constexpr unsigned kSyncPass = 0u << EPWM_TBCTL_SYNCOSEL_LSB;
constexpr unsigned kSyncZero = 1u << EPWM_TBCTL_SYNCOSEL_LSB;
constexpr unsigned kSyncCompareB = 2u << EPWM_TBCTL_SYNCOSEL_LSB;
constexpr unsigned kSyncNone = 3u << EPWM_TBCTL_SYNCOSEL_LSB;

class EPwmSync : public EPwmBench {
 protected:
  void configure(int module, unsigned control, unsigned phase = 0) {
    write(module, EPWM_TBPRD, 9999);
    write(module, EPWM_TBPHS_TBPHS, phase);
    write(module, EPWM_TBCTL, kUp | control);
  }
};

TEST_F(EPwmSync, TargetWithPhaseTwoRunsInPhase) {
  configure(0, kSyncZero);
  configure(1, EPWM_TBCTL_PHSEN_MASK, 2);
  start();
  run(25000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 5000);
  EXPECT_EQ(read(1, EPWM_TBCTR), 5000);
  EXPECT_TRUE(read(1, EPWM_TBSTS) & EPWM_TBSTS_SYNCI_MASK);
  write(1, EPWM_TBSTS, EPWM_TBSTS_SYNCI_MASK);
  EXPECT_FALSE(read(1, EPWM_TBSTS) & EPWM_TBSTS_SYNCI_MASK);
}

TEST_F(EPwmSync, TargetWithPhaseZeroLagsByTheDelay) {
  configure(0, kSyncZero);
  configure(1, EPWM_TBCTL_PHSEN_MASK, 0);
  start();
  run(25000);
  EXPECT_EQ(read(1, EPWM_TBCTR), 4998);
}

TEST_F(EPwmSync, SlowTimeBaseTakesOneOfItsOwnClocks) {
  const unsigned divide_by_4 = 2u << EPWM_TBCTL_CLKDIV_LSB;
  configure(0, kSyncZero | divide_by_4);
  configure(1, EPWM_TBCTL_PHSEN_MASK | divide_by_4, 1);
  start();
  run(4 * 25000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 5000);
  EXPECT_EQ(read(1, EPWM_TBCTR), 5000);
}

TEST_F(EPwmSync, PhaseIsSetAndTheChainPassesOnWithoutDelay) {
  configure(0, kSyncZero);
  configure(1, kSyncPass | EPWM_TBCTL_PHSEN_MASK, 2502);
  configure(2, kSyncPass | EPWM_TBCTL_PHSEN_MASK, 5002);
  configure(3, kSyncNone | EPWM_TBCTL_PHSEN_MASK, 7502);
  configure(4, kSyncPass | EPWM_TBCTL_PHSEN_MASK, 123);
  start();
  run(10100);
  EXPECT_EQ(read(1, EPWM_TBCTR), 2600);
  EXPECT_EQ(read(2, EPWM_TBCTR), 5100);
  EXPECT_EQ(read(3, EPWM_TBCTR), 7600);
  EXPECT_EQ(read(4, EPWM_TBCTR), 100) << "the pulse ends at a module that puts none out";
  EXPECT_FALSE(read(4, EPWM_TBSTS) & EPWM_TBSTS_SYNCI_MASK);
}

TEST_F(EPwmSync, CompareBCanBeTheSource) {
  configure(0, kSyncCompareB);
  write(0, EPWM_CMPB, 4000);
  configure(1, EPWM_TBCTL_PHSEN_MASK, 0);
  start();
  run(20000);
  services.forget();
  run(24001);
  EXPECT_EQ(read(1, EPWM_TBCTR), 9999);
  run(24002);
  EXPECT_EQ(read(1, EPWM_TBCTR), 0);
}

TEST_F(EPwmSync, SoftwarePulseMovesTheModuleAndTheChain) {
  configure(0, kSyncPass | EPWM_TBCTL_PHSEN_MASK, 700);
  configure(1, kSyncPass | EPWM_TBCTL_PHSEN_MASK, 800);
  start();
  run(3000);
  write(0, EPWM_TBCTL, kUp | kSyncPass | EPWM_TBCTL_PHSEN_MASK | EPWM_TBCTL_SWFSYNC_MASK);
  EXPECT_FALSE(read(0, EPWM_TBCTL) & EPWM_TBCTL_SWFSYNC_MASK) << "the bit reads back 0";
  run(3002);
  EXPECT_EQ(read(0, EPWM_TBCTR), 700);
  EXPECT_EQ(read(1, EPWM_TBCTR), 800);
}

TEST_F(EPwmSync, DisabledPhaseLoadLeavesTheCounterAlone) {
  configure(0, kSyncZero);
  configure(1, kSyncPass, 5000);
  start();
  run(10100);
  EXPECT_EQ(read(1, EPWM_TBCTR), 100);
}

TEST_F(EPwmSync, DirectionAfterTheLoadIsPhsdir) {
  configure(0, kSyncZero);
  write(1, EPWM_TBPRD, 5000);
  write(1, EPWM_TBPHS_TBPHS, 2000);
  write(1, EPWM_TBCTL, kUpDown | EPWM_TBCTL_PHSEN_MASK);  // PHSDIR 0: down
  start();
  run(12);
  EXPECT_EQ(read(1, EPWM_TBCTR), 1990);
  EXPECT_FALSE(read(1, EPWM_TBSTS) & EPWM_TBSTS_CTRDIR_MASK);
}

TEST_F(EPwmSync, LoadOnACompareValueActs) {
  configure(0, kSyncZero);
  configure(1, EPWM_TBCTL_PHSEN_MASK, 3000);
  write(1, EPWM_CMPCTL, EPWM_CMPCTL_SHDWAMODE_MASK);
  write(1, EPWM_CMPA_CMPA, 3000);
  write(1, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAU_LSB));
  start();
  run(2);
  EXPECT_EQ(services.edges, (Edges{{2, 1, true, false}}));
}

}  // namespace
}  // namespace stillspin::chip::testing
