// The low-pass integrator: its two forms against the continuous ones in double precision.

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/estimators/flux_paper.hpp"

extern "C" {
#include "estimators/stator_flux.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::flux_paper;

constexpr double kCutoff = 20.0;  // rad/s
constexpr double kFlux = 0.0865;
constexpr std::int32_t kBound = INT32_MAX;

stator_flux_config_t config(stator_flux_form_t form) {
  const stator_flux_config_t c = {form, raw(kCutoff * kPeriod, 30), raw(0.5, 30)};
  return c;
}

ab_t raw_flux(Vector flux) { return raw_ab(flux * (1.0 / kPeriod), 16); }
Vector real_flux(ab_t raw_flux) { return real(raw_flux, 16) * kPeriod; }

// Mean EMF of a period in which the flux goes from one value to another: their difference over T, exactly.
ab_t emf(Vector from, Vector to, Vector offset = {0.0, 0.0}) {
  return raw_ab((to - from) * (1.0 / kPeriod) + offset, 16);
}

// The flux of a shaft that speeds up and slows down through both directions, under a changing load.
Vector course(double t) {
  const double theta = 60.0 * t + 150.0 * (1.0 - std::cos(1.5 * t));
  return Vector{kFlux * (1.0 + 0.2 * std::sin(3.0 * t)), 0.0}.turned(theta);
}

// Every step of the compensated form is one of Hu and Wu's three integrators in double precision, fed with the same
// EMF.
TEST(StatorFlux, CompensatedFormIsFigure5) {
  const stator_flux_config_t c = config(STATOR_FLUX_COMPENSATED);
  stator_flux_t s = {};
  const Vector start = course(0.0) + Vector{0.01, -0.006};  // an offset that both have to lose
  stator_flux_preset(&s, raw_flux(start));
  HuWu reference(kCutoff, 0.0, 0.5, start);
  double worst = 0.0;
  for (int n = 0; n < 30000; ++n) {
    const double t = n * kPeriod;
    stator_flux_step(&s, &c, emf(course(t), course(t + kPeriod)), 0, kBound);
    const auto rate = [&](double at) { return (course(at + 1e-7) - course(at - 1e-7)) * (0.5 / 1e-7); };
    reference.step(t, kPeriod, rate);
    worst = std::fmax(worst, (real_flux(stator_flux_q16(&s, &c)) - reference.flux()).length());
  }
  std::printf("Fig. 5 against two low-passes and a PI controller: worst %.1e of psi_m\n", worst / kFlux);
  EXPECT_LT(worst, 2e-3 * kFlux);  // first order in w_c T, 0.002
}

TEST(StatorFlux, CompensatedFormFindsLengthAndPhaseInBothDirections) {
  const stator_flux_config_t c = config(STATOR_FLUX_COMPENSATED);
  for (const double w : {-1257.0, -200.0, -20.0, 20.0, 200.0, 1257.0}) {
    stator_flux_t s = {};
    stator_flux_preset(&s, raw_flux({0.6 * kFlux, 0.3 * kFlux}));
    const auto truth = [&](double t) { return Vector{kFlux, 0.0}.turned(w * t); };
    int n = 0;
    for (; n < 60000; ++n) {
      stator_flux_step(&s, &c, emf(truth(n * kPeriod), truth((n + 1) * kPeriod)), bpp(w), kBound);
    }
    const Vector seen = real_flux(stator_flux_q16(&s, &c));
    EXPECT_NEAR(seen.length(), kFlux, 1e-4 * kFlux) << w;
    EXPECT_NEAR(wrapped(angle(seen) - angle(truth(n * kPeriod))), 0.0, 2e-4) << w;
  }
}

// An offset of the voltage does not run away: it leaves a circle off the middle by what the decay balances.
TEST(StatorFlux, OffsetOfTheVoltageStaysBounded) {
  const double offset = 0.05, w = 200.0;
  for (const stator_flux_form_t form : {STATOR_FLUX_COMPENSATED, STATOR_FLUX_BARE}) {
    const stator_flux_config_t c = config(form);
    stator_flux_t s = {};
    stator_flux_preset(&s, raw_flux({kFlux, 0.0}));
    const auto truth = [&](double t) { return Vector{kFlux, 0.0}.turned(w * t); };
    Vector sum{0.0, 0.0};
    const int turn = 314;  // periods of a turn, nearly
    for (int n = 0; n < 60000; ++n) {
      stator_flux_step(&s, &c, emf(truth(n * kPeriod), truth((n + 1) * kPeriod), {offset, 0.0}), bpp(w), kBound);
      if (n >= 60000 - 10 * turn) sum = sum + (real_flux(s.flux_q16) - truth((n + 1) * kPeriod)) * (0.1 / turn);
    }
    const double rate = form == STATOR_FLUX_BARE ? kCutoff : kCutoff / 4.0;
    EXPECT_NEAR(sum.length(), offset / rate, 0.25 * offset / rate) << form;
  }
}

TEST(StatorFlux, BareFormWithPhaseCompensation) {
  const stator_flux_config_t c = config(STATOR_FLUX_BARE);
  double worst = 0.0;
  for (const double w : {-1257.0, -200.0, -20.0, -6.0, 6.0, 20.0, 200.0, 1257.0}) {
    stator_flux_t s = {};
    const auto truth = [&](double t) { return Vector{kFlux, 0.0}.turned(0.4 + w * t); };
    stator_flux_preset(&s, raw_flux(truth(0.0)));
    for (int n = 0; n < 20000; ++n) {
      stator_flux_step(&s, &c, emf(truth(n * kPeriod), truth((n + 1) * kPeriod)), bpp(w), kBound);
      const double error = (real_flux(stator_flux_q16(&s, &c)) - truth((n + 1) * kPeriod)).length();
      // On its way to 0.3 of the unit vector, at 6 rad/s, what the low-pass shows is shorter for some time.
      if (std::fabs(w) > 10.0 || n > 5000) worst = std::fmax(worst, error);
    }
    const Vector seen = real_flux(stator_flux_q16(&s, &c));
    const Vector bare = real_flux(s.flux_q16);
    EXPECT_NEAR(wrapped(angle(seen) - angle(bare)), phase_compensation(kCutoff, w), 1e-4) << w;
    EXPECT_NEAR(seen.length(), bare.length() * std::hypot(1.0, kCutoff / w), 1e-4 * kFlux) << w;
  }
  std::printf("bare low-pass with (34): worst %.1e of psi_m\n", worst / kFlux);
  EXPECT_LT(worst, 1e-4 * kFlux);
}

// The low-pass alone leads, and is short.
TEST(StatorFlux, PlainFormIsTheLowPass) {
  const stator_flux_config_t c = config(STATOR_FLUX_PLAIN);
  for (const double w : {-200.0, -20.0, 20.0, 200.0}) {
    stator_flux_t s = {};
    const auto truth = [&](double t) { return Vector{kFlux, 0.0}.turned(0.4 + w * t); };
    stator_flux_preset(&s, raw_flux(truth(0.0)));
    for (int n = 0; n < 20000; ++n) {
      stator_flux_step(&s, &c, emf(truth(n * kPeriod), truth((n + 1) * kPeriod)), bpp(w), kBound);
    }
    const Vector seen = real_flux(stator_flux_q16(&s, &c));
    EXPECT_NEAR(wrapped(angle(seen) - angle(truth(2.0))), std::atan(kCutoff / w), 1e-4) << w;
    EXPECT_NEAR(seen.length(), kFlux / std::hypot(1.0, kCutoff / w), 1e-4 * kFlux) << w;
  }
}

// While the speed and the cut-off with it change, and through zero, (34) as printed takes the low-pass for settled.
TEST(StatorFlux, BareFormIsRightUnderAccelerationAndThroughZero) {
  stator_flux_config_t c = config(STATOR_FLUX_BARE);
  const auto truth = [](double t) { return Vector{kFlux, 0.0}.turned(60.0 * t + 37.5 * (1.0 - std::cos(6.0 * t))); };
  stator_flux_t s = {};
  stator_flux_preset(&s, raw_flux(truth(0.0)));
  double worst = 0.0;
  double printed = 0.0;
  for (int n = 0; n < 60000; ++n) {
    const double t = n * kPeriod;
    const double w = 60.0 + 225.0 * std::sin(6.0 * (t + 0.5 * kPeriod));
    const double cutoff = std::fmax(kCutoff, 0.25 * std::fabs(w));
    c.cutoff_q30 = raw(cutoff * kPeriod, 30);
    stator_flux_step(&s, &c, emf(truth(t), truth(t + kPeriod)), bpp(w), kBound);
    const Vector wanted = truth(t + kPeriod);
    worst = std::fmax(worst, (real_flux(stator_flux_q16(&s, &c)) - wanted).length());
    const double phase = angle(real_flux(s.flux_q16)) + phase_compensation(cutoff, w);
    if (std::fabs(w) > 20.0) printed = std::fmax(printed, std::fabs(wrapped(phase - angle(wanted))));
  }
  std::printf("bare low-pass from -165 to 285 rad/s: worst %.1e of psi_m; the phase as printed: %.2f rad\n",
              worst / kFlux, printed);
  EXPECT_LT(worst, 1e-3 * kFlux);
  EXPECT_GT(printed, 0.1);
}

// At rest the low-pass forgets, and what is left of it is not blown up.
TEST(StatorFlux, AtRestTheFluxFades) {
  const stator_flux_config_t c = config(STATOR_FLUX_BARE);
  for (const double w : {0.0, 4.0, -4.0}) {
    stator_flux_t s = {};
    stator_flux_preset(&s, raw_flux({kFlux, 0.0}));
    const auto truth = [&](double t) { return Vector{kFlux, 0.0}.turned(w * t); };
    for (int n = 0; n < 20000; ++n) {
      stator_flux_step(&s, &c, emf(truth(n * kPeriod), truth((n + 1) * kPeriod)), bpp(w), kBound);
      const double length = real_flux(stator_flux_q16(&s, &c)).length();
      ASSERT_LT(length, 1.001 * kFlux) << w;
      ASSERT_LT(length, 4.2 * real_flux(s.flux_q16).length() + 1e-4 * kFlux) << w;
    }
    // |U|^2 / (1/17) of the truth, where |U|^2 is w^2 / (w^2 + w_c^2).
    const double share = 17.0 * w * w / (w * w + kCutoff * kCutoff);
    EXPECT_NEAR(real_flux(stator_flux_q16(&s, &c)).length(), share * kFlux, 0.01 * kFlux) << w;
  }
}

TEST(StatorFlux, NothingLeavesTheBound) {
  Random random(320);
  const std::int32_t bound = raw(8.0 * kFlux / kPeriod, 16);
  for (const stator_flux_form_t form : {STATOR_FLUX_COMPENSATED, STATOR_FLUX_BARE}) {
    const stator_flux_config_t c = config(form);
    stator_flux_t s = {};
    stator_flux_preset(&s, ab_t{0, 0});
    for (int n = 0; n < 20000; ++n) {
      const double size = random.log_between(1.0, 32000.0);
      stator_flux_step(&s, &c, raw_ab(random.direction(size), 16), bpp(random.between(-3000.0, 3000.0)), bound);
      ASSERT_LE(q_abs_sat(s.flux_q16.alpha), bound);
      ASSERT_LE(q_abs_sat(s.flux_q16.beta), bound);
    }
    // A jump beyond it starts anew, and finds back.
    while (s.flux_q16.alpha != 0) stator_flux_step(&s, &c, ab_t{INT32_MAX, INT32_MAX}, 0, bound);
    const auto truth = [&](double t) { return Vector{kFlux, 0.0}.turned(300.0 * t); };
    int n = 0;
    for (; n < 40000; ++n) {
      stator_flux_step(&s, &c, emf(truth(n * kPeriod), truth((n + 1) * kPeriod)), bpp(300.0), bound);
    }
    const Vector seen = real_flux(stator_flux_q16(&s, &c));
    EXPECT_NEAR((seen - truth(n * kPeriod)).length(), 0.0, 2e-3 * kFlux) << form;
  }
}

}  // namespace
