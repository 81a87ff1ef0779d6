// What is known of the rotor: nothing with the power stage off, nor before a start has found it.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/states.h"
#include "firmware/sources/flux/flux.h"
}

namespace stillspin::test {
namespace {

class SpeedKnown : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    inside::selected() = {0x20000000u, 123456, 1'000'000, 32767};
    inside::low_speed_estimate() = inside::high_speed_estimate() = inside::selected();
    inside::deviation_q20() = 1000;
    flux_observer.load_angle_bam = 0x01000000;
    inside::current_dq_q20() = {raw(-1.5, 20), raw(2.5, 20)};
    inside::limits() = LIMIT_WEAKENING;
    inside::ramped_bpp() = 123456;  // of when the power stage was on
    inside::reference_dq_q20() = {raw(-1.0, 20), raw(3.0, 20)};
    inside::modulated_q16() = {raw(20.0, 16), raw(-30.0, 16)};
  }
  static void expect(bool known, const char* what) { expect(known, known, what); }
  static void expect(bool known, bool seen, const char* what) {
    const std::uint16_t now = drive_known(&drive);
    EXPECT_EQ(now, (known ? KNOWN_ROTOR : 0) | (seen ? KNOWN_FRAME : 0)) << what;
    EXPECT_EQ(drive_signals().speed_known, known ? 1 : 0) << what;
    for (std::uint16_t place = 0; place < signal_count(); ++place) {
      const unsigned needs = signal_info(place)->needs;
      const bool there = needs == KNOWN_ROTOR ? known : needs == KNOWN_FRAME ? seen : false;
      if (needs != 0 && !signal_is_left_out(place)) {
        EXPECT_EQ(inside::signal(place, now) != 0, there) << what << place;
      }
    }
    const drive_signals_t s = drive_signals();
    for (const std::int32_t value : {s.angle, s.speed, s.load_torque, s.angle_low, s.angle_avv, s.deviation_q}) {
      EXPECT_EQ(value != 0, known) << what;
    }
    EXPECT_EQ(s.load_angle != 0, known && has_source(POSITION_FLUX_CONV)) << what;
    for (const std::int32_t value : {s.current_d, s.current_q, s.speed_reference, s.current_d_reference,
                                     s.current_q_reference, s.voltage_alpha, s.voltage_beta, s.limit})
      EXPECT_EQ(value != 0, seen) << what;
  }
};

TEST_F(SpeedKnown, InTheStatesInWhichTheRotorIsFollowed) {
  const std::pair<drive_state_t, bool> states[] = {{DRIVE_BOOT, false}, {DRIVE_CALIBRATE, false}, {DRIVE_READY, false},
                                                   {DRIVE_RUN, true},   {DRIVE_STOP, true},       {DRIVE_FAULT, false}};
  for (const auto& [state, known] : states) {
    inside::be_in(state);
    expect(known, std::to_string(state).c_str());
  }
}

TEST_F(SpeedKnown, InACommissioningUntilItsGatesAreOff) {
  NEEDS("commissioning");
  inside::be_in(DRIVE_COMMISSION);
  expect(true, "it measures");
  inside::unseen() = KNOWN_ROTOR;
  expect(false, true, "the shaft follows the current");
  inside::unseen() = 0;
  inside::is_over() = true;
  expect(false, "the background level has the rest");
}

// Before the polarity is known the angle may be half a turn off; a vector that turns says nothing of the rotor.
TEST_F(SpeedKnown, InAStartOnlyOnceAShaftThatTurnsIsCaught) {
  inside::be_in(DRIVE_START);
  for (const bool caught : {false, true}) {
    inside::unseen() = caught ? 0 : KNOWN_ROTOR;
    inside::invalid_periods() = 0;
    expect(caught, true, std::to_string(caught).c_str());
    inside::invalid_periods() = 1;
    expect(false, "the windows are of before");
  }
}

TEST_F(SpeedKnown, NotFromTheFirstPeriodOfAStartOn) {
  parameters.flying_start = 0;
  make_ready();
  drive_command_start();
  for (int n = 0; n < 8; ++n) {
    period();
    ASSERT_EQ(inside::state(), DRIVE_START);
    EXPECT_EQ(drive_known(&drive) & KNOWN_ROTOR, 0) << n;
  }
}

TEST_F(SpeedKnown, TheEncoderMakesNoDifference) {
  use_source(0);
  inside::be_in(DRIVE_READY);
  expect(false, "its count has an angle only while the drive runs");
}

}  // namespace
}  // namespace stillspin::test
