// The polarity of a shaft that stands, by saturation and by motion: what each test asks of the drive, and what stays
// open. What the estimators say is the test's.

#include "tests/firmware/start_standing.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
}

namespace {

using namespace stillspin::test;

TEST_F(StartStanding, SaturationTellsWhereItIsVisible) {
  for (const bool visible : {true, false}) {
    SetUp();
    inside::config().saturation = {0, visible ? raw(0.002, 30) : 0};
    at(START_SETTLE, 100);
    step();
    EXPECT_EQ(inside::start_phase(), visible ? START_SATURATION : START_MOTION);
    EXPECT_EQ(start().tick, 0);
    EXPECT_EQ(start().tries, 0);
    EXPECT_EQ(visible ? start().saturation.current_q20 : start().motion.current_q20,
              visible ? parameters.start_current : parameters.polarity_current);
  }
}

// The currents of the tests are those that are commanded: along d without a torque, along q with one.
TEST_F(StartStanding, TheTestsCommandTheirCurrents) {
  inside::config().saturation = {0, raw(0.002, 30)};
  at(START_SETTLE, 100);
  step();
  for (int n = 0; n < 30; ++n) step();
  EXPECT_EQ(inside::reference_dq_q20().d, parameters.start_current);
  EXPECT_EQ(inside::reference_dq_q20().q, 0);
  SetUp();
  inside::config().saturation = {0, 0};
  at(START_SETTLE, 100);
  step();
  std::int32_t most = 0;
  for (int n = 0; n < POLARITY_SEGMENTS * POLARITY_SEGMENT; ++n) {
    step();
    most = std::max(most, inside::reference_dq_q20().q);
  }
  EXPECT_EQ(most, parameters.polarity_current);
  EXPECT_EQ(inside::reference_dq_q20().d, 0);
  // What it expects is what this current does to the shaft in two patterns.
  const double torque =
      real(machine_torque_constant_q24(&inside::model(), 0), 24) * real(parameters.polarity_current, 20);
  const double accel = torque * real(inside::model().accel_q12, 12);
  EXPECT_NEAR(start().motion.expected_bam, accel * POLARITY_SEGMENT * POLARITY_SEGMENT * 2.0, 1e-3 * accel * 1e3);
}

// Twice the inertia, twice the segment; a second try has more current and the same segment.
TEST_F(StartStanding, MotionTakesTheTimeThatTheInertiaWants) {
  for (const auto& [inertia, length] : {std::pair{0.00455, 40}, {0.0091, 80}, {0.05, 160}, {0.0002, 20}}) {
    SetUp();
    parameters.inertia = raw(inertia, 24);
    ASSERT_TRUE(drive_config_load(&inside::config()));
    inside::model() = inside::config().nameplate;
    inside::config().saturation = {0, 0};
    at(START_SETTLE, 100);
    step();
    EXPECT_EQ(start().motion.length, length) << inertia;
    const std::int32_t expected = start().motion.expected_bam;
    motion_says(0.1);
    EXPECT_EQ(start().motion.length, length) << inertia;
    EXPECT_NEAR(start().motion.expected_bam, 2.0 * expected, 0.01 * expected);
  }
}

// A hundred periods after the test the current is gone; then the half turn is known.
TEST_F(StartStanding, SaturationDecidesOnceItsCurrentIsGone) {
  for (const polarity_result_t result : {POLARITY_RIGHT, POLARITY_WRONG}) {
    SetUp();
    at(START_SATURATION, SATURATION_LENGTH + 99);
    start().saturation.tick = SATURATION_LENGTH;
    start().saturation.result = result;
    start().saturation.sigma_q8 = 1234;
    step();
    EXPECT_EQ(inside::state(), DRIVE_START);
    step();
    expect_runs(result == POLARITY_RIGHT ? kThere : kThere + kPi);
    EXPECT_EQ(inside::start_found().sigma_q8, 1234);
  }
}

// Twice with the same current, both together; once with half as much again, up to the limit; then by motion.
TEST_F(StartStanding, WhatSaturationLeavesOpenIsTriedThreeTimes) {
  inside::config().saturation = {0, raw(0.002, 30)};
  at(START_SETTLE, 100);
  step();
  const std::int32_t current = parameters.start_current;
  saturation_says(POLARITY_AMBIGUOUS);
  EXPECT_EQ(inside::start_phase(), START_SATURATION);
  EXPECT_EQ(start().saturation.passes, 2);
  EXPECT_EQ(start().saturation.current_q20, current);
  EXPECT_EQ(start().tick, 0);
  saturation_says(POLARITY_AMBIGUOUS);
  EXPECT_EQ(start().saturation.passes, 1);
  EXPECT_EQ(start().saturation.current_q20, std::min(current + current / 2, parameters.current_limit));
  saturation_says(POLARITY_AMBIGUOUS);
  EXPECT_EQ(inside::start_phase(), START_MOTION);
  EXPECT_EQ(start().tries, 0);
}

TEST_F(StartStanding, TheThirdTryHasHalfAsMuchAgain) {
  inside::config().saturation = {0, raw(0.01, 30)};
  inside::config().values.start_current = raw(4.0, 20);
  at(START_SETTLE, 100);
  step();
  saturation_says(POLARITY_AMBIGUOUS);
  EXPECT_EQ(start().saturation.current_q20, raw(4.0, 20));
  saturation_says(POLARITY_AMBIGUOUS);
  EXPECT_EQ(inside::start_phase(), START_SATURATION);
  EXPECT_EQ(start().saturation.current_q20, raw(6.0, 20));
}

// It is the current along d that a saturation has to have, and that along q a motion, from its first period on.
TEST_F(StartStanding, ATestWhoseCurrentStaysAwayIsHeldBack) {
  for (const bool visible : {true, false}) {
    for (const bool follows : {true, false}) {
      SetUp();
      inside::config().saturation = {0, visible ? raw(0.002, 30) : 0};
      at(START_SETTLE, 100);
      step();
      const std::uint16_t test = visible ? START_SATURATION : START_MOTION;
      ASSERT_EQ(inside::start_phase(), test);
      for (int n = 0; n < 2000 && start().tries == 0 && inside::start_phase() == test; ++n) {
        const dq_t asked = inside::reference_dq_q20();
        inside::current_dq_q20() = follows ? asked : dq_t{visible ? 0 : asked.d, visible ? asked.q : 0};
        step();
        start().tick++;
      }
      EXPECT_EQ(start().starved, !follows) << visible;
      EXPECT_EQ(start().held_back, follows ? 0 : 1) << visible;
    }
  }
}

// A test whose current did not follow does not count, whatever it says: all over again from the listening, by motion,
// with half of the current that was too much; after the third time the voltage is named.
TEST_F(StartStanding, ATestWithoutItsCurrentDoesNotCount) {
  parameters.polarity_current = raw(4.0, 20);
  use_parameters();
  start().saturation.current_q20 = raw(10.0, 20);
  start().followed.worst_q20 = raw(3.8, 20);
  saturation_says(POLARITY_RIGHT);
  EXPECT_EQ(inside::start_phase(), START_AXIS);
  EXPECT_EQ(start().held_back, 1);
  at(START_SETTLE, 100);
  step();
  ASSERT_EQ(inside::start_phase(), START_MOTION);
  EXPECT_EQ(start().motion.current_q20, raw(4.0, 20));
  EXPECT_EQ(start().followed.worst_q20, 0);
  start().followed.worst_q20 = raw(1.6, 20);
  motion_says(1.0);
  EXPECT_EQ(inside::start_phase(), START_AXIS);
  at(START_SETTLE, 100);
  step();
  EXPECT_EQ(start().motion.current_q20, raw(2.0, 20));
  motion_says(0.0);
  EXPECT_EQ(start().motion.current_q20, raw(2.0, 20)) << "not more again";
  EXPECT_TRUE(start().motion.bounded);
  EXPECT_EQ(start().motion.passes, 2);
  start().followed.worst_q20 = raw(0.8, 20);
  motion_says(1.0);
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_START_VOLTAGE);
}

