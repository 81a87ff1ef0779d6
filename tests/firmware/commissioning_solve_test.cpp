// What the background level makes of the sums of a made-up machine: known values in, the same values out.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/commissioning_sums.hpp"

namespace {

using namespace stillspin::test;

double degrees(std::int32_t bam) { return bam * 180.0 / 2147483648.0; }

TEST(CommissioningTensor, FindsTheInductancesWhateverTheModelIs) {
  const machine_model_t m = nameplate();
  tensor_sums_t s;
  tensor_reset(&s);
  add_pairs(&s, m, {4.655e-3, 7.41e-3, 0.0}, 0.0, 0.0, 100);  // not a multiple of the three directions
  const map_values_t v = unsaturated_solve(&s, &m);
  ASSERT_TRUE(v.valid);
  EXPECT_NEAR(real(v.ldd_q20, 20), 4.655, 1e-3);  // mH; slopes have LSBs of 1e-6 A of 8 A
  EXPECT_NEAR(real(v.lqq_q20, 20), 7.41, 2e-3);
}

TEST(CommissioningTensor, TheAntisymmetricPartIsTheSensors) {
  const machine_model_t m = nameplate();
  const double mean = (kPeriod / 4.655e-3 + kPeriod / 7.41e-3) / 2.0;
  tensor_sums_t s;
  tensor_reset(&s);
  add_pairs(&s, m, {4.655e-3, 7.41e-3, 0.0}, 0.0, mean * 0.005 / std::sqrt(3.0), 99);
  EXPECT_NEAR(real(unsaturated_mismatch_q30(&s, &m), 30), 0.005, 2e-5);
}

TEST(CommissioningTensor, OneDirectionIsNotEnough) {
  const machine_model_t m = nameplate();
  tensor_sums_t s;
  tensor_reset(&s);
  tensor_axes_t a;
  EXPECT_FALSE(tensor_solve(&s, &m, &a)) << "nothing was added";
  deviation_t w[2] = {};
  tensor_add(&s, &w[0], &w[1]);
  EXPECT_FALSE(tensor_solve(&s, &m, &a)) << "no difference";
  w[0].voltage_q16.d = raw(200.0, 16);
  w[1].voltage_q16.d = -w[0].voltage_q16.d;
  tensor_add(&s, &w[0], &w[1]);
  EXPECT_FALSE(tensor_solve(&s, &m, &a));
}

// A machine that gives way in one direction has no inductances.
TEST(CommissioningTensor, AnAdmittanceBelowZeroIsNoMachine) {
  const machine_model_t m = nameplate();
  const Inductances odd = {4.655e-3, -20e-3, 0.0};
  tensor_sums_t s;
  tensor_reset(&s);
  add_pairs(&s, m, odd, 0.0, 0.0, 100);
  EXPECT_FALSE(unsaturated_solve(&s, &m).valid);
  map_group_t group[MAP_GROUPS] = {};
  for (int k = 0; k < 4; ++k) {
    add_pairs(&group[k].tensor, m, k == 2 ? odd : Inductances{4.655e-3, 5.9e-3, 0.0}, 0.0, 0.0, 60);
  }
  EXPECT_FALSE(map_solve(group, &m).valid);
  group[2] = group[0];
  EXPECT_TRUE(map_solve(group, &m).valid);
}

TEST(CommissioningMap, CrossSaturationInAFrameThatIsNotTheRotors) {
  const machine_model_t m = nameplate();
  const Inductances positive = {4.655e-3, 5.9e-3, 0.112e-3};
  const Inductances negative = {4.655e-3, 5.9e-3, -0.112e-3};
  map_group_t group[MAP_GROUPS] = {};
  // Where the predicted angle stands off the rotor: a constant for each kind of train falls out.
  const double frame[MAP_GROUPS] = {0.02, 0.02, -0.03, -0.03};
  for (int k = 0; k < 4; ++k) {
    add_pairs(&group[k].tensor, m, k % 2 == 0 ? positive : negative, frame[k], 0.0, 60);
    group[k].current = 60LL * raw(k % 2 == 0 ? 10.5 : -10.5, 20);
    group[k].position = 60LL * (k < 2 ? 50000000LL : -50000000LL);
  }
  const map_values_t v = map_solve(group, &m);
  ASSERT_TRUE(v.valid);
  EXPECT_NEAR(real(v.ldd_q20, 20), 4.655, 1e-3);
  EXPECT_NEAR(real(v.lqq_q20, 20), 5.9, 2e-3);
  EXPECT_NEAR(real(v.ldq_q20, 20), 0.112, 5e-4);
  EXPECT_NEAR(degrees(v.turn_bam), -std::atan2(2 * 0.112, 5.9 - 4.655) * 90.0 / kPi, 0.02);
  EXPECT_NEAR(degrees(v.apart_bam), 0.0, 0.01);
  EXPECT_TRUE(map_repeats(&v));
  EXPECT_NEAR(real(v.current_q20, 20), 10.5, 1e-4);
}

// A shaft that was moved in one kind of train only: the mean is half of it off, and both are as far from it.
TEST(CommissioningMap, TrainsThatDisagreeAreSeen) {
  const machine_model_t m = nameplate();
  for (const auto& [moved, repeats] : {std::pair{0.0065, true}, {0.0075, false}, {-0.0055, true}, {-0.0062, false}}) {
    map_group_t group[MAP_GROUPS] = {};
    for (int k = 0; k < 4; ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      add_pairs(&group[k].tensor, m, {4.655e-3, 5.9e-3, sign * 0.04e-3}, k < 2 ? sign * moved : 0.0, 0.0, 60);
    }
    const map_values_t v = map_solve(group, &m);
    ASSERT_TRUE(v.valid);
    // 32.1 mrad of turn, and half of what was moved more of it, or less: a tenth of that
    EXPECT_NEAR(std::abs(degrees(v.apart_bam)), std::abs(moved) * 90.0 / kPi, 0.01);
    EXPECT_EQ(map_repeats(&v), repeats) << moved;
  }
  map_values_t none{};
  none.apart_bam = 1193000;  // 0.1 degrees, where nothing turns
  EXPECT_TRUE(map_repeats(&none));
  none.apart_bam = -1194000;
  EXPECT_FALSE(map_repeats(&none));
}

TEST(CommissioningMap, ALevelThatWasMissedIsReferredToWhatWasMeant) {
  map_values_t zero{}, v{};
  zero.lqq_q20 = raw(7.4, 20);
  v.current_q20 = raw(3.4, 20);
  v.lqq_q20 = raw(7.06, 20);
  map_refer(&v, &zero, raw(3.5, 20));
  EXPECT_NEAR(real(v.lqq_q20, 20), 7.4 - 0.34 * 3.5 / 3.4, 1e-5);
}

TEST(CommissioningMap, SmoothingKeepsAnOddCubicAndRefusesWhatIsNone) {
  std::int32_t cubic[MAP_LEVELS], jagged[MAP_LEVELS];
  for (int k = 0; k < 4; ++k) {
    const double x = (k + 1) / 4.0;
    cubic[k] = raw(0.16 * x - 0.03 * x * x * x, 20);
    jagged[k] = raw(k % 2 == 0 ? 0.05 : -0.05, 20);
  }
  constexpr std::int32_t kSaliency = 2936013;  // 2.8 mH
  ASSERT_TRUE(map_smooth(cubic, kSaliency));
  for (int k = 0; k < 4; ++k) {
    const double x = (k + 1) / 4.0;
    EXPECT_NEAR(real(cubic[k], 20), 0.16 * x - 0.03 * x * x * x, 2e-5);
  }
  const std::int32_t first = jagged[0];
  EXPECT_FALSE(map_smooth(jagged, kSaliency));
  EXPECT_EQ(jagged[0], first) << "left as it was measured";
  for (std::int32_t& value : jagged) value /= 20;  // 0.0025 mH: nothing turns the axis, whatever the noise
  EXPECT_TRUE(map_smooth(jagged, kSaliency));
}

TEST(CommissioningStaircase, ResistanceDropAndEdgesComeApart) {
  const machine_model_t m = nameplate();
  const staircase_t s = climbed(m, 0.387, 0.08, -0.15);
  const staircase_values_t v = staircase_solve(&s, &m);
  ASSERT_TRUE(v.valid);
  EXPECT_NEAR(real(v.resistance_q24, 24), 0.387, 1e-5);
  EXPECT_NEAR(real(v.drop_error_q16, 16), 0.08, 5e-4);  // residuals have LSBs of 1e-6 A, 50 uV
  EXPECT_NEAR(real(v.edge_error_q16, 16), -0.15, 5e-4);
  EXPECT_NEAR(real(v.link_q16, 16), 300.0, 0.01);
  EXPECT_LT(real(v.command_rms_q16, 16), 1e-3);
}

// Within a tenth of the largest, whatever that is beside the saliency.
TEST(CommissioningMap, SmoothingForgivesATenthOfTheLargest) {
  for (const auto& [off, close] : {std::pair{0.015, true}, {0.10, false}}) {
    std::int32_t mutual[MAP_LEVELS];
    for (int k = 0; k < 4; ++k) mutual[k] = raw(0.04 * (k + 1) + (k == 1 ? off : 0.0), 20);
    EXPECT_EQ(map_smooth(mutual, raw(0.1, 20)), close) << off;
  }
}

// Both fits say how far the levels lie off them, the windows' beside the command.
TEST(CommissioningStaircase, LevelsThatLieOffAreNoLine) {
  const machine_model_t m = nameplate();
  staircase_t s = climbed(m, 0.387, 0.5, -1.2);
  staircase_values_t v = staircase_solve(&s, &m);
  EXPECT_LT(real(v.window_rms_q16, 16), 1e-3);
  const double off = 0.1;  // the same at both signs of a current: no line and no drop explains it
  const auto side = [off](int k) { return (k % 7) % 2 == 0 ? off : -off; };
  for (int k = 0; k < 14; ++k) s.level[k].residual -= 8400LL * raw(side(k) * real(m.yd_q30, 30), 20);
  v = staircase_solve(&s, &m);
  EXPECT_NEAR(real(v.window_rms_q16, 16), off, 1e-2 * off);
  EXPECT_LT(real(v.command_rms_q16, 16), 1e-2 * off);
  for (int k = 0; k < 14; ++k) s.level[k].command += 4200LL * raw(side(k), 20);
  v = staircase_solve(&s, &m);
  EXPECT_NEAR(real(v.command_rms_q16, 16), off, 1e-2 * off);
  EXPECT_LT(real(v.window_rms_q16, 16), 1e-2 * off) << "both scatter alike";
}

// A drop whose share goes with the current at every level cannot be told from a resistance.
TEST(CommissioningStaircase, LevelsThatDoNotTellDropFromResistanceGiveNeither) {
  const machine_model_t m = nameplate();
  staircase_t s = climbed(m, 0.387, 0.5, -1.2);
  for (staircase_level_t& l : s.level) l.factor = l.current;
  const staircase_values_t v = staircase_solve(&s, &m);
  EXPECT_FALSE(v.valid);
  EXPECT_EQ(v.resistance_q24, 0);
}

// A link that gives way in proportion to the current is no resistance of the machine: the mean misses it once and the
// windows twice, and what is taken for a drop is the same as without.
TEST(CommissioningStaircase, TheSagOfTheLinkIsNoResistance) {
  const machine_model_t m = nameplate();
  const double slope = 0.04;  // V per A, of one vector against the other
  staircase_t s = climbed(m, 0.387 + slope, 0.5, -1.2);
  for (staircase_level_t& l : s.level) {
    l.sag = -4200LL * raw(slope * 300.0 * real(l.current / 4200, 20), 12);
    l.residual -= l.windows * raw(slope * real(l.current / 4200, 20) * real(m.yd_q30, 30), 20);
  }
  const staircase_values_t v = staircase_solve(&s, &m);
  EXPECT_NEAR(real(v.resistance_q24, 24), 0.387, 1e-4);
  EXPECT_NEAR(real(v.drop_error_q16, 16), 0.5, 2e-3);
  EXPECT_NEAR(real(v.edge_error_q16, 16), -1.2, 2e-3);
}

// Drops that grow with the current like a resistance cannot be told from one.
TEST(CommissioningStaircase, ALineThatDropsFollowIsNotValid) {
  const machine_model_t m = nameplate();
  staircase_t s = climbed(m, 0.387, 0.08, -0.15);
  for (staircase_level_t& level : s.level) level.factor = level.current / 6;
  EXPECT_FALSE(staircase_solve(&s, &m).valid);
}

TEST(CommissioningStaircase, ALevelWithoutSamplesIsNotValid) {
  const machine_model_t m = nameplate();
  staircase_t s = climbed(m, 0.387, 0.0, 0.0);
  s.level[3].windows = 0;
  EXPECT_FALSE(staircase_solve(&s, &m).valid);
}

TEST(CommissioningSpin, FluxInertiaFrictionDespiteAnOffsetOfTheVoltage) {
  const spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
  const spin_values_t v = spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 4);
  ASSERT_TRUE(v.valid);
  EXPECT_NEAR(real(v.flux_q28, 28), 0.1552, 1e-5);
  EXPECT_NEAR(real(v.inertia_up_q24, 24), 0.00546, 5e-6);  // an LSB of 6e-8, the torque's of 1e-6
  EXPECT_NEAR(real(v.inertia_down_q24, 24), 0.00546, 5e-6);
  EXPECT_NEAR(real(v.friction_q24, 24), 0.003, 1e-5);
  // From one speed alone the offset counts in full: 0.3 V at 80 rad/s.
  EXPECT_NEAR(real(v.flux_low_q28, 28), 0.1552 + 0.3 / 80.0, 1e-4);
}

