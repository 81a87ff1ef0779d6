// What goes into an estimator and comes out of it, source by source: the current of the windows, the torque, what is
// learnt in which turn, the encoder, the stator flux, and the start that turns a vector.

#include <algorithm>

#include "tests/firmware/position.hpp"

extern "C" {
#include "firmware/flux_source.h"
#include "firmware/isr_cycles.h"
#include "svpwm/ripple.h"
}

namespace {

using namespace stillspin::test;

class Sources : public Position {
 protected:
  /// In a period of this turn.
  static void estimate(turn_t turn = TURNS) {
    drive.schedule.turn = turn;
    drive_estimate(&drive);
  }
  static dq_t measured() { return drive.control.measured_q20; }
};

// One, two or three windows of a current that stands still in the rotor's frame, ripple on top.
TEST_F(Sources, TheCurrentIsTheWindowsMeanLessTheirRipple) {
  const Vector current = {-2.0, 5.0}, ripple = {3.0, -4.0};  // A, V period
  const double speed = 0.13;                                 // rad per period
  for (std::uint16_t count = 1; count <= 3; ++count) {
    run_with(POSITION_ENCODER);
    see(count);
    for (int k = 0; k < count; ++k) drive.samples.windows[k].middle_tick = static_cast<std::int16_t>(1500 + 3100 * k);
    drive.position.used.speed_bpp = raw(speed / kTurn, 32);
    // The ripple of all of them is turned by one angle, that of the middle one.
    const double one = rad(kHere) + speed * drive.samples.windows[count / 2].middle_tick / 10000.0;
    const double yd = real(drive.model.yd_q30, 30), yq = real(drive.model.yq_q30, 30);
    const Vector waves = {yd * ripple.x, yq * ripple.y};
    drive.samples.ripple_q16 = raw_ab((ripple * count).turned(one), 16);
    for (std::uint16_t k = 0; k < count; ++k) {
      estimator_window_t& w = drive.samples.windows[k];
      const double angle = rad(kHere) + speed * w.middle_tick / 10000.0;
      w.current_q20 = raw_ab((current + waves).turned(angle), 20);
    }
    estimate();
    EXPECT_NEAR(real(measured().d, 20), current.x, 2e-4) << count;
    EXPECT_NEAR(real(measured().q, 20), current.y, 2e-4) << count;
  }
}

// No two sensors show more than 512 A; without windows the last current stays.
TEST_F(Sources, TheCurrentHasAnEndAndStaysWithoutWindows) {
  run_with(POSITION_ENCODER);
  see(1);
  drive.samples.windows[0].current_q20 = raw_ab(Vector{500.0, 0.0}.turned(rad(kHere)), 20);
  drive.samples.ripple_q16 = raw_ab(Vector{-5000.0, 0.0}.turned(rad(kHere)), 16);
  estimate();
  EXPECT_NEAR(real(measured().d, 20), 512.0, 1e-3);
  see(0);
  estimate();
  EXPECT_NEAR(real(measured().d, 20), 512.0, 1e-3);
}

// A start that is off, or has just been switched on, has samples of nothing.
TEST_F(Sources, ABlindStartMeasuresNothing) {
  const struct {
    bool powered;
    std::uint16_t blind;
    bool measures;
  } cases[] = {{true, 0, true}, {true, 2, false}, {false, 0, false}};
  for (const auto& c : cases) {
    run_with(POSITION_OBSERVER);
    see(1);
    drive.samples.windows[0].current_q20 = {raw(1.0, 20), 0};
    drive.control.measured_q20 = {0, 0};
    drive.state = DRIVE_START;
    drive.schedule.turning = false;
    drive.start.powered = c.powered;
    drive.start.blind = c.blind;
    estimate();
    EXPECT_EQ(measured().d != 0, c.measures) << c.powered << c.blind;
  }
}

// By the torque of the measured current; while the polarity is open its sign is, too.
TEST_F(Sources, TheTorqueAcceleratesOnceThePolarityIsKnown) {
  const Motor m;
  for (const bool starting : {false, true}) {
    run_with(POSITION_OBSERVER);
    see(0);
    drive.control.measured_q20 = {0, raw(4.0, 20)};
    drive.schedule.turning = !starting;
    drive.inertia.phase = INERTIA_RUN_UP;
    drive.inertia.start_base_q8 = raw(-3.0, 8);
    drive.inertia.gained_bpp = 100;
    estimate();
    const double accel =
        starting ? 0.0
                 : m.torque_constant() * 4.0 * m.pole_pairs / m.inertia * kPeriod * kPeriod / kTurn * 4294967296.0;
    EXPECT_NEAR(real(drive.position.torque_accel_q8, 8), accel, 1e-3 * accel);
    EXPECT_NEAR(drive.inertia.gained_bpp, 103.0 + accel, 1.0 + 1e-3 * accel) << "every period counts";
  }
}

// A source that looks on is told what its own angle makes of the current.
TEST_F(Sources, WhileAVectorIsTurnedTheTorqueIsThatOfTheAngleSeen) {
  run_with(POSITION_OBSERVER);
  see(0);
  drive.state = DRIVE_START;
  drive.start.phase = START_TURN;
  drive.start.powered = true;
  drive.start.seen.angle_bam = kHere + 0x40000000u;  // a quarter turn ahead: i_d is i_q against the rotation there
  drive.control.measured_q20 = {raw(4.0, 20), 0};
  estimate();
  EXPECT_LT(drive.position.torque_accel_q8, -raw(1000.0, 8));
  drive.start.seen.angle_bam = drive.position.used.angle_bam;
  estimate();
  EXPECT_EQ(drive.position.torque_accel_q8, 0);
}

// The model moves where the schedule says so or has its turn, and makes K of the rest in the look's turn.
TEST_F(Sources, TheModelFollowsWhereItHasItsPeriod) {
  for (int turn = 0; turn <= TURNS; ++turn) {
    for (const bool moves : {false, true}) {
      for (const bool watched : {false, true}) {
        run_with(POSITION_OBSERVER);
        see(0);
        drive.model = drive.config.nameplate;
        drive.watch.open = watched;
        drive.schedule.moves = moves;
        drive.control.measured_q20.q = raw(2.5, 20);
        const std::int32_t k = drive.model.k_dq_q24;
        drive.model.k_dq_q24 = 0;
        drive.position.observer.is_sensitive = true;
        drive.position.observer.sensitivity = {};
        estimate(static_cast<turn_t>(turn));
        const bool follows = moves || turn == TURN_MOVE;
        EXPECT_EQ(drive.model.iq_q20, follows ? raw(2.5, 20) : 0) << turn << moves;
        EXPECT_EQ(drive.model.k_dq_q24 == k, turn == TURN_LOOK && !watched) << turn << watched;
        see(1);
        drive.control.measured_q20.q = raw(2.5, 20);
        estimate(static_cast<turn_t>(turn));
        EXPECT_EQ(drive.position.observer.sensitivity.saliency_q30 != 0, follows) << "of the observer, with the model";
      }
    }
  }
}

// Skipped windows are not looked at, and the covariance is renewed where the schedule says so.
TEST_F(Sources, TheScheduleDecidesOnWindowsAndCovariance) {
  for (const bool skips : {false, true}) {
    for (const bool renews : {false, true}) {
      run_with(POSITION_OBSERVER);
      see_machine(kHere);
      deviation_observer_t& o = drive.position.observer;
      o.p_aa = o.p_ss = raw(0.02, 20);
      o.p_ll = raw(0.02, 20);
      drive.schedule.skips = skips;
      drive.schedule.renews = renews;
      estimate();
      EXPECT_EQ(o.left.span_ticks, skips ? 0 : 6000) << renews;
      EXPECT_EQ(o.gathered.periods == 0, renews) << skips;
    }
  }
}

// A load that may fall on a held shaft is followed at once.
TEST_F(Sources, AHeldShaftHasTheFastObserver) {
  std::int32_t grown[2];
  for (const bool held : {false, true}) {
    run_with(POSITION_OBSERVER);
    parameters.map_known = 1;
    ASSERT_TRUE(drive_config_load(&drive.config));
    drive.hold.left = held ? 100 : 0;
    drive.schedule.renews = true;
    deviation_observer_t& o = drive.position.observer;
    o.p_aa = o.p_as = o.p_al = o.p_ss = o.p_sl = 0;
    o.p_ll = raw(0.02, 20);
    see(0);
    estimate();
    grown[held] = o.p_ll - raw(0.02, 20);
  }
  EXPECT_GT(grown[1], 3 * grown[0]);
}

// Beside the observer AVV turns the windows into its own frame.
TEST_F(Sources, AvvBesideTheObserverSeesItsOwnError) {
  run_with(POSITION_OBSERVER_AVV);
  blend(BLEND_BOTH, 0.5);
  drive.position.avv.observer.angle_bam = kThere;
  see_machine(kHere);
  estimate();
  EXPECT_NEAR(rad(drive.position.avv.error_bam), -rad(kThere - kHere), 0.01);
  EXPECT_EQ(drive.position.low.angle_bam, drive.position.observer.angle_bam);
  EXPECT_EQ(drive.position.high.angle_bam, drive.position.avv.observer.angle_bam);
  const double low = rad(drive.position.low.angle_bam - kHere), high = rad(drive.position.high.angle_bam - kHere);
  EXPECT_NEAR(rad(drive.position.used.angle_bam - kHere), 0.5 * (low + high), 0.01 * (high - low) + 1e-3);
}

// Beyond 15 degrees the regression is not linear; it is asked in its own turn, and stands until the next.
TEST_F(Sources, AvvLearnsWithin15DegreesOnly) {
  for (const double degrees : {-16.0, -14.0, 14.0, 16.0}) {
    for (const turn_t turn : {TURN_REGRESS, TURN_MOVE}) {
      run_with(POSITION_AVV);
      const std::uint32_t there = kHere + bam(degrees * kDegree);
      see_machine(there);
      const bool before = std::fabs(degrees) > 15.0;
      drive.position.is_near = before;
      estimate(turn);
      EXPECT_NEAR(rad(drive.position.avv.error_bam) / kDegree, degrees, 0.3);
      EXPECT_EQ(drive.position.is_near, turn == TURN_REGRESS ? !before : before) << degrees;
    }
  }
}

// What the sensors' mismatch, the admittance's error and a voltage's leave in the observer's regression.
class Learning : public Sources {
 protected:
  void learn_with(std::int32_t source) {
    run_with(source);
    see(0);
    drive.model = drive.config.nameplate;
    sensor_match_reset(&drive.position.sensors);
    drive.trim.mismatch_q30 = 0;
    drive.position.is_near = true;
    drive.modulation.state.is_alternating = true;
    drive.model.iq_q20 = raw(3.0, 20);
    regression_t r = {};
    r.spread_q8 = raw(30000.0, 8);
    r.along_q16 = raw(40.0, 16);
    r.curl_q16 = raw(20.0, 16);
    r.mean_q20 = {0, raw(0.01, 20)};
    r.information = 1000000;
    drive.position.observer.regression = r;
  }
  static bool admittances() { return drive.model.trim.mean_q30 != 0; }
  static bool sensors() { return drive.position.sensors.mismatch_q30 != 0; }
  static bool voltage() { return drive.model.trim.rs_q24 != 0 || drive.model.trim.psi_q16 != 0; }
};

// Admittances and sensors in one turn, resistance and flux in another: once it runs, and near enough.
TEST_F(Learning, ADriveThatRunsLearnsEachInItsTurn) {
  for (int turn = 0; turn <= TURNS; ++turn) {
    if (turn == TURN_REGRESS || turn == TURN_LOOK) continue;
    for (const bool near : {true, false}) {
      for (const bool alternating : {true, false}) {
        learn_with(POSITION_OBSERVER);
        drive.position.is_near = near;
        drive.modulation.state.is_alternating = alternating;
        estimate(static_cast<turn_t>(turn));
        EXPECT_EQ(admittances(), near && turn == TURN_LIKENESS) << turn;
        EXPECT_EQ(sensors(), near && turn == TURN_LIKENESS && alternating) << turn << "all directions, or none";
        EXPECT_EQ(voltage(), near && turn == TURN_VOLTAGE) << turn;
        EXPECT_EQ(drive.trim.mismatch_q30, drive.position.sensors.mismatch_q30);
      }
    }
  }
}

// A period with three windows has no room for the polarity's watch beside it.
TEST_F(Learning, TheWatchTakesTheVoltagesTurnOfAFullPeriod) {
  for (const std::uint16_t count : {2, 3}) {
    for (const bool watched : {true, false}) {
      learn_with(POSITION_OBSERVER);
      see(count);
      drive.watch.open = watched;
      estimate(TURN_VOLTAGE);
      EXPECT_EQ(voltage(), !(watched && count == 3));
    }
  }
}

// A turn takes 5/4 as long as the places say, and twice that while the shaft turns, where half as much again is learnt.
TEST_F(Learning, SharesAreThoseOfTheParametersTimes) {
  learn_with(POSITION_OBSERVER);
  const double y0 = 0.5 * (real(drive.model.yd_q30, 30) + real(drive.model.yq_q30, 30));
  estimate(TURN_LIKENESS);
  const double share = 1.5 * real(drive.config.adapt_share_q30, 30);
  EXPECT_NEAR(real(drive.model.trim.mean_q30, 30) / (share * 40.0 / 30000.0), 1.0, 1e-3);
  EXPECT_NEAR(real(drive.trim.mismatch_q30, 30) / (share * std::sqrt(3.0) * 20.0 / 30000.0 / y0), 1.0, 1e-3);
  learn_with(POSITION_OBSERVER);
  drive.position.used.speed_bpp = drive.position.observer.speed_bpp = bpp(60.0);
  drive.model.trim.psi_variance_q32 = 0;
  machine_model_t model = drive.model;
  voltage_match_step(&model, &drive.position.observer.regression, raw(60.0 * kPeriod, 30),
                     raw(1.5 * real(drive.config.drift_share_q30, 30), 30));
  estimate(TURN_VOLTAGE);
  EXPECT_NE(model.trim.rs_q24, 0);
  EXPECT_NEAR(drive.model.trim.rs_q24, model.trim.rs_q24, 2 + std::abs(model.trim.rs_q24) / 100);
  EXPECT_NEAR(drive.model.trim.psi_q16, model.trim.psi_q16, 2 + std::abs(model.trim.psi_q16) / 100);
}

// A start learns admittances in their turn and the sensors in the voltage's, with 5/4 of the share.
TEST_F(Learning, AStartLearnsTheSensorsInTheVoltagesTurn) {
  for (const turn_t turn : {TURN_LIKENESS, TURN_VOLTAGE, TURN_MOVE}) {
    learn_with(POSITION_OBSERVER);
    see_machine(kHere);
    for (int k = 0; k < 2; ++k) {
      drive.samples.windows[k].slope_q20.alpha += raw(k == 0 ? 0.2 : -0.2, 20);
      drive.samples.windows[k].slope_q20.beta += raw(k == 0 ? 0.1 : -0.1, 20);
    }
    drive.state = DRIVE_START;
    drive.schedule.turning = false;
    drive.start.powered = true;
    estimate(turn);
    EXPECT_EQ(admittances(), turn == TURN_LIKENESS) << turn;
    EXPECT_EQ(sensors(), turn == TURN_VOLTAGE) << turn;
    EXPECT_FALSE(voltage());
    if (turn != TURN_LIKENESS) continue;
    const regression_t& r = drive.position.avv.regression;
    const double wanted = 1.25 * real(drive.config.adapt_share_q30, 30) * real(r.along_q16, 16) / real(r.spread_q8, 8);
    EXPECT_NEAR(real(drive.model.trim.mean_q30, 30) / wanted, 1.0, 1e-2);
  }
}

// A commissioning at standstill has AVV, which learns where it is told to, or the torque alone.
TEST_F(Learning, ACommissioningLearnsWhereItAdapts) {
  for (const bool adapting : {true, false}) {
    for (const bool predicting : {true, false}) {
      learn_with(POSITION_FLUX_CONV);
      see_machine(kHere);
      drive.samples.windows[0].slope_q20.alpha += raw(0.2, 20);
      drive.state = DRIVE_COMMISSION;
      drive.schedule.turning = false;
      drive.commissioning.turning = false;
      drive.commissioning.adapting = adapting;
      drive.commissioning.predicting = predicting;
      drive.position.avv.observer = {kThere, 1000, raw(500.0, 8), 0};
      drive.control.measured_q20 = {0, 0};
      const std::int32_t error = drive.position.avv.error_bam = 4711;
      estimate(TURN_LIKENESS);
      EXPECT_EQ(admittances(), adapting && !predicting);
      EXPECT_EQ(drive.position.avv.error_bam == error, predicting) << "no measurement at all";
      EXPECT_EQ(drive.position.used.angle_bam, drive.position.avv.observer.angle_bam);
      if (!predicting) continue;
      EXPECT_EQ(drive.position.used.angle_bam, kThere + 1000u);
      EXPECT_EQ(drive.position.used.speed_bpp, 1000) << "the load as of now is left out";
      EXPECT_EQ(drive.position.used.load_accel_q8, raw(500.0, 8));
      EXPECT_EQ(drive.position.used.quality_q15, 32767);
    }
  }
}

// The spin of a commissioning runs on the observer, whatever the source.
TEST_F(Sources, ACommissioningsSpinRunsOnTheObserver) {
  run_with(POSITION_ENCODER);
  drive.state = DRIVE_COMMISSION;
  drive.commissioning.turning = true;
  drive.position.observer.angle_bam = kThere;
  drive.position.encoder.angle_bam = kHere;
  estimate();
  EXPECT_EQ(drive.position.used.angle_bam, drive.position.observer.angle_bam);
  EXPECT_NEAR(rad(drive.position.used.angle_bam - kThere), 0.0, 0.01);
}

// Angle from the count and what was found at the start, speed by a tracking observer; the trim turns the frame alone.
TEST_F(Sources, TheEncoderHasAngleAndSpeed) {
  run_with(POSITION_ENCODER);
  board.encoder = 3000;
  position_align_encoder(&drive, kHere, bpp(80.0));
  EXPECT_EQ(drive.position.encoder.angle_bam, kHere);
  EXPECT_EQ(drive.position.encoder.speed_bpp, bpp(80.0));
  see(0);
  for (int n = 1; n <= 3000; ++n) {
    board.encoder = static_cast<std::uint32_t>(3000 + 3 * n) % 4096u;  // 12 electrical steps of a period
    estimate();
  }
  const double speed = 3.0 / 4096.0 * 4.0 * kTurn / kPeriod;
  EXPECT_NEAR(rad_per_s(drive.position.used.speed_bpp), speed, 1e-3 * speed);
  const double angle = rad(kHere) + std::fmod(9000.0, 1024.0) / 1024.0 * kTurn;
  EXPECT_NEAR(wrapped(rad(drive.position.used.angle_bam) - angle), 0.0, 0.01);
  EXPECT_EQ(drive.position.used.quality_q15, 32767);
  drive.config.encoder_trim_bam = bam(0.5);
  estimate();
  EXPECT_EQ(drive.position.low.angle_bam, drive.position.encoder.angle_bam);
  EXPECT_EQ(drive.position.used.angle_bam, drive.position.encoder.angle_bam + bam(0.5));
  EXPECT_EQ(drive.position.used.speed_bpp, drive.position.encoder.speed_bpp);
}

// An angle that is off is taken up within the long windows' bandwidth, three poles at once.
TEST_F(Sources, TheEncodersObserverHasTheLongWindowsBandwidth) {
  run_with(POSITION_ENCODER);
  see(0);
  position_align_encoder(&drive, kHere, 0);
  drive.position.encoder.angle_bam = kHere - bam(0.01);
  estimate();
  EXPECT_NEAR(rad(drive.position.encoder.angle_bam - kHere), -0.01 * (1.0 - 3.0 * 200.0 * kPeriod), 1e-6);
}

TEST_F(Sources, TheEncodersSpeedHasTheModelsEnd) {
  run_with(POSITION_ENCODER);
  position_align_encoder(&drive, kHere, INT32_MAX);
  EXPECT_EQ(drive.position.encoder.speed_bpp, MACHINE_SPEED_END_BPP);
}

// D of the zero vectors, in the frame in use, trim included.
TEST_F(Sources, BesideTheEncoderTheDeviationIsThatOfTheFrameInUse) {
  run_with(POSITION_ENCODER);
  position_align_encoder(&drive, kHere, 0);
  drive.config.encoder_trim_bam = bam(0.3);
  drive.samples.windows[0].slope_q20 = {raw(0.02, 20), raw(0.01, 20)};
  estimate();
  const Vector slope = Vector{0.02, 0.01}.turned(-rad(kHere) - 0.3);
  EXPECT_NEAR(real(drive.position.deviation_q20, 20), slope.y, 1e-4);
  EXPECT_NE(drive.position.avv.regression.information, 1) << "AVV looks on";
}

// Beside the encoder AVV looks on in its own frame, or a stator flux in its place.
TEST_F(Sources, BesideTheEncoderSomebodyLooksOn) {
  for (const std::int32_t beside : {0, 1}) {
    run_with(POSITION_ENCODER);
    position_align_encoder(&drive, kHere, 0);
    parameters.flux_beside = beside;
    drive.position.avv.observer.angle_bam = kThere;
    see_machine(kHere);
    estimate();
    if (beside == 0) {
      EXPECT_NEAR(rad(drive.position.avv.error_bam), -rad(kThere - kHere), 0.01);
      EXPECT_EQ(drive.position.high.angle_bam, drive.position.avv.observer.angle_bam);
    } else {
      EXPECT_EQ(drive.position.avv.error_bam, 0);
      EXPECT_EQ(drive.position.high.angle_bam, drive.position.encoder.angle_bam) << "at rest the flux follows";
    }
  }
}

// Below its lower speed a flux that looks on follows the truth; from there on it says what it sees, either way round.
TEST_F(Sources, AFluxLooksOnFromItsLowerSpeedOn) {
  for (const int rpm : {-120, -80, 80, 120}) {
    run_with(POSITION_ENCODER);
    parameters.flux_low = raw(100.0, 16);
    const estimator_output_t there = {kThere, 0, 0, 32767}, truth = {kHere, bpp_of(rpm), 33, 32767};
    flux_source_follow(&drive, &there);
    const estimator_input_t in = {&drive.model, drive.samples.windows, 0, 0, false, false, false, nullptr};
    const estimator_output_t out = flux_source_look_on(&drive, &in, &truth);
    const bool follows = std::abs(rpm) < 100;
    EXPECT_EQ(out.angle_bam == kHere, follows) << rpm;
    EXPECT_EQ(drive.position.flux.observer.angle_bam == kHere, follows) << rpm;
    EXPECT_EQ(out.load_accel_q8 == 33, follows);
  }
}

// The voltage of the period before, less the devices' drops and what the resistance takes, is what the flux grows by;
// the current is that at the period's end.
TEST_F(Sources, TheFluxIntegratesTheVoltageOfThePeriodsPulses) {
  for (const bool watched : {false, true}) {
    run_with(POSITION_FLUX_CONV);
    blend(BLEND_HIGH, 0.0);
    drive.watch.open = watched;  // then the observer goes on beside it
    see(0);
    const double speed = 0.2;
    const Vector current = {-1.0, 6.0};
    drive.position.used = {kHere, raw(speed / kTurn, 32), 0, 32767};
    drive.position.observer.speed_bpp = drive.position.used.speed_bpp;
    drive.control.measured_q20 = drive.control.reference_q20 = raw_dq(current, 20);
    flux_source_follow(&drive, &drive.position.used);
    drive.samples.link_q16 = raw(310.0, 16);
    for (int leg = 0; leg < 3; ++leg) {
      drive.modulation.sampled.pulses.at[leg] = static_cast<std::int16_t>(1000 + 500 * leg);
      drive.modulation.sampled.pulses.at[3 + leg] = static_cast<std::int16_t>(6000 - 700 * leg);
    }
    const Vector before = real(drive.position.flux.flux_q16, 16);
    const Vector from = current.turned(rad(kHere)), to = current.turned(rad(kHere) + speed);
    estimate();
    EXPECT_NEAR((real(drive.position.flux.current_q20, 20) - to).length(), 0.0, 1e-4);
    const Vector mean = real(svpwm_mean_q16(&drive.modulation.sampled.pulses, raw(310.0, 16)), 16);
    const Vector drop = real(dead_time_drop_q16(&drive.config.dead_time, raw_ab(to, 20)), 16);
    const Vector grown = mean - drop - (from + to) * (0.5 * real(drive.model.rs_q24, 24));
    EXPECT_GT(grown.length(), 20.0);
    // The low-pass forgets some thousandths of a flux of 1600 V.
    EXPECT_NEAR((real(drive.position.flux.flux_q16, 16) - before - grown).length(), 0.0, 8.0);
    EXPECT_EQ(drive.position.high.angle_bam, drive.position.flux.observer.angle_bam);
    if (watched) continue;
    EXPECT_EQ(drive.position.low.angle_bam, drive.position.high.angle_bam);
    EXPECT_EQ(drive.position.used.angle_bam, drive.position.high.angle_bam);
    // The observer goes along, so that it is right when it is wanted again.
    EXPECT_EQ(drive.position.observer.angle_bam, drive.position.high.angle_bam);
    EXPECT_EQ(drive.position.observer.speed_bpp, drive.position.high.speed_bpp);
    EXPECT_EQ(drive.position.observer.load_accel_q8, drive.position.high.load_accel_q8);
  }
}

// The drops of the devices are those of the current at the period's end, along both axes.
TEST_F(Sources, WhatTheDevicesTakeIsNotTheFluxs) {
  Vector flux[2];
  const Vector current = {-1.0, 6.0};
  const double volts = 4.0;
  Vector drop = {};
  for (const bool drops : {false, true}) {
    run_with(POSITION_FLUX_CONV);
    blend(BLEND_HIGH, 0.0);
    see(0);
    drive.config.dead_time.drop_q16 = drops ? raw(volts, 16) : 0;
    dead_time_design(&drive.config.dead_time);
    drive.control.measured_q20 = raw_dq(current, 20);
    flux_source_follow(&drive, &drive.position.used);
    estimate();
    flux[drops] = real(drive.position.flux.flux_q16, 16);
    drop = real(dead_time_drop_q16(&drive.config.dead_time, raw_ab(current.turned(rad(kHere)), 20)), 16);
  }
  EXPECT_GT(std::min(std::fabs(drop.x), std::fabs(drop.y)), 1.0);
  EXPECT_NEAR(flux[1].x - flux[0].x, -drop.x, 0.05);
  EXPECT_NEAR(flux[1].y - flux[0].y, -drop.y, 0.05);
}

// Between the speeds the flux has no time to learn where the observer has windows; where these are left out it has.
TEST_F(Sources, BesideTheObserverTheFluxLearnsWithoutWindows) {
  for (const std::uint16_t windows : {0, 2}) {
    run_with(POSITION_FLUX_CONV);
    blend(BLEND_BOTH, 0.5);
    flux_source_follow(&drive, &drive.position.used);
    drive.position.flux.pause = 1;
    see(windows);
    drive.schedule.skips = false;
    board.profile.clear();
    estimate();
    EXPECT_EQ(drive.position.flux.pause > 1, windows == 0);
    EXPECT_EQ(spent(), CYCLES_ESTIMATE_FLUX) << "for the virtual chip";
  }
}

TEST_F(Sources, TheFluxMayBeGivenTheShaftAtAnySpeed) {
  run_with(POSITION_FLUX_CONV);
  EXPECT_FALSE(flux_source_rests(&drive));
  flux_source_take(&drive);
  EXPECT_TRUE(flux_source_rests(&drive));
}

// The frame is the vector's, turned on; who looks on is set at rest, and runs from there on.
TEST_F(Sources, WhileAVectorIsTurnedTheSourceLooksOn) {
  for (const bool aligned : {false, true}) {
    run_with(POSITION_OBSERVER);
    see(0);
    drive.state = DRIVE_START;
    drive.start.phase = START_TURN;
    drive.start.powered = true;
    drive.config.turn.align_periods = 500;
    drive.start.turn.tick = aligned ? 500 : 499;
    drive.start.turn.angle_bam = kThere;
    drive.start.turn.speed_bpp = 4321;
    drive.position.used = {kHere, 1234, 0, 0};
    drive.position.observer.angle_bam = kThere;
    drive.position.observer.speed_bpp = 0;
    estimate();
    EXPECT_EQ(drive.position.used.angle_bam, kThere + 4321u);
    EXPECT_EQ(drive.position.used.speed_bpp, 4321);
    EXPECT_EQ(drive.start.seen.angle_bam, drive.position.observer.angle_bam);
    EXPECT_NEAR(rad(drive.start.seen.angle_bam - (aligned ? kThere : kHere)), 0.0, 1e-3);
    EXPECT_EQ(drive.position.avv.observer.angle_bam, kHere) << "all of them are set at rest";
  }
}

// A flux has no integral before the vector has its speed: until then it follows the vector.
TEST_F(Sources, AFluxFollowsAVectorUntilItIsUp) {
  for (const bool up : {false, true}) {
    run_with(POSITION_FLUX_CONV);
    see(0);
    blend(BLEND_HIGH, 0.0);
    drive.state = DRIVE_START;
    drive.start.phase = START_TURN;
    drive.start.powered = true;
    drive.start.turn.tick = drive.config.turn.align_periods = 500;
    drive.start.turn.angle_bam = kThere;
    drive.start.turn.speed_bpp = drive.config.turn.speed_bpp - (up ? 0 : 1);
    drive.position.used = {kHere, 1234, 0, 0};
    drive.position.flux.observer.angle_bam = kThere;
    estimate();
    EXPECT_EQ(drive.position.flux.observer.angle_bam == kHere, !up);
    EXPECT_EQ(drive.start.seen.angle_bam, drive.position.flux.observer.angle_bam);
    EXPECT_EQ(drive.position.used.angle_bam, kThere + static_cast<std::uint32_t>(drive.start.turn.speed_bpp));
  }
}

// While a vector is turned the references are in the vector's frame, and the flux knows them in its own.
TEST_F(Sources, AFluxThatLooksOnKnowsTheCurrentsInItsOwnFrame) {
  // PP-02 takes the flux's length from the references: along its own axis they change it, across they turn it.
  std::uint32_t seen[2];
  for (const bool turned : {false, true}) {
    run_with(POSITION_FLUX_CONV + FLUX_PP02);
    see(0);
    blend(BLEND_HIGH, 0.0);
    drive.state = DRIVE_START;
    drive.start.phase = START_TURN;
    drive.start.powered = true;
    drive.start.turn.tick = drive.config.turn.align_periods;
    drive.start.turn.speed_bpp = drive.config.turn.speed_bpp;
    drive.control.reference_q20 = drive.control.measured_q20 = raw_dq({0.0, 14.0}, 20);
    drive.position.used = {kHere, 0, 0, 0};
    drive.start.seen.angle_bam = turned ? kHere - 0x40000000u : kHere;
    const estimator_output_t now = {kHere, bpp_of(600), 0, 0};
    flux_source_follow(&drive, &now);
    estimate();
    seen[turned] = drive.start.seen.angle_bam;
  }
  EXPECT_NE(seen[0], seen[1]);
}

TEST_F(Sources, EveryEstimatorStartsFromAnAngleAndASpeed) {
  for (const std::int32_t source : {POSITION_PAPER, POSITION_OBSERVER}) {
    run_with(source);
    blend(BLEND_BOTH, 0.5);
    drive.position.flux.machine.psi_q16 = 0;
    drive.position.avv.observer.load_accel_q8 = drive.position.observer.load_accel_q8 = 99;
    const std::int32_t speed = drive.config.blend.high_bpp + 1;
    position_preset(&drive, kThere, speed);
    const drive_position_t& p = drive.position;
    for (const estimator_output_t& out : {p.used, p.low, p.high}) {
      EXPECT_EQ(out.angle_bam, kThere);
      EXPECT_EQ(out.speed_bpp, speed);
      EXPECT_EQ(out.load_accel_q8, 0);
    }
    EXPECT_EQ(p.avv.observer.angle_bam, kThere);
    EXPECT_EQ(p.avv.observer.speed_bpp, speed);
    EXPECT_EQ(p.avv.observer.load_accel_q8, 0);
    EXPECT_EQ(p.observer.angle_bam, kThere);
    EXPECT_EQ(p.observer.speed_bpp, speed);
    EXPECT_EQ(p.observer.load_accel_q8, 0);
    EXPECT_EQ(p.zvv.angle_bam, kThere);
    EXPECT_EQ(p.zvv.speed_bpp, speed);
    EXPECT_GT(p.flux.machine.psi_q16, 0) << "what was learnt of the machine is forgotten";
    // The paper's pair is right at once at any speed; the others begin with the low-speed estimator.
    EXPECT_EQ(p.blend.region, source == POSITION_PAPER ? BLEND_HIGH : BLEND_LOW);
    EXPECT_EQ(p.blend.share_q15, source == POSITION_PAPER ? 0 : 32767);
  }
}

TEST_F(Sources, NothingStartsFasterThanTheModelsEnd) {
  for (const int sign : {1, -1}) {
    run_with(POSITION_OBSERVER);
    position_preset(&drive, kThere, sign * 2000000000);
    const drive_position_t& p = drive.position;
    for (const std::int32_t speed : {p.used.speed_bpp, p.avv.observer.speed_bpp, p.observer.speed_bpp, p.zvv.speed_bpp})
      EXPECT_EQ(speed, sign * MACHINE_SPEED_END_BPP);
  }
}

// A start that looks for the axis has AVV alone at work.
TEST_F(Sources, AnAxisIsLookedForByAvvAlone) {
  run_with(POSITION_OBSERVER);
  position_preset_axis(&drive, kThere, 777);
  EXPECT_EQ(drive.position.used.angle_bam, kThere);
  EXPECT_EQ(drive.position.used.speed_bpp, 777);
  EXPECT_EQ(drive.position.avv.observer.angle_bam, kThere);
  EXPECT_EQ(drive.position.avv.observer.speed_bpp, 777);
  EXPECT_EQ(drive.position.observer.angle_bam, kHere);
}

// The paper's idle estimator has the other one's speed as well, and none of its load.
TEST_F(Sources, ThePapersIdleEstimatorKnowsTheSpeed) {
  run_with(POSITION_PAPER);
  see(1);
  blend(BLEND_LOW, 1.0);
  drive.position.zvv.speed_bpp = 5000;
  zvv_preset(&drive.position.zvv, kHere, 5000);
  drive.position.avv.observer.load_accel_q8 = 77;
  estimate();
  EXPECT_EQ(drive.position.avv.observer.speed_bpp, drive.position.zvv.speed_bpp);
  EXPECT_EQ(drive.position.avv.observer.load_accel_q8, 0);
  run_with(POSITION_PAPER);
  blend(BLEND_HIGH, 0.0);
  drive.position.avv.observer.speed_bpp = bpp_of(200);
  estimate();
  EXPECT_EQ(drive.position.zvv.speed_bpp, drive.position.avv.observer.speed_bpp);
  EXPECT_NEAR(rad_per_s(drive.position.zvv.speed_bpp), 200.0 / 60.0 * kTurn * 4.0, 1.0);
}

}  // namespace