TEST_F(StartStanding, ThreeEighthsOfTheAmplitudeAreTheLimit) {
  start().saturation.current_q20 = raw(10.0, 20);
  start().followed.worst_q20 = raw(3.7, 20);
  saturation_says(POLARITY_RIGHT);
  EXPECT_EQ(inside::state(), DRIVE_RUN);
}

// What less current does not tell either is the voltage's fault, not the shaft's.
TEST_F(StartStanding, WhatStaysOpenAfterThatNamesTheVoltage) {
  inside::config().saturation = {0, 0};
  start().held_back = 1;
  start().starved = true;
  at(START_SETTLE, 100);
  step();
  for (int n = 0; n < 5; ++n) motion_says(0.0);
  EXPECT_EQ(inside::state(), DRIVE_START);
  EXPECT_EQ(start().motion.passes, 6);
  motion_says(0.0);
  EXPECT_EQ(inside::fault(), FAULT_START_VOLTAGE);
}

// A saturation that stays open on a shaft that turns meanwhile, or an angle that does, is no place for the other test.
TEST_F(StartStanding, AShaftThatTheTestHasSetInMotionIsListenedToAnew) {
  inside::config().saturation = {0, raw(0.002, 30)};
  start().tries = 2;
  inside::avv_speed_bpp() = bpp(60.0);
  at(START_SATURATION, SATURATION_LENGTH + 100, 60.0);
  start().saturation.tick = SATURATION_LENGTH;
  start().saturation.result = POLARITY_AMBIGUOUS;
  step();
  EXPECT_EQ(start().held_back, 1);
  EXPECT_EQ(inside::start_phase(), START_AXIS);
}

