// ADC front end: from a value at the pin to a 12-bit code, with smooth INL, Gaussian noise and rounding.
//
// INL(x) = A (0.7 T3(x) + 0.3 T2(x)) in LSB over the full range x = -1..1, Chebyshev polynomials, so |INL| <= A is
// reached at the ends; each input has its own noise stream, so that fitting a third sensor changes no other code.

#ifndef STILLSPIN_SIM_HOST_PLANT_ADC_HPP
#define STILLSPIN_SIM_HOST_PLANT_ADC_HPP

#include <array>
#include <cstdint>

#include "sim_host/plant/noise.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::plant {

class Adc {
 public:
  explicit Adc(const AdcConfig& config);

  std::uint16_t current(int phase, double amperes);
  std::uint16_t link_voltage(double volts);
  std::uint16_t temperature() const { return static_cast<std::uint16_t>(config_.temperature_code); }

 private:
  std::uint16_t convert(double code, Noise& noise) const;

  AdcConfig config_;
  double codes_per_ampere_;
  double codes_per_volt_;
  std::array<Noise, 4> noise_;  // phases a, b, c, link
};

}  // namespace stillspin::plant

#endif
