// What the background level makes of the sums of a made-up machine: known values in, the same values out.

#include <gtest/gtest.h>

#include <cmath>

extern "C" {
#include "firmware/commissioning/solve.h"
}

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPeriod = 1e-4;

std::int32_t fixed(double x, int q) { return static_cast<std::int32_t>(std::lround(std::ldexp(x, q))); }
double real(std::int64_t x, int q) { return std::ldexp(static_cast<double>(x), -q); }
double degrees(std::int32_t bam) { return bam * 180.0 / 2147483648.0; }

machine_model_t nameplate() {
  machine_parameters_t p{};
  p.rs_q24 = fixed(0.355, 24);
  p.ld_q30 = fixed(4.9e-3, 30);
  p.lq_q30 = fixed(7.8e-3, 30);
  p.flux_q28 = fixed(0.16, 28);
  p.inertia_q24 = fixed(0.00455, 24);
  p.pole_pairs = 4;
  p.period_us = 100;
  machine_model_t m;
  EXPECT_TRUE(machine_model_init(&m, &p));
  return m;
}

// Incremental inductances, H, seen in a frame that lies `frame` radians ahead of the rotor.
struct Inductances {
  double dd, qq, dq;
};

// Adds pairs of opposite windows, 200 V along the three phases in turn, with the sensors' mismatch g as slopes see it.
void add_pairs(tensor_sums_t* s, const machine_model_t& m, const Inductances& l, double frame, double across,
               int count) {
  const double det = l.dd * l.qq - l.dq * l.dq;
  const double y_dd = kPeriod * l.qq / det, y_qq = kPeriod * l.dd / det, y_dq = -kPeriod * l.dq / det;
  const double c = std::cos(frame), sn = std::sin(frame);
  for (int k = 0; k < count; ++k) {
    const double angle = k * 2.0 * kPi / 3.0 + 0.3;
    const double v_d = 200.0 * std::cos(angle), v_q = 200.0 * std::sin(angle);
    // into the rotor's frame, the machine, and back
    const double r_d = c * v_d - sn * v_q, r_q = sn * v_d + c * v_q;
    const double i_d = y_dd * r_d + y_dq * r_q, i_q = y_dq * r_d + y_qq * r_q;
    const double s_d = c * i_d + sn * i_q - across * v_q, s_q = -sn * i_d + c * i_q + across * v_d;
    deviation_t w[2] = {};
    for (int n = 0; n < 2; ++n) {
      const double sign = n == 0 ? 1.0 : -1.0;
      w[n].voltage_q16 = {fixed(sign * v_d, 16), fixed(sign * v_q, 16)};
      w[n].residual_q20 = {fixed(sign * (s_d - real(m.yd_q30, 30) * v_d), 20),
                           fixed(sign * (s_q - real(m.yq_q30, 30) * v_q), 20)};
    }
    tensor_add(s, &w[0], &w[1]);
  }
}

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
  w[0].voltage_q16.d = fixed(200.0, 16);
  w[1].voltage_q16.d = -w[0].voltage_q16.d;
  tensor_add(&s, &w[0], &w[1]);
  EXPECT_FALSE(tensor_solve(&s, &m, &a));
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
    group[k].current = 60LL * fixed(k % 2 == 0 ? 10.5 : -10.5, 20);
    group[k].position = 60LL * (k < 2 ? 50000000LL : -50000000LL);
  }
  const map_values_t v = map_solve(group, &m);
  ASSERT_TRUE(v.valid);
  EXPECT_NEAR(real(v.ldd_q20, 20), 4.655, 1e-3);
  EXPECT_NEAR(real(v.lqq_q20, 20), 5.9, 2e-3);
  EXPECT_NEAR(real(v.ldq_q20, 20), 0.112, 5e-4);
  EXPECT_NEAR(degrees(v.turn_bam), -std::atan2(2 * 0.112, 5.9 - 4.655) * 90.0 / kPi, 0.02);
  EXPECT_NEAR(real(v.current_q20, 20), 10.5, 1e-4);
}

TEST(CommissioningMap, ALevelThatWasMissedIsReferredToWhatWasMeant) {
  map_values_t zero{}, v{};
  zero.lqq_q20 = fixed(7.4, 20);
  v.current_q20 = fixed(3.4, 20);
  v.lqq_q20 = fixed(7.06, 20);
  map_refer(&v, &zero, fixed(3.5, 20));
  EXPECT_NEAR(real(v.lqq_q20, 20), 7.4 - 0.34 * 3.5 / 3.4, 1e-5);
}

