// A shaft that has been caught: the loop is closed in its frame, and the estimators must follow it.

#include <algorithm>

#include "tests/firmware/start_caught.hpp"

extern "C" {
#include "firmware/mode/states.h"
#include "firmware/start/flying/flying.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
}

namespace {

using namespace stillspin::test;

// The estimators must follow what was caught before the drive may run; else the next pair is tried.
TEST_F(StartCaught, WhatIsNotFollowedIsCaughtAgain) {
  for (const double stray : {14.9, -14.9, 15.1, -15.1}) {
    SetUp();
    catch_at(300.0, 1.0);
    ASSERT_EQ(inside::start_phase(), START_CATCH);
    flying_start.learnt = true;
    flying_start.stray = inside::avv_error_bam() = static_cast<std::int32_t>(stray / 360.0 * 4294967296.0);
    starting.tick = 138;
    start_state.step(&drive);
    EXPECT_EQ(inside::start_phase(), START_CATCH) << "not before its time";
    EXPECT_FALSE(inside::wants_exclusive());
    starting.tick = 139;
    start_state.step(&drive);
    EXPECT_EQ(inside::start_phase(), START_CATCH) << "not beside anything else";
    EXPECT_TRUE(inside::wants_exclusive());
    inside::is_exclusive() = true;
    start_state.step(&drive);
    const bool follows = std::fabs(stray) < 15.0;
    EXPECT_EQ(inside::state(), follows ? DRIVE_RUN : DRIVE_START) << stray;
    EXPECT_EQ(starting.tries, follows ? 0 : 1);
    EXPECT_EQ(board.gates_on, follows);
  }
}

TEST_F(StartCaught, ALoopThatIsClosedBeginsAnew) {
  flying_start.stray = 99;
  flying_start.learnt = true;
  starting.axis.count = 5;
  inside::field_weakening().trim_q20 = raw(-3.0, 20);
  catch_at(300.0, 1.0);
  const flying_start_t& s = flying_start;
  ASSERT_EQ(inside::start_phase(), START_CATCH);
  EXPECT_TRUE(inside::is_caught());
  EXPECT_FALSE(inside::is_shorted() || s.learnt);
  EXPECT_EQ(s.stray, 0);
  EXPECT_EQ(starting.axis.count, 0);
  EXPECT_EQ(inside::start_found().sigma_q8, s.rotor.sigma_q8);
  EXPECT_GT(inside::start_found().sigma_q8, 0);
  EXPECT_EQ(inside::avv_angle_bam(), s.rotor.angle_bam);
  EXPECT_EQ(inside::avv_speed_bpp(), s.rotor.speed_bpp);
  EXPECT_EQ(inside::weakening_q20(), 0) << "at 300 rad/s nothing is weakened";
  EXPECT_FALSE(board.gates_on);
  start_state.step(&drive);
  EXPECT_TRUE(board.gates_on);
}

// Where no axis is asked for, the pulses' word is the last.
TEST_F(StartCaught, WithoutAnAxisToSeeItRunsAsSoonAsTheWindowsAreItsOwn) {
  catch_at(300.0, 1.0);
  ASSERT_EQ(inside::start_phase(), START_CATCH);
  start_ways.open_loop = true;
  start_state.step(&drive);
  EXPECT_TRUE(board.gates_on);
  inside::is_exclusive() = true;
  start_state.step(&drive);
  EXPECT_EQ(inside::state(), DRIVE_START) << "its windows are of before";
  inside::invalid_periods() = 0;
  inside::is_exclusive() = false;
  start_state.step(&drive);
  EXPECT_EQ(inside::state(), DRIVE_START) << "not beside anything else";
  EXPECT_TRUE(inside::wants_exclusive());
  EXPECT_NE(drive_known(&drive) & KNOWN_ROTOR, 0) << "it is caught";
  inside::is_exclusive() = true;
  start_state.step(&drive);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
  start_ways.open_loop = false;
}

// A fast shaft needs its field current from the first period on.
TEST_F(StartCaught, AFastShaftIsWeakenedAtOnce) {
  catch_at(1500.0, 1.0);
  ASSERT_EQ(inside::start_phase(), START_CATCH);
  EXPECT_LT(real(inside::weakening_q20(), 20), -0.1);
  EXPECT_LT(real(inside::reference_dq_q20().d, 20), -0.1);
}

// And goes on with it as the speed control will, which leaves the references to the start until then.
TEST_F(StartCaught, AFastShaftIsWeakenedInTheFieldsPeriods) {
  catch_at(1500.0, 1.0);
  constexpr std::int32_t kMark = 77;
  const auto changes = [&](task_t task) {
    inside::weakening_q20() = inside::reference_dq_q20().d = kMark;
    inside::scheduled_task() = task;
    start_state.step(&drive);
    return std::pair{inside::weakening_q20() != kMark, inside::reference_dq_q20().d != kMark};
  };
  EXPECT_EQ(changes(TASK_SLOT), std::pair(false, false));
  EXPECT_EQ(changes(TASK_FIELD), std::pair(true, false));
  inside::field_weakening().trim_q20 = raw(-3.0, 20);
  EXPECT_EQ(changes(TASK_SPEED), std::pair(false, true));
}

// Until the axis is seen the frame turns with the rotor as the back-EMF has it; then with the axis, where that is not
// further off than the back-EMF can be. The flux is seen by the inductances that were seen with it.
TEST_F(StartCaught, TheFrameTurnsWithTheRotorUntilItsAxisIsSeen) {
  for (const double off : {0.1, -0.1, 0.5, -0.5}) {
    SetUp();
    catch_at(300.0, 1.25);
    ASSERT_EQ(inside::start_phase(), START_CATCH);
    flying_start_t& s = flying_start;
    const flying_rotor_t caught = s.rotor;
    regression_t& r = inside::avv().regression;
    r = {};
    for (int n = 1; n <= 5; ++n) {
      start_state.step(&drive);
      EXPECT_FALSE(s.learnt);
      EXPECT_NEAR(wrapped(rad(s.rotor.angle_bam - caught.angle_bam)), n * 300.0 * kPeriod, 1e-3);
      EXPECT_EQ(inside::avv_angle_bam(), s.rotor.angle_bam);
      EXPECT_EQ(inside::avv_speed_bpp(), caught.speed_bpp);
    }
    EXPECT_EQ(starting.axis.count, 0) << "it has not been seen";
    EXPECT_NEAR(1.0 * inside::model().trim.psi_q16 / inside::model().emf_q16, 0.25, 0.01);
    const double mean = 0.5 * (real(inside::model().yd_q30, 30) + real(inside::model().yq_q30, 30));
    const double half = 0.5 * (real(inside::model().yd_q30, 30) - real(inside::model().yq_q30, 30)), spread = 4000.0;
    const auto see = [&] {  // inductances that are a fifth smaller than told
      r.information = 1000000;
      r.spread_q8 = raw(spread, 8);
      r.along_q16 = raw(0.25 * mean * spread, 16);
      r.mirror_q16 = raw((1.25 * std::cos(2.0 * off) - 1.0) * half * spread, 16);
      r.cross_q16 = raw(1.25 * std::sin(2.0 * off) * half * spread, 16);
      start_state.step(&drive);
    };
    inside::invalid_periods() = 1;
    see();
    EXPECT_EQ(starting.axis.count, 0) << "windows of gates that were off";
    inside::invalid_periods() = 0;
    for (int n = 0; n < AXIS_PERIODS; ++n) see();
    EXPECT_FALSE(s.learnt) << "a decision has a period of its own";
    const std::uint32_t before = s.rotor.angle_bam;
    inside::is_exclusive() = true;
    see();
    EXPECT_TRUE(s.learnt);
    const double most = 15.0 * kDegree;
    EXPECT_NEAR(wrapped(rad(s.rotor.angle_bam - before)), 300.0 * kPeriod + std::clamp(off, -most, most), 2e-3) << off;
    EXPECT_EQ(inside::avv_angle_bam(), s.rotor.angle_bam);
    EXPECT_TRUE(s.flux_due);
    inside::model().trim.psi_q16 = 1;
    inside::is_exclusive() = false;
    see();
    EXPECT_TRUE(s.flux_due) << "and a period of its own";
    inside::is_exclusive() = true;
    see();
    EXPECT_FALSE(s.flux_due);
    EXPECT_EQ(inside::model().trim.psi_q16, 0) << "the flux is as told";
  }
}

}  // namespace
