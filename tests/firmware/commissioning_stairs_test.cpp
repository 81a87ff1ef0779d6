// What a commissioning sums and sends: the staircase's levels, the pairs of the map, and when results are there.

#include "firmware/board/functions.h"
#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/interlock.h"
#include "firmware/mode/states.h"
#include "tests/firmware/commissioning_sums.hpp"
#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/commissioning/phases.h"
}

namespace {

using namespace stillspin::test;

// What a volt of drop in every phase makes along d is summed whatever drop the drive compensates: 4/3 V where the three
// currents are far from zero.
class CommissioningStairs : public Drive {
 protected:
  void SetUp() override {
    NEEDS("commissioning");
    Drive::SetUp();
    make_ready();
    inside::be_in(DRIVE_COMMISSION);
    commissioning.model = nameplate();
    begin();
  }
  static staircase_t& stairs() { return commissioning.staircase; }
  static void begin() {
    commissioning.tick = 0;
    (void)commissioning_climb(&drive);
    commissioning.tick = 1;
  }
  static double level(int index) { return real(stairs().first_q20 + stairs().step_q20 * index, 20); }
  static double ripple() {
    const double pulse = inside::config().modulator.pulse_ticks / 1e4;
    return real(inside::link_q16(), 16) * 2.0 / 3.0 * real(commissioning.model.yd_q30, 30) * pulse;
  }
  /// Above lambda / (Lq - Ld), A, the reluctance turns the torque's sign.
  static void turns_at(double current) {
    machine_model_t& m = commissioning.model;
    m.lq_q30 = m.ld_q30 + raw(real(m.flux_q28, 28) / current, 30);
  }
};

TEST_F(CommissioningStairs, TheFactorIsThatOfOneVolt) {
  for (const auto& [drop, sixths] : {std::pair{0.0, 0}, {0.95, 1}, {2.0, 5}}) {
    SetUp();
    inside::config().dead_time.drop_q16 = raw(drop, 16);
    dead_time_design(&inside::config().dead_time);
    inside::current_dq_q20() = {raw(10.0, 20), 0};
    inside::selected().angle_bam = bam(sixths * kPi / 3.0);
    begin();
    commissioning.tick = 2;  // in which it is made
    (void)commissioning_climb(&drive);
    stairs().tick = 600;
    (void)commissioning_climb(&drive);
    ASSERT_EQ(stairs().level[0].periods, 1);
    EXPECT_NEAR(real(stairs().level[0].factor, 20), 4.0 / 3.0, 1e-3) << drop;
  }
}

// Twice the ripple and a fifth to spare must leave room for a line; where it does not, no current is sent at all.
TEST_F(CommissioningStairs, WithoutRoomForALineNoCurrentIsSent) {
  for (const bool room : {true, false}) {
    SetUp();
    if (!room) commissioning.model.yd_q30 *= 8;  // 0.6 mH: a ripple of 8 A and more
    begin();
    for (int n = 0; n < 200; ++n) (void)commissioning_climb(&drive);
    EXPECT_NEAR(real(inside::reference_dq_q20().d, 20), room ? 5.6 : 0.0, room ? 1.5 : 0.0);
  }
}

// A level begins when heat sink and overload leave the whole limit, and one that has begun goes on; so does a train.
TEST_F(CommissioningStairs, ItWaitsAtRestForTheWholeLimit) {
  interlock_share_q15 = INTERLOCK_SHARE_ONE - 1;
  inside::reference_dq_q20().d = raw(0.5, 20);
  for (int n = 0; n < 100; ++n) EXPECT_FALSE(commissioning_climb(&drive));
  EXPECT_EQ(inside::reference_dq_q20().d, 0);
  EXPECT_EQ(stairs().tick, 0);
  commissioning.phase = COMMISSIONING_STAIRCASE;
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_COOLING) << "who waits is told";
  interlock_share_q15 = INTERLOCK_SHARE_ONE;
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_STAIRCASE);
  (void)commissioning_climb(&drive);
  interlock_share_q15 = INTERLOCK_SHARE_ONE - 1;
  for (int n = 0; n < 100; ++n) (void)commissioning_climb(&drive);
  EXPECT_EQ(stairs().tick, 101);
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_STAIRCASE) << "which goes on";
  EXPECT_GT(inside::reference_dq_q20().d, 0);
  map_t& m = commissioning.map;
  m.pause = true;
  m.train = 1;
  for (int n = 0; n < 2000; ++n) (void)commissioning_map(&drive);
  EXPECT_TRUE(m.pause);
  commissioning.phase = COMMISSIONING_MAP;
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_COOLING);
  commissioning.phase = COMMISSIONING_SPIN;
  EXPECT_EQ(drive_commissioning_phase(), COMMISSIONING_SPIN) << "which never waits";
  interlock_share_q15 = INTERLOCK_SHARE_ONE;
  for (int n = 0; n < 2; ++n) (void)commissioning_map(&drive);
  EXPECT_FALSE(m.pause);
}

