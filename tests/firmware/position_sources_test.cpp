// What goes into an estimator and comes out of it, source by source: the current of the windows, the torque, the
// schedule's turns, AVV beside the observer, and from where each begins.

#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/mode/states.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
#include "firmware/start/step.h"
}

namespace {

using namespace stillspin::test;

// One, two or three windows of a current that stands still in the rotor's frame, ripple on top.
TEST_F(Sources, TheCurrentIsTheWindowsMeanLessTheirRipple) {
  const Vector current = {-2.0, 5.0}, ripple = {3.0, -4.0};  // A, V period
  const double speed = 0.13;                                 // rad per period
  for (std::uint16_t count = 1; count <= 3; ++count) {
    run_with(POSITION_ENCODER);
    see(count);
    for (int k = 0; k < count; ++k) inside::windows()[k].middle_tick = static_cast<std::int16_t>(1500 + 3100 * k);
    inside::selected().speed_bpp = raw(speed / kTurn, 32);
    // The ripple of all of them is turned by one angle, that of the middle one.
    const double one = rad(kHere) + speed * inside::windows()[count / 2].middle_tick / 10000.0;
    const double yd = real(inside::model().yd_q30, 30), yq = real(inside::model().yq_q30, 30);
    const Vector waves = {yd * ripple.x, yq * ripple.y};
    inside::ripple_q16() = raw_ab((ripple * count).turned(one), 16);
    for (std::uint16_t k = 0; k < count; ++k) {
      estimator_window_t& w = inside::windows()[k];
      const double angle = rad(kHere) + speed * w.middle_tick / 10000.0;
      w.current_q20 = raw_ab((current + waves).turned(angle), 20);
    }
    estimate();
    EXPECT_NEAR(real(measured().d, 20), current.x, 2e-4) << count;
    EXPECT_NEAR(real(measured().q, 20), current.y, 2e-4) << count;
  }
}

// No two sensors show more than 512 A; without windows the last current stays.
TEST_F(Sources, TheCurrentHasAnEndAndStaysWithoutWindows) {
  run_with(POSITION_ENCODER);
  see(1);
  inside::windows()[0].current_q20 = raw_ab(Vector{500.0, 0.0}.turned(rad(kHere)), 20);
  inside::ripple_q16() = raw_ab(Vector{-5000.0, 0.0}.turned(rad(kHere)), 16);
  estimate();
  EXPECT_NEAR(real(measured().d, 20), 512.0, 1e-3);
  see(0);
  estimate();
  EXPECT_NEAR(real(measured().d, 20), 512.0, 1e-3);
}

// A start that is off, or has just been switched on, has samples of nothing.
TEST_F(Sources, ABlindStartMeasuresNothing) {
  for (const std::uint16_t invalid : {0, 1, 2}) {
    run_with(POSITION_OBSERVER);
    see(1);
    inside::windows()[0].current_q20 = {raw(1.0, 20), 0};
    inside::current_dq_q20() = {0, 0};
    inside::be_in(DRIVE_START);
    inside::is_scheduled_turning() = false;
    inside::invalid_periods() = invalid;
    estimate();
    EXPECT_EQ(measured().d != 0, invalid == 0) << invalid;
  }
}

// By the torque of the measured current; while the polarity is open its sign is, too.
TEST_F(Sources, TheTorqueAcceleratesOnceThePolarityIsKnown) {
  const Motor m;
  for (const bool starting : {false, true}) {
    run_with(POSITION_OBSERVER);
    see(0);
    inside::current_dq_q20() = {0, raw(4.0, 20)};
    inside::is_scheduled_turning() = !starting;
    inertia_match.phase = INERTIA_RUN_UP;
    inertia_match.start_base_q8 = raw(-3.0, 8);
    inertia_match.gained_bpp = 100;
    estimate();
    const double accel =
        starting ? 0.0
                 : m.torque_constant() * 4.0 * m.pole_pairs / m.inertia * kPeriod * kPeriod / kTurn * 4294967296.0;
    EXPECT_NEAR(real(inside::torque_accel_q8(), 8), accel, 1e-3 * accel);
    EXPECT_NEAR(inertia_match.gained_bpp, 103.0 + accel, 1.0 + 1e-3 * accel) << "every period counts";
  }
}

// A source that looks on is told what its own angle makes of the current.
TEST_F(Sources, WhileAVectorIsTurnedTheTorqueIsThatOfTheAngleSeen) {
  NEEDS("start/if_start");
  run_with(POSITION_OBSERVER);
  see(0);
  inside::be_in(DRIVE_START);
  inside::is_open_loop() = true;
  inside::start_phase() = START_IF_RAMP;
  inside::seen().angle_bam = kHere + 0x40000000u;  // a quarter turn ahead: i_d is i_q against the rotation there
  inside::current_dq_q20() = {raw(4.0, 20), 0};
  estimate();
  EXPECT_LT(inside::torque_accel_q8(), -raw(1000.0, 8));
  inside::seen().angle_bam = inside::selected().angle_bam;
  estimate();
  EXPECT_EQ(inside::torque_accel_q8(), 0);
}

// The same of what windows have measured, by a source that is alone and by one of two.
TEST_F(Sources, WhileAVectorIsTurnedTheTorqueIsThatOfTheWindowsToo) {
  NEEDS("start/if_start", "sources/flux");
  for (const int source : {POSITION_OBSERVER, POSITION_FLUX_CONV}) {
    run_with(source);
    inside::be_in(DRIVE_START);
    inside::is_open_loop() = true;
    inside::start_phase() = START_IF_RAMP;
    for (int k = 0; k < 2; ++k) inside::windows()[k].current_q20 = raw_ab(Vector{4.0, 0.0}.turned(rad(kHere)), 20);
    inside::seen().angle_bam = kHere + 0x40000000u;
    estimate();
    EXPECT_LT(inside::torque_accel_q8(), -raw(1000.0, 8)) << source;
  }
}

// What a source that is alone made of the windows is taken as it is: a frame that turns at another speed than the
// vector's was elsewhere in the windows' middle.
TEST_F(Sources, WhileAVectorIsTurnedTheWindowsAreSeenWhereTheSourceWas) {
  NEEDS("start/if_start");
  const double speed = 0.2;  // rad per period
  double told[2];
  for (const bool measured : {true, false}) {
    run_with(POSITION_OBSERVER);
    inside::be_in(DRIVE_START);
    inside::is_open_loop() = true;
    inside::start_phase() = START_IF_RAMP;
    inside::seen() = {kThere, raw(speed / kTurn, 32), 0, 32767};
    const double middle = rad(kThere) + 0.5 * speed;  // half a period from where it was at the end of the last one
    for (int k = 0; k < 2; ++k) {
      inside::windows()[k].middle_tick = 5000;
      inside::windows()[k].current_q20 = raw_ab(Vector{4.0, 0.0}.turned(middle + kPi / 2.0), 20);
    }
    if (!measured) {
      inside::window_count() = 0;
      const Vector in_use = Vector{0.0, 4.0}.turned(rad(kThere - kHere));
      inside::current_dq_q20() = raw_dq(in_use, 20);
    }
    estimate();
    told[measured] = real(inside::torque_accel_q8(), 8);
  }
  EXPECT_NEAR(told[true] / told[false], 1.0, 2e-3) << "all of it along q";
}

// The model moves where the schedule says so or has its slot, and makes K of the rest in the look's slot.
TEST_F(Sources, TheModelFollowsWhereItHasItsPeriod) {
  for (int slot = 0; slot <= SCHEDULE_SLOTS; ++slot) {
    for (const bool moves : {false, true}) {
      for (const bool watched : {false, true}) {
        run_with(POSITION_OBSERVER);
        see(0);
        inside::model() = inside::config().nameplate;
        polarity_watch.open = watched;
        inside::schedule().moves = moves;
        inside::current_dq_q20().q = raw(2.5, 20);
        const std::int32_t k = inside::model().k_dq_q24;
        inside::model().k_dq_q24 = 0;
        inside::observer().is_sensitive = true;
        inside::observer().sensitivity = {};
        estimate(static_cast<schedule_slot_t>(slot));
        const bool follows = moves || slot == SLOT_OPERATING_POINT;
        EXPECT_EQ(inside::model().iq_q20, follows ? raw(2.5, 20) : 0) << slot << moves;
        EXPECT_EQ(inside::model().k_dq_q24 == k, slot == SLOT_LOOK && !watched) << slot << watched;
        see(1);
        inside::current_dq_q20().q = raw(2.5, 20);
        estimate(static_cast<schedule_slot_t>(slot));
        EXPECT_EQ(inside::observer().sensitivity.h_speed_q20.q != 0, follows) << "of the observer, with the model";
      }
    }
  }
}

// Skipped windows are not looked at, and the covariance is renewed where the schedule says so.
TEST_F(Sources, TheScheduleDecidesOnWindowsAndCovariance) {
  for (const bool skips : {false, true}) {
    for (const bool renews : {false, true}) {
      run_with(POSITION_OBSERVER);
      see_machine(kHere);
      deviation_observer_t& o = inside::observer();
      o.p_aa = o.p_ss = raw(0.02, 20);
      o.p_ll = raw(0.02, 20);
      inside::skips_windows() = skips;
      inside::renews_covariance() = renews;
      estimate();
      EXPECT_EQ(o.residual.span_ticks, skips ? 0 : 6000) << renews;
      EXPECT_EQ(o.gathered.periods == 0, renews) << skips;
    }
  }
}

// A covariance of an angle that is not known is renewed by the windows alone, but not beside what is long: speed,
// field, and a judgement that does take place.
TEST_F(Sources, ACovarianceWaitsForThePeriodBehindALongTask) {
  for (const task_t task : {TASK_SPEED, TASK_FIELD, TASK_JUDGE_FIRST, TASK_JUDGE, TASK_RENEW, TASK_SLOT}) {
    for (const bool judges : {false, true}) {
      run_with(POSITION_OBSERVER);
      see_machine(kHere);
      inside::schedule().task = task;
      inside::schedule().judges = judges;
      deviation_observer_t& o = inside::observer();
      ASSERT_FALSE(deviation_observer_is_sure(&o)) << "as preset";
      estimate();
      const bool is_long = judges || task == TASK_SPEED || task == TASK_FIELD;
      EXPECT_EQ(o.gathered.periods == 0, !is_long) << task << judges;
    }
  }
}

// A load that may fall on a held shaft is followed at once.
TEST_F(Sources, AHeldShaftHasTheFastObserver) {
  std::int32_t grown[2];
  for (const bool held : {false, true}) {
    run_with(POSITION_OBSERVER);
    parameters.map_known = 1;
    ASSERT_TRUE(drive_config_load(&inside::config()));
    inside::schedule().held = held;
    inside::renews_covariance() = true;
    deviation_observer_t& o = inside::observer();
    o.p_aa = o.p_as = o.p_al = o.p_ss = o.p_sl = 0;
    o.p_ll = raw(0.02, 20);
    see(0);
    estimate();
    grown[held] = o.p_ll - raw(0.02, 20);
  }
  EXPECT_GT(grown[1], 3 * grown[0]);
}

// Beside the observer AVV turns the windows into its own frame.
TEST_F(Sources, AvvBesideTheObserverSeesItsOwnError) {
  run_with(POSITION_OBSERVER_AVV);
  blend(BLEND_BOTH, 0.5);
  inside::avv_angle_bam() = kThere;
  see_machine(kHere);
  estimate();
  EXPECT_NEAR(rad(inside::avv_error_bam()), -rad(kThere - kHere), 0.01);
  EXPECT_EQ(inside::low_speed_estimate().angle_bam, inside::observer().angle_bam);
  EXPECT_EQ(inside::high_speed_estimate().angle_bam, inside::avv_angle_bam());
  const double low = rad(inside::low_speed_estimate().angle_bam - kHere),
               high = rad(inside::high_speed_estimate().angle_bam - kHere);
  EXPECT_NEAR(rad(inside::selected().angle_bam - kHere), 0.5 * (low + high), 0.01 * (high - low) + 1e-3);
}

// Beyond 15 degrees the regression is not linear; it is asked in its own slot, and stands until the next.
TEST_F(Sources, AvvLearnsWithin15DegreesOnly) {
  for (const double degrees : {-16.0, -14.0, 14.0, 16.0}) {
    for (const schedule_slot_t slot : {SLOT_REGRESSION, SLOT_OPERATING_POINT}) {
      run_with(POSITION_AVV);
      const std::uint32_t there = kHere + bam(degrees * kDegree);
      see_machine(there);
      const bool before = std::fabs(degrees) > 15.0;
      inside::is_near() = before;
      estimate(slot);
      EXPECT_NEAR(rad(inside::avv_error_bam()) / kDegree, degrees, 0.3);
      EXPECT_EQ(inside::is_near(), slot == SLOT_REGRESSION ? !before : before) << degrees;
    }
  }
}

TEST_F(Sources, EveryEstimatorStartsFromAnAngleAndASpeed) {
  for (const std::int32_t source : {POSITION_PAPER, POSITION_OBSERVER, POSITION_FLUX_CONV, POSITION_ENCODER}) {
    if (!has_source(source)) continue;
    run_with(source);
    blend(BLEND_BOTH, 0.5);
    flux_observer.machine.psi_q16 = 0;
    inside::avv().observer.load_accel_q8 = inside::observer().load_accel_q8 = 99;
    const std::int32_t speed = inside::config().blend.high_bpp + 1;
    inside::preset(kThere, speed);
    const drive_estimate_t& p = inside::estimate();
    for (const estimator_output_t& out : {p.selected, p.low, p.high}) {
      EXPECT_EQ(out.angle_bam, kThere);
      EXPECT_EQ(out.speed_bpp, speed);
      EXPECT_EQ(out.load_accel_q8, 0);
    }
    EXPECT_EQ(p.avv.observer.angle_bam, kThere);
    EXPECT_EQ(p.avv.observer.speed_bpp, speed);
    EXPECT_EQ(p.avv.observer.load_accel_q8, 0);
    EXPECT_EQ(p.observer.angle_bam, kThere);
    EXPECT_EQ(p.observer.speed_bpp, speed);
    EXPECT_EQ(p.observer.load_accel_q8, 0);
    if (source == POSITION_PAPER) {
      EXPECT_EQ(paper_zvv.angle_bam, kThere);
      EXPECT_EQ(paper_zvv.speed_bpp, speed);
    }
    const bool flux = source == POSITION_FLUX_CONV || source == POSITION_ENCODER;  // beside which it may look on
    EXPECT_EQ(flux_observer.machine.psi_q16 > 0, flux) << "what was learnt is forgotten";
    // The paper's pair is right at once at any speed; the others begin with the low-speed estimator.
    EXPECT_EQ(p.blend.region, source == POSITION_PAPER ? BLEND_HIGH : BLEND_LOW);
    EXPECT_EQ(p.blend.share_q15, source == POSITION_PAPER ? 0 : 32767);
  }
}

TEST_F(Sources, NothingStartsFasterThanTheModelsEnd) {
  NEEDS("sources/paper");
  for (const int sign : {1, -1}) {
    run_with(POSITION_PAPER);
    inside::preset(kThere, sign * 2000000000);
    const drive_estimate_t& p = inside::estimate();
    for (const std::int32_t speed :
         {p.selected.speed_bpp, p.avv.observer.speed_bpp, p.observer.speed_bpp, paper_zvv.speed_bpp})
      EXPECT_EQ(speed, sign * MACHINE_SPEED_END_BPP);
  }
}

// A start that looks for the axis has AVV alone at work.
TEST_F(Sources, AnAxisIsLookedForByAvvAlone) {
  run_with(POSITION_OBSERVER);
  inside::preset_axis(kThere, 777);
  EXPECT_EQ(inside::selected().angle_bam, kThere);
  EXPECT_EQ(inside::selected().speed_bpp, 777);
  EXPECT_EQ(inside::avv_angle_bam(), kThere);
  EXPECT_EQ(inside::avv_speed_bpp(), 777);
  EXPECT_EQ(inside::observer().angle_bam, kHere);
}

// With the gates off the windows are no answer to the pattern's voltages: the current is measured, and nothing else.
TEST_F(Sources, WithTheGatesOffNoEstimatorIsAtWork) {
  for (const bool off : {true, false}) {
    run_with(POSITION_OBSERVER);
    inside::be_in(DRIVE_START);
    inside::is_scheduled_turning() = false;
    inside::gates_off() = off;
    see_machine(kHere);
    inside::windows()[0].current_q20 = {raw(1.0, 20), 0};
    estimate();
    EXPECT_NE(measured().d, 0);
    EXPECT_EQ(inside::avv_information() > 0, !off);
  }
}

}  // namespace
