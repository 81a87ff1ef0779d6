// Counter, compare events, shadow loads and their instants. All times are exact: the model counts in the same ticks.

#include "tests/chip/epwm.hpp"

namespace stillspin::chip::testing {
namespace {

class EPwmTimeBase : public EPwmBench {};

TEST_F(EPwmTimeBase, PulseStandsWhereTheCompareRegistersSay) {
  configure_leg(0, 9999, 1000, 3000);
  now = 17;
  start();
  run(17 + 20000);
  EXPECT_EQ(
      services.edges,
      (Edges{{1017, 0, true, false}, {3017, 0, false, false}, {11017, 0, true, false}, {13017, 0, false, false}}));
}

TEST_F(EPwmTimeBase, CounterCanBeReadAtAnyTime) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  for (const Tick t : {Tick{0}, Tick{1}, Tick{999}, Tick{1000}, Tick{9999}, Tick{10000}, Tick{10001}, Tick{25000}}) {
    run(t);
    EXPECT_EQ(read(0, EPWM_TBCTR), t % 10000) << "at " << t;
  }
}

TEST_F(EPwmTimeBase, CompareWrittenInAPeriodActsFromTheNextZero) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(500);
  write(0, EPWM_CMPA_CMPA, 2000);
  EXPECT_TRUE(read(0, EPWM_CMPCTL) & EPWM_CMPCTL_SHDWAFULL_MASK);
  EXPECT_FALSE(read(0, EPWM_CMPCTL) & EPWM_CMPCTL_SHDWBFULL_MASK);
  run(9999);
  EXPECT_EQ(services.edges.front(), (PinEdge{1000, 0, true, false})) << "the old value still acts in this period";
  EXPECT_TRUE(read(0, EPWM_CMPCTL) & EPWM_CMPCTL_SHDWAFULL_MASK);
  run(10000);
  EXPECT_FALSE(read(0, EPWM_CMPCTL) & EPWM_CMPCTL_SHDWAFULL_MASK);
  services.forget();
  run(14000);
  EXPECT_EQ(services.edges, (Edges{{12000, 0, true, false}, {13000, 0, false, false}}));
}

TEST_F(EPwmTimeBase, CompareCanBeLoadedAtThePeriodOrAtOnceOrNever) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(500);
  write(0, EPWM_CMPCTL, 1);  // CMPA at the period
  write(0, EPWM_CMPA_CMPA, 200);
  run(9998);
  EXPECT_TRUE(read(0, EPWM_CMPCTL) & EPWM_CMPCTL_SHDWAFULL_MASK);
  run(9999);
  EXPECT_FALSE(read(0, EPWM_CMPCTL) & EPWM_CMPCTL_SHDWAFULL_MASK);
  write(0, EPWM_CMPCTL, 3);  // frozen
  write(0, EPWM_CMPA_CMPA, 7000);
  services.forget();
  run(29000);
  EXPECT_EQ(services.edges.front(), (PinEdge{10200, 0, true, false}));
  EXPECT_EQ(services.edges[2], (PinEdge{20200, 0, true, false})) << "never means never";
  write(0, EPWM_CMPCTL, EPWM_CMPCTL_SHDWAMODE_MASK);
  write(0, EPWM_CMPA_CMPA, 9500);
  services.forget();
  run(29999);
  EXPECT_EQ(services.edges, (Edges{{29500, 0, true, false}}));
}

TEST_F(EPwmTimeBase, CompareBeyondThePeriodGivesNoPulse) {
  configure_leg(0, 9999, 10000, 10000);
  start();
  run(50000);
  EXPECT_TRUE(services.edges.empty());
}

TEST_F(EPwmTimeBase, CompareEqualToThePeriodStillActs) {
  configure_leg(0, 9999, 9999, 3000);
  start();
  run(13000);
  EXPECT_EQ(services.edges, (Edges{{9999, 0, true, false}, {13000, 0, false, false}}));
}

TEST_F(EPwmTimeBase, PeriodWaitsForZeroUnlessImmediate) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(100);
  write(0, EPWM_TBPRD, 4999);
  run(10000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 0);
  run(15000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 0) << "5000 counts after the load";
  write(0, EPWM_TBCTL, kUp | EPWM_TBCTL_PRDLD_MASK);
  write(0, EPWM_TBPRD, 999);
  run(16000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 0);
}

TEST_F(EPwmTimeBase, CounterBeyondItsPeriodRunsToTheTopAndSaysSo) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(5000);
  write(0, EPWM_TBCTL, kUp | EPWM_TBCTL_PRDLD_MASK);
  write(0, EPWM_TBPRD, 999);
  run(5001);
  EXPECT_EQ(read(0, EPWM_TBCTR), 5001);
  EXPECT_FALSE(read(0, EPWM_TBSTS) & EPWM_TBSTS_CTRMAX_MASK);
  run(65536 + 10);
  EXPECT_EQ(read(0, EPWM_TBCTR), 10);
  EXPECT_TRUE(read(0, EPWM_TBSTS) & EPWM_TBSTS_CTRMAX_MASK);
  write(0, EPWM_TBSTS, EPWM_TBSTS_CTRMAX_MASK);
  EXPECT_FALSE(read(0, EPWM_TBSTS) & EPWM_TBSTS_CTRMAX_MASK);
}

TEST_F(EPwmTimeBase, PrescalersMultiply) {
  configure_leg(0, 99, 10, 30);
  // HSPCLKDIV 3 is /6, CLKDIV 2 is /4: one count each 24 ticks.
  write(0, EPWM_TBCTL, kUp | (3u << EPWM_TBCTL_HSPCLKDIV_LSB) | (2u << EPWM_TBCTL_CLKDIV_LSB));
  start();
  run(24 * 35 - 1);
  EXPECT_EQ(read(0, EPWM_TBCTR), 34);
  EXPECT_EQ(services.edges, (Edges{{240, 0, true, false}, {720, 0, false, false}}));
}

