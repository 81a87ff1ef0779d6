#include "sim_host/bench/information.hpp"

#include <cmath>

#include "sim_host/plant/portable_math.hpp"

extern "C" {
#include "firmware/dictionary/units.h"
#include "firmware/drive/sampling.h"
}

namespace stillspin::bench {
namespace {

constexpr double kStep = 1e-4;  // rad of the angle, for the numeric derivative
constexpr double kTick = plant::kSecondsPerTick;

double variance_of(const plant::AdcConfig& adc) {
  const double code = adc.current_range / 2048.0;
  const double conversion = code * code * (adc.noise * adc.noise + 1.0 / 12.0);
  return conversion * (1.0 / HAL_ADC_START_SAMPLES + 1.0 / HAL_ADC_END_SAMPLES);
}

}  // namespace

WindowInformation::WindowInformation(const plant::PlantConfig& config)
    : machine_(config.machine), difference_variance_(variance_of(config.adc)) {}

// di/dt in the stationary frame, A/s.
WindowInformation::Pair WindowInformation::slope(double angle, double speed, Pair current, Pair voltage) const {
  const plant::Rotation r = plant::rotation(angle);
  const auto park = [&r](Pair v) { return plant::Pair{r.c * v.x + r.s * v.y, r.c * v.y - r.s * v.x}; };
  const plant::Pair i = park(current), v = park(voltage);
  const plant::Pair psi = machine_.flux(i.d, i.q, machine_.anchor(i.q));
  const plant::Pair harmonic = machine_.harmonic(plant::rotation(6.0 * angle));
  const plant::Pair u{v.d - machine_.resistance * i.d - speed * (harmonic.d - psi.q),
                      v.q - machine_.resistance * i.q - speed * (harmonic.q + psi.d)};
  double determinant = 0.0;
  const plant::Pair di = machine_.slope(i.d, i.q, u, &determinant);
  const plant::Pair s{di.d - speed * i.q, di.q + speed * i.d};
  return {r.c * s.d - r.s * s.q, r.s * s.d + r.c * s.q};
}

void WindowInformation::add(Information& sum, double angle, double speed, const estimator_window_t& w) const {
  const int q = 20 - unit_exponent(UNIT_A);
  const Pair current{std::ldexp(w.current_q20.alpha, -q), std::ldexp(w.current_q20.beta, -q)};
  const Pair voltage{std::ldexp(w.voltage_q19.alpha, -19), std::ldexp(w.voltage_q19.beta, -19)};
  const double before = (ESTIMATOR_PERIOD_TICKS - w.middle_tick) * kTick;
  const double at = angle - speed * before;
  const auto derivative = [&](double d_angle, double d_speed, double step) {
    const Pair up = slope(at + d_angle, speed + d_speed, current, voltage);
    const Pair down = slope(at - d_angle, speed - d_speed, current, voltage);
    return Pair{(up.x - down.x) / (2.0 * step), (up.y - down.y) / (2.0 * step)};
  };
  const Pair ha = derivative(kStep, 0.0, kStep);
  // A shaft that turns faster has been further behind in the middle of the window.
  const Pair hs = derivative(-before, 1.0, 1.0);
  // C = variance [1, 1/sqrt 3; 1/sqrt 3, 5/3], inverted.
  const double span = w.span_ticks * kTick;
  const double weight = span * span / difference_variance_;
  const auto product = [weight](Pair a, Pair b) {
    return weight * (1.25 * a.x * b.x + 0.75 * a.y * b.y - std::sqrt(3.0) / 4.0 * (a.x * b.y + a.y * b.x));
  };
  sum.angle += product(ha, ha);
  sum.cross += product(ha, hs);
  sum.speed += product(hs, hs);
}

Information WindowInformation::operator()(const plant::PlantState& state, const drive_samples_t& samples) const {
  Information sum;
  const double speed = state.speed_m * machine_.pole_pairs;
  for (int k = 0; k < samples.count; k++) add(sum, state.angle_e, speed, samples.windows[k]);
  return sum;
}

}  // namespace stillspin::bench
