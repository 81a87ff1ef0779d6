// Action qualifier and dead band: which edge reaches the pins, and when.

#include "tests/chip/epwm.hpp"

namespace stillspin::chip::testing {
namespace {

class EPwmOutputs : public EPwmBench {
 protected:
  /// One pulse of module 0 from `rise` to `fall` through dead bands of `rising` and `falling` ticks.
  Edges pulse(unsigned rise, unsigned fall, std::uint16_t rising, std::uint16_t falling) {
    configure_leg(0, 9999, rise, fall);
    configure_dead_band(0, rising, falling);
    start();
    services.forget();
    run(9999);
    return services.edges;
  }
};

TEST_F(EPwmOutputs, DeadBandDelaysTheTwoRisingPins) {
  EXPECT_EQ(pulse(1000, 3000, 200, 150),
            (Edges{{1000, 0, false, false}, {1200, 0, true, false}, {3000, 0, false, false}, {3150, 0, false, true}}));
}

TEST_F(EPwmOutputs, PulseShorterThanTheDeadBandIsSwallowed) {
  // The upper switch never turns on; the lower one still makes its gap, lengthened by its own delay.
  EXPECT_EQ(pulse(1000, 1150, 200, 200), (Edges{{1000, 0, false, false}, {1350, 0, false, true}}));
}

TEST_F(EPwmOutputs, PulseAsLongAsTheDeadBandIsSwallowedAndOneTickMoreIsNot) {
  EXPECT_EQ(pulse(1000, 1200, 200, 200), (Edges{{1000, 0, false, false}, {1400, 0, false, true}}));
  run(10000);
  services.forget();
  write(0, EPWM_CMPB, 1201);
  run(20000);
  services.forget();
  run(30000);
  EXPECT_EQ(
      services.edges,
      (Edges{{21000, 0, false, false}, {21200, 0, true, false}, {21201, 0, false, false}, {21401, 0, false, true}}));
}

TEST_F(EPwmOutputs, NotchShorterThanTheDeadBandKeepsTheLowerSwitchOff) {
  // High except for a notch of 120 ticks; the upper switch opens for notch plus dead band, the lower never closes.
  configure_leg(0, 9999, 5120, 5000);
  configure_dead_band(0, 200, 200);
  write(0, EPWM_AQSFRC, EPWM_AQSFRC_OTSFA_MASK | kSet);
  start();
  run(1000);
  services.forget();
  run(9999);
  EXPECT_EQ(services.edges, (Edges{{5000, 0, false, false}, {5320, 0, true, false}}));
}

TEST_F(EPwmOutputs, NeverBothOnWhateverThePulse) {
  configure_leg(0, 999, 1, 2);
  configure_dead_band(0, 40, 40);
  start();
  unsigned seed = 1;
  for (int period = 0; period < 2000; ++period) {
    seed = seed * 1664525u + 1013904223u;
    write(0, EPWM_CMPA_CMPA, 1 + (seed >> 16) % 998);
    write(0, EPWM_CMPB, 1 + (seed >> 8) % 998);
    run(now + 1000);
  }
  ASSERT_GT(services.edges.size(), 1000u);
  for (std::size_t i = 1; i < services.edges.size(); ++i) {
    const PinEdge& before = services.edges[i - 1];
    const PinEdge& after = services.edges[i];
    ASSERT_FALSE(after.a && after.b);
    if ((before.a && after.b) || (before.b && after.a)) {
      ADD_FAILURE() << "no gap at " << after;
    }
    if (after.a || after.b) {
      ASSERT_GE(after.t - before.t, 40) << "gap shorter than the dead band at " << after;
    }
  }
}

TEST_F(EPwmOutputs, PolarityAndModesOfTheDeadBand) {
  configure_leg(0, 9999, 1000, 3000);
  write(0, EPWM_DBRED, 100);
  write(0, EPWM_DBFED, 50);
  // OUT_MODE 2: rising delay on A only, B is the action qualifier's B.
  write(0, EPWM_DBCTL, 2u);
  write(0, EPWM_AQCTLB, action(kSet, EPWM_AQCTLB_CAU_LSB) | action(kClear, EPWM_AQCTLB_CBU_LSB));
  start();
  services.forget();
  run(9999);
  EXPECT_EQ(services.edges, (Edges{{1000, 0, false, true}, {1100, 0, true, true}, {3000, 0, false, false}}));
  // Both lines fed by B (IN_MODE 3), both inverted (POLSEL 3).
  write(0, EPWM_AQCTLA, 0);
  write(0, EPWM_DBCTL, 3u | (3u << EPWM_DBCTL_POLSEL_LSB) | (3u << EPWM_DBCTL_IN_MODE_LSB));
  services.forget();
  run(19999);
  EXPECT_EQ(
      services.edges,
      (Edges{{11000, 0, true, false}, {11100, 0, false, false}, {13000, 0, true, false}, {13050, 0, true, true}}));
}

TEST_F(EPwmOutputs, LaterEventWinsAtOneCount) {
  configure_leg(0, 9999, 3000, 3000);  // set by A and clear by B: B has the higher priority
  start();
  run(20000);
  EXPECT_TRUE(services.edges.empty());
  write(0, EPWM_AQCTLA, action(kClear, EPWM_AQCTLA_CAU_LSB) | action(kSet, EPWM_AQCTLA_CBU_LSB));
  run(29999);
  EXPECT_EQ(services.edges, (Edges{{23000, 0, true, false}}));
}

TEST_F(EPwmOutputs, EventWithoutActionLeavesItsPlaceToTheNext) {
  configure_leg(0, 9999, 3000, 3000);
  write(0, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAU_LSB));
  start();
  run(9999);
  EXPECT_EQ(services.edges, (Edges{{3000, 0, true, false}}));
}

TEST_F(EPwmOutputs, PeriodBeatsCompareInUpMode) {
  configure_leg(0, 9999, 9999, 10000);
  write(0, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAU_LSB) | action(kClear, EPWM_AQCTLA_PRD_LSB));
  start();
  run(30000);
  EXPECT_TRUE(services.edges.empty());
}

