// The I-F start with the current control in its loop, on a machine with inductances in double precision: what turns the
// vector is voltage, too, and the damping must not take it for EMF.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/control/quantities.hpp"

extern "C" {
#include "control/current_controller.h"
#include "control/if_start.h"
}

namespace stillspin::test {
namespace {

constexpr double kCurrent = 8.0;  // A
constexpr current_design_t kDesign = {1800, 100, 1, CURRENT_CORNER_HIGHER};

struct Quiet {
  double shift = 0.0;    // farthest that the damping turns the vector over the last 100 ms, degrees
  double swing = 0.0;    // of the speed then, of the last speed
  double current = 0.0;  // farthest from its length
};

class Start {
 public:
  Start(const Motor& motor, double load) : m_(motor), model_(model_of(motor)), load_(load) {
    turn_config_ = {
        raw(kCurrent, 20), 1000, bpp(500.0 / 60.0 * kTurn * 4.0) / 10000, bpp(125.7), 5000, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_TRUE(if_start_design(&turn_config_, &model_));
    current_controller_design(&current_config_, &model_, &kDesign);
    current_controller_reset(&current_);
    if_start_begin(&turn_, &turn_config_, 0, false);
    frame_ = rad(turn_.angle_bam);
  }

  /// To the end of its patience: nobody agrees.
  Quiet run() {
    Quiet q;
    int periods = 0;
    if_start_result_t result = IF_START_PENDING;
    while (result == IF_START_PENDING) {
      const Vector seen = mean_.turned(angle_ - frame_);
      const dq_t measured = raw_dq(seen, 20);
      if (++periods % 10 == 0) if_start_renew(&turn_, &turn_config_, command_);
      result = if_start_step(&turn_, &turn_config_, command_, 0, 0);
      frame_ = rad(turn_.angle_bam + static_cast<std::uint32_t>(turn_.speed_bpp));
      command_ = current_controller_step(&current_, &current_config_, &model_, {turn_.current_q20, 0}, measured,
                                         turn_.speed_bpp);
      const Vector wanted = real(command_, 16).turned(frame_ + 1.5 * rad(turn_.speed_bpp));
      period();
      voltage_ = wanted;
      if (turn_.waited > 4000) look(&q, seen);
    }
    return q;
  }

 private:
  void look(Quiet* q, Vector seen) const {
    q->shift = std::max(q->shift, std::fabs(rad(turn_.vector_bam - turn_.angle_bam)) / kDegree);
    q->swing = std::max(q->swing, std::fabs(speed_ / 125.7 - 1.0));
    q->current = std::max(q->current, (seen - Vector{kCurrent, 0.0}).length());
  }

  // The voltage stands still in the stationary frame.
  void period() {
    constexpr int kSteps = 10;
    const double h = kPeriod / kSteps;
    Vector sum = {0.0, 0.0};
    for (int k = 0; k < kSteps; ++k) {
      const Vector v = voltage_.turned(-angle_);
      i_ = i_ + Vector{(v.x - m_.rs * i_.x + speed_ * m_.lq * i_.y) / m_.ld,
                       (v.y - m_.rs * i_.y - speed_ * (m_.ld * i_.x + m_.flux)) / m_.lq} *
                    h;
      const double torque = 1.5 * m_.pole_pairs * (m_.flux + (m_.ld - m_.lq) * i_.x) * i_.y;
      const double against = std::clamp(speed_, -1.0, 1.0) * load_ + m_.friction * speed_ / m_.pole_pairs;
      speed_ += (torque - against) * m_.pole_pairs / m_.inertia * h;
      angle_ += speed_ * h;
      sum = sum + i_.turned(angle_);
    }
    mean_ = (sum * (1.0 / kSteps)).turned(-angle_);
  }

  Motor m_;
  machine_model_t model_;
  double load_, angle_ = 0.0, speed_ = 0.0, frame_ = 0.0;
  if_start_config_t turn_config_;
  if_start_t turn_;
  current_controller_config_t current_config_;
  current_controller_t current_;
  dq_t command_ = {0, 0};
  Vector voltage_ = {0.0, 0.0}, i_ = {0.0, 0.0}, mean_ = {0.0, 0.0};
};

// Motors of which the vector's own flux is up to four fifths of the magnet's.
Motor any_motor(Random& random) {
  Motor m;
  m.flux = random.log_between(0.05, 0.3);
  m.lq = random.log_between(0.06, 0.8) * m.flux / kCurrent;
  m.ld = m.lq / random.between(1.0, 2.5);
  m.rs = m.lq * random.log_between(20.0, 100.0);
  const double w0 = random.log_between(30.0, 150.0);
  m.inertia = m.torque_constant() * kCurrent * m.pole_pairs / (w0 * w0);
  m.friction = 0.0;
  return m;
}

TEST(IfStartLoop, TurningTheVectorFeedsNoSwing) {
  Random random(91);
  std::vector<Motor> motors = {Motor{}, motor_b()};
  for (int n = 0; n < 20; ++n) motors.push_back(any_motor(random));
  for (const Motor& m : motors) {
    for (const double share : {0.0, 0.5}) {
      const Quiet q = Start(m, share * m.torque_constant() * kCurrent).run();
      EXPECT_LT(q.shift, 2.0) << m.lq * kCurrent / m.flux << ", " << share;
      EXPECT_LT(q.swing, 0.01) << m.lq * kCurrent / m.flux << ", " << share;
      EXPECT_LT(q.current, 0.1) << m.lq * kCurrent / m.flux << ", " << share;
    }
  }
}

}  // namespace
}  // namespace stillspin::test
