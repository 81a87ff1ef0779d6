// The watch over the polarity: an axis of its own, followed by what the windows show of the saliency.

#include <algorithm>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

constexpr schedule_slot_t kRegress = SLOT_REGRESSION, kFollow = SLOT_LOOK, kNone = SCHEDULE_SLOTS;

class PolarityWatch : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    parameters.polarity_check = 1;
    use_parameters();
    make_ready();
    inside::be_in(DRIVE_RUN);
    inside::window_count() = 2;
    inside::current_dq_q20() = {0, 0};
    polarity_watch_begin(bam(0.5), 0);
  }
  static void source(std::int32_t source) {
    use_source(source);
    inside::avv_information() = 1000000;
    inside::avv_error_bam() = 0;
    inside::observer().regression = {};
    inside::observer().regression.information = 1000000;
    inside::observer().regression.spread_q8 = raw(40000.0, 8);
  }
  static bool step(schedule_slot_t turn) {
    inside::scheduled_slot() = turn;
    return polarity_watch_step(&drive);
  }
  static double axis() { return rad(polarity_watch.axis.angle_bam); }
};

// A triple pole at 120 rad/s takes three times 120 T of what the axis is off, once for every period since it last did;
// the saliency does not know one half turn from the other.
TEST_F(PolarityWatch, TheAxisFollowsWhatTheWindowsShow) {
  for (const double half : {0.0, kPi}) {
    for (const double off : {0.1, -0.1, 1.4, -1.4}) {
      SetUp();
      source(POSITION_AVV);
      inside::avv_angle_bam() = bam(0.5 + 0.75 * off + half);
      inside::avv_error_bam() = static_cast<std::int32_t>(bam(0.25 * off));
      for (int n = 0; n < 4; ++n) EXPECT_FALSE(step(kNone));
      EXPECT_FALSE(step(kFollow));
      const double all = std::clamp(5.0 * off, -kPi, kPi);  // an angle is no more than half a turn
      EXPECT_NEAR(axis(), 0.5 + 3.0 * 120.0 * kPeriod * all, 1e-4) << off << ", " << half;
      EXPECT_EQ(polarity_watch.axis_periods, 0);
      EXPECT_FALSE(polarity_watch.samples_invalid);
    }
  }
}

// The observer's windows were regressed some periods ago: what they showed belongs to where both were then.
TEST_F(PolarityWatch, TheObserversAxisIsThatOfItsRegression) {
  source(POSITION_OBSERVER);
  polarity_watch.axis.speed_bpp = bpp(200.0);
  EXPECT_FALSE(step(kRegress));
  const double then = 0.5 + 200.0 * kPeriod;
  EXPECT_EQ(polarity_watch.then_periods, 1);
  inside::observer().regressed_bam = bam(then + 0.2);
  for (int n = 0; n < 2; ++n) EXPECT_FALSE(step(kNone));
  EXPECT_FALSE(step(kFollow));
  EXPECT_NEAR(axis(), 0.5 + 4 * 200.0 * kPeriod + 3.0 * 120.0 * kPeriod * 0.2 * 4.0, 1e-4);
}

// Both axes of what was commanded are gathered until the back-EMF is looked at, and then it begins anew.
TEST_F(PolarityWatch, GathersTheCommandsSinceTheLastLook) {
  source(POSITION_OBSERVER);
  inside::command_dq_q16() = {raw(2.0, 16), raw(-5.0, 16)};
  for (int n = 0; n < 3; ++n) EXPECT_FALSE(step(kNone));
  EXPECT_EQ(polarity_watch.voltage_q12.d, 3 * raw(2.0, 12));
  EXPECT_EQ(polarity_watch.voltage_q12.q, 3 * raw(-5.0, 12));
  EXPECT_EQ(polarity_watch.periods, 3);
  polarity_watch.samples_invalid = false;
  inside::observer().gathered.periods = 0;
  EXPECT_FALSE(step(SLOT_REGRESSION));
  EXPECT_EQ(polarity_watch.periods, 4) << "which waits behind a renewal of the observer's covariance";
  inside::observer().gathered.periods = 1;
  inside::window_count() = ESTIMATOR_WINDOWS;
  EXPECT_FALSE(step(SLOT_REGRESSION));
  EXPECT_EQ(polarity_watch.periods, 5) << "nor beside the regression of three windows";
  inside::window_count() = 2;
  EXPECT_FALSE(step(SLOT_VOLTAGE));
  EXPECT_EQ(polarity_watch.periods, 6) << "nor beside the match of the voltage";
  EXPECT_FALSE(step(SLOT_REGRESSION));
  EXPECT_EQ(polarity_watch.voltage_q12.d | polarity_watch.voltage_q12.q | polarity_watch.periods, 0);
}