// With the machine cool a level of 0.9 s is a quarter of what trips.
TEST_F(CommissioningStairs, ALevelIsNoOverload) {
  parameters.rated_current = raw(4.0, 20);
  use_parameters();
  commissioning.model.yd_q30 /= 4;  // with next to no ripple
  for (const auto& [seconds, most] : {std::pair{60.0, 14.0}, {10.0, 4.0 * std::sqrt(10.0 / 3.6)}, {1.0, 4.0}}) {
    parameters.overload_time = static_cast<std::int32_t>(1000.0 * seconds);
    use_parameters();
    begin();
    EXPECT_NEAR(level(13), most, 0.01 * most) << seconds;
  }
  parameters.overload_current = 0;
  use_parameters();
  begin();
  EXPECT_NEAR(level(13), 14.0, 1e-3);
}

// At rest the pairs wait for the period that makes the torque constant.
TEST_F(CommissioningStairs, ThePairsAtRestAreNotBesideTheTorqueConstant) {
  inside::window_count() = 2;
  inside::windows()[0] = inside::windows()[1] = {};
  inside::windows()[0].span_ticks = inside::windows()[1].span_ticks = 2500;
  inside::windows()[0].voltage_q19 = {raw(200.0, 19), 0};
  inside::windows()[1].voltage_q19 = {raw(-200.0, 19), 0};
  int expected = 0;
  for (const task_t task : {TASK_SPEED, TASK_JUDGE_FIRST, TASK_SLOT, TASK_RENEW, TASK_FIELD, TASK_JUDGE}) {
    inside::scheduled_task() = task;
    commissioning_add_still(&drive);
    expected += task == TASK_JUDGE ? 0 : 1;
    EXPECT_EQ(commissioning.unsaturated.count, expected) << task;
  }
}

// A train or a pause without a pair of opposite windows adds nothing to its sums.
TEST_F(CommissioningStairs, TheMapSumsPairsOnly) {
  for (const bool pair : {true, false}) {
    SetUp();
    map_t& m = commissioning.map;
    m.segment = 60;
    m.train = 1;
    m.tick = 55;
    inside::window_count() = pair ? 2 : 1;
    inside::windows()[0] = inside::windows()[1] = {};
    inside::windows()[0].span_ticks = inside::windows()[1].span_ticks = 2500;
    inside::windows()[0].voltage_q19 = {raw(200.0, 19), 0};
    inside::windows()[1].voltage_q19 = {raw(-200.0, 19), 0};
    (void)commissioning_map(&drive);
    EXPECT_EQ(m.group[0][3].tensor.count, pair ? 1 : 0);  // the mirrored train begins with a negative current
    m.pause = true;
    m.tick = 350;
    (void)commissioning_map(&drive);
    EXPECT_EQ(commissioning.unsaturated.count, pair ? 1 : 0);
  }
}

