// One step of each slow adaptation, as its equation has it: what a run that converges does not show is how fast.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/deviation_information.h"
#include "estimators/flux_adaptation.h"
#include "estimators/inertia_match.h"
#include "estimators/inverse_inductance.h"
#include "estimators/sensor_match.h"
#include "estimators/stator_flux.h"
#include "estimators/synchronism.h"
#include "estimators/voltage_match.h"
#include "estimators/zvv.h"
}

namespace {

using namespace stillspin::test;

constexpr double kShare = 0.003;

regression_t regression(double spread, double along, double mirror, double curl) {
  regression_t r = {};
  r.spread_q8 = raw(spread, 8);
  r.along_q16 = raw(along, 16);
  r.mirror_q16 = raw(mirror, 16);
  r.curl_q16 = raw(curl, 16);
  r.information = 1 << 22;
  return r;
}

// Gains of 1 + g and 1 - g put Y0 g / sqrt(3) across dv.
TEST(OneStep, SensorMatch) {
  std::int32_t mismatch_q30 = raw(0.001, 30);
  const double mean = 0.0166, off = -0.004, spread = 40000.0;
  const regression_t r = regression(spread, 0.0, 0.0, off * mean / std::sqrt(3.0) * spread);
  sensor_match_step(&mismatch_q30, &r, q_invert(r.spread_q8), q_invert(raw(mean, 30)), raw(kShare, 30));
  EXPECT_NEAR(real(mismatch_q30, 30), 0.001 + kShare * off, 1e-8);
  regression_t blind = r;
  blind.information = 0;
  sensor_match_step(&mismatch_q30, &blind, q_invert(blind.spread_q8), q_invert(raw(mean, 30)), raw(kShare, 30));
  EXPECT_NEAR(real(mismatch_q30, 30), 0.001 + kShare * off, 1e-8);
}

TEST(OneStep, InverseInductance) {
  machine_model_t m = model_of(Motor{});
  const double spread = 40000.0;
  const regression_t r = regression(spread, 0.001 * spread, -0.0004 * spread, 0.0);
  inverse_inductance_step(&m, &r, q_invert(r.spread_q8), raw(0.02, 30));
  inverse_inductance_step(&m, &r, q_invert(r.spread_q8), raw(0.02, 30));
  EXPECT_NEAR(real(m.trim.mean_q30, 30), 2 * 0.02 * 0.001, 1e-8);
  EXPECT_NEAR(real(m.trim.half_q30, 30), 2 * 0.02 * -0.0004, 1e-8);
}

// The mean from three quarters to one and a half of what the parameters say, half the difference from a third to three
// times, but never so much that one of both were not positive.
TEST(OneStep, AdmittancesWithinTheirBounds) {
  const auto preset = [](const Motor& motor, double mean, double half) {
    machine_model_t m = model_of(motor);
    const machine_point_t& p = m.map.points[0];
    const Vector told = {real(p.ydd_q30 / 2 + p.yqq_q30 / 2, 30), real(p.ydd_q30 / 2 - p.yqq_q30 / 2, 30)};
    inverse_inductance_preset(&m, raw(mean * told.x, 30), raw(half * told.y, 30));
    return Vector{1.0 + real(m.trim.mean_q30, 30) / told.x, 1.0 + real(m.trim.half_q30, 30) / told.y};
  };
  EXPECT_NEAR(preset(Motor{}, 1.2, 0.9).x, 1.2, 1e-6);
  EXPECT_NEAR(preset(Motor{}, 1.2, 0.9).y, 0.9, 1e-6);
  EXPECT_NEAR(preset(Motor{}, 0.5, 0.2).x, 0.75, 1e-6);
  EXPECT_NEAR(preset(Motor{}, 0.5, 0.2).y, 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(preset(Motor{}, 2.0, 5.0).x, 1.5, 1e-6);
  EXPECT_NEAR(preset(Motor{}, 2.0, 5.0).y, 2.0, 1e-6);
  Motor salient;
  salient.lq = 5.0 * salient.ld;
  const Vector bound = preset(salient, 1.0, 3.0);
  EXPECT_NEAR(bound.y * (1.0 - 1.0 / 5.0), 0.875 * (1.0 + 1.0 / 5.0), 1e-5);  // seven eighths of the mean
}

// e = -dR i - w dpsi: each takes what it can have caused, of current in 4 A and speed in 1/50 rad per period, with a
// sixteenth of a unit squared that nothing has caused.
TEST(OneStep, VoltageMatch) {
  const machine_model_t told = model_of(Motor{});
  for (const auto& [amps, speed] : {std::pair{6.0, 0.004}, {-3.0, 0.03}, {2.0, -0.05}, {0.3, 0.005}}) {
    machine_model_t m = told;
    m.trim.psi_variance_q32 = 0;
    regression_t r = {};
    const double volts = 0.8;
    machine_model_follow(&m, raw(amps, 20));
    r.mean_q20.q = raw(volts * real(m.yq_q30, 30), 20);
    voltage_match_step(&m, &r, raw(speed, 30), raw(kShare, 30));
    const double i = amps / 4.0, w = speed * 50.0;
    const double still = i * i + 1.0 / 16.0;
    const double step = volts / (still + w * w) * kShare;
    EXPECT_NEAR(real(m.trim.rs_q24, 24), -step * still / (still + w * w) * i / 4.0, 2e-6) << amps;
    EXPECT_NEAR(real(m.trim.psi_q16, 16), -step * w * 50.0, 2e-3) << amps;
  }
}

// At speed the flux first learns as least squares do, a speed counting squared; the resistance waits. It begins at a
// third of the unit of speed, and ends where a step has eight times the slow share.
TEST(OneStep, VoltageMatchInHaste) {
  const machine_model_t told = model_of(Motor{});
  const auto step = [&](machine_model_t* m, double speed, double share) {
    regression_t r = {};
    machine_model_follow(m, raw(5.0, 20));
    r.mean_q20.q = raw(0.8 * real(m->yq_q30, 30), 20);
    voltage_match_step(m, &r, raw(speed, 30), raw(share, 30));
  };
  for (const double direction : {1.0, -1.0}) {
    machine_model_t m = told;
    m.trim.psi_variance_q32 = raw(0.09, 32);
    double psi = 0.0, variance = 0.09;
    for (int n = 0; n < 50; ++n) {
      const double speed = direction * (0.008 + 0.001 * n), w = 50.0 * speed;
      step(&m, speed, 1e-5);
      variance /= 1.0 + variance * w * w;
      psi -= 0.8 * w * variance * 50.0;
      ASSERT_NEAR(real(m.trim.psi_q16, 16), psi, 2e-4 * std::fabs(psi)) << n;
      ASSERT_NEAR(real(m.trim.psi_variance_q32, 32), variance, 1e-5 * variance) << n;
    }
    EXPECT_EQ(m.trim.rs_q24, 0);
  }
  for (const auto& [speed, share, hurries] :
       {std::tuple{0.0068, 1e-5, true}, {0.0065, 1e-5, false}, {0.02, 0.01124, true}, {0.02, 0.01126, false}}) {
    machine_model_t m = told;
    m.trim.psi_variance_q32 = raw(0.09, 32);
    step(&m, speed, share);
    EXPECT_EQ(m.trim.rs_q24 == 0, hurries) << speed << ", " << share;
  }
}

// As fast as a shaft may turn, a step takes over what is missing and no more.
TEST(OneStep, HasteAtFullSpeed) {
  machine_model_t m = model_of(Motor{});
  m.trim.psi_variance_q32 = raw(0.09, 32);
  regression_t r = {};
  machine_model_follow(&m, raw(5.0, 20));
  r.mean_q20.q = raw(0.8 * real(m.yq_q30, 30), 20);
  voltage_match_step(&m, &r, raw(1.9, 30), raw(1e-5, 30));
  EXPECT_NEAR(real(m.trim.psi_q16, 16), -0.8 / 1.9, 0.01 * 0.8 / 1.9);
  EXPECT_NEAR(real(m.trim.psi_variance_q32, 32), 0.09 / (1.0 + 0.09 * 95.0 * 95.0), 1e-8);
}

// From an eighth of the bound, the magnet's own flux, it finds back.
TEST(OneStep, AFluxBeyondItsBoundBeginsAnew) {
  const stator_flux_config_t c = {STATOR_FLUX_COMPENSATED, raw(0.002, 30), raw(0.5, 30)};
  const std::int32_t bound = raw(800.0, 16);
  for (const Vector flux : {Vector{799.0, 0.0}, {-799.0, 0.0}, {0.0, 799.0}, {0.0, -799.0}}) {
    stator_flux_t s = {};
    stator_flux_preset(&s, raw_ab(flux, 16));
    stator_flux_step(&s, &c, raw_ab(flux * 0.2, 16), 0, bound);
    EXPECT_EQ(s.flux_q16.alpha, 0);
    EXPECT_EQ(s.flux_q16.beta, 0);
    EXPECT_EQ(s.length_q16, 0);
    EXPECT_NEAR(real(s.compensation_q16, 16), 100.0, 0.01);
  }
}

// L_q moves to what saturation leaves of it, the magnet by its share of what is missing.
TEST(OneStep, FluxAdaptation) {
  const machine_model_t m = model_of(Motor{});
  flux_adaptation_config_t c = {raw(0.05, 24), bpp(200.0), raw(0.01, 24), raw(0.1, 30), raw(0.2, 30)};
  flux_machine_t f = {};
  flux_adaptation_t s = {};
  flux_adaptation_reset(&s);
  flux_machine_move(&f, &m, &s.shares);
  const Motor motor;
  const Vector i = {-1.0, 6.0};
  const Vector flux = {motor.ld * i.x + 0.9 * motor.flux, motor.lq * i.y};
  const flux_vectors_t v = flux_vectors(&f, raw_ab(flux * (1.0 / kPeriod), 16), raw_ab(i, 20));
  std::int32_t change = 0;
  ASSERT_TRUE(flux_adaptation_change_q24(&f, &v, raw_dq(i, 20), c.current_q24, &change));
  flux_adaptation_step(&s, &c, &m, &f, &v, raw_dq(i, 20), bpp(200.0));
  const double torque = 1.5 * motor.pole_pairs * (flux.x * i.y - flux.y * i.x);
  EXPECT_NEAR(real(s.shares.lq_q24, 24), 1.0 + c.inductance_q30 / 1073741824.0 * (1.0 / (1.0 + 0.05 * torque) - 1.0),
              1e-5);
  EXPECT_NEAR(real(s.shares.psi_q24, 24), 1.0 + c.magnet_q30 / 1073741824.0 * real(change, 24), 1e-6);
  // Slower, it says nothing of the magnet.
  flux_adaptation_t slow = {};
  flux_adaptation_reset(&slow);
  flux_adaptation_step(&slow, &c, &m, &f, &v, raw_dq(i, 20), bpp(199.0));
  EXPECT_EQ(slow.shares.psi_q24, 1 << 24);
}

// Judged after a quarter of a turn and not before; then after four times as much each time.
TEST(OneStep, InertiaIsJudgedByQuarterTurns) {
  for (const double turn : {0.24, 0.26}) {
    inertia_match_t s;
    inertia_match_reset(&s);
    s.phase = INERTIA_RUN_UP;
    s.next = INERTIA_SAME_Q24 / 4;
    s.before_q24 = INERTIA_SAME_Q24;
    inertia_seen_t in = {};
    in.reference_bpp = 1000000000;
    in.angle_bam = bam(turn * kTurn);
    s.gained_bpp = s.last_gained_bpp = bpp(turn * kTurn / 2.0 / 10.0 / kPeriod);  // half of it in these ten periods
    EXPECT_EQ(inertia_match_step(&s, &in, 10) != INERTIA_SAME_Q24, turn > 0.25) << turn;
    EXPECT_NEAR(real(s.ratio_q24, 24), turn > 0.25 ? 2.0 : 1.0, 1e-4) << turn;
    EXPECT_EQ(s.next, turn > 0.25 ? INERTIA_SAME_Q24 : INERTIA_SAME_Q24 / 4);
  }
}

// Within a sixteenth it stays; a run-up with too little torque says nothing.
TEST(OneStep, InertiaThatIsNearlyRightStays) {
  struct Case {
    double factor, least;
    bool changes;
  };
  for (const Case& c : {Case{1.05, 0.0, false},
                        {1.075, 0.0, true},
                        {0.95, 0.0, false},
                        {0.925, 0.0, true},
                        {2.0, 1.9, true},
                        {2.0, 2.1, false}}) {
    inertia_match_t s;
    inertia_match_reset(&s);
    s.phase = INERTIA_RUN_UP;
    s.next = INERTIA_SAME_Q24 / 4;
    inertia_seen_t in = {};
    in.reference_bpp = 1000000000;
    in.angle_bam = bam(0.4 * kTurn);
    s.gained_bpp = s.last_gained_bpp = bpp(0.4 * kTurn / c.factor / 10.0 / kPeriod);
    s.ms = 9;                                  // this is the tenth
    const double mean = s.gained_bpp / 100.0;  // bpp per period
    in.least_accel_q8 = raw(c.least / 2.0 * mean, 8);
    (void)inertia_match_step(&s, &in, 10);
    EXPECT_NEAR(real(s.ratio_q24, 24), c.changes ? c.factor : 1.0, 1e-3) << c.factor << ", " << c.least;
  }
}

// What is steady again must be the load of before within a quarter of the run-up's torque, or all is taken back.
TEST(OneStep, InertiaIsTakenBackWithTheLoad) {
  for (const double share : {0.24, 0.26, -0.24, -0.26}) {
    inertia_match_t s;
    inertia_match_reset(&s);
    s.phase = INERTIA_SETTLE;
    s.ratio_q24 = 2 * INERTIA_SAME_Q24;
    s.before_q24 = INERTIA_SAME_Q24;
    s.mean_q8 = 1000000;
    s.start_base_q8 = 300000;
    s.ms = s.quiet_ms = 200;
    inertia_seen_t in = {};
    in.still_bpp = 1000;
    s.base_q8 = in.torque_accel_q8 = static_cast<std::int32_t>(300000 + share * 1000000);
    const std::int32_t factor = inertia_match_step(&s, &in, 10);
    const bool same = std::fabs(share) < 0.25;
    EXPECT_EQ(factor, same ? INERTIA_SAME_Q24 : INERTIA_SAME_Q24 / 2) << share;
    EXPECT_EQ(s.ratio_q24, same ? 2 * INERTIA_SAME_Q24 : INERTIA_SAME_Q24) << share;
    EXPECT_EQ(s.phase, INERTIA_REST);
  }
}

// More than 8 units of information counts as less, all of it in proportion.
TEST(OneStep, InformationBeyondItsBoundShrinksAlike) {
  deviation_observer_config_t c = {};
  c.weight_q8 = 1 << 20;
  information_sums_t sums = {};
  sums.h_q15 = {3400, -5000};
  sums.e_q17 = {1300, 3000};
  sums.span_ticks = 1250;
  sums.a_q34 = std::int64_t{1} << 23;
  const dq_t h_s = {-20000000, 40000000};
  information_sums_t more = sums;
  sums.aa_q32 = std::int64_t{1} << 27;
  const information_t within = information_of(&sums, &c, h_s);
  ASSERT_LT(std::max(within.aa, within.ss), INFORMATION_MAX);
  // the same windows with so much weight that the angle's information is beyond
  c.weight_q8 *= 512;
  more.aa_q32 = sums.aa_q32;
  const information_t beyond = information_of(&more, &c, h_s);
  EXPECT_NEAR(std::max(beyond.aa, beyond.ss), INFORMATION_MAX, 16.0);
  const double share = static_cast<double>(beyond.ss) / within.ss;
  EXPECT_NEAR(beyond.aa, within.aa * share, 16.0 + 1e-4 * std::abs(beyond.aa));
  EXPECT_NEAR(beyond.as, within.as * share, 16.0 + 1e-4 * std::abs(beyond.as));
  EXPECT_NEAR(beyond.a, within.a * share, 16.0 + 1e-4 * std::abs(beyond.a));
  EXPECT_NEAR(beyond.s, within.s * share, 16.0 + 1e-4 * std::abs(beyond.s));
}

// An estimator that is preset goes on with the speed that it is given, and has seen nothing.
TEST(OneStep, PresetsTakeTheSpeedAlong) {
  zvv_t zvv = {};
  zvv_preset(&zvv, 0x12345678u, -70000, 0);
  EXPECT_EQ(zvv.angle_bam, 0x12345678u);
  EXPECT_EQ(zvv.speed_bpp, -70000);
  EXPECT_EQ(zvv.integral_q8bpp, -70000 * 256);
  avv_t avv = {};
  avv.regression.information = 77;
  avv.error_bam = 5;
  avv.observer.speed_remainder_q8 = 9;
  avv_preset(&avv, 0x12345678u, -70000, 40);
  EXPECT_EQ(avv.observer.angle_bam, 0x12345678u);
  EXPECT_EQ(avv.observer.speed_bpp, -70000);
  EXPECT_EQ(avv.observer.load_accel_q8, 40);
  EXPECT_EQ(avv.error_bam | avv.regression.information | avv.observer.speed_remainder_q8, 0);
}

TEST(OneStep, ResetsLeaveNothing) {
  synchronism_t s = {{1, 2}, 3, 4, 5, 6};
  synchronism_reset(&s);
  EXPECT_EQ(s.error_q16.d | s.error_q16.q | s.turned_q16 | s.emf_q16 | s.limit_q16 | s.debounce, 0);
}

}  // namespace