TEST(CommissioningSpin, FieldWeakeningIsNoFlux) {
  spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
  s.station[1].current_d = 5000LL * raw(-3.0, 20);
  s.station[1].voltage_q -= 5000LL * raw(0.0049 * 3.0 * 4 * 60.0, 16);
  const spin_values_t v = spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 4);
  EXPECT_NEAR(real(v.flux_q28, 28), 0.1552, 1e-5);
}

// The parameter's range: 0.5 kg m2, a twentieth of an ampere to accelerate the least.
TEST(CommissioningSpin, LargeAndSmallInertias) {
  for (const double inertia : {0.0001, 0.02, 0.1, 0.5}) {
    const spin_t s = spun(0.1552, inertia, 0.003, 0.387);
    const spin_values_t v = spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 4);
    EXPECT_NEAR(real(v.inertia_up_q24, 24), inertia, 0.001 * inertia + 1e-6);
    EXPECT_NEAR(real(v.inertia_down_q24, 24), inertia, 0.001 * inertia + 1e-6);
  }
}

// More than the flux may be, which is judged behind it.
TEST(CommissioningSpin, AMagnetTooStrongHasATorqueConstant) {
  const spin_t s = spun(2.5, 0.02, 0.003, 0.387, 20);
  const spin_values_t v = spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 20);
  EXPECT_NEAR(real(v.flux_q28, 28), 2.5, 1e-4);
  EXPECT_NEAR(real(v.inertia_up_q24, 24), 0.02, 2e-5);
  EXPECT_NEAR(real(v.inertia_down_q24, 24), 0.02, 2e-5);
}

