// What the background level does with changed parameters, and what the milliseconds of the inertia's match hand on.

#include "tests/firmware/fake_hal.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/signals.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/commands.h"
#include "firmware/mode/mode.h"
#include "firmware/mode/states.h"
}

namespace {

using namespace stillspin::test;

class Reload : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    make_ready();
    parameters.speed_limit = raw(1500.0, 8);  // so that more pole pairs have no larger back-EMF
  }
  static void reload() {
    drive_parameters_changed();
    background_step(&drive);
    EXPECT_FALSE(inside::reload_requested());
  }
};

TEST_F(Reload, NothingIsDoneThatWasNotAskedFor) {
  parameters.pole_pairs = 6;
  background_step(&drive);
  EXPECT_EQ(inside::config().bpp_per_rpm_q8 / 1832519L, 4);
  reload();
  EXPECT_EQ(inside::config().bpp_per_rpm_q8 / 1832519L, 6);
}

// While the power stage is off the model, the speed control and the hardware follow, and what was learnt is forgotten;
// while it is on they stay.
TEST_F(Reload, TheMachineFollowsWhileThePowerStageIsOff) {
  for (const drive_state_t state : {DRIVE_READY, DRIVE_RUN}) {
    SetUp();
    inside::be_in(state);
    const bool off = state == DRIVE_READY;
    inside::model().trim.rs_q24 = 12345;
    inside::speed_ready() = false;
    const std::int32_t share = inside::speed_controller().gains.share_q30;
    parameters.dead_time = raw(1.3, 16);
    parameters.magnet_flux = raw(0.1, 28);
    parameters.speed_alpha = raw(20.0, 14);
    board.dead_band = 0;
    reload();
    EXPECT_TRUE(inside::config_valid());
    EXPECT_EQ(inside::config().nameplate.flux_q28, raw(0.1, 28));
    EXPECT_EQ(inside::model().flux_q28 == raw(0.1, 28), off);
    EXPECT_EQ(inside::model().trim.rs_q24, off ? 0 : 12345);
    EXPECT_EQ(inside::speed_ready(), off);
    EXPECT_EQ(inside::speed_controller().gains.share_q30 != share, off);
    EXPECT_EQ(board.dead_band, off ? 130 : 0);
  }
}

TEST_F(Reload, SpeedAndCurrentAreInTheNewUnits) {
  drive_command_speed(raw(600.0, 16));
  parameters.pole_pairs = 8;
  parameters.current_limit = parameters.weakening_limit = raw(3.5, 20);
  reload();
  period();
  EXPECT_NEAR(inside::target_bpp() / (80.0 * kPeriod * 4294967296.0), 1.0, 1e-5);
  EXPECT_EQ(inside::current_limit_q20(), raw(3.5, 20));
}

// The old configuration stays in use, but nobody starts with it.
TEST_F(Reload, ParametersThatDoNotFitTogetherLeaveTheConfigurationAndSayWhy) {
  parameters.blend_high = parameters.blend_low;
  parameters.pole_pairs = 6;
  reload();
  EXPECT_FALSE(inside::config_valid());
  EXPECT_TRUE(inside::conflict_known());
  EXPECT_EQ(inside::conflict(), SAY_blend_high_must_be_above_blend_low);
  EXPECT_EQ(inside::config().bpp_per_rpm_q8 / 1832519L, 4);
  parameters.blend_high = 2 * parameters.blend_low;
  reload();
  EXPECT_TRUE(inside::config_valid());
  EXPECT_EQ(inside::conflict(), PACKED_NONE);
  EXPECT_EQ(inside::config().bpp_per_rpm_q8 / 1832519L, 6);
}

TEST_F(Reload, ADeadBandThatTheHardwareCannotMakeIsNoConfiguration) {
  board.dead_band_fits = false;
  reload();
  EXPECT_FALSE(inside::config_valid());
  board.dead_band_fits = true;
  reload();
  EXPECT_TRUE(inside::config_valid());
}

