// What falls on which period of the millisecond, on a drive that the test has put where it wants it.

#include <vector>

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

class Schedule : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    make_ready();
    run_with(POSITION_OBSERVER);
  }
  /// In RUN with this source, at a known angle without current, at the end of a millisecond.
  static void run_with(std::int32_t source) {
    use_source(source);
    ASSERT_TRUE(drive_config_load(&inside::config()));
    inside::be_in(DRIVE_RUN);
    polarity_watch.open = false;
    inside::periods() = 100;
    inside::preset(0, 0);
    know(0.01);
    inside::current_dq_q20() = {0, 0};
    inside::model().iq_q20 = 0;
    inside::schedule() = {};
    inside::scheduled_period() = 9;
    inside::schedule().last = SLOT_OPERATING_POINT;
  }
  /// The observer knows its angle to `share` of 5 degrees, with nothing gathered.
  static void know(double share) {
    deviation_observer_t& o = inside::observer();
    o.p_aa = raw(32.0 * share, 20);
    o.gathered = {0, 0, 0, 0};
    o.load_is_new = false;
    o.is_sensitive = true;
  }
  static void leave_working_point() { inside::current_dq_q20().q = raw(0.13, 20); }

  /// The next periods.
  static std::vector<schedule_t> next(int count) {
    std::vector<schedule_t> all;
    for (int k = 0; k < count; ++k) {
      schedule_next(&drive, &inside::schedule());
      all.push_back(inside::schedule());
    }
    return all;
  }
};

TEST_F(Schedule, TurnsGoRoundAndEveryTaskHasItsPeriod) {
  const std::vector<schedule_t> all = next(50);
  constexpr task_t kTasks[] = {TASK_SPEED, TASK_JUDGE_FIRST, TASK_SLOT, TASK_RENEW, TASK_SLOT,
                               TASK_FIELD, TASK_JUDGE,       TASK_SLOT, TASK_RENEW, TASK_SLOT};
  int turn = 0;
  for (int k = 0; k < 50; ++k) {
    const schedule_t& s = all[static_cast<std::size_t>(k)];
    EXPECT_EQ(s.period, k % 10);
    EXPECT_EQ(s.task, kTasks[k % 10]);
    EXPECT_EQ(s.slot, (s.task == TASK_SLOT) ? turn++ % SCHEDULE_SLOTS : static_cast<int>(SCHEDULE_SLOTS)) << k;
    EXPECT_EQ(s.renews, s.task == TASK_RENEW) << k;
    EXPECT_EQ(s.judges, s.task == TASK_JUDGE || s.task == TASK_JUDGE_FIRST) << k;
    EXPECT_TRUE(s.turning && !s.held && !s.moves && !s.skips) << k;
  }
  EXPECT_EQ(turn, 20);
}

// A start has no judgements and no renewals: all periods are turns but those of the speed and of the field.
TEST_F(Schedule, BeforeTheShaftTurnsEveryPeriodIsATurnThatHasNoTask) {
  inside::be_in(DRIVE_START);
  know(1.1);
  int turn = 0;
  for (const schedule_t& s : next(40)) {
    const bool own = s.task == TASK_SPEED || s.task == TASK_FIELD;
    EXPECT_EQ(s.slot, own ? static_cast<int>(SCHEDULE_SLOTS) : turn++ % SCHEDULE_SLOTS);
    EXPECT_FALSE(s.turning || s.unsure || s.update_urgent || s.renews || s.judges || s.skips || s.exclusive);
  }
  EXPECT_EQ(turn, 32);
}

TEST_F(Schedule, ADecisionOfTheStartHasAPeriodWithoutATask) {
  for (int before = 0; before < 10; ++before) {
    SetUp();
    inside::be_in(DRIVE_START);
    leave_working_point();
    next(before);
    inside::wants_exclusive() = true;
    schedule_t s = next(1)[0];
    const bool own = s.task == TASK_SPEED || s.task == TASK_FIELD;  // then it waits
    EXPECT_NE(s.exclusive, own);
    if (own) s = next(1)[0];
    EXPECT_TRUE(s.exclusive && s.skips);
    EXPECT_EQ(s.slot, SCHEDULE_SLOTS);
    EXPECT_FALSE(s.moves || s.renews || s.judges);
    inside::wants_exclusive() = false;
    EXPECT_FALSE(next(1)[0].exclusive);
  }
}