TEST_F(EPwmOutputs, ToggleTurnsRound) {
  configure_leg(0, 99, 50, 100);
  write(0, EPWM_AQCTLA, action(kToggle, EPWM_AQCTLA_CAU_LSB));
  start();
  run(299);
  EXPECT_EQ(services.edges, (Edges{{50, 0, true, false}, {150, 0, false, false}, {250, 0, true, false}}));
}

TEST_F(EPwmOutputs, OneShotForceActsAtOnceAndReadsBackZero) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(5000);
  services.forget();
  write(0, EPWM_AQSFRC, EPWM_AQSFRC_OTSFA_MASK | kSet | EPWM_AQSFRC_OTSFB_MASK | (kSet << EPWM_AQSFRC_ACTSFB_LSB));
  EXPECT_EQ(services.edges, (Edges{{5000, 0, true, true}}));
  EXPECT_EQ(read(0, EPWM_AQSFRC) & (EPWM_AQSFRC_OTSFA_MASK | EPWM_AQSFRC_OTSFB_MASK), 0u);
}

TEST_F(EPwmOutputs, ContinuousForceHoldsThePinAndWaitsForZero) {
  configure_leg(0, 9999, 1000, 3000);
  start();
  run(500);
  write(0, EPWM_AQCSFRC, 1);  // low, from the next zero on
  run(9999);
  EXPECT_EQ(services.edges.size(), 2u) << "this period still has its pulse";
  services.forget();
  run(29999);
  EXPECT_TRUE(services.edges.empty());
  write(0, EPWM_AQSFRC, 3u << EPWM_AQSFRC_RLDCSF_LSB);
  write(0, EPWM_AQCSFRC, 2);
  EXPECT_EQ(services.edges, (Edges{{29999, 0, true, false}})) << "immediate mode";
}

}  // namespace
}  // namespace stillspin::chip::testing
