// Interrupts and start-of-conversion pulses from the ePWM.

#include "tests/chip/epwm.hpp"

namespace stillspin::chip::testing {
namespace {

constexpr unsigned kOnZero = 1, kOnPeriod = 2, kOnAUp = 4, kOnADown = 5, kOnBUp = 6;

class EPwmEventTrigger : public EPwmBench {};

TEST_F(EPwmEventTrigger, CompareValuesStartTheTwoBursts) {
  configure_leg(3, 9999, 1200, 4700);
  write(3, EPWM_ETPS, (1u << EPWM_ETPS_SOCAPRD_LSB) | (1u << EPWM_ETPS_SOCBPRD_LSB));
  write(3, EPWM_ETSEL,
        (kOnAUp << EPWM_ETSEL_SOCASEL_LSB) | EPWM_ETSEL_SOCAEN_MASK | (kOnBUp << EPWM_ETSEL_SOCBSEL_LSB) |
            EPWM_ETSEL_SOCBEN_MASK);
  start();
  run(14999);
  EXPECT_EQ(services.starts, (Starts{{true, 1200}, {false, 4700}, {true, 11200}, {false, 14700}}));
  EXPECT_EQ(read(3, EPWM_ETFLG), EPWM_ETFLG_SOCA_MASK | EPWM_ETFLG_SOCB_MASK);
  write(3, EPWM_ETCLR, EPWM_ETCLR_SOCA_MASK);
  EXPECT_EQ(read(3, EPWM_ETFLG), EPWM_ETFLG_SOCB_MASK);
}

TEST_F(EPwmEventTrigger, CompareBeyondThePeriodStartsNothing) {
  configure_leg(3, 9999, 10000, 10000);
  write(3, EPWM_ETPS, 1u << EPWM_ETPS_SOCAPRD_LSB);
  write(3, EPWM_ETSEL, (kOnAUp << EPWM_ETSEL_SOCASEL_LSB) | EPWM_ETSEL_SOCAEN_MASK);
  start();
  run(50000);
  EXPECT_TRUE(services.starts.empty());
}

TEST_F(EPwmEventTrigger, PrescaleTakesEverySecondAndThird) {
  for (unsigned prescale = 1; prescale <= 3; ++prescale) {
    bank.reset(now);
    services.forget();
    configure_leg(0, 99, 10, 20);
    write(0, EPWM_ETPS, prescale << EPWM_ETPS_SOCAPRD_LSB);
    write(0, EPWM_ETSEL, (kOnPeriod << EPWM_ETSEL_SOCASEL_LSB) | EPWM_ETSEL_SOCAEN_MASK);
    const Tick t0 = now;
    start();
    run(t0 + 599);
    Starts expected;
    for (Tick n = prescale; n <= 6; n += prescale) {
      expected.push_back({true, t0 + 100 * n - 1});
    }
    EXPECT_EQ(services.starts, expected) << "prescale " << prescale;
  }
}

TEST_F(EPwmEventTrigger, TwoModulesInOneTickGiveOnePulse) {
  for (const int m : {3, 4}) {
    configure_leg(m, 9999, 2000, 10000);
    write(m, EPWM_ETPS, 1u << EPWM_ETPS_SOCAPRD_LSB);
    write(m, EPWM_ETSEL, (kOnAUp << EPWM_ETSEL_SOCASEL_LSB) | EPWM_ETSEL_SOCAEN_MASK);
  }
  start();
  run(9999);
  EXPECT_EQ(services.starts, (Starts{{true, 2000}}));
}

TEST_F(EPwmEventTrigger, DownEventsInUpDownMode) {
  write(0, EPWM_TBPRD, 5000);
  write(0, EPWM_TBCTL, kUpDown);
  write(0, EPWM_CMPA_CMPA, 1000);
  write(0, EPWM_ETPS, 1u << EPWM_ETPS_SOCAPRD_LSB);
  write(0, EPWM_ETSEL, (kOnADown << EPWM_ETSEL_SOCASEL_LSB) | EPWM_ETSEL_SOCAEN_MASK);
  start();
  run(19999);
  EXPECT_EQ(services.starts, (Starts{{true, 9000}, {true, 19000}}));
}

TEST_F(EPwmEventTrigger, OneFurtherInterruptIsPendingAndTheNextIsLost) {
  configure_leg(0, 9999, 1000, 3000);
  write(0, EPWM_ETPS, 1);
  write(0, EPWM_ETSEL, kOnZero | EPWM_ETSEL_INTEN_MASK);
  start();
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_INT), (Times{0}));
  run(35000);  // zeros at 10000, 20000, 30000 find the flag set
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_INT), (Times{0}));
  EXPECT_EQ((read(0, EPWM_ETPS) & EPWM_ETPS_INTCNT_MASK) >> EPWM_ETPS_INTCNT_LSB, 1);
  write(0, EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_INT), (Times{0, 35000}))
      << "the pending one leaves when the flag is cleared";
  write(0, EPWM_ETCLR, EPWM_ETCLR_INT_MASK);
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_INT).size(), 2u) << "only one was pending";
  run(40000);
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_INT).back(), 40000);
}

TEST_F(EPwmEventTrigger, DisabledInterruptNeitherRaisesNorSetsTheFlag) {
  configure_leg(0, 9999, 1000, 3000);
  write(0, EPWM_ETPS, 1);
  write(0, EPWM_ETSEL, kOnZero);
  start();
  run(15000);
  EXPECT_TRUE(services.interrupts.empty());
  EXPECT_EQ(read(0, EPWM_ETFLG), 0);
}

TEST_F(EPwmEventTrigger, SoftwareForceCountsAsAnEvent) {
  write(1, EPWM_ETPS, 2u | (1u << EPWM_ETPS_SOCBPRD_LSB));
  write(1, EPWM_ETSEL, EPWM_ETSEL_INTEN_MASK | EPWM_ETSEL_SOCBEN_MASK);
  write(1, EPWM_ETFRC, EPWM_ETFRC_INT_MASK);
  EXPECT_TRUE(services.interrupts.empty()) << "every second event";
  write(1, EPWM_ETFRC, EPWM_ETFRC_INT_MASK | EPWM_ETFRC_SOCB_MASK);
  EXPECT_EQ(services.times_of(VECTOR_EPWM2_INT), (Times{0}));
  EXPECT_EQ(services.starts, (Starts{{false, 0}}));
}

TEST_F(EPwmEventTrigger, ChopperIsRefused) {
  write(0, EPWM_PCCTL, EPWM_PCCTL_CHPEN_MASK);
  EXPECT_EQ(services.errors.size(), 1u);
}

}  // namespace
}  // namespace stillspin::chip::testing
