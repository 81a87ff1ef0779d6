// Every mistake of the wiring by its name, at every angle, on machines with and without saliency that the model does
// not know; and none that is not there.

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/estimators/machine_windows.hpp"

extern "C" {
#include "estimators/avv.h"
#include "estimators/wiring.h"
}

namespace {

using namespace stillspin::test;
using namespace stillspin::test::seen;

const avv_config_t kAvv = {raw(0.01, 30), raw(0.02, 30)};
constexpr double kSqrt3 = 1.7320508075688772;
constexpr std::array<double, 3> kAxes = {0.0, kTurn / 3.0, 2.0 * kTurn / 3.0};

// What is wired how: an open phase (0..2, else none), whose current the two sensors see, and with what factor.
struct Wires {
  int open = -1;
  std::array<int, 2> phase{0, 1};
  std::array<double, 2> factor{1.0, 1.0};
};

Vector axis_of(int phase) { return {std::cos(kAxes[phase]), std::sin(kAxes[phase])}; }

// With a phase open the current has the line across its axis alone: u u'/(u' L u).
Vector true_slope(const Motor& m, double theta, Vector v, int open) {
  if (open < 0) return current_derivative(m, theta, 0.0, {0, 0}, v);
  const Vector u = {-axis_of(open).y, axis_of(open).x};
  const double turn = 2.0 * (std::atan2(u.y, u.x) - theta);
  const double along = 0.5 * (m.ld + m.lq) + 0.5 * (m.ld - m.lq) * std::cos(turn);
  return u * ((v.x * u.x + v.y * u.y) / along);
}

// As the drive makes alpha and beta of two sensors.
Vector as_read(Vector current, const Wires& w) {
  double read[2];
  for (int k = 0; k < 2; ++k) {
    const Vector axis = axis_of(w.phase[k]);
    read[k] = w.factor[k] * (current.x * axis.x + current.y * axis.y);
  }
  return {read[0], (read[0] + 2.0 * read[1]) / kSqrt3};
}

wiring_t judged(const Motor& truth, const Wires& wires, double theta, double link = 300.0, double noise = 0.0,
                double range = 20.0) {
  static const machine_model_t model = model_of(Motor{});
  Random random(7);
  avv_t avv = {};
  axis_t axis;
  axis_begin(&axis);
  for (int n = 0; n < AXIS_PERIODS + 5; ++n) {  // a start waits for a period for itself
    std::vector<Window> windows = alternating(truth, n, theta, 0.0, Vector{0, 0});
    for (Window& w : windows) {
      w.voltage = w.voltage * (link / kLink);
      const Vector slope = true_slope(truth, theta, w.voltage, wires.open) * truth.period;
      w.slope = as_read(slope, wires) + Vector{noise * random.normal(), noise * random.normal()};
    }
    const Input in(model, windows);
    avv_preset(&avv, 0, 0, 0);
    (void)avv_step(&avv, &kAvv, in.get());
    axis_add(&axis, &avv.regression);
  }
  return wiring_judge(&axis, &model, raw(range / 2048.0, 20));
}

struct Mistake {
  wiring_t name;
  Wires wires;
};

const std::vector<Mistake> kMistakes = {
    {WIRING_OPEN_A, {0}},
    {WIRING_OPEN_B, {1}},
    {WIRING_OPEN_C, {2}},
    {WIRING_DEAD_A, {-1, {0, 1}, {0.0, 1.0}}},
    {WIRING_DEAD_B, {-1, {0, 1}, {1.0, 0.0}}},
    {WIRING_REVERSED_A, {-1, {0, 1}, {-1.0, 1.0}}},
    {WIRING_REVERSED_B, {-1, {0, 1}, {1.0, -1.0}}},
    {WIRING_REVERSED_BOTH, {-1, {0, 1}, {-1.0, -1.0}}},
    {WIRING_SWAPPED, {-1, {1, 0}}},
    {WIRING_OTHER_PHASES, {-1, {0, 2}}},
    {WIRING_OTHER_PHASES, {-1, {2, 1}}},
    {WIRING_OTHER_PHASES, {-1, {1, 2}}},
    {WIRING_OTHER_PHASES, {-1, {2, 0}}},
    {WIRING_OTHER_PHASES, {-1, {0, 2}, {-1.0, 1.0}}},
    {WIRING_NO_CURRENT, {-1, {0, 1}, {0.0, 0.0}}},
};

// Motor A, and B's ratio of the inductances; no saliency; all of it 40 % up and down.
std::vector<Motor> machines() {
  std::vector<Motor> list;
  for (const double ratio : {1.0, 7.8 / 4.9, 1.63 / 0.76}) {
    for (const double factor : {0.6, 1.0, 1.4}) {
      Motor m;
      m.ld *= factor;
      m.lq = m.ld * ratio;
      list.push_back(m);
    }
  }
  return list;
}

// 31 mA per period is what 12 mA rms leaves of a 27 us window.
TEST(Wiring, EveryMistakeHasItsName) {
  for (const Motor& m : machines()) {
    for (const Mistake& mistake : kMistakes) {
      for (int k = 0; k < 24; ++k) {
        for (const double noise : {0.0, 0.031}) {
          EXPECT_EQ(judged(m, mistake.wires, k * kTurn / 24.0, 300.0, noise), mistake.name)
              << "L " << m.ld << ' ' << m.lq << ", angle " << k;
        }
      }
    }
  }
}

TEST(Wiring, WhatIsRightIsGoodWhateverTheMachine) {
  for (const double ratio : {1.0, 1.6, 2.2, 5.0, 10.0}) {
    for (const double factor : {0.1, 1.0, 6.0}) {
      Motor m;
      m.ld *= factor;
      m.lq = m.ld * ratio;
      for (int k = 0; k < 24; ++k) {
        for (const double link : {32.0, 100.0, 300.0, 400.0}) {
          if (link < 100.0 && ratio > 5.0) continue;  // noise
          EXPECT_EQ(judged(m, {}, k * kTurn / 24.0, link, 0.031), WIRING_GOOD)
              << ratio << ' ' << factor << ", angle " << k << ", link " << link;
        }
      }
    }
  }
}

// Gains of 20 % are for the match of the sensors, not for the wires.
TEST(Wiring, UnequalSensorsAreNoMistake) {
  for (int k = 0; k < 24; ++k) {
    const Wires unequal = {-1, {0, 1}, {1.1, 0.9}};
    EXPECT_EQ(judged(Motor{}, unequal, k * kTurn / 24.0), WIRING_GOOD);
  }
}

// Where the current is lost in the converter's steps nothing is said.
TEST(Wiring, TooLittleToTellIsNoMistake) {
  Motor heavy;
  heavy.ld *= 40.0;
  heavy.lq *= 40.0;
  EXPECT_EQ(judged(Motor{}, {-1, {0, 1}, {0.0, 0.0}}, 0.3, 32.0, 0.0, 100.0), WIRING_GOOD);
  EXPECT_EQ(judged(heavy, {-1, {0, 1}, {-1.0, 1.0}}, 0.3, 32.0, 0.031), WIRING_GOOD);
}

// Sums as the windows of the nameplate's machine would make them, without a saliency; `curl` of what lies along them is
// seen across: both sensors turned.
axis_t turned_sums(double curl) {
  const machine_model_t m = model_of(Motor{});
  axis_t s = {};
  s.spread_q8 = raw(2e5, 8);
  s.count = AXIS_PERIODS;
  const double mean = 0.5 * (real(m.yd_q30, 30) + real(m.yq_q30, 30)) * 2e5;
  s.mirror_q16 = -raw(0.5 * (real(m.yd_q30, 30) - real(m.yq_q30, 30)) * 2e5, 16);
  s.curl_q16 = raw(curl * mean, 16);
  return s;
}

// Neither is a phase another one then, nor a sensor turned round.
TEST(Wiring, BothSensorsTurnedALittleIsNoMistake) {
  const machine_model_t m = model_of(Motor{});
  for (const double curl : {-0.4, 0.4}) {
    const axis_t s = turned_sums(curl);
    EXPECT_EQ(wiring_judge(&s, &m, 1), WIRING_GOOD) << curl;
  }
  const axis_t far = turned_sums(0.9);
  EXPECT_EQ(wiring_judge(&far, &m, 1), WIRING_OTHER_PHASES);
}

// Each sum alone, on what else would be a mistake.
TEST(Wiring, ASumAtTheEndOfItsFormatSaysNothing) {
  const machine_model_t m = model_of(Motor{});
  for (std::int32_t axis_t::* const sum : {&axis_t::along_q16, &axis_t::mirror_q16, &axis_t::cross_q16}) {
    axis_t s = turned_sums(0.9);
    s.*sum = INT32_MAX;
    EXPECT_EQ(wiring_judge(&s, &m, 1), WIRING_GOOD);
  }
  axis_t s = turned_sums(0.9);
  s.spread_q8 = INT32_MAX;
  s.curl_q16 = INT32_MAX;
  EXPECT_EQ(wiring_judge(&s, &m, 1), WIRING_GOOD) << "what the nameplate lets expect";
}

}  // namespace
