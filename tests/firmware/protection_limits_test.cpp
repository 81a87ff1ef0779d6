// Each limit of the protection at its last good value and the first bad one, and what a fault leaves for people.

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/fault_history.h"
#include "firmware/mode/states.h"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

class ProtectionLimits : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    make_run();
    polarity_watch.open = false;
    inside::judges_synchronism() = false;
    inside::modulator().is_alternating = false;
    inside::window_count() = 1;
    currents({0, 0});
  }
  static void currents(ab_t first, ab_t second = {0, 0}) {
    inside::windows()[0].current_q20 = first;
    inside::windows()[1].current_q20 = second;
  }
  static drive_fault_t judged() {
    inside::protect_step();
    return inside::fault();
  }
};

TEST_F(ProtectionLimits, MissingSamplesAndLatePeriods) {
  for (const int bad : {0, 1}) {
    SetUp();
    inside::missing_windows() = static_cast<std::uint16_t>(5 + bad);
    EXPECT_EQ(judged(), bad != 0 ? FAULT_NO_SAMPLES : FAULT_NONE);
    SetUp();
    inside::overruns() = static_cast<std::uint16_t>(10 + bad);
    EXPECT_EQ(judged(), bad != 0 ? FAULT_OVERRUN : FAULT_NONE);
  }
}

// Of a period without samples nothing is said of its current, whatever the one before had.
TEST_F(ProtectionLimits, APeriodWithoutSamplesHasNoCurrent) {
  currents({parameters.trip_current + 100, 0});
  inside::window_count() = 0;
  inside::missing_windows() = 1;
  EXPECT_EQ(judged(), FAULT_NONE);
  inside::window_count() = 1;
  EXPECT_EQ(judged(), FAULT_CURRENT_LIMIT);
}

// What a parameter says is still good.
TEST_F(ProtectionLimits, TheLinkAndTheCurrentMayReachTheirLimits) {
  for (const int bad : {0, 1}) {
    SetUp();
    inside::link_q16() = parameters.link_minimum - bad;
    EXPECT_EQ(judged(), bad != 0 ? FAULT_LINK_LOW : FAULT_NONE);
    SetUp();
    inside::link_q16() = parameters.link_maximum + bad;
    EXPECT_EQ(judged(), bad != 0 ? FAULT_LINK_HIGH : FAULT_NONE);
    for (const int sign : {1, -1}) {
      SetUp();
      currents({sign * (parameters.trip_current + bad), 0});
      EXPECT_EQ(judged(), bad != 0 ? FAULT_CURRENT_LIMIT : FAULT_NONE);
    }
  }
}

// A current that has gone is none; within a period the comparator is there.
TEST_F(ProtectionLimits, TheLatestWindowIsLookedAt) {
  const ab_t much = {raw(18.5, 20), 0};
  for (const bool latest : {false, true}) {
    SetUp();
    inside::window_count() = 2;
    latest ? currents({0, 0}, much) : currents(much);
    EXPECT_EQ(judged(), latest ? FAULT_CURRENT_LIMIT : FAULT_NONE);
  }
}

// A start that listens with the gates off means them to be off, and a fast shaft's current through the diodes is no
// fault of it; whoever has switched them on means them to be on.
TEST_F(ProtectionLimits, GatesThatAreMeantToBeOffAreNoFault) {
  for (const bool meant : {false, true}) {
    for (const bool runs : {false, true}) {
      for (const bool pin : {false, true}) {
        SetUp();
        inside::be_in(DRIVE_START);
        inside::gates_off() = meant;
        if (runs) drive_enter(&drive, DRIVE_RUN);
        board.gates_on = false;
        board.tripped_by_pin = pin;
        EXPECT_EQ(judged(), meant && !runs ? FAULT_NONE : pin ? FAULT_OVER_CURRENT : FAULT_GATES_OFF) << meant << runs;
      }
    }
  }
}

TEST_F(ProtectionLimits, ADriveThatIsOffIsNotJudged) {
  for (const drive_state_t state : {DRIVE_BOOT, DRIVE_CALIBRATE, DRIVE_READY}) {
    inside::be_in(state);
    inside::missing_windows() = inside::overruns() = 1000;
    inside::link_q16() = 0;
    EXPECT_EQ(judged(), FAULT_NONE) << state;
  }
}

