// An edge by the default hysteresis: slow and fast ramps with the noise that a speed has.

#include <cmath>

#include "tests/control/quantities.hpp"
#include "tests/firmware/scope.hpp"

namespace {

using namespace stillspin::test;

constexpr std::uint64_t kTrials = 200;
constexpr double kStep = 1e-4;  // s
constexpr double kRoom = 10.0;  // rpm between beginning and level: three times the noise, peak to peak

// The speed of the virtual bench at 1000 rpm has 0.6 rpm rms, 3.4 rpm peak to peak: what the observer passes on of the
// windows' noise, with 10 ms, and the motor's harmonics.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}
  double next() {
    slow_ += (-slow_ + std::sqrt(200.0) * 0.35 * random_.normal()) * 0.01;
    phase_ += 2.0 * M_PI * 67.0 * kStep;
    return slow_ + 0.05 * random_.normal() + 0.75 * std::sin(phase_);
  }

 private:
  Random random_;
  double slow_ = 0.0, phase_ = 0.0;
};

class ScopeNoise : public Scope {
 protected:
  void begin(std::uint64_t seed) {
    noise_ = Noise(seed);
    made_.clear();
  }

  /// Whether it triggers on a ramp through the level, rpm/s, with the noise of the seed from its beginning.
  bool triggers(double slope, scope_edge_t edge) {
    std::size_t at = 0;
    const auto noise = [&] {
      if (at == made_.size()) made_.push_back(noise_.next());  // takes longer than all the rest
      return made_[at++];
    };
    scope_setup_t s = counting();
    s.level = raw(500.0, 16);
    s.hysteresis = SCOPE_BY_SPAN;
    s.edge = edge;
    arm(s);
    const double way = slope < 0.0 ? -1.0 : 1.0, end = std::fmax(kRoom, std::fabs(slope) * 0.1);
    const auto stand = [&](double rpm, int count) {
      for (int k = 0; k < count; ++k) interrupt(raw(500.0 + rpm + noise(), 16));
    };
    stand(-way * kRoom, 500);
    for (double rpm = -kRoom; rpm < end; rpm += std::fabs(slope) * kStep) {
      interrupt(raw(500.0 + way * rpm + noise(), 16));
    }
    stand(way * end, 1000);
    return scope_status().state >= SCOPE_TRIGGERED;
  }

 private:
  Noise noise_{0};
  std::vector<double> made_;
};

TEST_F(ScopeNoise, ARampIsAnEdgeTheWayThatItGoesAndNoneTheOther) {
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    begin(seed);
    for (const double slope : {10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0}) {
      EXPECT_FALSE(triggers(-slope, SCOPE_RISING)) << slope << ' ' << seed;
      EXPECT_FALSE(triggers(slope, SCOPE_FALLING)) << slope << ' ' << seed;
      EXPECT_TRUE(triggers(slope, SCOPE_RISING)) << slope << ' ' << seed;
      EXPECT_TRUE(triggers(-slope, SCOPE_FALLING)) << slope << ' ' << seed;
    }
  }
}

// A current that swings through the level: its edges count wherever the level is between its quarters.
TEST_F(ScopeNoise, AnOscillationIsAnEdgeInEachOfItsPeriods) {
  for (const double hertz : {1.0, 5.0, 40.0, 200.0}) {
    for (const double level : {-0.45, 0.0, 0.45, 0.9}) {
      scope_setup_t s = counting();
      s.mode = SCOPE_SINGLE;
      s.level = raw(level * 10.0, 16);
      s.hysteresis = SCOPE_BY_SPAN;
      arm(s);
      for (int k = 0; k < int(2.0 / (hertz * kStep)); ++k) {
        interrupt(raw(10.0 * std::sin(2.0 * M_PI * hertz * kStep * k), 16));
      }
      EXPECT_GE(scope_status().state, SCOPE_TRIGGERED) << hertz << ' ' << level;
    }
  }
}

// Steps of a signal that has few of them.
TEST_F(ScopeNoise, AStateIsAnEdgeEachTime) {
  for (const scope_edge_t edge : {SCOPE_RISING, SCOPE_FALLING}) {
    scope_setup_t s = counting();
    s.level = 3;
    s.hysteresis = SCOPE_BY_SPAN;
    s.edge = edge;
    arm(s);
    interrupts(500, 0);
    interrupts(500, 4);
    EXPECT_EQ(scope_status().state >= SCOPE_TRIGGERED, edge == SCOPE_RISING);
    interrupts(500, 2);
    EXPECT_GE(scope_status().state, SCOPE_TRIGGERED);
  }
}

}  // namespace