// An observer that renews in every period is waited with for 32 periods; other sources have none to renew.
TEST_F(PolarityWatch, WhatRenewsForEverIsNotWaitedWith) {
  for (const std::int32_t used : {std::int32_t{POSITION_OBSERVER}, std::int32_t{POSITION_AVV}}) {
    SetUp();
    source(used);
    inside::observer().gathered.periods = 0;
    inside::window_count() = 2;
    polarity_watch.samples_invalid = false;
    for (int n = 1; n < 32; ++n) {
      EXPECT_FALSE(step(SLOT_REGRESSION));
      EXPECT_EQ(polarity_watch.periods, used == POSITION_OBSERVER ? n : 0);
    }
    EXPECT_FALSE(step(SLOT_REGRESSION));
    EXPECT_EQ(polarity_watch.periods, 0);
  }
}

// A large current turns the axis, and windows without an axis do not show it: then it is the one in use, and what had
// been counted begins anew.
TEST_F(PolarityWatch, BlindItTakesTheAngleInUse) {
  for (const int why : {0, 1, 2, 3}) {
    SetUp();
    source(POSITION_AVV);
    inside::selected() = {bam(-1.0), bpp(70.0), 0, 32767};
    inside::avv_angle_bam() = bam(0.5);
    const double limit = real(parameters.current_limit, 20);
    if (why == 1) inside::current_dq_q20().q = raw(0.51 * limit, 20);
    if (why == 2) inside::current_dq_q20().q = raw(-0.51 * limit, 20);
    if (why == 3) inside::avv_information() = 0;
    if (why == 0) inside::current_dq_q20().q = raw(0.49 * limit, 20);
    polarity_watch.sign.agreed = 18;
    inside::command_dq_q16() = {raw(1.0, 16), raw(2.0, 16)};
    EXPECT_FALSE(step(kNone));
    EXPECT_FALSE(step(kFollow));
    const bool invalid = why != 0;
    EXPECT_EQ(polarity_watch.samples_invalid, invalid) << why;
    EXPECT_NEAR(axis(), invalid ? -1.0 : 0.5, 1e-3) << why;
    EXPECT_EQ(polarity_watch.sign.agreed, invalid ? 0 : 18);
    EXPECT_EQ(polarity_watch.periods, invalid ? 0 : 2);
    EXPECT_EQ(polarity_watch.voltage_q12.q, invalid ? 0 : raw(4.0, 12));
    if (invalid) {
      EXPECT_EQ(polarity_watch.sign.last_iq_q20, inside::current_dq_q20().q);
      EXPECT_EQ(polarity_watch.axis.speed_bpp, bpp(70.0));
    }
  }
}

// It sleeps but in RUN, until its question is answered, and where nobody asks it.
TEST_F(PolarityWatch, IsAwakeInRunUntilItKnows) {
  EXPECT_TRUE(polarity_watch_is_awake(&drive));
  inside::be_in(DRIVE_STOP);
  EXPECT_FALSE(polarity_watch_is_awake(&drive));
  inside::be_in(DRIVE_RUN);
  parameters.polarity_check = 0;
  use_parameters();
  polarity_watch_begin(0, 0);
  EXPECT_FALSE(polarity_watch_is_awake(&drive));
}

// What has been seen of the back-EMF against the rotation, a quarter of what is expected, is a suspicion.
TEST_F(PolarityWatch, AQuarterOfTheEmfAgainstTheRotationIsASuspicion) {
  polarity_watch.sign.expected_q16 = raw(20.0, 16);
  for (const double seen : {-4.9, -5.1, 5.1}) {
    polarity_watch.sign.seen_q16 = raw(seen, 16);
    EXPECT_EQ(polarity_watch_suspects(), seen < -5.0) << seen;
  }
  polarity_watch.sign.seen_q16 = raw(-20.0, 16);
  polarity_watch.open = false;
  EXPECT_FALSE(polarity_watch_suspects());
}

