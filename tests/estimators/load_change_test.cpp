// What the deviation observer does with its load at a crawl: it keeps quiet while nothing changes, follows at once what
// does, and learns what repeats with the angle.

#include <gtest/gtest.h>

#include "tests/estimators/machine.hpp"
#include "tests/estimators/observer.hpp"

namespace {

using namespace stillspin::test;

constexpr double kNoise = 8e-3;  // A rms of a current difference over a window, as from a 12-bit ADC over +-20 A

// The shaft under a load that the test chooses, with an air-gap torque that holds the mean speed, as a drive's would.
class Shaft {
 public:
  explicit Shaft(double rpm, std::uint64_t seed = 400) : random_(seed), model_(model_of(motor_)) {
    const deviation_observer_tuning_t tuning = {
        raw(0.1, 20), raw(0.6, 20), raw(0.05, 20), raw(2.0, 20), bpp(motor_.electrical(10.0)), true};
    deviation_observer_design(&config_, &model_, &tuning);
    config_.cogging = {6, bpp(motor_.electrical(10.0)), accel_q8(1e3)};
    speed_ = reference_ = motor_.electrical(rpm);
    deviation_observer_preset(&observer_, bam(0.0), bpp(speed_), 0);
  }

  void without_cogging() { order(0); }
  void order(std::int32_t waves) { config_.cogging.order = waves; }
  void without_steps_at_speed() { config_.moving_step_q20 = 0; }
  void without_quiet() { config_.load_noise_quiet_q20 = config_.load_noise_q20; }
  void load(double nm) { load_ = nm; }
  void cogging(double nm, double phase) { cogging_ = nm, phase_ = phase; }

  // The torque is what the observer believes the load to be, and a speed loop of 100 rad/s on the observed speed.
  void run(double seconds) {
    for (int n = 0; n < std::lround(seconds / kPeriod); ++n) {
      const double load = load_ + cogging_ * std::cos(6.0 * theta_ - phase_);
      const double per_nm = motor_.pole_pairs / motor_.inertia;
      const double torque = (believed() + 100.0 * (reference_ - rad_per_s(observer_.speed_bpp))) / per_nm;
      const double accel = (torque - load) * per_nm;
      theta_ += speed_ * kPeriod + 0.5 * accel * kPeriod * kPeriod;
      speed_ += accel * kPeriod;
      std::vector<estimator_window_t> windows;
      for (const Window& w : alternating_windows(period_++)) {
        const double scale = kNoise / (w.span * 1e-4);
        windows.push_back(observed(motor_, w, theta_, speed_, Vector{0.0, 1.0}.turned(theta_),
                                   {scale * random_.normal(), scale * random_.normal()}));
      }
      const estimator_input_t in = input_of(model_, windows, accel_q8(torque * per_nm));
      output_ = deviation_observer_step(&observer_, &config_, &in);
      if (period_ % 10 == 0) deviation_observer_learn(&observer_, &config_);
      const double e = wrapped(theta_ - rad(output_.angle_bam)) / kDegree;
      worst_ = std::max(worst_, std::fabs(e));
      speed_power_ += std::pow(speed_ - reference_, 2);
      count_++;
    }
  }
  void forget() { worst_ = 0.0, speed_power_ = 0.0, count_ = 0; }
  double believed() const { return accel_of(output_.load_accel_q8); }
  double believed_nm() const { return believed() * motor_.inertia / motor_.pole_pairs; }
  double worst() const { return worst_; }                                // degrees
  double speed_rms() const { return std::sqrt(speed_power_ / count_); }  // of the true shaft's deviation, rad/s
  const deviation_observer_t& observer() const { return observer_; }