// A shaft that creeps has all its current: motion is tried as ever, and what stays open is the polarity's fault.
TEST_F(StartStanding, ACreepingShaftIsNotTheVoltagesFault) {
  parameters.polarity_current = raw(4.0, 20);
  parameters.current_limit = raw(14.0, 20);
  use_parameters();
  inside::config().saturation = {0, 0};
  start().held_back = 1;
  at(START_SETTLE, 100);
  step();
  for (const double amps : {4.0, 8.0, 14.0, 14.0}) {
    EXPECT_EQ(start().motion.current_q20, raw(amps, 20));
    EXPECT_FALSE(start().motion.bounded);
    motion_says(0.1);
  }
  EXPECT_EQ(inside::fault(), FAULT_POLARITY);
  SetUp();
  start().held_back = 2;
  start().tries = 2;
  at(START_SATURATION, SATURATION_LENGTH + 100, 60.0);
  start().saturation.tick = SATURATION_LENGTH;
  start().saturation.result = POLARITY_AMBIGUOUS;
  step();
  EXPECT_EQ(inside::fault(), FAULT_POLARITY);
}

// Twice the current with each try, up to the limit; what is tried with the same is added up. After four the polarity is
// a fault that says how sure it was.
TEST_F(StartStanding, WhatMotionLeavesOpenIsAFaultAfterFourTries) {
  parameters.polarity_current = raw(4.0, 20);
  parameters.current_limit = raw(14.0, 20);
  use_parameters();
  inside::config().saturation = {0, 0};
  at(START_SETTLE, 100);
  step();
  for (const auto& [amps, passes] : {std::pair{4.0, 1}, {8.0, 1}, {14.0, 1}, {14.0, 2}}) {
    EXPECT_EQ(inside::state(), DRIVE_START);
    EXPECT_EQ(inside::start_phase(), START_MOTION);
    EXPECT_EQ(start().motion.current_q20, raw(amps, 20));
    EXPECT_EQ(start().motion.passes, passes);
    motion_says(0.1);
  }
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_POLARITY);
  EXPECT_EQ(inside::start_found().sigma_q8, start().motion.sigma_q8);
  EXPECT_FALSE(board.gates_on);
}

// The motion is seen by the saliency, which a larger current would take away.
TEST_F(StartStanding, MotionIsLookedForWithACurrentThatLeavesTheSaliency) {
  for (const auto& [salient, most] : {std::pair{6.0, 6.0}, {20.0, 14.0}}) {
    SetUp();
    parameters.polarity_current = raw(4.0, 20);
    parameters.current_limit = raw(14.0, 20);
    parameters.saliency_current = raw(salient, 20);
    ASSERT_TRUE(drive_config_load(&inside::config()));
    inside::config().saturation = {0, 0};
    at(START_SETTLE, 100);
    step();
    for (const double amps : {4.0, std::min(8.0, most), most}) {
      EXPECT_EQ(start().motion.current_q20, raw(amps, 20));
      motion_says(0.1);
    }
  }
}

TEST_F(StartStanding, MotionTellsTheHalfTurn) {
  for (const double response : {1.0, -1.0}) {
    SetUp();
    inside::config().saturation = {0, 0};
    at(START_SETTLE, 100);
    step();
    motion_says(response);
    expect_runs(response > 0.0 ? kThere : kThere + kPi);
    EXPECT_EQ(inside::start_found().sigma_q8, start().motion.sigma_q8);
  }
}

// The angle that the motion is seen by is what the windows show, not what the observer has made of it.
TEST_F(StartStanding, MotionIsSeenByTheRawAngle) {
  inside::config().saturation = {0, 0};
  at(START_SETTLE, 100);
  step();
  at(START_MOTION, 2);
  inside::avv_error_bam() = 1000000;
  step();
  EXPECT_EQ(start().motion.last_bam, bam(kThere) + 1000000u);
}

}  // namespace
