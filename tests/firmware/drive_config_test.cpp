// From parameters to constants: defaults, what is refused, and thousands of random sets.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "sim_host/bench/texts.hpp"
#include "tests/control/quantities.hpp"
#include "tests/firmware/edition.hpp"
#include "tests/firmware/inside.hpp"

extern "C" {
#include "estimators/zvv.h"
#include "firmware/config/config.h"
#include "firmware/config/rules.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"
#include "firmware/sources/encoder/encoder.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/sources/paper/paper.h"
}

namespace {

using namespace stillspin::test;

std::uint16_t id_of(const std::string& name) {
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    if (name == stillspin::bench::text_of(parameter_name(parameter_info(k)))) return parameter_info(k)->id;
  }
  ADD_FAILURE() << "no parameter " << name;
  return 0;
}

// In the user's unit, rounded to the parameter's format.
void set(const std::string& name, double value) {
  const std::uint16_t id = id_of(name);
  for (std::uint16_t k = 0; k < parameter_count(); ++k) {
    const parameter_info_t* const info = parameter_info(k);
    if (info->id == id) {
      ASSERT_EQ(parameter_set(id, raw(value, info->q)), SET_OK) << name << " = " << value;
    }
  }
}

class DriveConfig : public testing::Test {
 protected:
  void SetUp() override { drive_reset(); }
  void TearDown() override { drive_reset(); }
};

TEST_F(DriveConfig, DefaultsAreValidAndMotorAs) {
  EXPECT_TRUE(inside::config_valid());
  EXPECT_TRUE(inside::speed_ready());
  const drive_config_t& c = inside::config();
  const Motor m;
  // a decimal parameter is right to half an LSB of its Q format; the tolerances are a few of those, relative
  EXPECT_NEAR(real(c.nameplate.ld_q30, 30), m.ld, 1e-8);
  EXPECT_NEAR(real(c.nameplate.lq_q30, 30), m.lq, 1e-8);
  EXPECT_NEAR(real(c.nameplate.flux_q28, 28), m.flux, 1e-8);
  EXPECT_NEAR(real(c.nameplate.rs_q24, 24), 0.32 + 0.035, 1e-6);  // with the devices
  EXPECT_EQ(c.bpp_per_rpm_q8, 4 * 1832519L);
  const double bpp_per_rpm = std::ldexp(4.0 / 60.0 * kPeriod, 32);
  EXPECT_NEAR(real(c.bpp_per_rpm_q8, 8) / bpp_per_rpm, 1.0, 1e-6);
  EXPECT_NEAR(real(c.rpm_per_bpp_q40, 40) * bpp_per_rpm, 1.0, 1e-6);
  EXPECT_NEAR(c.blend.low_bpp / (60.0 * bpp_per_rpm), 1.0, 1e-5);
  EXPECT_NEAR(c.blend.high_bpp / (100.0 * bpp_per_rpm), 1.0, 1e-5);
  EXPECT_NEAR(c.ramp_step_bpp / (3.0 * bpp_per_rpm), 1.0, 1e-4);  // 3000 rpm/s in a millisecond
  EXPECT_EQ(c.modulator.pulse_ticks, 4200);
  EXPECT_EQ(c.modulator.extended.window_min_ticks, 1800);
  EXPECT_EQ(c.modulator.extended.window_max_ticks, 3000);
  EXPECT_EQ(c.modulator.sampling.settle_ticks, 1050);
  EXPECT_EQ(c.dead_time.turn_on_ticks, 230);
  EXPECT_EQ(c.dead_time.turn_off_ticks, 60);
  EXPECT_NEAR(real(c.slopes.amps_per_code_q30, 30), 20.0 / 2048.0, 1e-9);
  EXPECT_NEAR(real(c.volts_per_code_q16, 16), 450.0 / 4096.0, 1.0 / 65536.0);
  EXPECT_NEAR(real(c.avv.bandwidth_long_q30, 30), 200.0 * kPeriod, 1e-8);
  EXPECT_NEAR(real(c.avv.bandwidth_short_q30, 30), 100.0 * kPeriod, 1e-8);
  EXPECT_NEAR(real(c.observer.weight_q8, 8), 100.0 / 3.0, 0.01);  // 100 mA
  EXPECT_NEAR(real(c.observer.limit_q19, 19), 19.2, 0.01);
  EXPECT_NEAR(real(c.adapt_share_q30, 30), SCHEDULE_SLOTS * kPeriod / 150e-3, 1e-8);
  const double newton_metres =
      m.inertia / m.pole_pairs * kTurn / std::ldexp(kPeriod * kPeriod, 32);  // per bpp a period
  EXPECT_NEAR(real(c.nameplate.torque_per_accel_q24, 24) / (256.0 * newton_metres), 1.0, 1e-3);
  // torque per speed: B times mechanical rad/s per bpp
  EXPECT_NEAR(real(c.friction_per_bpp_q40, 40) / (m.friction / m.pole_pairs * kTurn / std::ldexp(kPeriod, 32)), 1.0,
              1e-3);
}