 private:
  Motor motor_;
  Random random_;
  machine_model_t model_;
  deviation_observer_config_t config_ = {};
  deviation_observer_t observer_ = {};
  estimator_output_t output_ = {};
  double theta_ = 0.0, speed_ = 0.0, reference_ = 0.0, load_ = 0.0, cogging_ = 0.0, phase_ = 0.0;
  double worst_ = 0.0, speed_power_ = 0.0;
  int period_ = 0, count_ = 0;
};

TEST(LoadChange, AQuietLoadMakesAQuietSpeed) {
  Shaft quiet(0.0), plain(0.0);
  plain.without_quiet();
  for (Shaft* s : {&quiet, &plain}) {
    s->run(0.5);
    s->forget();
    s->run(1.0);
  }
  // the load's bandwidth falls with the cube root of its rate, (0.6/0.05)^(1/3) = 2.3, the speed's noise with its 1.5th
  // power: 3.5
  EXPECT_LT(quiet.speed_rms(), plain.speed_rms() / 2.5);
}

TEST(LoadChange, AStepIsFollowedAsIfItHadBeenExpected) {
  Shaft s(0.0), sleepy(0.0);
  for (Shaft* shaft : {&s, &sleepy}) {
    shaft->run(0.5);
    shaft->forget();
  }
  s.load(5.0);
  s.run(0.1);
  EXPECT_NEAR(s.believed_nm(), 5.0, 0.5);
  // a jump of 5 N m turns the shaft by 2.5 degrees electrical in 4.5 ms, about the time in which five standard
  // deviations have gathered; with the quiet filter alone it would be lost (a quarter turn)
  EXPECT_LT(s.worst(), 8.0);
}

TEST(LoadChange, AStepAtSpeedTurnsTheAngleLess) {
  Shaft s(60.0), sleepy(60.0);
  sleepy.without_steps_at_speed();
  for (Shaft* shaft : {&s, &sleepy}) {
    shaft->run(0.5);
    shaft->forget();
    shaft->load(8.0);
    shaft->run(0.1);
  }
  EXPECT_NEAR(s.believed_nm(), 8.0, 0.8);
  EXPECT_LT(s.worst(), 0.7 * sleepy.worst());
}

TEST(LoadChange, NoFalseAlarmInNoise) {
  Shaft s(5.0);
  s.run(1.0);
  int alarms = 0;
  for (int n = 0; n < 2000; ++n) {
    const std::int32_t before = s.observer().noise_boost_q30;
    s.run(0.01);
    if (s.observer().noise_boost_q30 > before) alarms++;
  }
  EXPECT_EQ(alarms, 0);  // five standard deviations of some 3000 independent means: 0.002 expected
}

double amplitude_nm(std::int32_t accel_q8) { return accel_of(accel_q8) * Motor{}.inertia / Motor{}.pole_pairs; }

TEST(LoadChange, CoggingIsLearntAndTheShaftTurnsEvenly) {
  for (const double phase : {0.0, 1.0, -2.0}) {
    Shaft s(5.0), ignorant(5.0);
    ignorant.without_cogging();
    for (Shaft* shaft : {&s, &ignorant}) {
      shaft->cogging(0.1, phase);
      shaft->run(3.0);
      shaft->forget();
      shaft->run(1.0);
    }
    EXPECT_LT(s.speed_rms(), 0.4 * ignorant.speed_rms()) << phase;
    EXPECT_NEAR(amplitude_nm(s.observer().cogging.cos_q8), 0.1 * std::cos(phase), 0.015) << phase;
    EXPECT_NEAR(amplitude_nm(s.observer().cogging.sin_q8), 0.1 * std::sin(phase), 0.015) << phase;
  }
}

// Half a wave for each factor of e, whether that takes 60 ms or 1.2 s: the delay of the load must not turn the fit.
TEST(LoadChange, CoggingIsLearntWithinThreeWavesAtAnySpeed) {
  for (const double rpm : {-8.0, 1.0, 2.0, 8.0}) {
    Shaft s(rpm);
    s.cogging(0.1, 0.7);
    s.run(3.0 * 60.0 / (24.0 * std::fabs(rpm)));
    EXPECT_NEAR(amplitude_nm(s.observer().cogging.cos_q8), 0.1 * std::cos(0.7), 0.03) << rpm;
    EXPECT_NEAR(amplitude_nm(s.observer().cogging.sin_q8), 0.1 * std::sin(0.7), 0.03) << rpm;
  }
}

// What is learnt stays with a load that steps: the step is none of the wave's business.
TEST(LoadChange, ALoadStepDoesNotSpoilTheWave) {
  Shaft s(5.0);
  s.cogging(0.1, 0.0);
  s.run(3.0);
  s.load(4.0);
  s.run(0.2);
  s.load(0.0);
  s.run(1.5);
  EXPECT_NEAR(amplitude_nm(s.observer().cogging.cos_q8), 0.1, 0.04);
  EXPECT_NEAR(amplitude_nm(s.observer().cogging.sin_q8), 0.0, 0.04);
}

TEST(LoadChange, AShaftWithoutCoggingLearnsNoneAndGetsQuieter) {
  Shaft knows(5.0), ignorant(5.0);
  ignorant.without_cogging();
  for (Shaft* s : {&knows, &ignorant}) {
    s->run(2.0);
    s->forget();
    s->run(2.0);
  }
  EXPECT_NEAR(amplitude_nm(knows.observer().cogging.cos_q8), 0.0, 0.01);
  EXPECT_NEAR(amplitude_nm(knows.observer().cogging.sin_q8), 0.0, 0.01);
  // a bandwidth lower by the root of two: the speed's noise by its 1.5th power, 1.7
  EXPECT_LT(knows.speed_rms(), ignorant.speed_rms() / 1.4);
}

TEST(LoadChange, AnotherOrderForgetsWhatWasLearnt) {
  Shaft s(5.0);
  s.cogging(0.1, 0.0);
  s.run(2.0);
  ASSERT_GT(amplitude_nm(s.observer().cogging.cos_q8), 0.05);
  s.order(12);
  s.run(0.1);
  EXPECT_LT(amplitude_nm(s.observer().cogging.cos_q8), 0.05);
}

// A wave stands still at standstill: whatever the load, nothing is learnt from it.
TEST(LoadChange, NothingIsLearntAtStandstill) {
  Shaft s(0.0);
  s.run(0.2);
  s.load(3.0);
  s.run(0.5);
  EXPECT_NEAR(amplitude_nm(s.observer().cogging.cos_q8), 0.0, 0.05);
  EXPECT_NEAR(amplitude_nm(s.observer().cogging.sin_q8), 0.0, 0.05);
  EXPECT_NEAR(s.believed_nm(), 3.0, 0.3);
}

}  // namespace
