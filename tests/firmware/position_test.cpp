// Which estimators run when, what the idle one does meanwhile, and what of an angle the speed control may use: single
// steps of a drive that the test has put where it wants it.

#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/observer/observer.h"
#include "firmware/sources/paper/paper.h"
}

namespace {

using namespace stillspin::test;

// ZVV alone, both, AVV alone; who does not run stands by where the other one is.
TEST_F(Position, ThePapersIdleEstimatorStandsBy) {
  NEEDS("sources/paper");
  const struct {
    blend_region_t region;
    double share;
    std::uint16_t windows;
    bool zvv, avv;
  } cases[] = {{BLEND_LOW, 1.0, 1, true, false}, {BLEND_LOW, 1.0, 2, true, true},  {BLEND_LOW, 0.5, 1, true, true},
               {BLEND_BOTH, 0.5, 2, true, true}, {BLEND_HIGH, 0.5, 2, true, true}, {BLEND_HIGH, 0.0, 2, false, true}};
  for (const auto& c : cases) {
    run_with(POSITION_PAPER);
    see(c.windows);
    blend(c.region, c.share);
    drive_estimate_t& p = inside::estimate();
    p.avv.observer.angle_bam = kThere;
    inside::estimate_step();
    const double apart = rad(kThere - kHere);  // who runs moves, a thousandth of that
    EXPECT_NEAR(rad(paper_zvv.angle_bam - kHere), c.zvv ? 0.0 : apart, 1e-3 * apart) << c.region << c.share;
    EXPECT_NEAR(rad(p.avv.observer.angle_bam - kHere), c.avv ? apart : 0.0, 1e-3 * apart) << c.region << c.share;
    EXPECT_EQ(p.low.angle_bam, paper_zvv.angle_bam);
    EXPECT_EQ(p.high.angle_bam, p.avv.observer.angle_bam);
  }
}

// Where the paper's estimators are both at work one has the windows of the periods of speed control and field
// weakening, the other, which has more of the shaft, those of all others.
TEST_F(Position, ThePapersEstimatorsTakeTurns) {
  NEEDS("sources/paper");
  for (const task_t task : {TASK_SPEED, TASK_FIELD, TASK_JUDGE_FIRST, TASK_RENEW, TASK_SLOT}) {
    for (const bool below : {false, true}) {
      run_with(POSITION_PAPER);
      blend(below ? BLEND_LOW : BLEND_BOTH, below ? 1.0 : 0.5);
      inside::scheduled_task() = task;
      inside::windows()[0].change_q19 = raw_change({0.0, 0.02}, 3000);
      inside::windows()[1].voltage_q19 = {raw(150.0, 19), 0};
      inside::low_speed_estimate().quality_q15 = 12345;
      inside::estimate_step();
      const bool of_zvv = (task == TASK_SPEED || task == TASK_FIELD) != below;
      EXPECT_EQ(paper_zvv.deviation_q20 != 0, of_zvv) << task;
      EXPECT_EQ(inside::low_speed_estimate().quality_q15 == 12345, !of_zvv) << task;
      EXPECT_EQ(inside::avv_information() > 0, !of_zvv) << task;
      EXPECT_EQ(inside::low_speed_estimate().angle_bam, paper_zvv.angle_bam) << task;
    }
  }
}

// Windows are looked at in the estimator's own frame, whatever angle is in use.
TEST_F(Position, WindowsAreTurnedAnewWhereAnotherAngleIsInUse) {
  NEEDS("sources/paper");
  for (const bool same : {true, false}) {
    run_with(POSITION_PAPER);
    see(1);
    blend(BLEND_LOW, 1.0);
    inside::windows()[0].change_q19 = raw_change({0.02, 0.01}, 3000);
    if (!same) inside::selected().angle_bam = kThere;
    inside::estimate_step();
    const Vector slope = Vector{0.02, 0.01}.turned(-rad(kHere));
    EXPECT_NEAR(real(paper_zvv.deviation_q20, 20), slope.y, 5e-5) << same;
  }
}

// So does ZVV where it takes turns with AVV, for which they were turned.
TEST_F(Position, ZvvTurnsItsWindowsIntoItsOwnFrameBesideAvv) {
  NEEDS("sources/paper");
  run_with(POSITION_PAPER);
  blend(BLEND_BOTH, 0.5);
  inside::scheduled_task() = TASK_SPEED;
  inside::high_speed_estimate().angle_bam = inside::avv_angle_bam() = kThere;
  inside::windows()[0].change_q19 = raw_change({0.02, 0.01}, 3000);
  inside::estimate_step();
  const Vector slope = Vector{0.02, 0.01}.turned(-rad(kHere));
  EXPECT_NEAR(real(paper_zvv.deviation_q20, 20), slope.y, 5e-5);
}

// The place of a regression that saw nothing teaches nothing.
TEST_F(Position, WithoutWindowsNothingIsNearEnoughToLearnFrom) {
  for (const std::uint16_t windows : {2, 0}) {
    run_with(POSITION_OBSERVER);
    see(windows);
    inside::scheduled_slot() = SLOT_REGRESSION;
    inside::is_near() = windows == 0;
    inside::estimate_step();
    EXPECT_EQ(inside::is_near(), windows > 0);
  }
}

// One place later the regression is asked; what saw nothing then is not asked back.
TEST_F(Position, WhatWasNotNearIsNotLearntFromLater) {
  for (const bool near : {true, false}) {
    for (const double off : {0.0, 14.9, -14.9, 15.1, -15.1}) {
      run_with(POSITION_OBSERVER);
      inside::scheduled_slot() = SLOT_LOOK;
      inside::is_near() = near;
      regression_t& r = inside::observer().regression;
      r = {};
      r.spread_q8 = raw(40000.0, 8);
      const machine_model_t& m = inside::model();
      const double half = std::ldexp((m.yd_q30 - m.yq_q30) / 2.0 * r.spread_q8, -22), turned = 2.0 * off * kDegree;
      r.mirror_q16 = static_cast<std::int32_t>(half * (std::cos(turned) - 1.0));
      r.cross_q16 = static_cast<std::int32_t>(half * std::sin(turned));
      inside::estimate_step();
      EXPECT_NEAR(rad(static_cast<std::uint32_t>(inside::avv_error_bam())) / kDegree, off, 0.01);
      EXPECT_EQ(inside::is_near(), near && std::fabs(off) < 15.0) << off;
    }
  }
}

// An axis that next to nothing tells is not asked: Lq less than an eighth above Ld, as the parameters have it.
TEST_F(Position, WithNextToNoSaliencyTheRegressionIsNotAsked) {
  for (const double share : {1.0, 1.12, 1.13}) {
    for (const bool near : {true, false}) {
      run_with(POSITION_OBSERVER);
      inside::scheduled_slot() = SLOT_LOOK;
      inside::is_near() = near;
      machine_point_t& p = inside::model().map.points[0];
      p.ydd_q30 = static_cast<std::int32_t>(share * p.yqq_q30);
      regression_t& r = inside::observer().regression;
      r = {};
      r.spread_q8 = raw(40000.0, 8);
      r.cross_q16 = static_cast<std::int32_t>(std::ldexp(0.5 * inside::model().yd_q30 * r.spread_q8, -22));
      inside::estimate_step();
      EXPECT_EQ(inside::is_near(), near && share < 1.125) << share;
    }
  }
}

// The flux is alone when the blend has come up all the way and the polarity is no question any more.
TEST_F(Position, TheFluxIsAloneAtTheBlendsEndAndWithAKnownPolarity) {
  NEEDS("sources/flux");
  const struct {
    blend_region_t region;
    double share;
    bool watched, alone;
  } cases[] = {{BLEND_HIGH, 0.0, false, true},
               {BLEND_HIGH, 0.25, false, false},
               {BLEND_HIGH, 0.0, true, false},
               {BLEND_BOTH, 0.0, false, false},
               {BLEND_LOW, 1.0, false, false}};
  for (const auto& c : cases) {
    run_with(POSITION_FLUX_CONV);
    blend(c.region, c.share);
    polarity_watch.open = c.watched;
    EXPECT_EQ(position_observer_rests(&drive), c.alone) << c.region << c.share << c.watched;
    EXPECT_EQ(flux_source.excitation(&drive), c.alone ? EXCITATION_CENTRED : EXCITATION_ALTERNATING);
  }
}

// Above the blend's begin the windows teach nothing, but that the watch of the polarity wants their axis.
TEST_F(Position, WindowsBesideTheFluxAreRegressedAtLowSpeedAndForTheWatch) {
  NEEDS("sources/flux");
  for (const blend_region_t region : {BLEND_LOW, BLEND_BOTH, BLEND_HIGH}) {
    for (const bool watched : {false, true}) {
      for (const bool asked : {false, true}) {
        run_with(POSITION_FLUX_CONV);
        blend(region, 0.5);
        polarity_watch.open = watched;
        inside::scheduled_slot() = asked ? SLOT_REGRESSION : SCHEDULE_SLOTS;
        inside::is_near() = !asked;
        inside::observer().regressed_bam = kThere;
        inside::estimate_step();
        const bool regressed = asked && (region == BLEND_LOW || watched);
        EXPECT_EQ(inside::observer().regressed_bam != kThere, regressed) << region;
        EXPECT_EQ(inside::is_near(), regressed || !asked) << "what was not regressed teaches nothing";
      }
    }
  }
}

// A current that was turned into the frame of who looks at the windows first is the one in the frame in use.
TEST_F(Position, TheCurrentIsThatInTheFrameInUse) {
  const struct {
    std::int32_t source;
    blend_region_t region;
    double share;
  } cases[] = {{POSITION_ENCODER, BLEND_LOW, 1.0},       {POSITION_PAPER, BLEND_LOW, 1.0},
               {POSITION_PAPER, BLEND_HIGH, 0.0},        {POSITION_PAPER, BLEND_BOTH, 0.5},
               {POSITION_AVV, BLEND_LOW, 1.0},           {POSITION_OBSERVER, BLEND_LOW, 1.0},
               {POSITION_OBSERVER_AVV, BLEND_BOTH, 0.5}, {POSITION_FLUX_CONV, BLEND_BOTH, 0.5},
               {POSITION_FLUX_CONV, BLEND_HIGH, 0.0}};
  for (const auto& c : cases) {
    if (!has_source(c.source)) continue;
    for (const bool starting : {false, true}) {
      run_with(c.source);
      see(1);
      blend(c.region, c.share);
      inside::windows()[0].current_q20 = {raw(3.0, 20), raw(1.0, 20)};
      if (starting) inside::be_in(DRIVE_START);
      inside::is_scheduled_turning() = !starting;
      inside::selected().angle_bam = kThere;
      inside::high_speed_estimate().angle_bam = kHere + 0x01000000u;
      inside::estimate_step();
      const Vector current = Vector{3.0, 1.0}.turned(-rad(kThere));
      // A sum of windows is Q14.
      EXPECT_NEAR(real(inside::current_dq_q20().d, 20), current.x, 6.5e-5) << c.source << c.region << starting;
      EXPECT_NEAR(real(inside::current_dq_q20().q, 20), current.y, 6.5e-5) << c.source << c.region << starting;
    }
  }
}

// Below the blend the flux is where the observer's angle lets expect; from its begin on it runs by itself.
TEST_F(Position, TheFluxFollowsUntilItHasAShare) {
  NEEDS("sources/flux");
  for (const double share : {1.0, 0.9}) {
    run_with(POSITION_FLUX_CONV);
    const estimator_input_t in = {&inside::model(), inside::windows(), 2, 0, false, false, false, false, nullptr, 0};
    const estimator_output_t there = {kThere, 0, 0, 32767}, low = {kHere, 0, 0, 32767};
    flux_source_follow(&drive, &there);
    blend(BLEND_LOW, share);
    (void)flux_source_beside(&drive, &inside::estimate(), &in, &low);
    if (share == 1.0) {
      EXPECT_EQ(inside::high_speed_estimate().angle_bam, kHere);
    } else {
      EXPECT_NEAR(rad(inside::high_speed_estimate().angle_bam - kThere), 0.0, 0.01);
    }
  }
}

// A shaft is held in RUN; told to stop it is braked like any other.
TEST_F(Position, AHeldShaftIsHeldInRunOnly) {
  run_with(POSITION_OBSERVER);
  brake_release_hold.left = 100;
  EXPECT_TRUE(hold_is_on(&drive));
  inside::speed_step();
  EXPECT_EQ(brake_release_hold.left, 99u);
  inside::be_in(DRIVE_STOP);
  EXPECT_FALSE(hold_is_on(&drive));
  inside::speed_step();
  EXPECT_EQ(brake_release_hold.left, 99u);
}

// While the link's limit brakes the shaft, a ramp that would brake it more waits, and one that speeds it up does not.
TEST_F(Position, TheRampWaitsForAShaftThatMayNotBeBrakedFaster) {
  for (const int sign : {1, -1}) {
    for (const int change : {-1, 1}) {
      for (const bool limited : {false, true}) {
        run_with(POSITION_OBSERVER);
        const std::int32_t now = sign * bpp_of(1000);
        inside::selected().speed_bpp = inside::ramped_bpp() = now;
        inside::target_bpp() = now + sign * change * bpp_of(500);
        inside::limits() = limited ? LIMIT_BRAKING : 0;
        inside::scheduled_task() = TASK_SPEED;
        inside::speed_step();
        const bool waits = limited && change < 0;
        EXPECT_EQ(inside::ramped_bpp() == now, waits) << sign << change << limited;
      }
    }
  }
}

// An inertia that a run-up suggested and its end refutes is taken back, and with it the load that the observer made of
// it; while the shaft runs up the observer gets the speed that the torque should have made.
TEST_F(Position, TheObserverIsToldOfAnInertiaThatIsTakenBack) {
  run_with(POSITION_OBSERVER);
  inside::config().mapped = true;
  parameters.inertia_adapt = 1;
  use_parameters();
  inertia_match_t& s = inertia_match;
  s.phase = INERTIA_SETTLE;
  s.ratio_q24 = raw(0.5, 24);
  s.before_q24 = raw(1.0, 24);
  s.ms = s.quiet_ms = 200;
  s.start_base_q8 = 0;
  s.base_q8 = s.mean_q8 = raw(4000.0, 8);  // the load came with the run-up and stayed
  inside::torque_accel_q8() = s.base_q8;
  inside::observer().load_accel_q8 = raw(300.0, 8);
  inside::observer().speed_bpp = 777;
  inside::match_inertia();
  EXPECT_EQ(s.phase, INERTIA_REST);
  EXPECT_EQ(s.ratio_q24, raw(1.0, 24));
  EXPECT_EQ(inside::observer().load_accel_q8, raw(600.0, 8));
  EXPECT_EQ(inside::observer().speed_bpp, 777);
  EXPECT_EQ(inside::model().accel_q12, inside::config().nameplate.accel_q12);
}

}  // namespace