TEST(CommissioningMap, SmoothingKeepsAnOddCubicAndRefusesWhatIsNone) {
  std::int32_t cubic[MAP_LEVELS], jagged[MAP_LEVELS];
  for (int k = 0; k < 4; ++k) {
    const double x = (k + 1) / 4.0;
    cubic[k] = fixed(0.16 * x - 0.03 * x * x * x, 20);
    jagged[k] = fixed(k % 2 == 0 ? 0.05 : -0.05, 20);
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

staircase_t climbed(const machine_model_t& m, double resistance, double drop_error, double edge_error) {
  staircase_t s{};
  for (int k = 0; k < 14; ++k) {
    const double sign = k < 7 ? 1.0 : -1.0, f = sign * 4.0 / 3.0;
    const double i = sign * (5.6 + 1.4 * (k % 7));
    staircase_level_t& l = s.level[k];
    l.periods = 4200;
    l.windows = 8400;
    l.current = 4200LL * fixed(i, 20);
    l.factor = 4200LL * fixed(f, 20);
    l.command = 4200LL * fixed(resistance * i + (drop_error + edge_error) * f, 20);
    l.window_current = 8400LL * fixed(i, 20);
    l.window_factor = 8400LL * fixed(f, 20);
    const double missing = (resistance - real(m.rs_q24, 24)) * i + drop_error * f;
    l.residual = 8400LL * fixed(-missing * real(m.yd_q30, 30), 20);
    l.link_q16 = fixed(300.0, 16);
  }
  return s;
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

TEST(CommissioningStaircase, ALevelWithoutSamplesIsNotValid) {
  const machine_model_t m = nameplate();
  staircase_t s = climbed(m, 0.387, 0.0, 0.0);
  s.level[3].windows = 0;
  EXPECT_FALSE(staircase_solve(&s, &m).valid);
}

// Sums of a spin of a machine with these values, between two speeds in rad/s (mechanical).
spin_t spun(double flux, double inertia, double friction, double resistance) {
  constexpr int kPairs = 4;
  const double bpp = 4294967296.0 * kPeriod * kPairs / (2.0 * kPi);  // per rad/s mechanical
  const double kt = 1.5 * kPairs * flux, offset = 0.3;
  const double speed[3] = {20.0, 60.0, 20.0};
  spin_t s{};
  for (int k = 0; k < 3; ++k) {
    const double current = friction * speed[k] / kt;
    s.station[k].periods = 5000;
    s.station[k].speed = 5000LL * std::llround(speed[k] * bpp);
    s.station[k].current_q = 5000LL * fixed(current, 20);
    s.station[k].voltage_q = 5000LL * fixed(flux * kPairs * speed[k] + resistance * current + offset, 16);
  }
  for (int k = 0; k < 2; ++k) {
    const double change = speed[k + 1] - speed[k];
    const double current = (inertia * change / (5000 * kPeriod) + friction * 40.0) / kt;
    s.ramp[k].periods = 5000;
    s.ramp[k].speed = 5000LL * std::llround(40.0 * bpp);
    s.ramp[k].current_q = 5000LL * fixed(current, 20);
  }
  return s;
}

TEST(CommissioningSpin, FluxInertiaFrictionDespiteAnOffsetOfTheVoltage) {
  const spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
  const spin_values_t v = spin_solve(&s, fixed(0.387, 24), fixed(0.0049, 30), 4);
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
  s.station[1].current_d = 5000LL * fixed(-3.0, 20);
  s.station[1].voltage_q -= 5000LL * fixed(0.0049 * 3.0 * 4 * 60.0, 16);
  const spin_values_t v = spin_solve(&s, fixed(0.387, 24), fixed(0.0049, 30), 4);
  EXPECT_NEAR(real(v.flux_q28, 28), 0.1552, 1e-5);
}

TEST(CommissioningSpin, AShaftThatDidNotTurnIsNotValid) {
  spin_t s = spun(0.1552, 0.00546, 0.003, 0.387);
  s.station[1].speed = s.station[0].speed;
  EXPECT_FALSE(spin_solve(&s, fixed(0.387, 24), fixed(0.0049, 30), 4).valid);
}

}  // namespace
