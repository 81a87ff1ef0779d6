// Speed control and its limits through the ten periods of a millisecond, on a drive that the test has put where it
// wants it.

#include "tests/firmware/speed_control.hpp"

#include <algorithm>

extern "C" {
#include "control/brake_limit.h"
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

// Braking is limited between link_regulation and two thirds of the way to the fault, and near standstill, where the EMF
// is less than the resistance takes, not at all.
TEST_F(SpeedTask, BrakingIsLimitedByTheLink) {
  parameters.link_regulation = raw(400.0, 16);
  parameters.link_maximum = raw(430.0, 16);
  parameters.current_limit = raw(10.0, 20);
  use_parameters();
  for (const auto& [w, link] : {std::pair{-400.0, 390.0},
                                {-400.0, 405.0},
                                {-400.0, 410.0},
                                {-400.0, 415.0},
                                {-400.0, 425.0},
                                {5.0, 410.0},
                                {13.0, 410.0},
                                {-16.0, 410.0},
                                {19.0, 410.0}}) {
    speed(w);
    inside::link_q16() = raw(link, 16);
    part(TASK_SPEED);
    brake_limit_input_t in = {};
    in.link_q16 = raw(link, 16);
    in.start_q16 = raw(400.0, 16);
    in.end_q16 = raw(420.0, 16);
    in.emf_q16 = raw(std::fabs(w) * 1e-4 * real(inside::model().emf_q16, 16), 16);
    in.drop_q16 = raw(10.0 * real(inside::model().nominal_rs_q24, 24), 16);
    EXPECT_NEAR(real(inside::braking_headroom_q20(), 20), real(brake_limit_q20(&in, raw(10.0, 20)), 20), 0.01)
        << w << ", " << link;
  }
}

// Against the rotation, and only there, the speed control keeps to that limit, and says so.
TEST_F(SpeedTask, ABrakingShaftKeepsToItsLimit) {
  for (const double sign : {1.0, -1.0}) {
    for (const double change : {1.0, -1.0}) {
      SetUp();
      parameters.link_regulation = raw(400.0, 16);
      parameters.link_maximum = raw(430.0, 16);
      use_parameters();
      inside::link_q16() = raw(415.0, 16);
      inside::current_limit_q20() = raw(8.0, 20);
      speed(sign * 300.0);
      inside::ramped_bpp() = inside::target_bpp() = bpp(sign * (300.0 + change * 250.0));
      for (int n = 0; n < 5; ++n) part(TASK_SPEED);
      const bool brakes = change < 0.0;
      const double braking = real(inside::braking_headroom_q20(), 20);
      ASSERT_GT(braking, 0.5);
      ASSERT_LT(braking, 6.0);
      EXPECT_NEAR(iq(), sign * change * (brakes ? braking : 8.0), 1e-4) << sign << change;
      EXPECT_EQ((inside::limits() & LIMIT_BRAKING) != 0, brakes);
      EXPECT_EQ((inside::limits() & LIMIT_CURRENT) != 0, !brakes);
    }
  }
}

TEST_F(SpeedTask, WithinItsLimitsNoLimitIsSaid) {
  inside::weakening_q20() = raw(-1.0, 20);
  inside::limits() = LIMIT_BRAKING | LIMIT_CURRENT | LIMIT_WEAKENING;
  speed(100.0);
  inside::ramped_bpp() = inside::target_bpp() = bpp(100.0);
  part(TASK_SPEED);
  EXPECT_EQ(inside::limits(), LIMIT_WEAKENING) << "that one weakening renews itself";
}

// The load that the observer sees is balanced at once, less what friction is part of it.
TEST_F(SpeedTask, TheLoadIsBalancedAtOnce) {
  const auto current = [&](double w, double load_nm) {
    SetUp();
    speed(w);
    inside::ramped_bpp() = inside::target_bpp() = bpp(w);
    inside::config().friction_per_bpp_q40 =
        raw(0.002 / 4.0 * kTurn / kPeriod / 4294967296.0, 40);  // 2 mNms, mechanical
    inside::selected().load_accel_q8 = static_cast<std::int32_t>(load_nm * real(inside::model().accel_q12, 12) * 256.0);
    part(TASK_SPEED);
    return iq();
  };
  EXPECT_NEAR(current(0.0, 1.0) - current(0.0, 0.0), 1.0 / torque_constant(), 2e-3);
  EXPECT_NEAR(current(0.0, -2.0) - current(0.0, 0.0), -2.0 / torque_constant(), 4e-3);
  // The observer's load has the friction in it, and the speed law has its own.
  const double friction = 0.002 / 4.0 * 200.0;
  EXPECT_NEAR(current(200.0, 1.0) - current(200.0, 1.0 + friction), -friction / torque_constant(), 2e-3);
}

// While a start's hold has the torque, the speed law waits where it will go on from: the current less the load's.
TEST_F(SpeedTask, AHeldShaftsSpeedLawWaitsWhereItGoesOn) {
  use_source(POSITION_OBSERVER);
  ASSERT_TRUE(drive_config_load(&inside::config()));
  brake_release_hold.left = 5;
  brake_release_hold.reference_bam = 0;
  part(TASK_SPEED);
  inside::reference_dq_q20().q = raw(3.0, 20);
  inside::selected().load_accel_q8 = static_cast<std::int32_t>(1.2 * real(inside::model().accel_q12, 12) * 256.0);
  part(TASK_SPEED);
  EXPECT_EQ(brake_release_hold.left, 3u);
  EXPECT_NEAR(real(inside::speed_controller().current_q20, 20), iq() - 1.2 / torque_constant(), 2e-3);
  EXPECT_GT(iq(), 2.2);
}

// acceleration = wc^2 (theta* - theta) + 2 wc (w* - w) + load, wc = 225 rad/s, by 0.7 A in a period at most; theta*
// runs on at the reference's speed.
TEST_F(SpeedTask, AHeldShaftIsHeldStiffly) {
  struct Case {
    double off, slow, load_nm, iq;
  };
  for (const Case& c : {Case{0.001, 0.0, 0.0, 0.5},
                        {-0.001, 0.0, 0.0, 0.5},
                        {0.0, 0.1, 0.0, 0.5},
                        {0.0, 0.0, 0.2, 0.5},
                        {0.5, 0.0, 0.0, 0.5},
                        {0.004, 0.0, 2.2, 3.0},
                        {-0.004, 0.0, -2.2, -3.0},
                        {0.01, 0.0, 4.4, 1.0},
                        {0.0533, 0.0, 0.0, 3.0},
                        {-0.0533, 0.0, 0.0, -3.0}}) {
    SetUp();
    use_source(POSITION_OBSERVER);
    ASSERT_TRUE(drive_config_load(&inside::config()));
    part(TASK_SPEED);
    parameters.hold_time = 1;
    use_parameters();
    hold_begin(&drive);
    brake_release_hold.reference_bam = bam(0.3 + c.off);
    const double w = 50.0;
    inside::ramped_bpp() = bpp(w);
    const double per_nm = real(inside::model().accel_q12, 12) * kTurn / 4294967296.0 / kPeriod / kPeriod;
    inside::selected() = {bam(0.3 + w * kPeriod), bpp(w - c.slow),
                          static_cast<std::int32_t>(c.load_nm * real(inside::model().accel_q12, 12) * 256.0), 32767};
    inside::reference_dq_q20().q = raw(c.iq, 20);
    ASSERT_TRUE(hold_is_on(&drive));
    const double held = real(hold_step_q20(&drive), 20);
    const double per_ampere = per_nm * torque_constant();
    const double accel = 225.0 * 225.0 * c.off + 450.0 * c.slow + c.load_nm * per_nm;
    const double wanted = accel / per_ampere;
    EXPECT_NEAR(held, c.iq + std::clamp(wanted - c.iq, -0.7, 0.7), 2e-3) << c.off << c.slow << c.load_nm;
    EXPECT_EQ(brake_release_hold.left, 9u);
  }
}

// What is long has a period of its own; what is short is with something else.
TEST_F(SpeedTask, EachPeriodHasItsOwnTask) {
  constexpr std::int32_t kMark = 77;
  for (int k = 0; k < 10; ++k) {
    SetUp();
    parameters.inertia_adapt = 1;
    use_parameters();
    use_source(POSITION_OBSERVER);
    inside::config().mapped = true;
    drive_control_t& c = inside::control();
    c.weakening.id_q20 = kMark;
    inertia_match.ms = kMark;
    c.references.current_q20.d = kMark;
    c.headroom_q20 = raw(3.0, 20);
    c.braking_headroom_q20 = kMark;
    inside::scheduled_period() = static_cast<std::uint16_t>((k + 9) % 10);
    schedule_next(&drive, &inside::schedule());
    inside::speed_step();
    EXPECT_EQ(c.headroom_q20 != raw(3.0, 20), k == 0) << k;
    EXPECT_EQ(c.braking_headroom_q20 != kMark, k == 0) << k;
    EXPECT_EQ(c.weakening.id_q20 != kMark, k == 5) << k;
    EXPECT_EQ(inertia_match.ms != kMark, k == 6) << k;
    EXPECT_EQ(c.references.current_q20.d != kMark, k == 0) << k;
  }
}

TEST_F(SpeedTask, NothingIsControlledWhileNothingTurns) {
  inside::be_in(DRIVE_READY);
  inside::ramped_bpp() = 0;
  inside::target_bpp() = 1000000;
  millisecond();
  EXPECT_EQ(inside::ramped_bpp(), 0);
}

// The drive's clock, in any state.
TEST_F(SpeedTask, AMillisecondHasTenPeriods) {
  for (const drive_state_t state : {DRIVE_READY, DRIVE_RUN, DRIVE_FAULT}) {
    inside::be_in(state);
    const std::uint32_t before = inside::time_ms();
    for (int k = 0; k < 20; ++k) {
      schedule_next(&drive, &inside::schedule());
      drive_sequence(&drive);
    }
    EXPECT_EQ(inside::time_ms(), before + 2) << state;
  }
}

// The ramp moves by its step in each millisecond and in STOP to zero; where there is none the reference jumps.
TEST_F(SpeedTask, TheRampLeadsToItsTarget) {
  inside::config().ramp_step_bpp = 1000;
  inside::target_bpp() = 5000000;
  part(TASK_SPEED);
  part(TASK_SPEED);
  EXPECT_EQ(inside::ramped_bpp(), 2000);
  inside::be_in(DRIVE_STOP);
  part(TASK_SPEED);
  EXPECT_EQ(inside::ramped_bpp(), 1000);
  inside::be_in(DRIVE_RUN);
  inside::config().ramp_step_bpp = 0;
  part(TASK_SPEED);
  EXPECT_EQ(inside::ramped_bpp(), 5000000);
}

// The law is told where the ramp is and by how much it moves on; where there is none, where it has jumped to.
TEST_F(SpeedTask, TheLawFollowsTheRampAndJumpsWithoutOne) {
  for (const std::int32_t step : {20000, 0}) {
    SetUp();
    inside::config().ramp_step_bpp = step;
    inside::ramped_bpp() = 300000;
    inside::target_bpp() = 500000;
    speed_controller_t law = inside::speed_controller();
    const speed_controller_input_t in = {step > 0 ? 300000 : 500000, step, 0, 0, raw(-10.0, 20), raw(10.0, 20)};
    part(TASK_SPEED);
    EXPECT_EQ(inside::reference_dq_q20().q, speed_controller_step(&law, SPEED_PREDICTIVE, &in)) << step;
  }
}

// Told to stand, a shaft keeps its place: only in RUN, with the ramp at zero too, and from a speed on that is at rest.
TEST_F(SpeedTask, AtZeroThePlaceIsKept) {
  parameters.position_hold = 1280;
  ASSERT_TRUE(drive_config_load(&inside::config()));
  const auto holds = [&](drive_state_t state, std::int32_t target, std::int32_t ramp, std::int32_t now, bool before) {
    inside::be_in(state);
    inside::target_bpp() = target;
    inside::config().ramp_step_bpp = 1;
    inside::ramped_bpp() = ramp;
    inside::selected().speed_bpp = now;
    position_hold_release(&inside::position_hold());
    if (before) (void)position_hold_step(&inside::position_hold(), 0, inside::config().hold_gain_q30);
    part(TASK_SPEED);
    return inside::position_hold().holding;
  };
  const std::int32_t rest = 2 * inside::config().observer.cogging.crawl_bpp;
  ASSERT_GT(rest, 10);
  EXPECT_TRUE(holds(DRIVE_RUN, 0, 0, 0, false));
  EXPECT_TRUE(holds(DRIVE_RUN, 0, 0, rest - 1, false));
  EXPECT_TRUE(holds(DRIVE_RUN, 0, 0, 1 - rest, false));
  EXPECT_FALSE(holds(DRIVE_RUN, 0, 0, rest, false));
  EXPECT_TRUE(holds(DRIVE_RUN, 0, 0, 4 * rest, true)) << "a shaft that is pushed away is taken back";
  EXPECT_FALSE(holds(DRIVE_RUN, 100, 0, 0, true));
  EXPECT_FALSE(holds(DRIVE_RUN, 0, 100, 0, true));
  EXPECT_FALSE(holds(DRIVE_STOP, 0, 0, 0, true));
}

}  // namespace
