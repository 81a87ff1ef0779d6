// The start of a shaft that turns: pairs of short circuits whose back-EMFs the test makes up.

#include "tests/firmware/fake_hal.hpp"

namespace {

using namespace stillspin::test;

class StartCaught : public Drive {
 protected:
  void SetUp() override {
    Drive::SetUp();
    parameters.position_source = 0;
    make_ready();
    drive_command_start();
    period();
    ASSERT_EQ(drive.state, DRIVE_START);
  }

  /// The next short circuit, with a back-EMF of this size (V) in this direction (rad) in its middle, which is now.
  static void see_pulse(double direction, double volts) {
    flying_pulse_t& p = drive.start.pulse;
    drive.samples.count = 0;
    p.windows = 2;
    p.first_tick = drive.start.clock - 5000;
    p.last_tick = drive.start.clock + 5000;
    p.first_q20 = p.last_q20 = {raw(2.0, 20), 0};  // enough to be looked at
    p.drive_q16 = raw_ab(Vector{volts, 0.0}.turned(direction) * 2.0, 16);
    judge();
  }
  /// Of the short circuit that has been seen: the gates go off, it is judged, and the loop is closed where it fits.
  static void judge() {
    start_step_pulse(&drive);
    EXPECT_FALSE(board.gates_on) << "the current dies away";
    start_step_pulse(&drive);
    EXPECT_TRUE(drive.start.decides) << "in a period for itself";
    EXPECT_EQ(drive.start.phase, START_PULSE);
    drive.schedule.decides = true;
    start_step_pulse(&drive);
    drive.schedule.decides = false;
    if (drive.start.phase == START_CATCH) start_step_catch(&drive);
  }
  void await_pulse() {
    for (int n = 0; n < 700 && drive.start.phase != START_PULSE; ++n) period();
    ASSERT_EQ(drive.start.phase, START_PULSE);
  }
  /// Two short circuits of a shaft at this speed (rad/s, electrical) whose magnet is `flux` times what was told.
  void catch_at(double speed, double flux) {
    const double volts = std::fabs(speed) * Motor{}.flux * flux;
    await_pulse();
    const std::int32_t first = drive.start.clock;
    see_pulse(0.5, volts);
    ASSERT_EQ(drive.start.phase, START_LISTEN);
    await_pulse();
    see_pulse(0.5 + speed * (drive.start.clock - first) * 1e-8, volts);
  }
};

TEST_F(StartCaught, APairThatFitsGivesTheSpeed) {
  for (const double speed : {300.0, -300.0}) {
    SetUp();
    catch_at(speed, 1.0);
    EXPECT_EQ(drive.start.phase, START_CATCH);
    EXPECT_TRUE(drive.control.closed);
    EXPECT_NEAR(rad_per_s(drive.start.rotor.speed_bpp), speed, 1.0);
  }
}

// The short circuit lies some time back by then: the rotor is where it has turned to since.
TEST_F(StartCaught, TheRotorIsCarriedOnToTheRunningPeriod) {
  for (const double speed : {300.0, -300.0}) {
    SetUp();
    await_pulse();
    const std::int32_t first = drive.start.clock;
    see_pulse(0.5, 48.0);
    await_pulse();
    constexpr int kAgo = 47000;  // ticks, 4.7 periods
    drive.start.clock += kAgo;
    const double turned = speed * (drive.start.clock - kAgo - first) * 1e-8;
    flying_pulse_t& p = drive.start.pulse;
    drive.samples.count = 0;
    p.windows = 2;
    p.first_tick = drive.start.clock - kAgo - 5000;
    p.last_tick = drive.start.clock - kAgo + 5000;
    p.first_q20 = p.last_q20 = raw_ab(Vector{2.0, 0.0}.turned(0.5 + turned), 20);
    p.drive_q16 = raw_ab(Vector{96.0, 0.0}.turned(0.5 + turned), 16);
    const double lag = rad(flying_evaluate(&p, &drive.model).lag_bam);
    judge();
    ASSERT_EQ(drive.start.phase, START_CATCH);
    // e = w lambda q, and the turning saliency has turned it against the rotation by the lag
    const double behind = std::copysign(kPi / 2.0 - lag, speed);
    const double there = 0.5 + turned - behind + speed * kAgo * 1e-8;
    EXPECT_NEAR(wrapped(rad(drive.start.rotor.angle_bam) - there), 0.0, 2e-3) << speed;
  }
}

// A magnet's flux that is an eighth off is taken as seen, up to three eighths; a small EMF says nothing of it.
TEST_F(StartCaught, AFluxThatIsOffIsTakenFromALargeEmf) {
  const struct {
    double speed, flux, taken;
  } cases[] = {{300.0, 1.05, 0.0},  {300.0, 1.25, 0.25},  {-400.0, 0.8, -0.2},
               {300.0, 1.7, 0.375}, {600.0, 0.5, -0.375}, {200.0, 1.2, 0.0} /* 38 V */};
  for (const auto& c : cases) {
    SetUp();
    catch_at(c.speed, c.flux);
    ASSERT_EQ(drive.start.phase, START_CATCH) << c.flux;
    EXPECT_NEAR(1.0 * drive.model.trim.psi_q16 / drive.model.emf_q16, c.taken, 0.01) << c.speed << ", " << c.flux;
  }
}

// Two pulses between which nothing turned belong to no shaft. Four pairs, then it is a fault.
TEST_F(StartCaught, PairsThatDoNotFitAreTriedAgainFourTimes) {
  for (int pair = 1; pair <= 4; ++pair) {
    for (int k = 0; k < 2; ++k) {
      ASSERT_EQ(drive.state, DRIVE_START) << pair;
      await_pulse();
      see_pulse(0.5, 48.0);
    }
    EXPECT_EQ(drive.start.tries, pair);
    EXPECT_FALSE(board.gates_on);
    EXPECT_FALSE(drive.control.closed);
  }
  EXPECT_EQ(drive.state, DRIVE_FAULT);
  EXPECT_EQ(drive.fault, FAULT_POLARITY);
}

TEST_F(StartCaught, AShortCircuitWithoutSamplesIsNotJudged) {
  await_pulse();
  drive.start.pulse.windows = 0;
  drive.samples.count = 0;
  drive.start.tick = 100;
  start_step_pulse(&drive);
  EXPECT_EQ(drive.start.phase, START_PULSE);
  EXPECT_EQ(drive.start.pulses, 0);
}

// The estimators must follow what was caught before the drive may run; else the next pair is tried.
TEST_F(StartCaught, WhatIsNotFollowedIsCaughtAgain) {
  for (const double stray : {14.9, -14.9, 15.1, -15.1}) {
    SetUp();
    catch_at(300.0, 1.0);
    ASSERT_EQ(drive.start.phase, START_CATCH);
    drive.start.learnt = true;
    drive.start.stray = drive.position.avv.error_bam = static_cast<std::int32_t>(stray / 360.0 * 4294967296.0);
    drive.start.tick = 139;
    start_step_catch(&drive);
    EXPECT_EQ(drive.start.phase, START_CATCH) << "not before its time";
    EXPECT_FALSE(drive.start.decides);
    drive.start.tick = 140;
    start_step_catch(&drive);
    EXPECT_EQ(drive.start.phase, START_CATCH) << "not beside anything else";
    EXPECT_TRUE(drive.start.decides);
    drive.schedule.decides = true;
    start_step_catch(&drive);
    const bool follows = std::fabs(stray) < 15.0;
    EXPECT_EQ(drive.state, follows ? DRIVE_RUN : DRIVE_START) << stray;
    EXPECT_EQ(drive.start.tries, follows ? 0 : 1);
    EXPECT_EQ(board.gates_on, follows);
  }
}

// All lower devices on for the whole period, which three windows share.
TEST_F(StartCaught, TheShortCircuitLastsThePeriod) {
  const sampling_config_t& c = drive.config.modulator.sampling;
  const svpwm_pattern_t p = start_short_circuit(&c);
  ASSERT_EQ(p.window_count, 3);
  int at = 0;
  for (const svpwm_window_t& w : p.windows) {
    EXPECT_EQ(w.start, at + c.settle_ticks);
    EXPECT_EQ(w.state, 0);
    at += 3300;
    EXPECT_EQ(w.end, std::min<int>(at - c.burst_ticks, c.last_tick));
  }
  EXPECT_GE(p.windows[2].end, 6600 + c.settle_ticks + c.span_min_ticks);
  for (const std::int16_t edge : p.pulses.at) {
    EXPECT_LT(edge, 0) << "a leg is never high";
  }
}

// Of the period in which the gates came on, only what lies behind that instant belongs to the short circuit; of the
// others all does.
TEST_F(StartCaught, WindowsBeforeTheGatesDoNotCount) {
  for (const int blind : {2, 1, 0}) {
    for (const int on : {1000, 1290, 1310, 1500, 4000, 9000}) {
      drive.start.phase = START_PULSE;
      drive.start.powered = true;
      drive.start.tick = 0;
      drive.start.blind = static_cast<std::uint16_t>(blind);
      drive.start.on_tick = on;
      flying_begin(&drive.start.pulse);
      drive.samples.count = 2;
      for (int k = 0; k < 2; ++k) {
        estimator_window_t w = {};
        w.middle_tick = static_cast<std::int16_t>(2500 + 5000 * k);
        w.span_ticks = 2000;
        drive.samples.windows[k] = w;
      }
      start_step_pulse(&drive);
      int expected = 0;  // the devices switch 2 us after they are told
      for (const int begin : {1500, 6500}) expected += blind == 0 || begin >= on + 200;
      EXPECT_EQ(drive.start.pulse.windows, expected) << blind << ", " << on;
    }
  }
}

}  // namespace
