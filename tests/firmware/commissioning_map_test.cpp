// The last phase of a commissioning that moves the shaft: the map of the inductances, its trains and what they sum.

#include <algorithm>

#include "tests/firmware/commissioning_phases.hpp"

namespace {

using namespace stillspin::test;

// The map: trains of torque current that put the shaft back, their mirror images, and pauses; at four levels. The shaft
// turns as the torque that was commanded makes it.
struct Train {
  std::vector<double> current;  // reference of i_q in each period, A
  double farthest = 0.0;        // of the predicted way, rad
  double end = 0.0;             // of that way
};

TEST_F(Phases, TheMapsTrainsPutTheShaftBack) {
  const map_t& m = commissioning.map;
  inside::selected().angle_bam = bam(0.5);
  std::vector<Train> trains;
  std::vector<std::int32_t> feeds, references;
  std::vector<int> pauses(1, 0), stills;
  std::size_t length = 0;
  for (int n = 0; m.level == 0; ++n) {
    ASSERT_LT(n, 400000);
    if (!m.pause) length = static_cast<std::size_t>(m.segment);
    const bool paused = n == 0 || m.pause;
    const std::int32_t still = commissioning.unsaturated.count;
    const std::uint32_t held = commissioning.target_bam;
    if (n > 0) inside::selected().angle_bam = held;  // the shaft is where it is held
    inside::current_dq_q20() = {0, inside::reference_dq_q20().q};
    windows({0.0, real(inside::reference_dq_q20().q, 20)}, 0.0, 0.0);
    ASSERT_FALSE(step(commissioning_map));
    commissioning.map.judge = false;  // the background level has seen a saliency
    if (paused) {
      ++pauses.back();
      EXPECT_EQ(commissioning.predicting, !m.pause);
      if (n > 0 && pauses.back() <= 300 && trains.size() % 2 == 0) {
        EXPECT_NEAR(rad(angle_diff_bam(commissioning.target_bam, held)), 45.0 * kDegree / 300.0, 1e-6);
      } else if (n > 0) {
        EXPECT_EQ(commissioning.target_bam, held);
      }
      if (m.pause) continue;
      stills.push_back(commissioning.unsaturated.count);
      trains.emplace_back();
      continue;
    }
    EXPECT_EQ(commissioning.unsaturated.count, still);
    Train& t = trains.back();
    t.current.push_back(real(inside::reference_dq_q20().q, 20));
    t.farthest = std::max(t.farthest, std::fabs(rad(m.position_bam)));
    if (trains.size() == 1) {
      feeds.push_back(inside::feed_forward_q16());
      references.push_back(inside::reference_dq_q20().q);
    }
    if (m.pause) {
      t.end = rad(m.position_bam);
      // The ramps of the current leave 6 / n of the way for a segment of n periods; the mirrored train takes it back.
      EXPECT_NEAR(std::fabs(t.end), 6.0 / m.segment * t.farthest, 0.15 * std::fabs(t.end)) << trains.size();
      if (trains.size() > 1) {
        EXPECT_NEAR(t.end, -trains[trains.size() - 2].end, 1e-4 * t.farthest) << trains.size();
      }
      EXPECT_NEAR(t.current.back(), 0.0, 1e-5);
      pauses.push_back(0);
    }
  }
  // Three settled quarters of a train: - + + - first, then + - - +.
  const double level = limit_ / 4.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double sign = k == 0 ? -1.0 : 1.0;
    const double signs[] = {sign, -sign, -sign, sign};
    for (std::size_t part = 0; part < 4; ++part) {
      EXPECT_NEAR(trains[k].current[(part + 1) * length - 1], signs[part] * level, 1e-5) << k << ", " << part;
    }
  }
  // A slope of the whole current in twelve periods, whose voltage goes ahead of it by two.
  for (std::size_t n = 1; n < references.size(); ++n) {
    EXPECT_LE(std::abs(references[n] - references[n - 1]), parameters.current_limit / 12);
    const double volts = n + 2 < references.size()
                             ? real(references[n + 2] - references[n + 1], 20) / real(inside::model().yq_q30, 30)
                             : 0.0;
    EXPECT_NEAR(real(feeds[n], 16), volts, 1e-3) << n;
  }
  // Held for 40 ms, moved on for 30 before every second train; the last 20 are the point without current.
  for (std::size_t k = 0; k < trains.size(); ++k) {
    EXPECT_EQ(pauses[k], 402 + (k % 2 == 0 ? 300 : 0)) << k << ": a train begins in a period of its own";
    EXPECT_EQ(stills[k], 200 * static_cast<int>(k + 1)) << k;
  }
}