TEST_F(PolarityWatch, BeginsWithNothingOfTheLastRun) {
  for (const int check : {0, 1}) {
    polarity_watch_t& w = polarity_watch;
    parameters.polarity_check = check;
    use_parameters();
    w.axis_periods = w.then_periods = 7;
    w.periods = 7;
    w.voltage_q12 = {7, 7};
    w.samples_invalid = true;
    w.sign.periods = 7;
    w.open = check == 0;
    w.sign.agreed = 9;
    w.sign.seen_q16 = w.sign.expected_q16 = -99;
    polarity_watch_begin(bam(1.1), bpp(50.0));
    EXPECT_EQ(w.open, check != 0);
    EXPECT_EQ(w.axis.angle_bam, bam(1.1));
    EXPECT_EQ(w.axis.speed_bpp, bpp(50.0));
    EXPECT_EQ(w.axis_periods | w.then_periods | w.periods | w.voltage_q12.d | w.voltage_q12.q, 0);
    EXPECT_EQ(w.sign.agreed + w.sign.seen_q16 + w.sign.expected_q16, 0);
    EXPECT_FALSE(w.samples_invalid);
    EXPECT_EQ(w.sign.periods, 0);
  }
}

// The command is in the frame in use, the back-EMF on the watch's own axis: an angle in use that is off is not a magnet
// that is reversed.
TEST_F(PolarityWatch, AnAngleInUseThatIsOffIsNoReversedMagnet) {
  for (const double emf : {40.0, -40.0}) {
    for (const double off : {0.0, 1.7, -1.7, 3.0}) {
      SetUp();
      source(POSITION_AVV);
      const std::int32_t speed = bpp_of(600);
      polarity_watch.axis.speed_bpp = speed;
      const Vector command = Vector{0.0, emf}.turned(-off);
      inside::command_dq_q16() = raw_dq(command, 16);
      const std::uint32_t start = polarity_watch.axis.angle_bam;
      bool reversed = false;
      int n = 0;
      for (; n < 600 && polarity_watch.open; ++n) {
        const std::uint32_t now = start + static_cast<std::uint32_t>(speed) * static_cast<std::uint32_t>(n + 1);
        inside::avv_angle_bam() = now;
        inside::selected().angle_bam = now + bam(off < 0.0 ? off + kTurn : off);
        reversed = step(n % 5 == 3 ? kRegress : n % 5 == 4 ? kFollow : kNone);
      }
      EXPECT_GE(n, 50) << "5 ms";
      EXPECT_FALSE(polarity_watch.open) << off;
      EXPECT_EQ(reversed, emf < 0.0) << off;
    }
  }
}

// What nobody has looked at for 64 periods begins anew, and with it the change of the current.
TEST_F(PolarityWatch, SumsThatAreNotLookedAtBeginAnew) {
  source(POSITION_AVV);
  inside::command_dq_q16() = {raw(4000.0, 16), raw(-4000.0, 16)};
  for (int n = 0; n < 64; ++n) EXPECT_FALSE(step(kNone));
  EXPECT_EQ(polarity_watch.voltage_q12.d, 64 * raw(4000.0, 12));
  EXPECT_EQ(polarity_watch.voltage_q12.q, -64 * raw(4000.0, 12));
  polarity_watch.sign.last_iq_q20 = 1;
  inside::current_dq_q20() = {0, raw(0.4, 20)};
  EXPECT_FALSE(step(kNone));
  EXPECT_EQ(polarity_watch.periods, 1);
  EXPECT_EQ(polarity_watch.voltage_q12.d, raw(4000.0, 12));
  EXPECT_EQ(polarity_watch.sign.last_iq_q20, raw(0.4, 20));
  EXPECT_EQ(polarity_watch.axis_periods, 65) << "the axis coasts on";
}

// Beside the regression of two windows there is no room to judge: that comes with the next look at the axis, which may
// find that there was none.
TEST_F(PolarityWatch, WhatIsSeenBesideTheRegressionIsJudgedWithTheAxis) {
  for (const bool blind : {false, true}) {
    SetUp();
    source(POSITION_AVV);
    inside::command_dq_q16() = {0, raw(40.0, 16)};
    polarity_watch.axis.speed_bpp = bpp_of(600);
    EXPECT_FALSE(step(kRegress));
    EXPECT_EQ(polarity_watch.sign.periods, 1);
    EXPECT_EQ(polarity_watch.sign.expected_q16, 0);
    if (blind) inside::avv_information() = 0;
    EXPECT_FALSE(step(kFollow));
    EXPECT_EQ(polarity_watch.sign.periods, 0);
    EXPECT_EQ(polarity_watch.sign.expected_q16 == 0, blind);
  }
}

}  // namespace