TEST_F(DriveConfig, DefaultsOfThePaperAreMotorAs) {
  NEEDS("sources/paper");
  EXPECT_NEAR(real(paper_config.kp_q30, 30), 11.0 * kPeriod, 1e-8);
  EXPECT_NEAR(real(paper_config.ki_q40, 40) / (1100.0 * kPeriod * kPeriod), 1.0, 1e-4);
}

// Refused, and the configuration in use is left as it was.
void expect_refused() {
  drive_config_t c = inside::config();
  c.ramp_step_bpp = 12345;
  drive_config_t before;
  std::memcpy(&before, &c, sizeof c);
  EXPECT_FALSE(drive_config_load(&c));
  EXPECT_EQ(std::memcmp(&before, &c, sizeof c), 0);
}

// Two windows do for the observer where it has vectors with the mean voltage between them; the paper wants three.
TEST_F(DriveConfig, AsManyWindowsAsWhoLooksAtThemWants) {
  const struct {
    std::int32_t source, excitation;
    int windows;
  } cases[] = {{POSITION_OBSERVER, 2, 3}, {POSITION_OBSERVER, 3, 2}, {POSITION_OBSERVER, 5, 3}, {POSITION_PAPER, 3, 3}};
  for (const auto& k : cases) {
    if (position_sources[k.source] == nullptr) continue;
    parameters.position_source = k.source;
    if (k.source == POSITION_PAPER) parameters.id_low_speed = raw(-1.0, 20);
    parameters.excitation = k.excitation;
    drive_config_t c = inside::config();
    EXPECT_TRUE(drive_config_load(&c));
    EXPECT_EQ(c.modulator.sampling.windows, k.windows) << k.source << k.excitation;
  }
}

TEST_F(DriveConfig, InconsistentBlend) {
  set("blend_low", 100.0);
  set("blend_high", 100.0);
  expect_refused();
  set("blend_high", 99.0);
  expect_refused();
  set("blend_high", 101.0);
  EXPECT_TRUE(drive_config_load(&inside::config()));
}

TEST_F(DriveConfig, InductanceAcrossBelowTheOneAlong) {
  set("inductance_q", 4.8);
  expect_refused();
  set("inductance_q", 4.9);  // a surface-magnet machine is allowed
  EXPECT_TRUE(drive_config_load(&inside::config()));
}

TEST_F(DriveConfig, WindowLimitsTheWrongWayRound) {
  set("window_minimum", 25.0);
  set("window_maximum", 24.0);
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
  set("window_maximum", 25.0);
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
}

// What the estimators make of a machine has to fit their formats at every point of its map, not at no current alone.
TEST_F(DriveConfig, AMapWithTooLittleInductanceIsRefused) {
  set("inductance_d", 0.2);
  set("inductance_q", 0.4);
  EXPECT_TRUE(drive_config_load(&inside::config()));
  set("ldd_3", 75.0);  // T/L of 0.67 A per V
  expect_refused();
}

TEST_F(DriveConfig, AnAxisThatTurnsTooFarIsRefused) {
  set("inductance_d", 0.9);
  set("inductance_q", 0.9);
  set("ldq_2", 0.3);
  EXPECT_TRUE(drive_config_load(&inside::config()));
  set("ldq_2", 0.81);  // T/L of 0.58 A per V along the axes, 0.53 across
  expect_refused();
}

TEST_F(DriveConfig, AMagnetThatDrivesTooMuchCurrentIsRefused) {
  set("inductance_d", 0.2);
  set("inductance_q", 0.8);
  set("magnet_flux", 0.79);
  EXPECT_TRUE(drive_config_load(&inside::config()));
  set("magnet_flux", 0.81);  // lambda/Lq of 1013 A
  expect_refused();
  set("magnet_flux", 0.7);
  set("lqq_4", 90.0);
  EXPECT_TRUE(drive_config_load(&inside::config()));
  set("lqq_4", 80.0);  // 1094 A at its last point alone
  expect_refused();
}

TEST_F(DriveConfig, ASaliencyTooLargeForTheSensorsIsRefused) {
  set("inductance_d", 0.5);
  set("inductance_q", 5.0);
  EXPECT_TRUE(drive_config_load(&inside::config()));
  set("current_full_scale", 200.0);
  expect_refused();
}