TEST(CommissioningSpin, BothRampsAreNeeded) {
  for (int k = 0; k < 2; ++k) {
    spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
    s.ramp[k].periods = 0;
    EXPECT_FALSE(spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 4).valid);
  }
}

TEST(CommissioningSpin, AShaftThatDidNotTurnIsNotValid) {
  spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
  s.station[1].speed = s.station[0].speed;
  EXPECT_FALSE(spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 4).valid);
}

TEST(CommissioningSpin, EachStationIsNeeded) {
  for (int k = 0; k < 3; ++k) {
    spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
    s.station[k].periods = 0;
    EXPECT_FALSE(spin_solve(&s, raw(0.387, 24), raw(0.0049, 30), 4).valid) << k;
  }
}

// A report shows what was measured beside why it is not used: of what was not, that is nothing.
TEST(CommissioningSolve, WhatWasNotMeasuredIsZero) {
  const machine_model_t m = nameplate();
  const staircase_t no_stairs{};
  const staircase_values_t stairs = staircase_solve(&no_stairs, &m);
  EXPECT_FALSE(stairs.valid);
  EXPECT_EQ(stairs.resistance_q24 | stairs.drop_error_q16 | stairs.edge_error_q16 | stairs.link_q16, 0);
  EXPECT_EQ(stairs.command_rms_q16 | stairs.window_rms_q16, 0);
  const map_group_t no_groups[MAP_GROUPS] = {};
  for (const map_values_t& map : {unsaturated_solve(&no_groups[0].tensor, &m), map_solve(no_groups, &m)}) {
    EXPECT_FALSE(map.valid);
    EXPECT_EQ(map.ldd_q20 | map.lqq_q20 | map.ldq_q20 | map.turn_bam | map.share_q24 | map.current_q20, 0);
  }
  const spin_t no_spin{};
  const spin_values_t spin = spin_solve(&no_spin, raw(0.387, 24), raw(0.0049, 30), 4);
  EXPECT_FALSE(spin.valid);
  EXPECT_EQ(spin.flux_q28 | spin.flux_low_q28 | spin.friction_q24, 0);
  EXPECT_EQ(spin.inertia_up_q24 | spin.inertia_down_q24, 0);
  EXPECT_EQ(unsaturated_mismatch_q30(&no_groups[0].tensor, &m), 0);
}

// The turn that is not there without current; the motion that nobody has predicted is none of a point without it.
TEST(CommissioningSolve, APointWithoutCurrentHasNeitherTurnNorShare) {
  const machine_model_t m = nameplate();
  tensor_sums_t s;
  tensor_reset(&s);
  add_pairs(&s, m, {4.655e-3, 7.41e-3, 0.0}, 0.0, 0.0, 99);
  const map_values_t v = unsaturated_solve(&s, &m);
  ASSERT_TRUE(v.valid);
  EXPECT_EQ(v.ldq_q20 | v.turn_bam | v.share_q24 | v.current_q20, 0);
}

}  // namespace