TEST_F(Reload, TheDeadBandIsTheParametersButNeverLessThanTheHardwaresLeast) {
  parameters.dead_time = raw(1.736, 16);
  EXPECT_EQ(drive_dead_band_ticks(), 174);
  parameters.dead_time = raw(1.734, 16);
  EXPECT_EQ(drive_dead_band_ticks(), 173);
  parameters.dead_time = 0;
  EXPECT_EQ(drive_dead_band_ticks(), HAL_PWM_DEAD_BAND_MIN_TICKS);
}

class Inertia : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    make_ready();
    inside::be_in(DRIVE_RUN);
    inside::config().mapped = true;
    parameters.inertia_adapt = 1;
    use_source(POSITION_OBSERVER);
    inside::ramped_bpp() = inside::selected().speed_bpp = bpp_of(100);
    inertia_match.reference_bpp = inside::ramped_bpp();
  }
  static double acceleration_limit() {
    const Motor m;
    return m.torque_constant() * real(parameters.current_limit, 20) * m.pole_pairs / m.inertia * kPeriod * kPeriod /
           kTurn * 4294967296.0;
  }
  /// A run-up that has turned the shaft twice as far as its torque should have, with this share of the limit's torque.
  static void run_up(double share) {
    inertia_match_t& s = inertia_match;
    inertia_match_reset(&s);
    s.phase = INERTIA_RUN_UP;
    s.reference_bpp = inside::ramped_bpp() - 1000;
    s.ms = 99;
    s.before_q24 = s.ratio_q24;
    s.start_base_q8 = raw(1000.0, 8);
    s.speed0_bpp = bpp_of(10);
    s.gained_bpp = s.last_gained_bpp = static_cast<std::int32_t>(1000.0 * share * acceleration_limit());
    s.angle_bam = inside::selected().angle_bam;
    s.expected = raw(4.0, 24);
    s.turned = raw(8.0, 24);
    s.next = raw(4.0, 24);
    inside::ramped_bpp() = bpp_of(900);
  }
};

// What was found in a run-up is given to the model, the speed control and the observer, which has mistaken it for load.
TEST_F(Inertia, WhatARunUpFindsIsHandedOn) {
  run_up(0.5);
  const std::int32_t speed = inertia_match.speed0_bpp + 2 * inertia_match.gained_bpp;
  inside::observer().load_accel_q8 = raw(-7000.0, 8);
  inside::observer().speed_bpp = bpp_of(20);
  const double accel = inside::model().accel_q12, share = inside::speed_controller().gains.amps_per_bpp;
  inside::match_inertia();
  const double ratio = real(inertia_match.ratio_q24, 24);
  EXPECT_NEAR(ratio, 2.0, 0.1);
  EXPECT_NEAR(inside::model().accel_q12 / accel, ratio, 1e-3);
  EXPECT_NEAR(inside::speed_controller().gains.amps_per_bpp / share, 1.0 / ratio, 1e-3);
  EXPECT_EQ(inside::observer().load_accel_q8, inertia_match.start_base_q8) << "the load is that of before";
  EXPECT_NEAR(inside::observer().load_accel_q8, 1000.0 * 256.0 * ratio, 256.0);
  EXPECT_NEAR(inside::observer().speed_bpp / static_cast<double>(speed), 1.0, 0.05);
}

TEST_F(Inertia, ASpeedBeyondTheModelsIsItsEnd) {
  run_up(0.5);
  inertia_match.speed0_bpp = MACHINE_SPEED_END_BPP - 1000;
  inertia_match.turned = raw(60.0, 24);
  inertia_match.expected = raw(30.0, 24);
  inside::match_inertia();
  EXPECT_EQ(inside::observer().speed_bpp, MACHINE_SPEED_END_BPP);
}