// Windows tell as much as one that is as long as they are together.
TEST_F(ProtectionLimits, TheSpanOfThePapersWindowsIsThatOfAll) {
  NEEDS("sources/paper");
  synchronism_t expected = {};
  for (const auto& [first, second] : {std::pair{4000, 0}, {1000, 3000}, {3000, 1000}}) {
    SetUp();
    use_source(POSITION_PAPER);
    inside::judges_synchronism() = true;
    inside::window_count() = second == 0 ? 1 : 2;
    inside::windows()[0].span_ticks = static_cast<std::int16_t>(first);
    inside::windows()[1].span_ticks = static_cast<std::int16_t>(second);
    inside::avv().regression = {};
    inside::avv_information() = 1;  // it has seen something
    synchronism_reset(&inside::synchronism());
    (void)judged();
    const synchronism_t& s = inside::synchronism();
    if (second == 0) expected = s;
    ASSERT_GT(expected.limit_q16, 0);
    EXPECT_EQ(s.limit_q16, expected.limit_q16) << first;
  }
}

// AVV beside the encoder may stray: that is divergence, the angle in use stands. Beside the observer one of them is
// lost.
TEST_F(ProtectionLimits, AvvBesideTheEncoderIsNoDoubtOfTheAngle) {
  for (const std::int32_t source : {POSITION_ENCODER, POSITION_OBSERVER_AVV}) {
    SetUp();
    use_source(source);
    inside::judges_synchronism() = true;
    inside::windows()[0] = {{0, 0}, {0, 0}, {0, 0}, 5000, 5000, true};
    inside::selected().speed_bpp = 0;
    inside::low_speed_estimate().quality_q15 = inside::high_speed_estimate().quality_q15 = 32767;
    inside::high_speed_estimate().angle_bam = inside::low_speed_estimate().angle_bam + bam(2.0);
    synchronism_reset(&inside::synchronism());
    (void)judged();
    EXPECT_EQ(inside::synchronism().debounce > 0, source == POSITION_OBSERVER_AVV);
  }
}

// In the first turns a doubt of the angle is the encoder's that counts the other way round; no other source can.
TEST_F(ProtectionLimits, InTheFirstTurnsAnEncoderMayBeReversed) {
  for (const std::int32_t source : {POSITION_ENCODER, POSITION_OBSERVER}) {
    for (const bool first_turns : {true, false}) {
      SetUp();
      use_source(source);
      polarity_watch.open = first_turns;
      inside::judges_synchronism() = true;
      inside::scheduled_slot() = SCHEDULE_SLOTS;
      inside::selected().speed_bpp = bpp_of(3 * 3300);
      inside::diverged_periods() = 60000;
      encoder.aligned_bam = 0;
      encoder.observer.angle_bam = 0x1000000u;
      inside::high_speed_estimate().angle_bam = 0u - 0x1000000u;
      const bool reversed = first_turns && source == POSITION_ENCODER;
      EXPECT_EQ(judged(), reversed ? FAULT_ENCODER : FAULT_DIVERGENCE) << source << first_turns;
    }
  }
}

TEST_F(ProtectionLimits, TheRecordOfAFaultSaysWhatWas) {
  inside::time_ms() = 12345;
  inside::be_in(DRIVE_STOP);
  inside::selected().speed_bpp = bpp_of(600);
  inside::link_q16() = raw(287.5, 16);
  inside::current_dq_q20() = {raw(1.5, 20), raw(-2.5, 20)};
  drive_trip(&drive, FAULT_LINK_LOW);
  drive_trip(&drive, FAULT_OVERRUN);  // the first stays
  EXPECT_EQ(fault_history_total(), 1);
  fault_record_t r = {};
  ASSERT_TRUE(fault_history_read(0, &r));
  EXPECT_EQ(r.time_ms, 12345u);
  EXPECT_EQ(r.fault, FAULT_LINK_LOW);
  EXPECT_EQ(r.state, DRIVE_STOP);
  EXPECT_EQ(r.speed_q16 >> 16, 600);
  EXPECT_EQ(r.link_q16, raw(287.5, 16));
  EXPECT_EQ(r.current_d_q20, raw(1.5, 20));
  EXPECT_EQ(r.current_q_q20, raw(-2.5, 20));
  EXPECT_FALSE(fault_history_read(1, &r));
}

}  // namespace
