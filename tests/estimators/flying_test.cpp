// Short circuits of a turning machine, integrated from the stationary-frame equation.

#include <gtest/gtest.h>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/flying.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

struct Shaft {
  Motor motor;
  double theta, w;  // rad, rad/s, at time 0
};

constexpr double kStep = 1e-6;
constexpr int kMiddles[] = {2150, 5450, 8350};

// A short circuit from `start` (s) on, its windows of `periods` periods from the next one on.
flying_emf_t pulse(const Shaft& s, const machine_model_t& model, double start, int periods, Vector i = {0, 0}) {
  flying_pulse_t p;
  flying_begin(&p);
  const double lead = 0.42e-4;  // the gates come on in the middle of a period
  double t = start;
  for (int n = 0; n < periods; ++n) {
    for (const int middle : kMiddles) {
      const double until = start + lead + (n + middle * 1e-4) * kPeriod;
      for (; t < until; t += kStep) i = i + current_derivative(s.motor, s.theta + s.w * t, s.w, i, {0, 0}) * kStep;
      estimator_window_t w = {};
      w.current_q20 = raw_ab(i, 20);
      w.middle_tick = static_cast<std::int16_t>(middle);
      flying_add(&p, &model, &w, static_cast<std::int32_t>(std::lround(t * 1e8)));
    }
  }
  return flying_evaluate(&p, &model);
}

struct Found {
  bool clear;
  double angle_error, speed;  // degrees, rad/s
};

Found catch_it(const Shaft& s, const machine_model_t& model, int periods) {
  const flying_emf_t first = pulse(s, model, 1e-3, periods);
  const int pause = flying_pause(&first, &model, 6, 600);
  const flying_emf_t second = pulse(s, model, 1e-3 + (periods + 1 + pause) * kPeriod, periods);
  flying_rotor_t r;
  const bool clear = flying_resolve(&first, &second, &model, &r);
  const double truth = s.theta + s.w * r.tick * 1e-8;
  return {clear, wrapped(rad(r.angle_bam) - truth) / kDegree, rad_per_s(r.speed_bpp)};
}

// Left are resistance and the second order of the turn within a pulse.
TEST(Flying, AngleDirectionAndSpeedFromSixtyToThreeThousandRpm) {
  const Motor m;
  const machine_model_t model = model_of(m);
  for (const double rpm : {60.0, 200.0, 1000.0, 3000.0}) {
    for (const double sign : {1.0, -1.0}) {
      for (int k = 0; k < 12; ++k) {
        const Shaft s = {m, k * 30.0 * kDegree, sign * m.electrical(rpm)};
        const Found f = catch_it(s, model, rpm > 500.0 ? 1 : 6);
        EXPECT_TRUE(f.clear) << sign * rpm;
        EXPECT_NEAR(f.angle_error, 0.0, 2.0) << sign * rpm << " at " << k * 30;
        EXPECT_NEAR(f.speed / s.w, 1.0, 0.03) << sign * rpm << " at " << k * 30;
      }
    }
  }
}

TEST(Flying, ParametersThirtyPercentOff) {
  const machine_model_t model = model_of(Motor{});
  for (const double inductance : {0.7, 1.3}) {
    for (const double flux : {0.7, 1.3}) {
      Motor m;
      m.ld *= inductance;
      m.lq *= inductance;
      m.flux *= flux;
      m.rs *= inductance;
      for (const double rpm : {-3000.0, -100.0, 100.0, 3000.0}) {
        const Shaft s = {m, 0.7, m.electrical(rpm)};
        const Found f = catch_it(s, model, std::fabs(rpm) > 500.0 ? 1 : 6);
        EXPECT_TRUE(f.clear) << rpm;
        EXPECT_NEAR(f.angle_error, 0.0, 5.0) << rpm;
        EXPECT_NEAR(f.speed / s.w, 1.0, 0.05) << rpm;
      }
    }
  }
}

TEST(Flying, TheSizeOfTheEmf) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const Shaft s = {m, 0.3, m.electrical(500.0)};
  const flying_emf_t e = pulse(s, model, 0.0, 3);
  EXPECT_NEAR(real(e.size_q16, 16), m.flux * s.w, 0.03 * m.flux * s.w);  // resistance and turn, to first order
}