TEST_F(Schedule, OnlyAStartDecides) {
  for (const drive_state_t state : {DRIVE_READY, DRIVE_RUN, DRIVE_STOP, DRIVE_COMMISSION}) {
    inside::wants_exclusive() = true;
    drive_enter(&drive, state);
    EXPECT_FALSE(next(1)[0].exclusive) << state;
  }
}

// As the alternating layout repeats after six periods, the regression has to see all of them.
TEST_F(Schedule, TheRegressionSeesEveryPlaceOfTheAlternatingLayout) {
  int seen[6] = {};
  const std::vector<schedule_t> all = next(600);
  for (int k = 0; k < 600; ++k) seen[k % 6] += all[static_cast<std::size_t>(k)].slot == SLOT_REGRESSION ? 1 : 0;
  for (const int count : seen) EXPECT_EQ(count, 8);
}

TEST_F(Schedule, WhatCannotWaitTakesThreeTurnsInARowAtMost) {
  for (const bool moved : {true, false}) {
    SetUp();
    if (moved) leave_working_point();
    if (!moved) inside::observer().gathered.periods = 7;  // a gain that gets old
    int given = 0, turns = 0;
    for (const schedule_t& s : next(40)) {
      if (s.task != TASK_SLOT) {
        EXPECT_EQ(s.slot, SCHEDULE_SLOTS);
        EXPECT_FALSE(s.moves);
        continue;
      }
      const bool gives_way = moved ? s.moves : s.renews;
      EXPECT_EQ(gives_way, s.slot == SCHEDULE_SLOTS);
      EXPECT_FALSE(moved ? s.renews : s.moves);
      ++(gives_way ? given : turns);
    }
    EXPECT_EQ(given, 12);
    EXPECT_EQ(turns, 4);
  }
}

TEST_F(Schedule, WorkingPointAndCovarianceTakeTurns) {
  leave_working_point();
  inside::observer().load_is_new = true;
  bool moved_last = false;
  int given = 0;
  for (const schedule_t& s : next(80)) {
    if (s.task != TASK_SLOT || s.slot != SCHEDULE_SLOTS) continue;
    EXPECT_NE(s.moves, s.renews);
    EXPECT_TRUE(given == 0 || s.moves != moved_last);
    ++given;
    moved_last = s.moves;
  }
  EXPECT_EQ(given, 24);
}

// An eighth of an ampere is near enough.
TEST_F(Schedule, AWorkingPointNearByCanWait) {
  for (const double off : {0.12, -0.12}) {
    inside::current_dq_q20().q = raw(off, 20);
    for (const schedule_t& s : next(10)) EXPECT_FALSE(s.moves);
  }
}

// It renews its covariance with every look at the windows, so that the longest tasks leave these out; nothing is
// judged.
TEST_F(Schedule, AnObserverThatDoesNotKnowItsAngleLooksWhereThereIsRoom) {
  know(1.1);
  leave_working_point();
  for (const schedule_t& s : next(40)) {
    EXPECT_TRUE(s.unsure && s.update_urgent);
    EXPECT_FALSE(s.judges);
    EXPECT_FALSE(s.moves) << "it renews anyway";
    EXPECT_EQ(s.skips, s.task == TASK_SPEED || s.task == TASK_FIELD);
  }
  // Known, but with much to learn: the same, and the synchronism is judged.
  know(0.9);
  inside::observer().gathered = {0, raw(1.0, 21), 0, 1};
  for (const schedule_t& s : next(10)) {
    EXPECT_TRUE(s.update_urgent && !s.unsure);
    const bool long_task = s.task == TASK_SPEED || s.task == TASK_FIELD;
    EXPECT_EQ(s.skips, long_task || s.judges);
    EXPECT_EQ(s.judges, s.task == TASK_JUDGE || s.task == TASK_JUDGE_FIRST);
  }
}

