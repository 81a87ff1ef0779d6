// The board's own protection: over-current comparator, gate enable; and when the period's start is told.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/bench/rig.hpp"

namespace stillspin::bench {
namespace {

// Voltage along phase a, of the ideal inverter: 2/3 of 300 V times what leg a is on longer than legs b and c, less
// twice the dead band, which takes from the leg with positive and adds to the legs with negative current. Through 0.32
// Ohm and 4.9 mH, a time constant of 15 ms.
constexpr std::uint16_t kBase = 1000;
constexpr std::uint16_t kOverload = 2200;  // 23.2 V: 72 A in the end, 19 A after 4.7 ms
constexpr std::uint16_t kModerate = 1140;  // 2.0 V: 6.25 A in the end
constexpr double kModerateAmps = 6.25;
constexpr double kComparatorAmps = 19.0;  // of sensors for 20 A
constexpr Tick kOverloadTime = 80 * kPeriod;

struct BoardTest : ::testing::Test {
  Rig rig{clamped_rotor()};

  void energise(std::uint16_t leg_a) {
    rig.run_until(kRigReady);
    rig_firmware.frame = pulses_along_a(leg_a, kBase);
    rig_firmware.gates_on = true;
    rig.run_for(2 * kPeriod);
    ASSERT_FALSE(rig_firmware.gates_refused);
  }
};

TEST_F(BoardTest, PeriodStartIsToldAtCounterZeroBeforeTheControlInterrupt) {
  rig.run_until(kRigReady);
  ASSERT_GT(rig.starts.size(), 50u);
  const auto& last = rig.starts.back();
  for (std::size_t k = rig.starts.size() - 50; k < rig.starts.size(); ++k) {
    const auto& start = rig.starts[k];
    EXPECT_EQ(start.counter, 0u) << "period " << k;
    // One control interrupt between two starts, each after its start.
    EXPECT_EQ(last.control - start.control, rig.starts.size() - 1 - k);
    EXPECT_EQ(last.tick - start.tick, static_cast<Tick>(rig.starts.size() - 1 - k) * kPeriod);
  }
}

TEST_F(BoardTest, OverCurrentSwitchesThePinsOffThroughTheTripZone) {
  energise(kOverload);
  rig.run_for(kOverloadTime);
  // The peak detector is read afterwards: its next reading may still hold the first moment of the current's fall.
  EXPECT_GE(rig.board.trips(), 1u);
  EXPECT_LE(rig.board.trips(), 2u);
  EXPECT_TRUE(rig_firmware.tripped_by_pin);
  EXPECT_FALSE(rig.any_pin_high());
  EXPECT_EQ(rig.current_a(), 0.0);  // the diodes have taken the energy back to the link
  EXPECT_GT(rig.peak, kComparatorAmps);
  // The current rises while leg a is on alone, 6 us before and 6 us after the legs b and c. The comparator sees it at
  // the edge that ends such a time: beyond its level by 200 V * 6 us / 4.9 mH = 0.25 A at most.
  EXPECT_LT(rig.peak, kComparatorAmps + 0.25);
}

// The pins follow in the tick in which the comparator fires, not when somebody looks again: at the edges that end the
// times in which the current rises, which are those of leg b and c (4500) and of leg a (6100) with their dead bands.
TEST_F(BoardTest, TripActsInTheTickInWhichTheComparatorFires) {
  energise(kOverload);
  rig.run_for(kOverloadTime);
  ASSERT_GE(rig.board.trips(), 1u);
  const Tick into_period = (rig.last_edge - rig.starts.front().tick) % kPeriod;
  const bool at_first = into_period >= 4500 && into_period <= 4500 + 2 * kRigDeadBand;
  const bool at_second = into_period >= 6100 && into_period <= 6100 + 2 * kRigDeadBand;
  EXPECT_TRUE(at_first || at_second) << into_period;
}

// Nothing switches and nothing is sampled: the board looks at the current by itself, four times a period.
TEST_F(BoardTest, ComparatorLooksBetweenEdgesToo) {
  rig.run_until(kRigReady);
  rig_firmware.frame = pulses_along_a(7000, 20);
  rig_firmware.frame.burst_start_tick[0] = HAL_PWM_NONE;
  rig_firmware.frame.burst_end_tick[0] = HAL_PWM_NONE;
  rig_firmware.gates_on = true;
  rig.run_for(40 * kPeriod);
  EXPECT_TRUE(rig_firmware.tripped_by_pin);
  // 200 V * 25 us / 4.9 mH: one look later at the most
  EXPECT_LT(rig.peak, kComparatorAmps + 1.03);
}

TEST_F(BoardTest, PinsStayOffAfterTheTripUntilTheFirmwareClearsIt) {
  energise(kOverload);
  rig.run_for(kOverloadTime);
  ASSERT_TRUE(rig_firmware.tripped_by_pin);
  const Tick off_since = rig.last_edge;
  const std::uint64_t trips = rig.board.trips();
  rig_firmware.frame = pulses_along_a(kModerate, kBase);
  rig.run_for(50 * kPeriod);
  EXPECT_EQ(rig.last_edge, off_since) << "an edge although the trip is latched";
  rig_firmware.gates_on = true;
  rig.run_for(50 * kPeriod);
  EXPECT_FALSE(rig_firmware.gates_refused) << "the comparator must have let go of the pin";
  EXPECT_GT(rig.last_edge, off_since);
  EXPECT_GT(rig.current_a(), 0.5);
  EXPECT_EQ(rig.board.trips(), trips);
}

TEST_F(BoardTest, ModerateCurrentDoesNotTrip) {
  energise(kModerate);
  rig.run_for(1000 * kPeriod);
  EXPECT_EQ(rig.board.trips(), 0u);
  // Ripple within a period: 200 V * 1.4 us / 4.9 mH = 0.06 A; what is left of the exponential: e^-6.5.
  EXPECT_NEAR(rig.current_a(), kModerateAmps, 0.08);
}

TEST_F(BoardTest, GatesPassOnlyWhileTheEnableIsToggled) {
  energise(kModerate);
  rig.run_for(300 * kPeriod);
  ASSERT_GT(rig.current_a(), 1.0);
  rig_firmware.toggle = false;
  const Tick stopped = rig.chip.now();
  // The last change of the pin was up to a period ago.
  rig.run_until(stopped + kEnableTimeout - 2 * kPeriod);
  EXPECT_TRUE(rig.board.gates_enabled());
  EXPECT_GT(rig.current_a(), 1.0);
  // The board looks once a period.
  rig.run_until(stopped + kEnableTimeout + 2 * kPeriod);
  EXPECT_FALSE(rig.board.gates_enabled());
  rig.run_for(20 * kPeriod);  // 6 A at 200 V back into the link: 0.15 ms
  EXPECT_EQ(rig.current_a(), 0.0);
  EXPECT_GT(rig.last_edge, rig.chip.now() - kPeriod) << "the chip itself knows nothing of it and goes on pulsing";
}

TEST_F(BoardTest, TogglingAgainLetsThePulsesThrough) {
  energise(kModerate);
  rig_firmware.toggle = false;
  rig.run_for(100 * kPeriod);
  ASSERT_EQ(rig.current_a(), 0.0);
  rig_firmware.toggle = true;
  rig.run_for(100 * kPeriod);
  EXPECT_TRUE(rig.board.gates_enabled());
  EXPECT_GT(rig.current_a(), 1.0);
}

TEST_F(BoardTest, GatesAreOffBeforeTheFirstToggle) {
  rig_firmware.toggle = false;
  energise(kOverload);
  rig.run_for(100 * kPeriod);
  EXPECT_FALSE(rig.board.gates_enabled());
  EXPECT_EQ(rig.peak, 0.0);
  EXPECT_GT(rig.last_edge, rig.chip.now() - kPeriod);
}

}  // namespace
}  // namespace stillspin::bench