TEST_F(EPwmTimeBase, SlowSystemClockSlowsTheCounter) {
  services.sysclk = 10;
  bank.reset(0);
  configure_leg(0, 9999, 100, 300);
  start();
  run(999);
  EXPECT_EQ(read(0, EPWM_TBCTR), 99);
  now = 1500;
  run(now);
  services.sysclk = 1;
  bank.clocks_changed(now);
  run(1600);
  EXPECT_EQ(read(0, EPWM_TBCTR), 150 + 100);
  EXPECT_EQ(services.edges, (Edges{{1000, 0, true, false}}));
}

TEST_F(EPwmTimeBase, UpDownCountsBothWays) {
  write(0, EPWM_TBPRD, 5000);
  write(0, EPWM_TBCTL, kUpDown);
  write(0, EPWM_CMPA_CMPA, 1500);
  write(0, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAU_LSB) | action(kClear, EPWM_AQCTLA_CAD_LSB));
  start();
  run(4999);
  EXPECT_TRUE(read(0, EPWM_TBSTS) & EPWM_TBSTS_CTRDIR_MASK);
  run(5000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 5000);
  EXPECT_FALSE(read(0, EPWM_TBSTS) & EPWM_TBSTS_CTRDIR_MASK) << "at the period the direction is down";
  run(6000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 4000);
  run(10000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 0);
  EXPECT_TRUE(read(0, EPWM_TBSTS) & EPWM_TBSTS_CTRDIR_MASK) << "at zero it is up";
  run(12000);
  EXPECT_EQ(services.edges, (Edges{{1500, 0, true, false}, {8500, 0, false, false}, {11500, 0, true, false}}));
}

TEST_F(EPwmTimeBase, DownCountsFromThePeriod) {
  write(0, EPWM_TBPRD, 999);
  write(0, EPWM_TBCTL, kDown);
  write(0, EPWM_CMPA_CMPA, 600);
  write(0, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAD_LSB) | action(kClear, EPWM_AQCTLA_ZRO_LSB));
  start();
  run(2000);
  // Zero at 0, then 999 at 1, 600 at 400, zero at 1000.
  EXPECT_EQ(services.edges,
            (Edges{{400, 0, true, false}, {1000, 0, false, false}, {1400, 0, true, false}, {2000, 0, false, false}}));
}

TEST_F(EPwmTimeBase, CounterStandsWithoutItsClock) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(700);
  bank.set_time_base_clock(false, now);
  run(5000);
  EXPECT_EQ(read(0, EPWM_TBCTR), 700);
  EXPECT_TRUE(services.edges.empty());
  start();
  run(5300);
  EXPECT_EQ(services.edges, (Edges{{5300, 0, true, false}}));
}

TEST_F(EPwmTimeBase, TimeBaseClockStartsAllModulesInOneTick) {
  for (int m = 0; m < EPwmBank::kModules; ++m) {
    configure_leg(m, 9999, 100, 200);
    write(m, EPWM_ETPS, 1);
    write(m, EPWM_ETSEL, 1u | EPWM_ETSEL_INTEN_MASK);
  }
  now = 123;
  start();
  ASSERT_EQ(services.interrupts.size(), 6u);
  for (const auto& i : services.interrupts) {
    EXPECT_EQ(i.t, 123);
  }
  EXPECT_EQ(bank.next_event(), 223) << "one call of run_event() served all six";
}

TEST_F(EPwmTimeBase, StandingCounterWithPeriodZeroLoadsItsPeriodWhenWritten) {
  write(0, EPWM_TBCTL, kUp);
  start();
  run(1000);
  EXPECT_EQ(bank.next_event(), kNever) << "a counter that cannot move must not flood the event loop";
  write(0, EPWM_TBPRD, 99);
  run(1001);
  run(1011);
  EXPECT_EQ(read(0, EPWM_TBCTR), 10);
}

TEST_F(EPwmTimeBase, WhatWasConfiguredBeforeTheStartHoldsFromTheFirstCount) {
  // The active compare registers are 0 after reset; they must not act at the zero at which the counter starts.
  configure_leg(0, 9999, 1000, 3000);
  write(0, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAU_LSB));
  write(0, EPWM_ETPS, 1u << EPWM_ETPS_SOCAPRD_LSB);
  write(0, EPWM_ETSEL, (4u << EPWM_ETSEL_SOCASEL_LSB) | EPWM_ETSEL_SOCAEN_MASK);
  start();
  EXPECT_TRUE(services.edges.empty());
  EXPECT_TRUE(services.starts.empty());
}

TEST_F(EPwmTimeBase, CompareZeroLoadedAtZeroMissesItsPeriod) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(500);
  write(0, EPWM_CMPA_CMPA, 0);
  run(9999);
  services.forget();
  run(30000);
  EXPECT_EQ(services.edges, (Edges{{20000, 0, true, false}, {23000, 0, false, false}, {30000, 0, true, false}}))
      << "nothing in the period from 10000 on: the count 0 was over when the 0 was loaded";
}

TEST_F(EPwmTimeBase, ResetStopsEverything) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(1500);
  bank.reset(now);
  EXPECT_EQ(services.edges.back(), (PinEdge{1500, 0, false, false}));
  EXPECT_EQ(bank.next_event(), kNever);
  EXPECT_EQ(read(0, EPWM_TBCTL), 0x0083);
}

}  // namespace
}  // namespace stillspin::chip::testing