// A shaft that is caught has its field weakened before it counts as one that turns: the windows wait for that.
TEST_F(Schedule, BesideTheFieldOfACaughtShaftTheWindowsAreLeftOut) {
  inside::be_in(DRIVE_START);
  for (const bool caught : {true, false}) {
    inside::is_caught() = caught;
    for (const schedule_t& s : next(20)) {
      EXPECT_FALSE(s.turning);
      EXPECT_EQ(s.skips, caught && s.task == TASK_FIELD);
    }
  }
}

// Its first look of all is not beside the model's slots.
TEST_F(Schedule, AnObserverThatIsNewLeavesTheModelItsSlots) {
  know(1.1);
  inside::observer().is_sensitive = false;
  bool seen = false;
  for (const schedule_t& s : next(40)) {
    if (s.slot != SLOT_LOOK && s.slot != SLOT_OPERATING_POINT) continue;
    EXPECT_TRUE(s.skips);
    seen = true;
  }
  EXPECT_TRUE(seen);
}

TEST_F(Schedule, NothingIsJudgedInTheFirstMillisecond) {
  inside::periods() = 9;
  for (const schedule_t& s : next(10)) {
    EXPECT_FALSE(s.judges);
    EXPECT_TRUE(s.update_urgent && !s.unsure) << "how much its windows will tell is not known yet";
    EXPECT_NE(s.skips, s.renews);
  }
  inside::periods() = 10;
  EXPECT_TRUE(next(2).back().judges);
}

TEST_F(Schedule, AHeldShaftMovesItsWorkingPointWithEveryTurn) {
  brake_release_hold.left = 1000;
  inside::observer().load_is_new = true;
  for (const schedule_t& s : next(40)) {
    EXPECT_TRUE(s.held);
    EXPECT_EQ(s.slot, SCHEDULE_SLOTS);
    EXPECT_EQ(s.moves, s.task == TASK_SLOT || s.task == TASK_JUDGE_FIRST);
    EXPECT_EQ(s.renews, s.task == TASK_RENEW);
    EXPECT_EQ(s.judges, s.task == TASK_JUDGE);
  }
}

// Only where it runs does the deviation observer want anything.
TEST_F(Schedule, SourcesWithoutTheObserverDoNotWaitForIt) {
  for (std::int32_t source = POSITION_ENCODER; source <= POSITION_FLUX_ACTIVE; ++source) {
    if (!has_source(source)) continue;
    for (const bool alone : {false, true}) {
      run_with(source);
      know(1.1);
      inside::blend_region() = alone ? BLEND_HIGH : BLEND_LOW;
      inside::blend_share_q15() = alone ? 0 : 32767;
      const bool has =
          source == POSITION_OBSERVER || source == POSITION_OBSERVER_AVV || (source >= POSITION_FLUX_CONV && !alone);
      for (const schedule_t& s : next(10)) {
        EXPECT_EQ(s.unsure, has) << source << alone;
        EXPECT_EQ(s.judges, !has && (s.task == TASK_JUDGE || s.task == TASK_JUDGE_FIRST)) << source;
      }
    }
  }
}

// Where observer and flux are both at work the observer leaves its windows out beside the two other long tasks.
TEST_F(Schedule, BesideTheFluxLongTasksHaveTheirPeriodWithoutWindows) {
  NEEDS("sources/flux");
  const struct {
    std::int32_t source;
    blend_region_t region;
    double share;
    bool skips;
  } cases[] = {{POSITION_FLUX_CONV, BLEND_LOW, 1.0, false},
               {POSITION_FLUX_CONV, BLEND_BOTH, 0.5, true},
               {POSITION_FLUX_CONV, BLEND_HIGH, 0.0, false},
               {POSITION_OBSERVER_AVV, BLEND_BOTH, 0.5, false},
               {POSITION_ENCODER, BLEND_BOTH, 0.5, false}};
  for (const auto& c : cases) {
    run_with(c.source);
    inside::blend_region() = c.region;
    inside::blend_share_q15() = static_cast<std::int32_t>(32767.0 * c.share);
    for (const schedule_t& s : next(20)) {
      EXPECT_EQ(s.skips, c.skips && (s.task == TASK_SPEED || s.task == TASK_FIELD)) << c.source << c.region << s.period;
    }
  }
}

}  // namespace