// Three tenths of the torque at the current's limit, less says nothing.
TEST_F(Inertia, ARunUpUnderLittleTorqueSaysNothing) {
  for (const double share : {0.29, 0.31}) {
    SetUp();
    run_up(share);
    inside::match_inertia();
    EXPECT_EQ(inertia_match.ratio_q24 != INERTIA_SAME_Q24, share > 0.3) << share;
  }
}

// The reference counts as reached within 20 rpm.
TEST_F(Inertia, TheReferenceIsReachedWithin20Rpm) {
  for (const int off : {-21, -19, 19, 21}) {
    SetUp();
    inside::selected().speed_bpp = bpp_of(100 + off);
    inside::match_inertia();
    EXPECT_EQ(inertia_match.quiet_ms, std::abs(off) < 20 ? 1 : 0) << off;
  }
}

// At rest the torque's slow mean; what begins the run-up is the ramp.
TEST_F(Inertia, ARunUpBeginsWithTheRampAfterARest) {
  inside::torque_accel_q8() = raw(160.0, 8);
  inside::selected().angle_bam = 0x12345678u;
  for (int n = 0; n < 30; ++n) inside::match_inertia();
  EXPECT_EQ(inertia_match.phase, INERTIA_REST);
  EXPECT_GT(inertia_match.base_q8, raw(100.0, 8));
  EXPECT_EQ(inertia_match.angle_bam, 0x12345678u);
  inside::ramped_bpp() += 1;
  inside::match_inertia();
  EXPECT_EQ(inertia_match.phase, INERTIA_RUN_UP);
  EXPECT_EQ(inertia_match.speed0_bpp, inside::selected().speed_bpp);
}

// A large current turns the angle where the map is not known, and other sources have no observer to correct.
TEST_F(Inertia, NothingIsLearntWithoutTheMapTheParameterAndTheObserver) {
  for (int missing = 0; missing < 4; ++missing) {
    SetUp();
    run_up(0.5);
    if (missing == 1) inside::config().mapped = false;
    if (missing == 2) inside::config().values.inertia_adapt = 0;
    if (missing == 3) use_source(POSITION_OBSERVER_AVV);
    inside::match_inertia();
    EXPECT_EQ(inertia_match.ratio_q24 != INERTIA_SAME_Q24, missing == 0) << missing;
  }
}

TEST_F(Inertia, OutsideOfRunARunUpIsForgotten) {
  for (const drive_state_t state : {DRIVE_READY, DRIVE_START, DRIVE_STOP, DRIVE_FAULT}) {
    run_up(0.5);
    inertia_match.quiet_ms = 30;
    inside::be_in(state);
    inside::match_inertia();
    EXPECT_EQ(inertia_match.phase, INERTIA_REST);
    EXPECT_EQ(inertia_match.quiet_ms, 0);
    EXPECT_EQ(inertia_match.ratio_q24, INERTIA_SAME_Q24);
  }
}

// A tool finds every signal, and what is in it.
TEST(SignalTable, EverySignalHasAPlaceAndNothingIsBehindTheLast) {
  ASSERT_GT(signal_count(), 20);
  drive_reset();
  for (std::uint16_t place = 0; place < signal_count(); ++place) ASSERT_NE(signal_info(place), nullptr);
  EXPECT_EQ(signal_info(signal_count()), nullptr);
  const std::uint16_t none = signal_count();
  std::int32_t value = 1;
  (void)drive_signals_copy(&none, 1, &value);
  EXPECT_EQ(value, 0);
  inside::heat_sink_q8() = 20 * 256;
  const auto last = static_cast<std::uint16_t>(signal_count() - 1);
  EXPECT_EQ(inside::signal(last, KNOWN_HEAT_SINK), 20 * 256) << "the last of them";
  EXPECT_EQ(inside::signal(last, 0), 0);
  inside::be_in(DRIVE_STOP);
  EXPECT_EQ(inside::signal(0, 0), DRIVE_STOP);
  EXPECT_EQ(drive_signals().state, DRIVE_STOP);
}

}  // namespace