// By the rules or, where it is the formats that do not hold it, by the configuration itself.
TEST_F(DriveConfig, WhatDoesNotFitIsRefused) {
  const auto refused = [](auto change) {
    drive_reset();
    change(parameters);
    return parameter_conflict() != PACKED_NONE;
  };
  EXPECT_FALSE(refused([](parameters_t&) {}));
  const auto edges = [](double dead, double off) {
    return [=](parameters_t& p) { p.dead_time = raw(dead, 16), p.turn_on_delay = 0, p.turn_off_delay = raw(off, 16); };
  };
  EXPECT_TRUE(refused(edges(1.0, 1.1))) << "a device is on before the other one is off";
  EXPECT_FALSE(refused(edges(1.0, 1.0)));
  EXPECT_TRUE(refused(edges(2.5, 1.0))) << "no room before the first edge";
  EXPECT_TRUE(refused([](parameters_t& p) { p.current_bandwidth = 2600, p.current_divider = 2; }));
  EXPECT_FALSE(refused([](parameters_t& p) { p.current_bandwidth = 2080, p.current_divider = 2; }));
  const auto inductance = [](double mh) {
    return [=](parameters_t& p) { p.inductance_d = p.inductance_q = raw(mh, 20); };
  };
  EXPECT_TRUE(refused(inductance(0.166))) << "more than 0.6 A per V and period";
  EXPECT_FALSE(refused(inductance(0.168)));
}

// Whatever was in it before: the configuration is a function of the parameters, so nothing found at run time can hide
// in it and be reverted by a reload.
TEST_F(DriveConfig, ALoadOverwritesTheWholeConfiguration) {
  drive_config_t zeros, ones;
  std::memset(&zeros, 0, sizeof zeros);
  std::memset(&ones, 0x01, sizeof ones);
  ASSERT_TRUE(drive_config_load(&zeros));
  ASSERT_TRUE(drive_config_load(&ones));
  EXPECT_EQ(std::memcmp(&zeros, &ones, sizeof zeros), 0);
}

// Anywhere between the ends, the ends themselves included; also near the default, so that some sets are accepted.
std::int32_t random_value(Random& random, const parameter_info_t& p, bool wild) {
  const int kind = random.below(8);
  const std::int32_t least = parameter_minimum(&p), most = parameter_maximum(&p), usual = parameter_initial(&p);
  if (wild && kind == 0) return least;
  if (wild && kind == 1) return most;
  const double lo = wild ? least : std::max<double>(least, usual - 0.2 * std::fabs(usual));
  const double hi = wild ? most : std::min<double>(most, usual + 0.2 * std::fabs(usual));
  return static_cast<std::int32_t>(std::llround(random.between(lo, hi)));
}

TEST_F(DriveConfig, RandomSetsAreAcceptedConsistentOrRefused) {
  Random random(80);
  int accepted = 0, refused = 0;
  for (int n = 0; n < 9000; ++n) {
    parameters_reset(&parameters);
    for (std::uint16_t k = 0; k < parameter_count(); ++k) {
      const parameter_info_t& p = *parameter_info(k);
      ASSERT_EQ(parameter_set(p.id, random_value(random, p, n % 2 == 0)), SET_OK)
          << stillspin::bench::text_of(parameter_name(&p));
    }
    parameters.slice_time = raw(5.0, 16);  // by itself hardly any divides the period
    drive_config_t c = inside::config();
    if (parameter_conflict() != PACKED_NONE || !drive_config_load(&c)) {
      ++refused;
      continue;
    }
    ++accepted;
    ASSERT_LE(parameters.inductance_d, parameters.inductance_q);
    ASSERT_LT(parameters.blend_low, parameters.blend_high);
    ASSERT_LE(parameters.window_minimum, parameters.window_maximum);
    ASSERT_GT(c.nameplate.yq_q30, 0);
    ASSERT_GE(c.nameplate.yd_q30, c.nameplate.yq_q30);
    ASSERT_LT(c.blend.low_bpp, c.blend.high_bpp);
    ASSERT_GE(c.avv.bandwidth_long_q30, c.avv.bandwidth_short_q30);
    ASSERT_GE(c.dead_time.turn_on_ticks, c.dead_time.turn_off_ticks);
    ASSERT_GE(c.ramp_step_bpp, 0);
    ASSERT_GT(c.observer.weight_q8, 0);
    ASSERT_GT(c.observer.load_noise_q20, 0);
    const bool flux = parameters.position_source >= POSITION_FLUX_CONV && !drive_source_is_left_out(&parameters);
    const double low = real(flux ? parameters.flux_low : parameters.blend_low, 16) / 60.0 * parameters.pole_pairs *
                       std::ldexp(kPeriod, 32);
    ASSERT_NEAR(c.blend.low_bpp / low, 1.0, 1e-4);
  }
  EXPECT_GT(accepted, 100);  // both ways were taken
  EXPECT_GT(refused, 100);
}

