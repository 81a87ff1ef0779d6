// The start of a shaft that stands but for its polarity, phase by phase: what each asks of the drive and where it goes
// from there. What the estimators say is the test's.

#include "tests/firmware/start_standing.hpp"

extern "C" {
#include "estimators/wiring.h"
#include "firmware/config/config.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/inertia.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/sources/encoder/encoder.h"
}

namespace {

using namespace stillspin::test;

// Nothing of the last run is left, whatever it was.
TEST_F(StartStanding, BeginsWithNothingOfTheLastRun) {
  inside::be_in(DRIVE_READY);
  drive_control_t& c = inside::control();
  references_t& r = c.references;
  c.ramp.value = r.feed_forward_q16 = r.current_q20.d = r.current_q20.q = 12345;
  r.closed = c.position_hold.holding = true;
  r.spin_d_q20 = 12345;
  inside::wiring() = WIRING_OPEN_B;
  inside::missing_windows() = inside::overruns() = 3;
  inside::synchronism().debounce = 99;
  starting.tries = starting.held_back = 2;
  inside::model().trim.rs_q24 = 777;
  inside::model().accel_q12 /= 2;
  inertia_match.ratio_q24 /= 2;
  inside::config().sensor_mismatch_q30 = 4321;
  start_state.begin(&drive, DRIVE_RUN);
  EXPECT_EQ(inside::state(), DRIVE_START);
  EXPECT_EQ(c.ramp.value | r.feed_forward_q16 | r.current_q20.d | r.current_q20.q | r.spin_d_q20, 0);
  EXPECT_EQ(inside::wiring(), WIRING_GOOD);
  EXPECT_FALSE(r.closed);
  EXPECT_FALSE(c.position_hold.holding);
  EXPECT_EQ(inside::missing_windows() + inside::overruns(), 0);
  EXPECT_EQ(inside::synchronism().debounce, 0);
  EXPECT_EQ(starting.tries + starting.held_back, 0);
  EXPECT_EQ(inside::model().trim.rs_q24, 0);
  EXPECT_EQ(inside::model().accel_q12, inside::config().nameplate.accel_q12);
  EXPECT_EQ(inertia_match.ratio_q24, INERTIA_SAME_Q24);
  EXPECT_EQ(inside::sensor_trim().mismatch_q30, 4321);
  EXPECT_TRUE(board.gates_on);
}

// From the fourth period on each regression counts, twelve of them, all at an angle of zero. Then the current loop is
// closed in the frame that was found.
TEST_F(StartStanding, TheAxisIsFoundInTwelvePeriods) {
  const machine_model_t& m = inside::model();
  const double half = 0.5 * (real(m.yd_q30, 30) - real(m.yq_q30, 30)), spread = 40000.0;
  int n = 0;
  for (; inside::start_phase() == START_AXIS && n < 50; ++n) {
    regression_t& r = inside::avv().regression;
    r = {};
    r.information = 1000000;
    r.spread_q8 = raw(spread, 8);
    r.along_q16 = raw(0.0005 * spread, 16);
    r.mirror_q16 = raw((std::cos(2.0 * kThere) - 1.0) * half * spread, 16);  // the model has it at zero
    r.cross_q16 = raw(std::sin(2.0 * kThere) * half * spread, 16);
    step();
    if (inside::start_phase() == START_AXIS) {
      EXPECT_EQ(inside::avv_angle_bam(), 0u);
      EXPECT_FALSE(inside::loop_is_closed());
    }
  }
  EXPECT_EQ(n, 3 + 12);
  EXPECT_EQ(inside::start_phase(), START_SETTLE);
  EXPECT_TRUE(inside::loop_is_closed());
  EXPECT_NEAR(rad(inside::avv_angle_bam()), kThere, 1e-4);
  EXPECT_NEAR(real(m.trim.mean_q30, 30), 0.0005, 1e-6);
  EXPECT_NEAR(real(m.trim.half_q30, 30), 0.0, 1e-6);
}

/// Regressions of an axis at zero, with this share of the model's saliency, until the phase is over.
void find_axis(double saliency, void (*step)()) {
  const machine_model_t m = inside::model();
  const double half = 0.5 * (real(m.yd_q30, 30) - real(m.yq_q30, 30)), spread = 40000.0;
  for (int n = 0; inside::state() == DRIVE_START && inside::start_phase() == START_AXIS && n < 50; ++n) {
    regression_t& r = inside::avv().regression;
    r = {};
    r.information = 1000000;
    r.spread_q8 = raw(spread, 8);
    r.mirror_q16 = raw((saliency - 1.0) * half * spread, 16);
    step();
  }
}

// What the currents say of the wires is a fault by its kind, and nothing goes on.
TEST_F(StartStanding, WhatIsWrongWithTheWiresIsAFault) {
  const struct {
    wiring_t wiring;
    drive_fault_t fault;
  } cases[] = {{WIRING_GOOD, FAULT_NONE},
               {WIRING_NO_CURRENT, FAULT_NO_CURRENT},
               {WIRING_OPEN_A, FAULT_OPEN_PHASE},
               {WIRING_OPEN_C, FAULT_OPEN_PHASE},
               {WIRING_DEAD_A, FAULT_CURRENT_SENSOR},
               {WIRING_REVERSED_BOTH, FAULT_CURRENT_SENSOR},
               {WIRING_SWAPPED, FAULT_SENSOR_ORDER},
               {WIRING_OTHER_PHASES, FAULT_SENSOR_ORDER}};
  for (const auto& c : cases) {
    SetUp();
    start_ways.checks_wiring = false;  // the test says what was found
    inside::wiring() = c.wiring;
    find_axis(1.0, step);
    EXPECT_EQ(inside::fault(), c.fault) << c.wiring;
    EXPECT_EQ(inside::start_phase(), c.fault == FAULT_NONE ? START_SETTLE : START_AXIS) << c.wiring;
    EXPECT_EQ(board.gates_on, c.fault == FAULT_NONE) << c.wiring;
  }
}

// A commissioning takes a shaft that shows no axis as it is; a run needs one, and a commissioning takes one that it can
// have.
TEST_F(StartStanding, WithoutAnAxisACommissioningBeginsAtOnce) {
  for (const drive_state_t behind : {DRIVE_RUN, DRIVE_COMMISSION}) {
    for (const double saliency : {1.0, 0.0}) {
      SetUp();
      inside::state_behind() = behind;
      find_axis(saliency, step);
      const bool at_once = behind == DRIVE_COMMISSION && saliency == 0.0;
      EXPECT_EQ(inside::start_found().uniform, saliency == 0.0);
      EXPECT_EQ(inside::state(), at_once ? DRIVE_COMMISSION : DRIVE_START) << behind << saliency;
      EXPECT_EQ(inside::start_phase(), at_once ? START_AXIS : START_SETTLE) << behind << saliency;
    }
  }
}

// Without a test of the polarity the drive runs at the angle that the axis gives, a tenth of a millisecond's settling
// later; a shaft that stands is held from there if that is wanted, one that turns at 20 rpm or more is not.
TEST_F(StartStanding, WithoutAPolarityTestTheAxisIsTaken) {
  for (const double rpm : {0.0, 18.0, 22.0, -18.0, -22.0}) {
    SetUp();
    parameters.polarity_check = 0;
    parameters.hold_time = 40;
    use_parameters();
    brake_release_hold.left = 7;  // of the last run
    const double speed = Motor{}.electrical(rpm);
    at(START_SETTLE, 99, speed);
    step();
    EXPECT_EQ(inside::state(), DRIVE_START);
    step();
    expect_runs(kThere);
    const bool turns = std::fabs(rpm) > 20.0;
    EXPECT_NEAR(rad_per_s(inside::ramped_bpp()), turns ? speed : 0.0, 0.01) << rpm;
    EXPECT_EQ(brake_release_hold.left, turns ? 0u : 400u) << rpm;
    EXPECT_EQ(inside::start_found().sigma_q8, 0);
  }
}

// A winding that differs by a sixteenth or more is taken as seen.
TEST_F(StartStanding, TheResistanceIsTakenWhereItIsOff) {
  for (const double share : {0.055, 0.07, -0.055, -0.07}) {
    SetUp();
    const machine_model_t& m = inside::model();
    const double rs = real(m.nominal_rs_q24, 24);
    saturation_t& s = start().saturation;
    s.current_q20 = raw(10.0, 20);
    s.missing_count = 100;
    s.missing_q20 = -100 * raw(share * rs * 10.0 * real(m.yd_q30, 30), 20);
    saturation_says(POLARITY_RIGHT);
    EXPECT_NEAR(real(m.trim.rs_q24, 24), std::fabs(share) > 1.0 / 16.0 ? share * rs : 0.0, 1e-4) << share;
  }
}

TEST_F(StartStanding, TheGatesHaveTheirInstant) {
  start_power(&drive, false);
  EXPECT_FALSE(board.gates_on || !inside::gates_off());
  board.pwm_tick = 4321;
  inside::invalid_periods() = 0;
  start_power(&drive, true);
  EXPECT_TRUE(board.gates_on && !inside::gates_off());
  EXPECT_EQ(start().on_tick, 4321);
  EXPECT_EQ(inside::invalid_periods(), 2) << "this period and the next have begun with the gates off";
}

TEST_F(StartStanding, NoTorqueIsAskedForWhenItIsOver) {
  inside::reference_dq_q20().q = raw(3.0, 20);
  start_run(&drive, bam(0.8), 0);
  EXPECT_EQ(inside::reference_dq_q20().q, 0);
}

// Speed control, encoder and the watch over the polarity go on from here; nobody holds the shaft.
TEST_F(StartStanding, WhatRunsGoesOnFromTheAngleAndTheSpeed) {
  use_source(POSITION_ENCODER);
  board.encoder = 1234;
  brake_release_hold.left = 9;
  inside::speed_controller().current_q20 = inside::speed_controller().integral_q20 = raw(2.0, 20);
  drive_bumpless_transfer(&drive, bam(0.8), bpp(100.0));
  EXPECT_EQ(inside::selected().angle_bam, bam(0.8));
  EXPECT_EQ(inside::selected().speed_bpp, bpp(100.0));
  EXPECT_EQ(encoder.observer.angle_bam, bam(0.8));
  EXPECT_EQ(encoder.observer.speed_bpp, bpp(100.0));
  const std::uint32_t count = encoder_angle(1234, 4, parameters.encoder_counts);
  EXPECT_EQ(encoder.offset_bam, bam(0.8) - count);
  EXPECT_EQ(polarity_watch.axis.angle_bam, bam(0.8));
  EXPECT_EQ(polarity_watch.axis.speed_bpp, bpp(100.0));
  EXPECT_EQ(brake_release_hold.left, 0u);
  EXPECT_EQ(inside::ramped_bpp(), bpp(100.0));
  EXPECT_EQ(inside::speed_controller().current_q20, 0);
}

TEST_F(StartStanding, AnAxisHasTwentyMilliseconds) {
  start().tick = 199;
  step();
  EXPECT_EQ(inside::state(), DRIVE_START);
  inside::window_count() = 2;
  step();
  EXPECT_EQ(inside::fault(), FAULT_START_VOLTAGE);
}

TEST_F(StartStanding, WithoutWindowsTheAxisLacksSamples) {
  start().tick = 200;
  inside::window_count() = 0;
  step();
  EXPECT_EQ(inside::fault(), FAULT_NO_SAMPLES);
}

}  // namespace
