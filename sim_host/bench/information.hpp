// What the windows of a period tell about angle and speed, if nothing but the conversions' noise were in them.
//
// A window is a measurement of the current's slope, two numbers s(theta, w) in the stationary frame. With the noise
// covariance C of a current difference over the span D its Fisher information is
//   I = D^2 H' C^-1 H,   H = [ds/dtheta, ds/dw],
// summed over the windows. s is that of the true machine (machine.hpp) at the true angle and speed, H its numeric
// derivative; current, voltage, middle and span are those of the window as the drive had it. Noise: adc.noise and the
// rounding of a conversion, in two sensors that do not know of one another, averaged over the bursts; alpha is phase
// a, beta (a + 2 b)/sqrt 3. Bent converters, unequal gains, ringing are no noise: they are not in here.

#ifndef STILLSPIN_SIM_HOST_BENCH_INFORMATION_HPP
#define STILLSPIN_SIM_HOST_BENCH_INFORMATION_HPP

#include "sim_host/plant/machine.hpp"
#include "sim_host/plant/plant.hpp"

extern "C" {
#include "firmware/mode/mode.h"
}

namespace stillspin::bench {

/// Fisher information about the electrical angle (rad) and speed (rad/s) at the start of the period after.
struct Information {
  double angle = 0.0;  // 1/rad^2
  double cross = 0.0;  // s/rad^2
  double speed = 0.0;  // s^2/rad^2
};

class WindowInformation {
 public:
  explicit WindowInformation(const plant::PlantConfig& config);

  /// Of the windows in `samples`, which end where the plant is in `state`.
  Information operator()(const plant::PlantState& state, const drive_samples_t& samples) const;

 private:
  struct Pair {
    double x = 0.0;
    double y = 0.0;
  };
  Pair slope(double angle, double speed, Pair current, Pair voltage) const;
  void add(Information& sum, double angle, double speed, const estimator_window_t& w) const;

  plant::Machine machine_;
  double difference_variance_;  // A^2, of one phase
};

}  // namespace stillspin::bench

#endif
