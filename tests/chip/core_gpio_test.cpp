// Pins: direction, set/clear/toggle, multiplexer, trip and encoder routing.

#include <gtest/gtest.h>

#include "tests/chip/core.hpp"

namespace {

using namespace core_bench;

Chip* chip = nullptr;
std::uint16_t seen[8];
std::uint32_t wide[8];

class Pins : public ::testing::Test {
 protected:
  void run(Chip::Firmware firmware, Tick until = 50'000) {
    device = std::make_unique<Chip>(world, firmware);
    chip = device.get();
    device->run_until(until);
  }
  std::vector<std::pair<int, bool>> changes() const {
    std::vector<std::pair<int, bool>> list;
    for (const PinChange& c : world.pins) list.emplace_back(c.pin, c.level);
    return list;
  }
  RecordingWorld world;
  std::unique_ptr<Chip> device;
};

using Changes = std::vector<std::pair<int, bool>>;

void write_protected32(std::uint32_t address, std::uint32_t value) {
  target_eallow();
  target_write32(address, value);
  target_edis();
}

TEST_F(Pins, SetClearToggle) {
  run([] {
    write_protected32(REG_GPADIR, 1uL << 31);
    write_protected32(REG_GPBDIR, 1u << 2);  // GPIO34
    target_write32(REG_GPASET, 1uL << 31);
    target_write32(REG_GPASET, 1uL << 31);  // no change, no report
    target_write32(REG_GPATOGGLE, 1uL << 31);
    target_write32(REG_GPBTOGGLE, 1u << 2);
    target_write32(REG_GPBTOGGLE, 1u << 2);
    target_write32(REG_GPASET, 1uL << 31);
    target_write32(REG_GPACLEAR, 1uL << 31);
    sleep_for_ever();
  });
  EXPECT_EQ(changes(), (Changes{{31, true}, {31, false}, {34, true}, {34, false}, {31, true}, {31, false}}));
}

TEST_F(Pins, ChangesCarryTheTickOfTheWrite) {
  run([] {
    write_protected32(REG_GPADIR, 1);
    target_elapse(100);
    target_write16(REG_GPASET, 1);
    sleep_for_ever();
  });
  ASSERT_EQ(world.pins.size(), 1u);
  EXPECT_EQ(world.pins[0].t, 30 + 1000 + 10);  // at 10 MHz: three instructions, the wait, the write
}

TEST_F(Pins, DataRegisterReadsPinsNotLatches) {
  world.levels[1] = true;
  world.levels[33] = true;
  run([] {
    write_protected32(REG_GPADIR, 1);         // GPIO0 output, GPIO1 input
    target_write32(REG_GPADAT, 0xFFFF0001u);  // inputs keep the latch to themselves
    wide[0] = target_read32(REG_GPADAT);
    wide[1] = target_read32(REG_GPBDAT);
    sleep_for_ever();
  });
  EXPECT_EQ(wide[0], 0x3u);
  EXPECT_EQ(wide[1], 0x2u);
}

TEST_F(Pins, LatchWrittenBeforeTheDirectionTakesEffectWithIt) {
  run([] {
    target_write32(REG_GPASET, 1u << 5);
    write_protected32(REG_GPADIR, 1u << 5);
    write_protected32(REG_GPADIR, 0);
    sleep_for_ever();
  });
  EXPECT_EQ(changes(), (Changes{{5, true}, {5, false}}));
}

TEST_F(Pins, MultiplexedPinIsNoOutput) {
  run([] {
    write_protected32(REG_GPADIR, 1);
    write_protected32(REG_GPAMUX1, 1);  // GPIO0 is EPWM1A
    target_write32(REG_GPASET, 1);
    sleep_for_ever();
  });
  EXPECT_TRUE(world.pins.empty());
}

TEST_F(Pins, PullUpRegisterComesUpWithTheEPwmPinsFloating) {
  run([] {
    wide[0] = target_read32(REG_GPAPUD);
    sleep_for_ever();
  });
  EXPECT_EQ(wide[0], 0x0FFFu);
}

// ePWM1: force output A high by software, continuously.
void force_epwm1a_high() {
  write_protected(REG_PCLKCR1, PCLKCR1_EPWM1ENCLK_MASK);
  write_protected(REG_PCLKCR0, PCLKCR0_TBCLKSYNC_MASK);
  target_write16(EPWM_BASE(1) + EPWM_AQSFRC, 0x00C0);  // RLDCSF: immediate
  target_write16(EPWM_BASE(1) + EPWM_AQCSFRC, 0x0002);
}

TEST_F(Pins, PwmReachesTheWorldOnlyThroughItsPin) {
  run([] {
    force_epwm1a_high();
    target_elapse(100);
    seen[0] = target_read16(REG_GPADAT);
    wide[0] = static_cast<std::uint32_t>(chip->now());
    write_protected32(REG_GPAMUX1, 1);
    seen[1] = target_read16(REG_GPADAT);
    sleep_for_ever();
  });
  ASSERT_EQ(world.pwm.size(), 1u);
  EXPECT_EQ(world.pwm[0], (PwmChange{wide[0] + 20, 0, true, false}));  // EALLOW and the write, at 10 MHz
  EXPECT_EQ(seen[0], 0);
  EXPECT_EQ(seen[1], 1);
}

// One-shot trip of ePWM1 on TZ1, both outputs to low.
void trip_on_tz1() {
  force_epwm1a_high();
  target_eallow();
  target_write16(EPWM_BASE(1) + EPWM_TZSEL, 0x0100);
  target_write16(EPWM_BASE(1) + EPWM_TZCTL, 0x000A);
  target_write32(REG_GPAMUX1, 1uL << 24 | 1u);  // GPIO12 is TZ1
  target_edis();
}

TEST_F(Pins, TripPinActsInTheTickOfTheWorldsCall) {
  world.levels[12] = true;
  world.calls = {20'000};
  world.on_call = [this](Tick) { world.levels[12] = false; };
  run([] {
    trip_on_tz1();
    sleep_for_ever();
  });
  ASSERT_EQ(world.pwm.size(), 2u);
  EXPECT_EQ(world.pwm[1], (PwmChange{20'000, 0, false, false}));
}

TEST_F(Pins, TripPinReportedThroughPinsChanged) {
  world.levels[12] = true;
  run(
      [] {
        trip_on_tz1();
        sleep_for_ever();
      },
      10'000);
  ASSERT_EQ(world.pwm.size(), 1u);
  world.levels[12] = false;
  device->pins_changed();
  device->run_until(20'000);
  ASSERT_EQ(world.pwm.size(), 2u);
  EXPECT_EQ(world.pwm[1], (PwmChange{10'000, 0, false, false}));
}

TEST_F(Pins, UnroutedTripPinDoesNothing) {
  world.levels[12] = false;
  world.calls = {20'000};
  run([] {
    force_epwm1a_high();
    target_eallow();
    target_write16(EPWM_BASE(1) + EPWM_TZSEL, 0x0100);
    target_write16(EPWM_BASE(1) + EPWM_TZCTL, 0x000A);
    target_write32(REG_GPAMUX1, 1u);
    target_edis();
    sleep_for_ever();
  });
  EXPECT_EQ(world.pwm.size(), 1u);
}

TEST_F(Pins, PinLowWhenTheTripIsRoutedTripsAtOnce) {
  world.levels[12] = false;
  run([] {
    trip_on_tz1();
    sleep_for_ever();
  });
  ASSERT_FALSE(world.pwm.empty());
  EXPECT_FALSE(world.pwm.back().a);
}

void count_encoder() {
  write_protected(REG_PCLKCR1, PCLKCR1_EQEP1ENCLK_MASK);
  target_write32(EQEP_BASE(1) + EQEP_QPOSMAX, 4095);
  target_write16(EQEP_BASE(1) + EQEP_QEPCTL, 0x1008);  // QPEN, wraps at QPOSMAX
  target_elapse(1000);
  wide[0] = target_read32(EQEP_BASE(1) + EQEP_QPOSCNT);
}

TEST_F(Pins, EncoderCountsWhenRouted) {
  world.edges = 100;
  world.calls = {5'000};
  world.on_call = [this](Tick) { world.edges = 150; };
  run([] {
    write_protected32(REG_GPAMUX2, 1u << 8 | 1u << 10);
    count_encoder();
    sleep_for_ever();
  });
  EXPECT_EQ(wide[0], 50u);
}

TEST_F(Pins, EncoderStandsStillWhenNotRouted) {
  world.edges = 100;
  world.calls = {5'000};
  world.on_call = [this](Tick) { world.edges = 150; };
  run([] {
    count_encoder();
    sleep_for_ever();
  });
  EXPECT_EQ(wide[0], 0u);
}

TEST_F(Pins, ClearedPinLevelIsSeenByAPollingFirmware) {
  world.calls = {5'000, 7'000};
  world.on_call = [this](Tick) { world.levels[3] = !world.levels[3]; };
  run([] {
    while ((target_read16(REG_GPADAT) & 8u) == 0) {
    }
    wide[0] = static_cast<std::uint32_t>(chip->now());
    while ((target_read16(REG_GPADAT) & 8u) != 0) {
    }
    wide[1] = static_cast<std::uint32_t>(chip->now());
    sleep_for_ever();
  });
  EXPECT_GE(wide[0], 5'000u);
  EXPECT_LT(wide[0], 5'030u);  // a poll is a frame 1 read of 3 cycles at 10 MHz
  EXPECT_GE(wide[1], 7'000u);
  EXPECT_LT(wide[1], 7'030u);
}

}  // namespace
