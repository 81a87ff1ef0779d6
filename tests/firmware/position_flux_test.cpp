// The stator flux, alone, beside others and while a start turns a vector.

#include <algorithm>

#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/interfaces/isr_cycles.h"
#include "firmware/mode/states.h"
#include "firmware/sources/flux/flux.h"
#include "firmware/start/if_start/if_start.h"
#include "firmware/start/step.h"
#include "svpwm/ripple.h"
}

namespace {

using namespace stillspin::test;

// Below its lower speed a flux that looks on follows the truth; from there on it says what it sees, either way round.
TEST_F(Sources, AFluxLooksOnFromItsLowerSpeedOn) {
  NEEDS("sources/flux");
  for (const int rpm : {-120, -80, 80, 120}) {
    run_with(POSITION_ENCODER);
    parameters.flux_low = raw(100.0, 16);
    parameters.flux_beside = 1;
    ASSERT_TRUE(drive_config_load(&inside::config()));
    const estimator_output_t there = {kThere, 0, 0, 32767}, truth = {kHere, bpp_of(rpm), 33, 32767};
    flux_source_follow(&drive, &there);
    const estimator_input_t in = {&inside::model(), inside::windows(), 0, 0, false, false, false, false, nullptr, 0};
    const estimator_output_t out = flux_source_look_on(&drive, &in, &truth);
    const bool follows = std::abs(rpm) < 100;
    EXPECT_EQ(out.angle_bam == kHere, follows) << rpm;
    EXPECT_EQ(flux_observer.observer.angle_bam == kHere, follows) << rpm;
    EXPECT_EQ(out.load_accel_q8 == 33, follows);
  }
}

// The voltage of the period before, less the devices' drops and what the resistance takes, is what the flux grows by;
// the current is that at the period's end.
TEST_F(Sources, TheFluxIntegratesTheVoltageOfThePeriodsPulses) {
  NEEDS("sources/flux");
  for (const bool watched : {false, true}) {
    run_with(POSITION_FLUX_CONV);
    blend(BLEND_HIGH, 0.0);
    polarity_watch.open = watched;  // then the observer goes on beside it
    see(0);
    const double speed = 0.2;
    const Vector current = {-1.0, 6.0};
    inside::selected() = {kHere, raw(speed / kTurn, 32), 0, 32767};
    inside::observer().speed_bpp = inside::selected().speed_bpp;
    inside::current_dq_q20() = inside::reference_dq_q20() = raw_dq(current, 20);
    flux_source_follow(&drive, &inside::selected());
    inside::link_q16() = raw(310.0, 16);
    for (int leg = 0; leg < 3; ++leg) {
      inside::sampled_pattern().pulses.at[leg] = static_cast<std::int16_t>(1000 + 500 * leg);
      inside::sampled_pattern().pulses.at[3 + leg] = static_cast<std::int16_t>(6000 - 700 * leg);
    }
    const Vector before = real(flux_observer.flux_q16, 16);
    const Vector from = current.turned(rad(kHere)), to = current.turned(rad(kHere) + speed);
    estimate();
    EXPECT_NEAR((real(flux_observer.current_q20, 20) - to).length(), 0.0, 1e-4);
    const Vector mean = real(svpwm_mean_q16(&inside::sampled_pattern().pulses, raw(310.0, 16)), 16);
    const Vector drop = real(dead_time_drop_q16(&inside::config().dead_time, raw_ab(to, 20)), 16);
    const Vector grown = mean - drop - (from + to) * (0.5 * real(inside::model().rs_q24, 24));
    EXPECT_GT(grown.length(), 20.0);
    // The low-pass forgets some thousandths of a flux of 1600 V.
    EXPECT_NEAR((real(flux_observer.flux_q16, 16) - before - grown).length(), 0.0, 8.0);
    EXPECT_EQ(inside::high_speed_estimate().angle_bam, flux_observer.observer.angle_bam);
    if (watched) continue;
    EXPECT_EQ(inside::low_speed_estimate().angle_bam, inside::high_speed_estimate().angle_bam);
    EXPECT_EQ(inside::selected().angle_bam, inside::high_speed_estimate().angle_bam);
    // The observer goes along, so that it is right when it is wanted again.
    EXPECT_EQ(inside::observer().angle_bam, inside::high_speed_estimate().angle_bam);
    EXPECT_EQ(inside::observer().speed_bpp, inside::high_speed_estimate().speed_bpp);
    EXPECT_EQ(inside::observer().load_accel_q8, inside::high_speed_estimate().load_accel_q8);
  }
}

// The drops of the devices are those of the current at the period's end, along both axes.
TEST_F(Sources, WhatTheDevicesTakeIsNotTheFluxs) {
  NEEDS("sources/flux");
  Vector flux[2];
  const Vector current = {-1.0, 6.0};
  const double volts = 4.0;
  Vector drop = {};
  for (const bool drops : {false, true}) {
    run_with(POSITION_FLUX_CONV);
    blend(BLEND_HIGH, 0.0);
    see(0);
    inside::config().dead_time.drop_q16 = drops ? raw(volts, 16) : 0;
    dead_time_design(&inside::config().dead_time);
    inside::current_dq_q20() = raw_dq(current, 20);
    flux_source_follow(&drive, &inside::selected());
    estimate();
    flux[drops] = real(flux_observer.flux_q16, 16);
    drop = real(dead_time_drop_q16(&inside::config().dead_time, raw_ab(current.turned(rad(kHere)), 20)), 16);
  }
  EXPECT_GT(std::min(std::fabs(drop.x), std::fabs(drop.y)), 1.0);
  EXPECT_NEAR(flux[1].x - flux[0].x, -drop.x, 0.05);
  EXPECT_NEAR(flux[1].y - flux[0].y, -drop.y, 0.05);
}

// Between the speeds the flux has no time to learn where the observer has windows; where these are left out it has.
TEST_F(Sources, BesideTheObserverTheFluxLearnsWithoutWindows) {
  NEEDS("sources/flux");
  for (const std::uint16_t windows : {0, 2}) {
    run_with(POSITION_FLUX_CONV);
    blend(BLEND_BOTH, 0.5);
    flux_source_follow(&drive, &inside::selected());
    flux_observer.pause = 1;
    see(windows);
    inside::skips_windows() = false;
    board.profile.clear();
    estimate();
    EXPECT_EQ(flux_observer.pause > 1, windows == 0);
    EXPECT_EQ(spent(), CYCLES_ESTIMATE_FLUX) << "for the virtual chip";
  }
}

TEST_F(Sources, TheFluxMayBeGivenTheShaftAtAnySpeed) {
  NEEDS("sources/flux");
  run_with(POSITION_FLUX_CONV);
  EXPECT_FALSE(position_observer_rests(&drive));
  inside::transfer_position();
  EXPECT_TRUE(position_observer_rests(&drive));
}

// The frame is the vector's, turned on; who looks on is set at rest, and runs from there on.
TEST_F(Sources, WhileAVectorIsTurnedTheSourceLooksOn) {
  NEEDS("start/if_start");
  for (const bool aligned : {false, true}) {
    run_with(POSITION_OBSERVER);
    see(0);
    inside::be_in(DRIVE_START);
    inside::is_open_loop() = true;
    inside::start_phase() = START_IF_RAMP;
    if_ramp_config.align_periods = 500;
    if_ramp.tick = aligned ? 500 : 499;
    if_ramp.angle_bam = kThere;
    if_ramp.speed_bpp = 4321;
    inside::selected() = {kHere, 1234, 0, 0};
    inside::observer().angle_bam = kThere;
    inside::observer().speed_bpp = 0;
    estimate();
    EXPECT_EQ(inside::selected().angle_bam, kThere + 4321u);
    EXPECT_EQ(inside::selected().speed_bpp, 4321);
    EXPECT_EQ(inside::seen().angle_bam, inside::observer().angle_bam);
    EXPECT_NEAR(rad(inside::seen().angle_bam - (aligned ? kThere : kHere)), 0.0, 1e-3);
    EXPECT_EQ(inside::avv_angle_bam(), kHere) << "all of them are set at rest";
  }
}

// A flux has no integral before the vector has its speed: until then it follows the vector.
TEST_F(Sources, AFluxFollowsAVectorUntilItIsUp) {
  NEEDS("sources/flux");
  for (const bool up : {false, true}) {
    run_with(POSITION_FLUX_CONV);
    see(0);
    blend(BLEND_HIGH, 0.0);
    inside::be_in(DRIVE_START);
    inside::is_open_loop() = true;
    inside::start_phase() = START_IF_RAMP;
    if_ramp.tick = if_ramp_config.align_periods = 500;
    if_ramp.angle_bam = kThere;
    if_ramp.speed_bpp = if_ramp_config.speed_bpp - (up ? 0 : 1);
    inside::selected() = {kHere, 1234, 0, 0};
    flux_observer.observer.angle_bam = kThere;
    estimate();
    EXPECT_EQ(flux_observer.observer.angle_bam == kHere, !up);
    EXPECT_EQ(inside::seen().angle_bam, flux_observer.observer.angle_bam);
    EXPECT_EQ(inside::selected().angle_bam, kThere + static_cast<std::uint32_t>(if_ramp.speed_bpp));
  }
}

// While a vector is turned the references are in the vector's frame, and the flux knows them in its own.
TEST_F(Sources, AFluxThatLooksOnKnowsTheCurrentsInItsOwnFrame) {
  NEEDS("sources/flux");
  // PP-02 takes the flux's length from the references: along its own axis they change it, across they turn it.
  std::uint32_t seen[2];
  for (const bool turned : {false, true}) {
    run_with(POSITION_FLUX_CONV + FLUX_PP02);
    see(0);
    blend(BLEND_HIGH, 0.0);
    inside::be_in(DRIVE_START);
    inside::is_open_loop() = true;
    inside::start_phase() = START_IF_RAMP;
    if_ramp.tick = if_ramp_config.align_periods;
    if_ramp.speed_bpp = if_ramp_config.speed_bpp;
    inside::reference_dq_q20() = inside::current_dq_q20() = raw_dq({0.0, 14.0}, 20);
    inside::selected() = {kHere, 0, 0, 0};
    inside::seen().angle_bam = turned ? kHere - 0x40000000u : kHere;
    const estimator_output_t now = {kHere, bpp_of(600), 0, 0};
    flux_source_follow(&drive, &now);
    estimate();
    seen[turned] = inside::seen().angle_bam;
  }
  EXPECT_NE(seen[0], seen[1]);
}

}  // namespace