// No level above one without saliency, and half of the currents where fewer than two have it: twice at most. Until the
// background level has judged, the shaft is held.
TEST_F(CommissioningStairs, TheMapGoesNoFurtherThanTheSaliency) {
  map_t& m = commissioning.map;
  commissioning.tick = 0;
  (void)commissioning_map(&drive);
  commissioning.tick = 1;
  const auto complete = [&m](bool lost) {
    m.train = 16;
    m.tick = 701;
    m.lost = lost;
    for (map_group_t& g : m.group[m.level]) g.tensor.count = 8000;
    m.judge = true;
    EXPECT_FALSE(commissioning_map(&drive));
    EXPECT_EQ(m.train, 16) << "which waits";
    m.judge = false;
    const bool ended = commissioning_map(&drive);
    EXPECT_NE(m.pause, !ended && m.tick == 0 && m.train > 0);
    m.pause = true;
    return ended;
  };
  EXPECT_FALSE(complete(false));
  EXPECT_FALSE(complete(true));
  EXPECT_EQ(m.most_q20, parameters.current_limit / 2);
  EXPECT_EQ(m.level, 0);
  EXPECT_EQ(m.train, 0);
  EXPECT_EQ(m.tick, 0) << "in the pause that empties the sums";
  EXPECT_FALSE(complete(true));
  EXPECT_EQ(m.most_q20, parameters.current_limit / 4);
  EXPECT_FALSE(complete(false));
  EXPECT_FALSE(complete(false));
  EXPECT_TRUE(complete(true));
  EXPECT_EQ(m.levels, 2);
  EXPECT_EQ(m.most_q20, parameters.current_limit / 4);
}

// With half of the currents a first level that had a saliency is the second one, and its sums stay.
TEST_F(CommissioningStairs, TheLevelThatWasGoodIsKept) {
  map_t& m = commissioning.map;
  for (const int lost : {0, 1}) {
    m.most_q20 = parameters.current_limit;
    commissioning.tick = 0;
    (void)commissioning_map(&drive);
    commissioning.tick = 1;
    for (int level = 0; level < 4; ++level) {
      for (int k = 0; k < 4; ++k) m.group[level][k].tensor.count = m.group[level][k].current = 100 * level + k + 1;
    }
    m.level = static_cast<std::uint16_t>(lost);
    m.train = 16;
    m.tick = 701;
    m.lost = true;
    EXPECT_FALSE(commissioning_map(&drive));
    ASSERT_EQ(m.level, 0);
    ASSERT_EQ(m.most_q20, parameters.current_limit / 2);
    for (int n = 0; n < 16; ++n) (void)commissioning_map(&drive);
    for (int level = 0; level < 4; ++level) {
      for (int k = 0; k < 4; ++k) {
        const int expected = lost == 1 && level == 1 ? k + 1 : 0;
        EXPECT_EQ(m.group[level][k].tensor.count, expected) << lost << level << k;
        EXPECT_EQ(m.group[level][k].current, expected) << lost << level << k;
      }
    }
  }
}

// A level that has lost its saliency is left before it is complete; one that has not is gone on with.
TEST_F(CommissioningStairs, ALevelWithoutSaliencyIsLeftAtOnce) {
  map_t& m = commissioning.map;
  for (const bool lost : {false, true}) {
    commissioning.tick = 0;
    (void)commissioning_map(&drive);
    commissioning.tick = 1;
    m.level = 2;
    m.train = 16;
    m.tick = 701;
    m.lost = lost;
    for (map_group_t& g : m.group[2]) g.tensor.count = 200;
    EXPECT_EQ(commissioning_map(&drive), lost);
    EXPECT_EQ(m.levels, lost ? 2 : 4);
    EXPECT_EQ(m.train, lost ? 0 : 17);
  }
}

