// What the commissioning does with the drive in each of its phases but the map, and what it sums up: the shaft and the
// windows are the test's, so what comes out is known beforehand.

#include "tests/firmware/commissioning_phases.hpp"

#include <algorithm>

namespace {

using namespace stillspin::test;

// A second-order law of 60 rad/s with the load fed forward, up to a quarter of the largest current.
TEST_F(Phases, TheShaftIsHeldByASecondOrderLaw) {
  struct Case {
    double off, speed, load;
  };
  commissioning.tick = 0;
  (void)commissioning_align(&drive);
  for (const Case& c : {Case{0.2, 0.0, 0.0}, {0.0, 3.0, 0.0}, {0.0, 0.0, 200.0}, {-0.1, 2.0, -300.0}}) {
    inside::selected() = {bam(1.0), bpp(c.speed), accel_q8(c.load), 32767};
    commissioning.target_bam = bam(1.0 + c.off);
    commissioning_hold(&drive);
    const double accel = 3600.0 * c.off - 120.0 * c.speed + c.load;
    const double torque_constant = real(machine_torque_constant_q24(&inside::model(), 0), 24);
    EXPECT_NEAR(real(inside::reference_dq_q20().q, 20), accel / per_torque() / torque_constant, 2e-3) << c.off;
  }
  for (const double sign : {1.0, -1.0}) {
    inside::selected() = {0, 0, 0, 32767};
    commissioning.target_bam = bam(sign * 2.0);
    commissioning_hold(&drive);
    EXPECT_NEAR(real(inside::reference_dq_q20().q, 20), sign * limit_ / 4.0, 1e-5);
  }
}

// A radian asks for 3/8 of what the current limit accelerates with, where that is less.
TEST_F(Phases, AHeavyRotorIsHeldSofter) {
  for (const int heavier : {1, 2, 5}) {
    inside::model().accel_q12 = inside::config().nameplate.accel_q12 / heavier;
    inside::model().torque_per_accel_q24 = inside::config().nameplate.torque_per_accel_q24 * heavier;
    inside::selected() = {bam(1.0), 0, 0, 32767};
    commissioning.tick = 0;
    (void)commissioning_align(&drive);
    const double torque_constant = real(machine_torque_constant_q24(&inside::model(), 0), 24);
    const double stiffness = std::fmin(3600.0, 0.3755 * per_torque() * torque_constant * limit_);
    EXPECT_EQ(stiffness < 3600.0, heavier > 1);
    for (const double off : {0.1, 0.0}) {
      inside::selected() = {bam(1.0), bpp(off > 0.0 ? 0.0 : 2.0), 0, 32767};
      commissioning.target_bam = bam(1.0 + off);
      commissioning_hold(&drive);
      const double accel = off > 0.0 ? stiffness * off : -2.0 * std::sqrt(stiffness) * 2.0;
      EXPECT_NEAR(real(inside::reference_dq_q20().q, 20), accel / per_torque() / torque_constant, 5e-3) << heavier;
    }
  }
}

// Its rotor turns to where the current points: the frame is that of the target, and nothing is held.
TEST_F(Phases, AShaftThatShowsNoAxisFollowsTheCurrent) {
  commissioning.uniform = true;
  inside::selected() = {bam(1.0), bpp(5.0), accel_q8(200.0), 32767};
  commissioning.target_bam = bam(1.4);
  commissioning_hold(&drive);
  EXPECT_EQ(inside::reference_dq_q20().q, 0);
  estimator_input_t in{};
  const estimator_output_t in_use = commissioning_estimate(&drive, &inside::estimate(), &in);
  EXPECT_EQ(in_use.angle_bam, bam(1.4));
  EXPECT_EQ(in_use.speed_bpp, 0);
  EXPECT_EQ(in_use.load_accel_q8, 0);
}

// What swings about the current shows an EMF across it, and the current goes against that, up to a quarter of the
// limit.
TEST_F(Phases, ARotorThatFollowsTheCurrentIsBrakedAsItSwings) {
  commissioning.uniform = true;
  const double conductance = 16.0 * real(inside::model().yq_q30, 30);  // 16 T / L
  for (const double volts : {4.0, -2.0, 100.0}) {
    inside::reference_dq_q20().q = 0;
    inside::command_dq_q16() = {raw(3.0, 16), raw(volts, 16)};
    const double end = -std::min(conductance * volts, limit_ / 4.0);
    commissioning_hold(&drive);
    EXPECT_NEAR(real(inside::reference_dq_q20().q, 20), end / 64.0, 1e-4) << volts;
    for (int n = 0; n < 1000; ++n) commissioning_hold(&drive);
    EXPECT_NEAR(real(inside::reference_dq_q20().q, 20), end, 1e-3 * limit_) << volts;
  }
}

// The current that it follows turns by a quarter at least, so that it does not stay where it is pushed from both sides.
TEST_F(Phases, ARotorThatFollowsTheCurrentIsTakenAlong) {
  inside::start_found().uniform = true;
  for (const auto& [from, to] : {std::pair{0.0, 120.0}, {-80.0, 0.0}, {150.0, -120.0}}) {
    commissioning.tick = 0;
    inside::reference_dq_q20() = {0, 0};
    inside::selected().angle_bam = bam(from * kDegree);
    int n = 1;
    for (; !step(commissioning_align); ++n) ASSERT_LT(n, 20000);
    EXPECT_EQ(n, 12001);
    EXPECT_NEAR(wrapped(rad(commissioning.target_bam) - to * kDegree) / kDegree, 0.0, 1e-4) << from;
    EXPECT_EQ(inside::reference_dq_q20().d, parameters.current_limit / 2);
  }
}

// To the nearest sixth of a turn, 0.02 degrees in a period, and 600 ms in all.
TEST_F(Phases, TheShaftIsTakenToASixthOfATurn) {
  for (const auto& [from, to] : {std::pair{0.0, 0.0}, {29.0, 0.0}, {31.0, 60.0}, {-80.0, -60.0}, {179.0, 180.0}}) {
    commissioning.tick = 0;
    inside::selected().angle_bam = bam(from * kDegree);
    std::uint32_t last = bam(from * kDegree);
    int n = 1;
    for (; !step(commissioning_align); ++n) {
      const std::int32_t moved = angle_diff_bam(commissioning.target_bam, last);
      ASSERT_LE(std::fabs(rad(moved)), 0.0201 * kDegree);
      last = commissioning.target_bam;
      if (n == 100) {
        const double way = std::clamp(to - from, -2.0, 2.0);
        EXPECT_NEAR(wrapped(rad(last) - (from + way) * kDegree) / kDegree, 0.0, 0.01) << from;
      }
      ASSERT_LT(n, 10000);
    }
    EXPECT_EQ(n, 6001);
    EXPECT_NEAR(wrapped(rad(commissioning.target_bam) - to * kDegree) / kDegree, 0.0, 1e-4) << from;
  }
}

// Only opposite vectors make a pair: what is common to both is then not the link.
TEST_F(Phases, APairIsUnderOppositeVectors) {
  windows({2.0, 0.0}, 0.3, -0.2);
  ASSERT_TRUE(commissioning_has_pair(&drive));
  EXPECT_NEAR(real(commissioning_window(&drive, 0).residual_q20.d, 20), 0.3, 1e-4);
  EXPECT_NEAR(real(commissioning_window(&drive, 1).residual_q20.d, 20), -0.2, 1e-4);
  inside::window_count() = 3;
  EXPECT_FALSE(commissioning_has_pair(&drive));
  for (const auto& [volts, pair] : {std::pair{9.5, true}, {10.5, false}, {-9.5, true}, {-10.5, false}}) {
    windows({2.0, 0.0}, 0.0, 0.0);
    inside::windows()[1].voltage_q19.alpha += raw(volts, 19);
    EXPECT_EQ(commissioning_has_pair(&drive), pair) << volts;
    windows({2.0, 0.0}, 0.0, 0.0);
    inside::windows()[1].voltage_q19.beta += raw(volts, 19);
    EXPECT_EQ(commissioning_has_pair(&drive), pair) << volts;
  }
}

// Fourteen levels of i_d up to the limit, evenly spaced from where the ripple changes no current's sign on. Its sums
// have a third each of 0.84 s, from 60 ms after it was asked for on.
TEST_F(Phases, TheStaircaseSumsEachLevel) {
  const double ripple =
      kLink * 2.0 / 3.0 * real(inside::model().yd_q30, 30) * inside::config().modulator.pulse_ticks / 1e4;
  const auto level = [&](int index) {
    const double least = std::max(0.4 * limit_, 2.4 * ripple);
    return least + (limit_ - least) / 13.0 * index;
  };
  inside::command_dq_q16() = {raw(1.5, 16), raw(-0.3, 16)};
  inside::reference_dq_q20() = {0, 0};
  constexpr double kSag = 5e-4;  // V per tick: the link falls under the first vector and rises under the second
  int n = 0;
  std::int32_t last = 0;
  for (; n < 200000; ++n) {
    const double current = real(inside::reference_dq_q20().d, 20);
    inside::current_dq_q20() = inside::reference_dq_q20();
    windows({current, 0.0}, 0.05, -0.01);
    inside::link_end_q16()[0] = raw(kLink - kSag * (4350 - 1500), 16);
    inside::link_end_q16()[1] = raw(kLink - kSag * 3000 + kSag * (8550 - 5500), 16);
    if (step(commissioning_climb)) break;
    ASSERT_LE(std::abs(inside::reference_dq_q20().d - last), parameters.current_limit / 64) << n;
    last = inside::reference_dq_q20().d;
  }
  EXPECT_NEAR(n, 14 * 9006 + 601 + 64, 64);
  EXPECT_EQ(inside::reference_dq_q20().d, 0) << "the current is gone when it is over";
  ASSERT_EQ(commissioning.staircase.index, 14);
  for (int k = 0; k < 14; ++k) {
    const staircase_level_t& l = commissioning.staircase.level[k];
    ASSERT_EQ(l.periods, 8406 / 3) << k << ": the sums take turns";
    ASSERT_EQ(l.windows, 8406 / 3 * 2) << k;
    EXPECT_NEAR(real(l.current / l.periods, 20), level(k), 2e-3 * limit_) << k;
    EXPECT_EQ(l.command, std::int64_t{2802} * raw(1.5, 20)) << k;
    EXPECT_NEAR(real(l.residual / l.windows, 20), 0.02, 1e-4) << k;
    // one volt against each current: 1/3 (2 + 1 + 1) along d
    EXPECT_NEAR(real(l.factor / l.periods, 20), 4.0 / 3.0, 1e-3) << k;
    // Between the windows' middles the link differs by less than between their ends; two thirds of it are along d.
    const double middles = kSag * (3000 - (3100 - 1500) - (7300 - 5500));
    EXPECT_NEAR(2.0 * real(l.sag / 2802, 12) / kLink, middles * 2.0 / 3.0, 3e-4) << k;
    EXPECT_EQ(l.link_q16, raw(kLink, 16));
  }
}

TEST_F(Phases, ProgressIsTheSharesOfThePhases) {
  commissioning_t& c = commissioning;
  const auto progress = [&](commissioning_phase_t phase) {
    c.phase = phase;
    return drive_commissioning_progress();
  };
  EXPECT_EQ(progress(COMMISSIONING_IDLE), 0);
  EXPECT_EQ(progress(COMMISSIONING_ALIGN), 0);
  EXPECT_EQ(progress(COMMISSIONING_STAIRCASE), 8);
  c.staircase.index = 7;
  EXPECT_EQ(progress(COMMISSIONING_STAIRCASE), 8 + 82);
  c.spin.leg = 2;
  EXPECT_EQ(progress(COMMISSIONING_SPIN), 173 + 34);
  c.map.level = 1;
  EXPECT_EQ(progress(COMMISSIONING_MAP), 242 + 758 * 270 / 1000);  // the first level takes the longest
  c.map.group[1][MAP_GROUPS - 1].tensor.count = 2000;              // half of what the second level wants
  EXPECT_EQ(progress(COMMISSIONING_MAP), 242 + 758 * (270 + 315 / 2) / 1000);
  c.map.level = MAP_LEVELS;
  EXPECT_EQ(progress(COMMISSIONING_MAP), 1000);
  EXPECT_EQ(progress(COMMISSIONING_EVALUATE), 1000);
}

}  // namespace