TEST_F(DriveConfig, SpeedCommandIsClampedToTheLimit) {
  const double per_rpm = Motor{}.pole_pairs / 60.0 * std::ldexp(kPeriod, 32);
  const std::pair<double, double> cases[] = {{600, 600}, {-600, -600}, {5000, 3300}, {-32000, -3300}};
  for (const auto& [asked, got] : cases) {
    drive_command_speed(raw(asked, 16));
    drive_sequence(&drive);
    EXPECT_NEAR(inside::target_bpp() / per_rpm, got, 0.01) << asked;
  }
}

TEST_F(DriveConfig, EncoderAngle) {
  for (const int counts : {4096, 1000, 65536}) {
    for (const int count : {0, 1, counts / 3, counts - 1}) {
      const double exact = kTurn * 4 * count / counts;
      // 2^32 / counts rounded up by less than one LSB per count
      EXPECT_NEAR(wrapped(rad(encoder_angle(static_cast<std::uint32_t>(count), 4, counts)) - exact), 0.0,
                  4.0 * count * kTurn * std::ldexp(1.0, -32) + 1e-8);
    }
  }
}

TEST_F(DriveConfig, TheStatorFluxNeedsAMachineThatItCanBeGiven) {
  NEEDS("sources/flux");
  set("inductance_d", 1.5);
  set("inductance_q", 9.2);  // 6.1 times
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  set("position_source", 7.0);
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
  set("inductance_q", 7.8);
  EXPECT_EQ(parameter_conflict(), PACKED_NONE);
  set("flux_low", 600.0);
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
  parameters.flux_low = 1;  // in rpm Q16: less than the format of an electrical speed tells from nothing
  parameters.flux_high = 2;
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
}

// Whatever was changed since counts at once, and nothing else is calculated again.
TEST_F(DriveConfig, WhatTheLastConfigurationFoundIsKnown) {
  EXPECT_EQ(parameter_conflict_known(), PACKED_NONE);
  set("blend_high", 50.0);  // blend_low is 60
  EXPECT_NE(parameter_conflict_known(), PACKED_NONE) << "before a configuration has been made";
  background_step(&drive);
  ASSERT_NE(parameter_conflict_known(), PACKED_NONE);
  EXPECT_NE(stillspin::bench::text_of(parameter_conflict_known()).find("blend_high"), std::string::npos);
  set("blend_high", 100.0);
  EXPECT_EQ(parameter_conflict_known(), PACKED_NONE);
  background_step(&drive);
  EXPECT_EQ(parameter_conflict_known(), PACKED_NONE);
  parameters.blend_high = 0;  // behind its back
  EXPECT_EQ(parameter_conflict_known(), PACKED_NONE) << "taken from the configuration";
  EXPECT_NE(parameter_conflict(), PACKED_NONE);
  drive_parameters_changed();
  EXPECT_NE(parameter_conflict_known(), PACKED_NONE);
}

// Hand-over by its own speeds, method by the source, saturation by the map.
TEST_F(DriveConfig, TheStatorFluxFollowsItsParameters) {
  NEEDS("sources/flux");
  set("position_source", 7.0);
  set("flux_cutoff", 30.0);
  set("lqq_4", 80.0);
  set("lqq_2", 90.0);
  ASSERT_TRUE(drive_config_load(&inside::config()));
  const drive_config_t& c = inside::config();
  EXPECT_EQ(flux_config.method, FLUX_PP02);
  EXPECT_NEAR(real(flux_config.cutoff_q30, 30), 30.0 * kPeriod, 1e-8);
  EXPECT_NEAR(rad_per_s(flux_config.adaptation.lowest_bpp), 400.0, 0.1);
  EXPECT_NEAR(c.blend.low_bpp / (350.0 * std::ldexp(4.0 / 60.0 * kPeriod, 32)), 1.0, 1e-5);
  EXPECT_GT(flux_config.adaptation.saturation_q24, 0);
  EXPECT_EQ(flux_config.adaptation.magnet_q30, 0);
  set("flux_adapt", 2.0);
  ASSERT_TRUE(drive_config_load(&inside::config()));
  EXPECT_EQ(flux_config.adaptation.saturation_q24, 0);
  EXPECT_GT(flux_config.adaptation.magnet_q30, 0);
}

}  // namespace