// The plan of the current is no steeper than half of the link drives, and a reversal has the time that this takes.
TEST_F(CommissioningStairs, ATrainIsAsSlowAsTheLinkIsLow) {
  map_t& m = commissioning.map;
  const auto begun = [&m](double millihenry) {
    commissioning.tick = 0;
    (void)commissioning_map(&drive);
    commissioning.tick = 1;
    inside::model().yq_q30 = raw(0.1 / millihenry, 30);
    m.tick = 701;
    (void)commissioning_map(&drive);
    return real(m.step_q20, 20);
  };
  const double link = real(inside::link_q16(), 16);
  EXPECT_NEAR(begun(7.8), 14.0 / 12.0, 1e-5);
  EXPECT_EQ(m.blank, 26);
  EXPECT_NEAR(begun(50.0), link / 2.0 * 0.1 / 50.0, 1e-3);
  EXPECT_NEAR(m.blank, 20.0 + 2.0 * 3.5 / (link * 0.001), 1.0);
}

TEST_F(CommissioningStairs, ResultsAreThereWhenItHasEnded) {
  commissioning_t& c = commissioning;
  commissioning_state.begin(&drive, DRIVE_READY);
  c.phase = COMMISSIONING_EVALUATE;
  c.evaluate = true;
  EXPECT_EQ(drive_commissioning_count(), 0);
  commissioning_service(&drive);
  EXPECT_EQ(drive_commissioning_outcome(), COMMISSIONING_PARTLY);
  ASSERT_EQ(drive_commissioning_count(), 24);
  EXPECT_NE(drive_commissioning_result(23)->id, 0);
  EXPECT_EQ(drive_commissioning_result(24), nullptr);
  commissioning_state.begin(&drive, DRIVE_READY);
  EXPECT_EQ(drive_commissioning_result(0), nullptr) << "until the next one begins";
}

// Where the rotor is pulled to the frame, up to the limit, whether it shows an axis or not.
TEST_F(CommissioningStairs, TheLevelsPullTheRotor) {
  for (const bool uniform : {false, true}) {
    commissioning.uniform = uniform;
    begin();
    for (const int k : {0, 6, 13}) EXPECT_NEAR(level(k), 14.0 * (0.4 + 0.6 / 13.0 * k), 1e-3) << k;
  }
  turns_at(6.0);  // by its nameplate; the windows say that there is no saliency
  begin();
  EXPECT_NEAR(level(13), 14.0, 1e-3) << "a rotor that follows needs no holding";
}

// With i_d > 0 the reluctance turns the torque's sign at lambda / (Lq - Ld): the levels end at half of that, and where
// this leaves no room they are below zero, as far as the magnets bear it. With no room there either there are none.
TEST_F(CommissioningStairs, TheReluctanceKeepsTheLevelsWhereTheShaftIsHeld) {
  for (const auto& [end, most] : {std::pair{40.0, 14.0}, {16.0, 8.0}, {6.0, -12.0}}) {
    turns_at(end);
    begin();
    EXPECT_NEAR(level(13), most, 0.01) << end;
    EXPECT_NEAR(level(0), std::copysign(std::max(0.4 * std::fabs(most), 2.4 * ripple()), most), 0.01) << end;
  }
  inside::config().values.weakening_limit = raw(9.0, 20);
  begin();
  EXPECT_NEAR(level(13), -9.0, 0.01);
  inside::config().values.weakening_limit = 0;
  begin();
  EXPECT_NEAR(level(13), 0.0, 1e-9) << "no room on either side";
}

// A line over less than a quarter of the current says little of its slope: where the other side leaves more, the levels
// are there.
TEST_F(CommissioningStairs, AShortLineIsLeftForALongerOne) {
  for (const auto& [share, most] : {std::pair{0.30, 1.0}, {0.32, -12.0}, {0.48, -12.0}}) {
    const double pulling = ripple() / share;
    turns_at(2.0 * pulling);
    begin();
    EXPECT_NEAR(level(13), most > 0.0 ? pulling : most, 0.01) << share;
  }
  inside::config().values.weakening_limit = raw(2.0 * ripple(), 20);
  begin();
  EXPECT_NEAR(level(13), ripple() / 0.48, 0.01) << "the other side has less";
}

