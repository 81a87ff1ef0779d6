// The start of a shaft that turns: its short circuits, and what is made of a pair. How the drive goes on from there is
// start_caught_frame_test.cpp.

#include "tests/firmware/start_caught.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"
#include "firmware/start/flying/flying.h"
#include "firmware/start/phases.h"
#include "firmware/start/start.h"
}

#include <algorithm>

namespace {

using namespace stillspin::test;

TEST_F(StartCaught, APairThatFitsGivesTheSpeed) {
  for (const double speed : {300.0, -300.0}) {
    SetUp();
    catch_at(speed, 1.0);
    EXPECT_EQ(inside::start_phase(), START_CATCH);
    EXPECT_TRUE(inside::loop_is_closed());
    EXPECT_NEAR(rad_per_s(flying_start.rotor.speed_bpp), speed, 1.0);
  }
}

// The short circuit lies some time back by then: the rotor is where it has turned to since.
TEST_F(StartCaught, TheRotorIsCarriedOnToTheRunningPeriod) {
  for (const double speed : {300.0, -300.0}) {
    SetUp();
    await_pulse();
    const std::uint32_t first = clock();
    see_pulse(0.5, 48.0);
    await_pulse();
    constexpr int kAgo = 47000;  // ticks, 4.7 periods
    const double turned = speed * (clock() - kAgo - first) * 1e-8;
    flying_pulse_t& p = flying_start.pulse;
    inside::window_count() = 0;
    p.windows = 2;
    p.first_tick = clock() - kAgo - 5000;
    p.last_tick = clock() - kAgo + 5000;
    p.first_q20 = p.last_q20 = raw_ab(Vector{2.0, 0.0}.turned(0.5 + turned), 20);
    p.drive_q16 = raw_ab(Vector{96.0, 0.0}.turned(0.5 + turned), 16);
    const double lag = rad(flying_evaluate(&p, &inside::model()).lag_bam);
    judge();
    ASSERT_EQ(inside::start_phase(), START_CATCH);
    // e = w lambda q, and the turning saliency has turned it against the rotation by the lag
    const double behind = std::copysign(kPi / 2.0 - lag, speed);
    const double there = 0.5 + turned - behind + speed * kAgo * 1e-8;
    EXPECT_NEAR(wrapped(rad(flying_start.rotor.angle_bam) - there), 0.0, 2e-3) << speed;
  }
}

// A magnet's flux that is an eighth off is taken as seen, up to three eighths; a small EMF says nothing of it.
TEST_F(StartCaught, AFluxThatIsOffIsTakenFromALargeEmf) {
  const struct {
    double speed, flux, taken;
  } cases[] = {{300.0, 1.05, 0.0},  {300.0, 1.25, 0.25},   {-400.0, 0.8, -0.2},
               {300.0, 1.7, 0.375}, {600.0, 0.5, -0.375},  {200.0, 1.2, 0.0} /* 38 V */,
               {300.0, 1.115, 0.0}, {300.0, 1.135, 0.135}, {400.0, 0.88, 0.0}};
  for (const auto& c : cases) {
    SetUp();
    catch_at(c.speed, c.flux);
    ASSERT_EQ(inside::start_phase(), START_CATCH) << c.flux;
    EXPECT_NEAR(1.0 * inside::model().trim.psi_q16 / inside::model().emf_q16, c.taken, 0.01)
        << c.speed << ", " << c.flux;
  }
}

// Two pulses between which nothing turned belong to no shaft. Four pairs, then it is a fault.
TEST_F(StartCaught, PairsThatDoNotFitAreTriedAgainFourTimes) {
  for (int pair = 1; pair <= 4; ++pair) {
    for (int k = 0; k < 2; ++k) {
      ASSERT_EQ(inside::state(), DRIVE_START) << pair;
      await_pulse();
      see_pulse(0.5, 48.0);
    }
    EXPECT_EQ(starting.tries, pair);
    EXPECT_FALSE(board.gates_on);
    EXPECT_FALSE(inside::loop_is_closed());
  }
  EXPECT_EQ(inside::state(), DRIVE_FAULT);
  EXPECT_EQ(inside::fault(), FAULT_POLARITY);
}

TEST_F(StartCaught, AShortCircuitWithoutSamplesIsNotJudged) {
  await_pulse();
  flying_start.pulse.windows = 0;
  inside::window_count() = 0;
  starting.tick = 100;
  start_state.step(&drive);
  EXPECT_EQ(inside::start_phase(), START_PULSE);
  EXPECT_EQ(flying_start.pulses, 0);
}

// Of the period in which the gates came on, only what lies behind that instant belongs to the short circuit; of the
// others all does.
TEST_F(StartCaught, WindowsBeforeTheGatesDoNotCount) {
  for (const int invalid : {2, 1, 0}) {
    for (const int on : {1000, 1290, 1300, 1310, 1500, 4000, 9000}) {
      inside::start_phase() = START_PULSE;
      inside::gates_off() = false;
      starting.tick = 0;
      inside::invalid_periods() = static_cast<std::uint16_t>(invalid);
      starting.on_tick = on;
      flying_begin(&flying_start.pulse);
      inside::window_count() = 2;
      for (int k = 0; k < 2; ++k) {
        estimator_window_t w = {};
        w.middle_tick = static_cast<std::int16_t>(2500 + 5000 * k);
        w.span_ticks = 2000;
        inside::windows()[k] = w;
      }
      start_state.step(&drive);
      int expected = 0;  // the devices switch 2 us after they are told
      for (const int begin : {1500, 6500}) expected += invalid == 0 || begin >= on + 200;
      EXPECT_EQ(flying_start.pulse.windows, expected) << invalid << ", " << on;
    }
  }
}

// In sixty degrees at the speed of the EMF: far enough to be told from noise, near enough for one turn alone.
TEST_F(StartCaught, TheNextPulseWaitsForSixtyDegrees) {
  for (const double speed : {25.0, 100.0, 300.0, 3000.0}) {
    SetUp();
    await_pulse();
    see_pulse(0.5, speed * Motor{}.flux);
    ASSERT_EQ(inside::start_phase(), START_LISTEN);
    const double wait = kPi / 3.0 / speed / kPeriod;
    EXPECT_NEAR(flying_start.pause, std::max(6.0, wait), wait < 6.0 ? 0.0 : 0.01 * wait + 1.0) << speed;
    EXPECT_FALSE(inside::loop_is_closed());
    await_pulse();
    EXPECT_EQ(flying_start.pulse.windows, 0) << "seen anew";
  }
}

// Beyond what drops and noise can fake.
TEST_F(StartCaught, AnEmfBelowThreeVoltsIsAShaftThatStands) {
  for (const double volts : {2.9, 3.1}) {
    SetUp();
    await_pulse();
    see_pulse(0.5, volts);
    EXPECT_EQ(inside::start_phase(), volts < 3.0 ? START_AXIS : START_LISTEN);
    EXPECT_EQ(inside::is_shorted(), volts > 3.0);
    EXPECT_EQ(board.gates_on, volts < 3.0);
  }
}

// A sixteenth of the largest current is enough to be looked at; without it a pulse takes its time.
TEST_F(StartCaught, APulseEndsWithItsCurrentOrItsTime) {
  const double enough = real(parameters.current_limit, 20) / 16.0;
  for (const double share : {0.97, 1.03}) {
    for (const int tick : {11, 12}) {
      SetUp();
      await_pulse();
      inside::window_count() = 0;
      starting.tick = static_cast<std::uint16_t>(tick - 1);
      flying_start.pulse.windows = 1;
      flying_start.pulse.last_q20 = {0, raw(-share * enough, 20)};
      start_state.step(&drive);
      EXPECT_EQ(board.gates_on, share < 1.0 && tick < 12) << share << " " << tick;
    }
  }
}

// As long as it was told, with the gates off and the short circuit as what the modulator gives.
TEST_F(StartCaught, AStartListensForItsPause) {
  inside::start_phase() = START_PULSE;  // which has told how long
  flying_start.pause = 10;
  listen_phase.begin(&drive);
  EXPECT_TRUE(inside::is_shorted());
  for (int n = 1; n < 10; ++n) start_state.step(&drive);
  EXPECT_EQ(inside::start_phase(), START_LISTEN);
  EXPECT_FALSE(board.gates_on);
  start_state.step(&drive);
  EXPECT_EQ(inside::start_phase(), START_PULSE);
  EXPECT_TRUE(board.gates_on);
}

}  // namespace