// As many periods of each sign in each kind of train as a level wants, over whole rounds of eight places, without those
// in which the current settles.
TEST_F(Phases, TheMapSumsItsGroups) {
  const map_t& m = commissioning.map;
  int trains[4] = {}, segments[4] = {};
  int asked = 0;
  for (int n = 0; !step(commissioning_map); ++n) {
    ASSERT_LT(n, 2000000);
    if (commissioning.map.judge) ++asked;
    commissioning.map.judge = false;
    inside::selected().angle_bam = commissioning.target_bam;
    if (m.level < 4) trains[m.level] = m.train, segments[m.level] = m.segment;
    inside::current_dq_q20() = {0, inside::reference_dq_q20().q};
    windows({0.0, real(inside::reference_dq_q20().q, 20)}, 0.0, 0.0);
  }
  EXPECT_EQ(asked, (trains[0] + trains[1] + trains[2] + trains[3]) / 16) << "the background level, after each round";
  for (int level = 0; level < 4; ++level) {
    // A reversal takes twice the level at a twelfth of the limit a period, and 20 periods to settle.
    const int blank = 6 * (level + 1) + 20;
    const int length = segments[level];
    EXPECT_GE(length, blank + 14) << level;
    EXPECT_EQ(trains[level] % 16, 0) << level;
    for (int group = 0; group < 4; ++group) {
      const map_group_t& g = m.group[level][group];
      // The signs are + - - +: the second of two equal segments need not settle.
      const bool outer = group == 0 || group == 3;
      const int periods = outer ? 2 * (length - blank) : 2 * length - blank;
      EXPECT_EQ(g.tensor.count, trains[level] / 2 * periods) << level << ", " << group;
      EXPECT_GE(g.tensor.count, 8000 / (level + 1)) << level;
      const double sign = group % 2 == 0 ? 1.0 : -1.0;
      EXPECT_NEAR(real(g.current / g.tensor.count, 20), sign * limit_ * (level + 1) / 4.0, 1e-3) << level << group;
      // What a train does to the shaft goes the way of its first current, and the mirrored one the other.
      EXPECT_EQ(g.position > 0, group < 2) << level << ", " << group;
      EXPECT_NEAR(static_cast<double>(g.position), -static_cast<double>(m.group[level][3 - group].position),
                  1e-3 * std::fabs(static_cast<double>(g.position)))
          << level << ", " << group;
    }
  }
}

// A twelfth of the limit a period, half of what the link drives through Lq, or what saturation leaves of that: at least
// a quarter, for a slow train takes the shaft far.
TEST_F(Phases, ATrainsCurrentChangesNoFasterThanSaturationLeaves) {
  map_t& m = commissioning.map;
  for (const double slope : {2.0, 0.5, 0.0}) {
    commissioning.tick = 0;
    ASSERT_FALSE(step(commissioning_map));
    EXPECT_EQ(m.slope_q20, INT32_MAX) << "a map begins without";
    m.slope_q20 = raw(slope, 20);
    for (int n = 0; m.pause; ++n) {
      ASSERT_LT(n, 2000);
      inside::selected().angle_bam = commissioning.target_bam;
      windows({0.0, 0.0}, 0.0, 0.0);
      ASSERT_FALSE(step(commissioning_map));
    }
    const std::int32_t most_q20 = parameters.current_limit / 12;
    EXPECT_EQ(m.step_q20, std::clamp(raw(slope, 20), most_q20 / 4, most_q20)) << slope;
    EXPECT_GE(m.segment, m.blank + 14) << slope;
  }
}

// At a quarter of the limit's levels there is nothing left to halve.
TEST_F(Phases, AMapThatFindsNoSaliencyEndsAtAQuarterOfTheLimit) {
  map_t& m = commissioning.map;
  ASSERT_FALSE(step(commissioning_map));
  m.most_q20 = parameters.current_limit;
  const auto lose = [&] {
    m.lost = m.pause = true;
    m.judge = false;
    m.tick = 2000;  // behind any pause
    return step(commissioning_map);
  };
  for (const int share : {2, 4}) {
    ASSERT_FALSE(lose());
    EXPECT_EQ(m.most_q20, parameters.current_limit / share);
    EXPECT_FALSE(m.lost);
  }
  EXPECT_TRUE(lose());
  EXPECT_EQ(m.most_q20, parameters.current_limit / 4);
  EXPECT_EQ(m.levels, 0);
}

// A segment is as long as a constant torque takes for six degrees: accel n^2, within what is short and long.
TEST_F(Phases, ASegmentTakesTheShaftSixDegreesOn) {
  const map_t& m = commissioning.map;
  for (const auto& [inertia, length] : {std::pair{1.0, 0}, {0.2, 40}, {100.0, 90}}) {
    commissioning.tick = 0;
    inside::model() = inside::config().nameplate;
    inside::model().accel_q12 = static_cast<std::int32_t>(inside::model().accel_q12 / inertia);
    while (commissioning.tick == 0 || m.pause) (void)step(commissioning_map);
    const double accel = real(machine_torque_constant_q24(&inside::model(), 0), 24) * limit_ / 4.0 * per_torque();
    const double periods = std::sqrt(6.0 * kDegree / accel) / kPeriod;
    EXPECT_NEAR(m.segment, length == 0 ? std::clamp(periods, 40.0, 90.0) : length, 1.0) << inertia;
  }
}

// A level is complete when the group that is filled last is, after whole rounds of places; or after so many trains that
// the pairs of windows will not come.
TEST_F(Phases, ALevelWantsItsLastGroup) {
  map_t& m = commissioning.map;
  for (const bool few : {false, true}) {
    for (const int trains : {15, 16, 608}) {
      m = {};
      commissioning.tick = 1;
      m.group[0][3].tensor.count = few ? 7999 : 8000;
      m.train = static_cast<std::uint16_t>(trains);
      m.tick = 1000;
      m.speed_q8 = m.position_bam = 1234;  // of the last train
      m.pause = true;
      ASSERT_FALSE(step(commissioning_map));
      EXPECT_EQ(m.level, trains == 608 || (trains == 16 && !few) ? 1 : 0) << few << ", " << trains;
      EXPECT_FALSE(m.pause);
      EXPECT_EQ(m.speed_q8 | m.position_bam | m.tick, 0);
    }
  }
}

}  // namespace
