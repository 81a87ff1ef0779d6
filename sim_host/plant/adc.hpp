// ADC front end: from a value at the pin to a 12-bit code, with smooth INL, Gaussian noise and rounding.
//
// INL(x) = A (0.7 T3(x) + 0.3 T2(x)) in LSB over the full range x = -1..1, Chebyshev polynomials, so |INL| <= A is
// reached at the ends; each input has its own noise stream, so that fitting a third sensor changes no other code.

#ifndef STILLSPIN_SIM_HOST_PLANT_ADC_HPP
#define STILLSPIN_SIM_HOST_PLANT_ADC_HPP

#include <algorithm>
#include <array>
#include <cstdint>

#include "sim_host/plant/noise.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {

class Adc {
 public:
  explicit Adc(const AdcConfig& config);

  std::uint16_t current(int phase, double amperes) {
    return convert(kMiddle + codes_per_ampere_ * amperes, noise_[phase]);
  }
  std::uint16_t link_voltage(double volts) { return convert(codes_per_volt_ * volts, noise_[3]); }
  std::uint16_t temperature() const { return static_cast<std::uint16_t>(config_.temperature_code); }

 private:
  static constexpr double kMiddle = 2048.0;
  static constexpr double kLast = 4095.0;

  static double clipped(double code) { return std::min(std::max(code, 0.0), kLast); }

  std::uint16_t convert(double code, Noise& noise) const {
    const double x = (clipped(code) - kMiddle) / kMiddle;
    code += config_.inl * (0.7 * (4.0 * x * x - 3.0) * x + 0.3 * (2.0 * x * x - 1.0));
    if (config_.noise > 0.0) code += config_.noise * noise.gaussian();
    return static_cast<std::uint16_t>(static_cast<int>(clipped(code) + 0.5));
  }

  AdcConfig config_;
  double codes_per_ampere_;
  double codes_per_volt_;
  std::array<Noise, 4> noise_;  // phases a, b, c, link
};

}  // namespace stillspin::plant

#endif