// At high speed one window is all that a pulse has: its bursts are its ends.
TEST(Flying, OneWindowIsEnough) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const Shaft s = {m, 0.8, m.electrical(3000.0)};
  Vector i = {0, 0};
  for (double t = 0.0; t < 0.3e-4; t += kStep) i = i + current_derivative(m, s.theta + s.w * t, s.w, i, {0, 0}) * kStep;
  const double span = 0.2e-4, middle = 0.3e-4;
  const Vector slope = current_derivative(m, s.theta + s.w * middle, s.w, i, {0, 0});
  estimator_window_t w = {};
  w.current_q20 = raw_ab(i, 20);
  w.change_q19 = raw_change(slope * kPeriod, 2000);
  w.span_ticks = 2000;
  flying_pulse_t p;
  flying_begin(&p);
  flying_add(&p, &model, &w, 3000);
  EXPECT_NEAR(real(flying_current(&p), 20),
              std::max(std::fabs(i.x + slope.x * span / 2), std::fabs(i.y + slope.y * span / 2)), 1e-4);
  const flying_emf_t e = flying_evaluate(&p, &model);
  EXPECT_EQ(e.tick, 3000);
  EXPECT_NEAR(real(e.size_q16, 16), m.flux * s.w, 0.02 * m.flux * s.w);
  const double emf_angle = s.theta + s.w * middle + kPi / 2 - rad(e.lag_bam);
  EXPECT_NEAR(wrapped(rad(e.direction_bam) - emf_angle) / kDegree, 0.0, 0.5);
}

TEST(Flying, AStandingShaftHasNone) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const flying_emf_t e = pulse({m, 0.3, 0.0}, model, 0.0, 12);
  EXPECT_EQ(e.size_q16, 0);
  EXPECT_EQ(flying_pause(&e, &model, 6, 600), 600);
}

// A turn that the size of the EMF does not explain: two pulses that saw different things.
TEST(Flying, ATurnThatDoesNotFitIsRefused) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const flying_emf_t first = {bam(0.0), raw(60.0, 16), 0, 0};
  flying_rotor_t r;
  const double w = 60.0 / m.flux;                                        // 375 rad/s
  const std::int32_t apart = static_cast<std::int32_t>(1.0 / w / 1e-8);  // one radian
  flying_emf_t second = {bam(1.0), raw(60.0, 16), apart, 0};
  EXPECT_TRUE(flying_resolve(&first, &second, &model, &r));
  second.direction_bam = bam(0.1);  // hardly any
  EXPECT_FALSE(flying_resolve(&first, &second, &model, &r));
  second.direction_bam = bam(3.0);  // three times as much
  EXPECT_FALSE(flying_resolve(&first, &second, &model, &r));
}

TEST(Flying, WithoutWindowsNoCurrentIsKnown) {
  flying_pulse_t p;
  flying_begin(&p);
  p.last_q20 = {raw(3.0, 20), 0};  // of another pulse
  EXPECT_EQ(flying_current(&p), 0);
}

// The turn between the pulses must fit the EMF's size within 2.5 times, in both directions: else it was not the shaft.
TEST(Flying, TheTurnMustFitTheEmf) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const double w = 600.0 / 60.0 * m.pole_pairs * kTurn;
  for (const double factor : {0.35, 0.45, 1.0, 2.2, 2.8}) {
    flying_emf_t first = pulse({m, 0.3, w}, model, 1e-3, 3);
    flying_emf_t second = first;
    const double seconds = 25.0 * kDegree / w;  // turns 25 degrees at its own speed
    second.tick = first.tick + static_cast<std::int32_t>(std::lround(seconds * 1e8));
    second.direction_bam = first.direction_bam + bam(25.0 * kDegree * factor);
    if (25.0 * factor < 15.0) second.tick = first.tick + static_cast<std::int32_t>(std::lround(seconds * 3.0 * 1e8));
    if (25.0 * factor < 15.0) second.direction_bam = first.direction_bam + bam(75.0 * kDegree * factor);
    flying_rotor_t r;
    EXPECT_EQ(flying_resolve(&first, &second, &model, &r), factor > 0.4 && factor < 2.5) << factor;
  }
}

// How sure the turn is: in standard deviations of an EMF that is a volt off.
TEST(Flying, TheTurnIsMeasuredInErrorsOfTheEmf) {
  const machine_model_t model = model_of(Motor{});
  flying_rotor_t r;
  const flying_emf_t small = {bam(0.0), raw(20.0, 16), 0, 0};
  const flying_emf_t large = {bam(-1.2), raw(60.0, 16), 100000, 0};
  (void)flying_resolve(&small, &large, &model, &r);
  EXPECT_NEAR(real(r.sigma_q8, 8), 1.2 * 20.0, 0.05);  // of the smaller EMF, whichever way the shaft turns
  (void)flying_resolve(&large, &small, &model, &r);
  EXPECT_NEAR(real(r.sigma_q8, 8), 1.2 * 20.0, 0.05);
}