// Beyond what the voltage of the resistance leaves of the shorter pulse a period has no two opposite windows.
TEST_F(CommissioningStairs, TheLevelsEndWhereThePulsesAreNoLongerOpposite) {
  const double limit = 10.0;
  const double share = real(commissioning.model.yd_q30, 30);  // T / L
  commissioning.model.rs_q24 = raw(3.0 / 8.0 * ripple() / share / limit, 24);
  begin();
  EXPECT_NEAR(level(13), limit, 0.01);
  // With a pulse p and R i on one phase the others' common part lasts p less 3/2 R i T / U, and that is longer.
  const double pulse = inside::config().modulator.pulse_ticks / 1e4;
  const double apart = 1.5 * real(commissioning.model.rs_q24, 24) * limit / real(inside::link_q16(), 16);
  EXPECT_NEAR(apart / (pulse - apart), 3.0 / 5.0, 0.01);
}

TEST_F(CommissioningStairs, TheBackgroundLevelJudgesALevelOfTheMap) {
  commissioning.map.lost = true;
  commissioning.map.judge = true;
  commissioning_service(&drive);
  EXPECT_FALSE(commissioning.map.judge);
  EXPECT_FALSE(commissioning.map.lost) << "what was not measured has lost nothing";
}

// A line is drawn over the upper eighth of the current at least, where no phase's current changes its sign; without
// that nothing is waited for, and what an earlier commissioning has summed up is none of this one.
TEST_F(CommissioningStairs, ALineNeedsTwiceTheRipple) {
  for (const auto& [share, least] : {std::pair{0.3, 0.72}, {0.45, 0.875}, {0.49, 0.875}, {0.51, 0.0}}) {
    SetUp();
    const double limit = real(parameters.current_limit, 20);
    inside::config().values.trip_current = raw(3.0 * limit, 20);
    commissioning.model.yd_q30 = raw(share * limit / ripple() * real(commissioning.model.yd_q30, 30), 30);
    stairs().level[0].periods = 2802;
    begin();
    if (least > 0.0) {
      EXPECT_NEAR(level(0), least * limit, 0.01 * limit) << share;
      EXPECT_NEAR(level(13), limit, 0.01 * limit) << share;
    } else {
      EXPECT_NEAR(level(13), 0.0, 1e-9);
      EXPECT_FALSE(staircase_solve(&stairs(), &commissioning.model).valid);
    }
  }
}

// Staircase and map alike: somewhat more than the ripple is left to the trip, and a quarter of the limit at the least.
TEST_F(CommissioningStairs, TheRippleDoesNotTrip) {
  for (const auto& [trip, most] : {std::pair{18.0, 14.0}, {12.0, 12.0 - 9.0 / 8.0 * ripple()}, {4.0, 3.5}}) {
    inside::config().values.trip_current = raw(trip, 20);
    begin();
    EXPECT_NEAR(level(13), most, 0.01) << trip;
    commissioning.tick = 0;
    (void)commissioning_map(&drive);
    EXPECT_NEAR(real(commissioning.map.most_q20, 20), most, 0.01) << trip;
  }
}

// Opposite along either axis; vectors that are alike in one of them are no pair.
TEST_F(CommissioningStairs, APairIsOppositeAlongBothAxes) {
  inside::window_count() = 2;
  estimator_window_t* const w = inside::windows();
  w[0] = w[1] = {};
  w[0].span_ticks = w[1].span_ticks = 2500;
  for (const auto& [a, b] : {std::pair{100.0, 150.0}, {0.0, 150.0}, {-100.0, 0.0}}) {
    for (const auto& [along, across] : {std::pair{-1.0, -1.0}, {-1.0, 1.0}, {1.0, -1.0}}) {
      w[0].voltage_q19 = raw_ab({a, b}, 19);
      w[1].voltage_q19 = raw_ab({along * a, across * b}, 19);
      const bool pair = (a == 0.0 || along < 0.0) && (b == 0.0 || across < 0.0);
      EXPECT_EQ(commissioning_has_pair(&drive), pair) << a << " " << b << " " << along << across;
    }
  }
}

}  // namespace
