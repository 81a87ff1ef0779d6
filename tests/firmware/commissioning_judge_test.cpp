// What is used of what was measured: a machine whose sums are all right, and each thing that may be wrong with them.

#include "tests/firmware/commissioning_judge.hpp"

#include <vector>

namespace {

using namespace stillspin::test;

TEST_F(CommissioningJudge, AMachineThatFitsIsUsedAsAWhole) {
  commissioning_report_t report;
  commissioning_judge(&c, &report);
  ASSERT_EQ(commissioning_use(&report), COMMISSIONING_DONE);
  EXPECT_NEAR(real(parameters.stator_resistance, 24), 0.352, 1e-4);
  EXPECT_NEAR(real(parameters.device_drop, 16), 0.95 + 0.08, 1e-3);
  EXPECT_NEAR(real(parameters.inductance_q, 20), 7.41, 3e-3);
  EXPECT_NEAR(real(parameters.lqq_4, 16), 100.0 * 5.81 / 7.41, 0.1);
  EXPECT_NEAR(real(parameters.ldq_4, 20), 0.16, 1e-3);
  EXPECT_EQ(parameters.map_known, 1);
  EXPECT_NEAR(real(parameters.magnet_flux, 28), 0.1552, 1e-5);
  EXPECT_NEAR(real(parameters.inertia, 24), 0.00546, 1e-5);
  EXPECT_NEAR(real(parameters.friction, 24), 0.003, 1e-5);
}

// What shows no axis has one inductance and no map, and is to be turned by a vector from now on.
TEST_F(CommissioningJudge, AMachineWithoutSaliencyIsUsedWithoutAMap) {
  c.uniform = true;
  unsaturated({6.0e-3, 6.4e-3, 0.0});
  c.map.group[3][0].position = 1LL << 40;  // of an earlier one
  const parameters_t before = parameters;
  commissioning_report_t report;
  commissioning_judge(&c, &report);
  ASSERT_EQ(commissioning_use(&report), COMMISSIONING_DONE);
  EXPECT_EQ(report.count, 10);
  EXPECT_NEAR(real(parameters.inductance_d, 20), 2.0 / (1.0 / 6.0 + 1.0 / 6.4), 3e-3);
  EXPECT_EQ(parameters.inductance_q, parameters.inductance_d);
  EXPECT_EQ(parameters.start_method, 1);
  EXPECT_EQ(parameters.lqq_4, before.lqq_4);
  EXPECT_EQ(parameters.map_known, 0);
  EXPECT_NEAR(real(parameters.magnet_flux, 28), 0.1552, 1e-5);
  EXPECT_NEAR(real(parameters.inertia, 24), 0.00546, 1e-5);
}

// What the edges lose is split between drop and delay; with 2 us of dead time a delay ends at 0.4.
TEST_F(CommissioningJudge, ADelayThatLeavesNoDeadTimeIsRefusedWithItsDrop) {
  const parameters_t nameplate_parameters = parameters;
  for (const auto& [edge, fits] : {std::pair{0.27, true}, {0.33, false}}) {
    parameters = nameplate_parameters;
    c.staircase = climbed(c.model, 0.387, 0.08, edge);
    commissioning_report_t report;
    commissioning_judge(&c, &report);
    const parameters_t before = parameters;
    EXPECT_EQ(commissioning_use(&report), fits ? COMMISSIONING_DONE : COMMISSIONING_PARTLY) << edge;
    EXPECT_EQ(report.list[1].verdict, fits ? VERDICT_USED : VERDICT_DEPENDS);
    EXPECT_EQ(report.list[2].verdict, fits ? VERDICT_USED : VERDICT_RANGE);
    EXPECT_EQ(report.list[0].verdict, VERDICT_USED);
    EXPECT_NE(parameters.stator_resistance, before.stator_resistance);
    EXPECT_EQ(parameters.device_drop == before.device_drop, !fits);
    EXPECT_EQ(parameters.turn_on_delay == before.turn_on_delay, !fits);
  }
}

// A flux that is good in itself, with an EMF at the speed limit that the link must not bear: then none is used.
TEST_F(CommissioningJudge, WhatDoesNotFitTogetherIsNotUsedAtAll) {
  const parameters_t before = parameters;
  c.spin = spun(0.25, 0.00546, 0.003, 0.387);
  commissioning_report_t report;
  commissioning_judge(&c, &report);
  for (int k = 0; k < report.count; ++k) ASSERT_EQ(report.list[k].verdict, VERDICT_USED) << report.list[k].id;
  --report.count;  // the last one is of another commissioning
  EXPECT_EQ(commissioning_use(&report), COMMISSIONING_PARTLY);
  EXPECT_EQ(report.list[report.count].verdict, VERDICT_USED) << "behind its end";
  for (int k = 0; k < report.count; ++k) {
    EXPECT_EQ(report.list[k].verdict, VERDICT_DEPENDS) << report.list[k].id;
    EXPECT_EQ(parameter_get(report.list[k].id), report.list[k].before) << report.list[k].id;
  }
  EXPECT_EQ(parameters.stator_resistance, before.stator_resistance);
  EXPECT_EQ(parameters.friction, before.friction);
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

TEST_F(CommissioningJudge, AResistanceIsWithinThreeTimesTheNameplates) {
  for (const auto& [ohms, good] : {std::pair{0.9, true}, {1.05, false}, {0.15, true}, {0.13, false}}) {
    c.staircase = climbed(c.model, ohms, 0.08, -0.15);
    EXPECT_EQ(verdict("stator_resistance"), good ? VERDICT_USED : VERDICT_NAMEPLATE) << ohms;
  }
}

// The commands say how straight the line is, the windows how quiet the drop.
TEST_F(CommissioningJudge, ALevelOffTheLineSpoilsWhatItBelongsTo) {
  c.staircase.level[4].command += 4200LL * raw(1.5, 20);
  EXPECT_EQ(verdict("stator_resistance"), VERDICT_SPREAD);
  c.staircase = climbed(c.model, 0.387, 0.08, -0.15);
  c.staircase.level[4].residual -= 8400LL * raw(1.5 * real(c.model.yd_q30, 30), 20);
  EXPECT_EQ(verdict("stator_resistance"), VERDICT_USED);
  EXPECT_EQ(verdict("device_drop"), VERDICT_SPREAD);
  EXPECT_EQ(verdict("turn_on_delay"), VERDICT_SPREAD) << "which rests on it";
}

// A line is a line although the shaft lay where a phase was without current.
TEST_F(CommissioningJudge, AShaftThatMovedGivesNoStaircase) {
  for (const auto& [factor, verdict_then] : {std::pair{1.05, VERDICT_USED}, {0.95, VERDICT_SPREAD}}) {
    SetUp();
    c.staircase.level[3].factor = 4200LL * raw(factor, 20);
    EXPECT_EQ(verdict("stator_resistance"), verdict_then) << factor;
    EXPECT_EQ(verdict("device_drop"), verdict_then) << factor;
  }
}

TEST_F(CommissioningJudge, DropsAndEdgesAreNearTheNameplates) {
  for (const auto& [volts, good] : {std::pair{1.4, true}, {1.6, false}}) {
    c.staircase = climbed(c.model, 0.387, volts, -0.15);
    EXPECT_EQ(verdict("device_drop"), good ? VERDICT_USED : VERDICT_NAMEPLATE) << volts;
  }
  for (const auto& [microseconds, good] : {std::pair{0.9, true}, {1.1, false}}) {
    c.staircase = climbed(c.model, 0.387, 0.08, microseconds * 3.0);  // 300 V for 1 us of 100 us
    EXPECT_EQ(verdict("turn_on_delay"), good ? VERDICT_USED : VERDICT_NAMEPLATE) << microseconds;
  }
}

// One that is not near the nameplate's says nothing good of the other one and of the map.
TEST_F(CommissioningJudge, InductancesAreUsedTogether) {
  unsaturated({2.4e-3, 7.41e-3, 0.0});
  EXPECT_EQ(verdict("inductance_d"), VERDICT_NAMEPLATE);
  EXPECT_EQ(verdict("inductance_q"), VERDICT_DEPENDS);
  EXPECT_EQ(verdict("lqq_1"), VERDICT_DEPENDS);
}

TEST_F(CommissioningJudge, AFrictionThatDrivesIsNone) {
  c.spin = spun(0.1552, 0.00546, -0.001, 0.387);
  EXPECT_EQ(verdict("inertia"), VERDICT_USED);
  EXPECT_EQ(verdict("friction"), VERDICT_NOT_PHYSICAL);
}

// From a twentieth of the nameplate's to twenty times it.
TEST_F(CommissioningJudge, AnInertiaIsWithinTwentyTimesTheNameplates) {
  for (const auto& [times, good] : {std::pair{19.6, true}, {20.4, false}, {1.0 / 19.6, true}, {1.0 / 20.4, false}}) {
    SetUp();
    c.spin = spun(0.1552, times * real(parameters.inertia, 24), 0.003, 0.387);
    EXPECT_EQ(verdict("inertia"), good ? VERDICT_USED : VERDICT_NAMEPLATE) << times;
  }
}

// Flux over inertia for the trains of the map: what the spin says, where that may be.
TEST_F(CommissioningJudge, TheMotionIsTheSpinsOrTheNameplates) {
  const auto taken = [this](const spin_t& spin) {
    c.spin = spin;
    commissioning_solve_motion(&c);
    const bool same = c.torque_q24 == c.model.torque_q24 && c.accel_q12 == c.model.accel_q12;
    return !same;
  };
  EXPECT_TRUE(taken(spun(0.1552, 0.00546, 0.003, 0.387)));
  EXPECT_NEAR(1.0 * c.torque_q24 / c.model.torque_q24, 0.1552 / 0.16, 3e-4);
  EXPECT_NEAR(1.0 * c.accel_q12 / c.model.accel_q12, 0.00455 / 0.00546, 1e-3);
  EXPECT_FALSE(taken(spun(0.33, 0.00546, 0.003, 0.387))) << "more than twice the flux";
  EXPECT_FALSE(taken(spun(-0.16, 0.00546, 0.003, 0.387)));
  EXPECT_FALSE(taken(spun(0.1552, 0.1, 0.003, 0.387))) << "more than twenty times the inertia";
  EXPECT_FALSE(taken(spun(0.1552, -0.005, 0.003, 0.387)));
  spin_t none = spun(0.1552, 0.00546, 0.003, 0.387);
  none.station[1].periods = 0;
  EXPECT_FALSE(taken(none));
}

// Percent, what was taken off meanwhile and what is seen beyond it.
TEST_F(CommissioningJudge, TheSensorsMismatchIsPercent) {
  c.mismatch_q30 = raw(0.012, 30);
  commissioning_report_t report;
  commissioning_judge(&c, &report);
  (void)commissioning_use(&report);
  EXPECT_NEAR(real(parameters.sensor_mismatch, 16), 1.2, 5e-3);
}

// How far the trains moved the shaft says of flux over inertia what the spin must bear out within a quarter.
TEST_F(CommissioningJudge, TheTrainsMustBearTheInertiaOut) {
  const double predicted = 50000000.0 / 4294967296.0 * kTurn;
  for (const auto& [share, verdict_then] : {std::pair{0.32, VERDICT_USED},
                                            {0.35, VERDICT_INCONSISTENT},
                                            {-0.19, VERDICT_USED},
                                            {-0.21, VERDICT_INCONSISTENT}}) {
    for (int k = 0; k < 4; ++k) {
      map_group_t& g = c.map.group[3][k];
      tensor_reset(&g.tensor);
      const Inductances l = saturated(4);
      const double off = (k < 2 ? 1.0 : -1.0) * share * predicted;  // the axis is ahead of the predicted frame
      add_pairs(&g.tensor, c.model, {l.dd, l.qq, k % 2 == 0 ? l.dq : -l.dq}, -off, 0.0, 60);
      constexpr std::int64_t kPositions[] = {70000000, 30000000, -20000000, -80000000};  // their mean is what counts
      g.position = 60 * kPositions[k];
    }
    EXPECT_NEAR(real(map_solve(c.map.group[3], &c.model).share_q24, 24), share, 1e-3);
    EXPECT_EQ(verdict("inertia"), verdict_then) << share;
  }
}

// Both ramps within a fifth; flux from one speed alone within a tenth.
TEST_F(CommissioningJudge, TheSpinMustAgreeWithItself) {
  for (const auto& [more, agrees] : {std::pair{1.18, true}, {1.23, false}, {0.82, true}, {0.77, false}}) {
    SetUp();
    c.spin.ramp[1] = spun(0.1552, 0.00546 * more, 0.003, 0.387).ramp[1];
    EXPECT_EQ(verdict("inertia") == VERDICT_USED, agrees) << more;
  }
  for (const auto& [volts, agrees] : {std::pair{1.1, true}, {1.4, false}, {-1.1, true}, {-1.4, false}}) {
    SetUp();  // a tenth of 12.4 V at the low speed, of which 0.3 are there already
    for (spin_sums_t& s : c.spin.station) s.voltage_q += 5000LL * raw(volts - 0.3, 16);
    EXPECT_EQ(verdict("magnet_flux") == VERDICT_USED, agrees) << volts;
  }
}

// Currents that are measured wrong spoil everything else.
TEST_F(CommissioningJudge, AMismatchThatNoSensorHasSpoilsEverything) {
  c.mismatch_q30 = raw(0.4, 30);
  commissioning_report_t report;
  commissioning_judge(&c, &report);
  int refused = 0;
  for (int k = 0; k < report.count; ++k) {
    if (report.list[k].verdict == VERDICT_RANGE) ++refused;
    EXPECT_TRUE(report.list[k].verdict == VERDICT_DEPENDS || report.list[k].verdict == VERDICT_RANGE) << k;
  }
  EXPECT_EQ(refused, 1) << "the mismatch itself";
}

}  // namespace