// A turn of fifteen degrees or less is no turn.
TEST(Flying, ATurnOfFifteenDegreesIsTooSmall) {
  const Motor m;
  const machine_model_t model = model_of(m);
  for (const double degrees : {14.9, 15.1, -14.9, -15.1}) {
    const double w = 300.0;
    const auto apart = static_cast<std::int32_t>(std::lround(std::fabs(degrees) * kDegree / w * 1e8));
    const flying_emf_t first = {bam(0.7), raw(w * m.flux, 16), 0, 0};
    const flying_emf_t second = {bam(0.7 + degrees * kDegree), raw(w * m.flux, 16), apart, 0};
    flying_rotor_t r;
    EXPECT_EQ(flying_resolve(&first, &second, &model, &r), std::fabs(degrees) > 15.0) << degrees;
    EXPECT_NEAR(rad_per_s(r.speed_bpp), degrees > 0 ? w : -w, 0.1) << degrees;
  }
}

// Sixty degrees at the speed that the first pulse tells, within the ends that are asked for.
TEST(Flying, ThePauseIsASixthOfATurn) {
  const Motor m;
  const machine_model_t model = model_of(m);
  for (const double w : {20.0, 100.0, 600.0, 4000.0}) {
    const flying_emf_t e = {0, raw(w * m.flux, 16), 0, 0};
    const double periods = kPi / 3.0 / w / kPeriod;
    EXPECT_NEAR(flying_pause(&e, &model, 6, 300), std::clamp(periods, 6.0, 300.0), 1.0) << w;
  }
}

// What the devices and the resistance take is no EMF: with a current that stands still both are all there is.
TEST(Flying, ResistanceAndDropsAreTakenOff) {
  const Motor m;
  const machine_model_t model = model_of(m);
  flying_pulse_t p;
  flying_begin(&p);
  estimator_window_t w = {};
  w.current_q20 = raw_ab({6.0, -9.0}, 20);
  w.voltage_q19 = raw_ab({-1.0, 1.5}, 19);
  for (int k = 0; k < 3; ++k) flying_add(&p, &model, &w, 2000 + 3000 * k);
  const flying_emf_t e = flying_evaluate(&p, &model);
  const Vector expected = {-1.0 - m.rs * 6.0, 1.5 + m.rs * 9.0};
  EXPECT_NEAR(real(e.size_q16, 16), expected.length(), 1e-3);
  EXPECT_NEAR(wrapped(rad(e.direction_bam) - std::atan2(expected.y, expected.x)), 0.0, 1e-3);
}

// It is the mean of both sizes that the turn has to fit, between two fifths and five halves of it, whichever of the
// pulses was the stronger one.
TEST(Flying, TheTurnMustFitTheMeanOfBothSizes) {
  const Motor m;
  const machine_model_t model = model_of(m);
  const double turn = 40.0 * kDegree;
  for (const double share : {0.395, 0.405, 2.47, 2.53}) {
    for (const bool fades : {true, false}) {
      const double w = share * 40.0 / m.flux;
      const auto apart = static_cast<std::int32_t>(std::lround(turn / w * 1e8));
      const flying_emf_t first = {bam(-2.0), raw(fades ? 60.0 : 20.0, 16), 0, 0};
      const flying_emf_t second = {bam(-2.0 + turn), raw(fades ? 20.0 : 60.0, 16), apart, 0};
      flying_rotor_t r;
      EXPECT_EQ(flying_resolve(&first, &second, &model, &r), share > 0.4 && share < 2.5) << share << fades;
    }
  }
}

// The current in the middle of the pulse, half of which the first burst may have, lags by (Lq/Ld - 1) i / (yq
// lambda/T).
TEST(Flying, TheLagIsThatOfTheCurrentInTheMiddle) {
  const Motor m;
  const machine_model_t model = model_of(m);
  flying_pulse_t p = {};
  p.windows = 1;
  p.first_tick = 1000;
  p.last_tick = 4000;
  p.first_q20 = raw_ab({2.0, -1.0}, 20);
  p.last_q20 = raw_ab({6.0, -5.0}, 20);  // 4 A and -3 A between them
  const double lag = (m.lq / m.ld - 1.0) * 5.0 / (m.flux / m.lq);
  EXPECT_NEAR(rad(static_cast<std::uint32_t>(flying_evaluate(&p, &model).lag_bam)), lag, 1e-3 * lag);
  EXPECT_EQ(flying_evaluate(&p, &model).tick, 2500);
}

// A turn in no time is as fast as a speed can be told.
TEST(Flying, ASpeedBeyondTheFormatIsItsEnd) {
  const machine_model_t model = model_of(Motor{});
  for (const double turn : {1.0, -1.0}) {
    const flying_emf_t first = {bam(0.0), raw(60.0, 16), 0, 0}, second = {bam(turn), raw(60.0, 16), 100, 0};
    flying_rotor_t r;
    EXPECT_FALSE(flying_resolve(&first, &second, &model, &r));
    EXPECT_EQ(r.speed_bpp, turn > 0.0 ? MACHINE_SPEED_END_BPP : -MACHINE_SPEED_END_BPP);
    EXPECT_EQ(r.tick, 100);
  }
}

}  // namespace
