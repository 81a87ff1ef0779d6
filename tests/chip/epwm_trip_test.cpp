// Trip zone: from the pin to the gates in the same tick, and what it takes to come back.

#include "tests/chip/epwm.hpp"

namespace stillspin::chip::testing {
namespace {

constexpr unsigned kTz1 = 1u << 0;
constexpr unsigned kBothLow = 2u | (2u << EPWM_TZCTL_TZB_LSB);
constexpr unsigned kBothHigh = 1u | (1u << EPWM_TZCTL_TZB_LSB);

class EPwmTrip : public EPwmBench {
 protected:
  void SetUp() override {
    EPwmBench::SetUp();
    configure_leg(0, 9999, 1000, 8000);
    configure_dead_band(0, 100, 100);
    write(0, EPWM_TZCTL, kBothLow);
  }
  std::uint16_t flags() { return read(0, EPWM_TZFLG); }
};

TEST_F(EPwmTrip, OneShotTakesBothPinsLowAtOnceAndStays) {
  write(0, EPWM_TZSEL, EPWM_TZSEL_OSHT1_MASK);
  write(0, EPWM_TZEINT, EPWM_TZEINT_OST_MASK);
  start();
  run(2345);
  services.forget();
  bank.set_trip_pins(kTz1, now);
  EXPECT_EQ(services.edges, (Edges{{2345, 0, false, false}}));
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_TZINT), (Times{2345}));
  run(2400);
  bank.set_trip_pins(0, now);
  run(35000);
  EXPECT_EQ(services.edges.size(), 1u) << "no edge while tripped";
  EXPECT_EQ(flags(), EPWM_TZFLG_OST_MASK | EPWM_TZFLG_INT_MASK);
  write(0, EPWM_TZCLR, EPWM_TZCLR_OST_MASK | EPWM_TZCLR_INT_MASK);
  EXPECT_EQ(flags(), 0);
  EXPECT_EQ(services.edges.back(), (PinEdge{35000, 0, true, false})) << "released in the middle of the pulse";
}

TEST_F(EPwmTrip, CannotBeClearedWhileThePinIsActive) {
  write(0, EPWM_TZSEL, EPWM_TZSEL_OSHT1_MASK);
  start();
  run(2000);
  bank.set_trip_pins(kTz1, now);
  write(0, EPWM_TZCLR, EPWM_TZCLR_OST_MASK);
  EXPECT_TRUE(flags() & EPWM_TZFLG_OST_MASK);
  EXPECT_EQ(services.edges.back(), (PinEdge{2000, 0, false, false}));
  bank.set_trip_pins(0, now);
  write(0, EPWM_TZCLR, EPWM_TZCLR_OST_MASK);
  EXPECT_FALSE(flags() & EPWM_TZFLG_OST_MASK);
}

TEST_F(EPwmTrip, PinsThatAreNotSelectedDoNothing) {
  write(0, EPWM_TZSEL, EPWM_TZSEL_OSHT2_MASK);
  start();
  run(2000);
  services.forget();
  bank.set_trip_pins(kTz1, now);
  EXPECT_TRUE(services.edges.empty());
  EXPECT_EQ(flags(), 0);
  bank.set_trip_pins(1u << 1, now);
  EXPECT_EQ(services.edges.size(), 1u);
}

TEST_F(EPwmTrip, SoftwareForceTripsWithoutAPin) {
  start();
  run(2000);
  services.forget();
  write(0, EPWM_TZFRC, EPWM_TZFRC_OST_MASK);
  EXPECT_EQ(services.edges, (Edges{{2000, 0, false, false}}));
  EXPECT_EQ(flags(), EPWM_TZFLG_OST_MASK);
}

TEST_F(EPwmTrip, CycleByCycleComesBackAtTheNextZeroWithoutThePin) {
  write(0, EPWM_TZSEL, EPWM_TZSEL_CBC1_MASK);
  start();
  run(2000);
  bank.set_trip_pins(kTz1, now);
  run(15000);
  EXPECT_EQ(services.edges.back(), (PinEdge{2000, 0, false, false})) << "still active at the zero of 10000";
  bank.set_trip_pins(0, now);
  run(19999);
  EXPECT_EQ(services.edges.back(), (PinEdge{2000, 0, false, false}));
  run(20000);
  EXPECT_EQ(services.edges.back(), (PinEdge{20000, 0, false, true}));
  EXPECT_EQ(flags(), EPWM_TZFLG_CBC_MASK) << "the flag waits for TZCLR";
}

TEST_F(EPwmTrip, ActionsHighAndHighImpedanceAndNone) {
  start();
  run(2000);
  write(0, EPWM_TZCTL, kBothHigh);
  write(0, EPWM_TZFRC, EPWM_TZFRC_OST_MASK);
  EXPECT_EQ(services.edges.back(), (PinEdge{2000, 0, true, true}));
  write(0, EPWM_TZCTL, 0);
  EXPECT_EQ(services.edges.back(), (PinEdge{2000, 0, false, false})) << "a floating pin reads low";
  write(0, EPWM_TZCTL, 3u | (3u << EPWM_TZCTL_TZB_LSB));
  EXPECT_EQ(services.edges.back(), (PinEdge{2000, 0, true, false}));
}

TEST_F(EPwmTrip, InterruptFlagHoldsBackAndClearingItAloneSendsAnother) {
  write(0, EPWM_TZEINT, EPWM_TZEINT_OST_MASK);
  start();
  run(2000);
  write(0, EPWM_TZFRC, EPWM_TZFRC_OST_MASK);
  write(0, EPWM_TZFRC, EPWM_TZFRC_OST_MASK);
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_TZINT).size(), 1u);
  write(0, EPWM_TZCLR, EPWM_TZCLR_INT_MASK);
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_TZINT).size(), 2u);
  write(0, EPWM_TZCLR, EPWM_TZCLR_OST_MASK | EPWM_TZCLR_INT_MASK);
  EXPECT_EQ(services.times_of(VECTOR_EPWM1_TZINT).size(), 2u);
}

}  // namespace
}  // namespace stillspin::chip::testing
