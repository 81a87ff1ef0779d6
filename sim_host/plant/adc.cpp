#include "sim_host/plant/adc.hpp"

#include <algorithm>

namespace stillspin::plant {
namespace {

constexpr double kMiddle = 2048.0;
constexpr double kLast = 4095.0;

}  // namespace

Adc::Adc(const AdcConfig& c)
    : config_(c),
      codes_per_ampere_(kMiddle / c.current_range),
      codes_per_volt_(2.0 * kMiddle * c.voltage_gain / c.voltage_range),
      noise_{Noise(c.seed, 0), Noise(c.seed, 1), Noise(c.seed, 2), Noise(c.seed, 3)} {}

std::uint16_t Adc::current(int phase, double amperes) {
  return convert(kMiddle + codes_per_ampere_ * amperes, noise_[phase]);
}

std::uint16_t Adc::link_voltage(double volts) { return convert(codes_per_volt_ * volts, noise_[3]); }

std::uint16_t Adc::convert(double code, Noise& noise) const {
  const double clipped = std::min(std::max(code, 0.0), kLast);
  const double x = (clipped - kMiddle) / kMiddle;
  code += config_.inl * (0.7 * (4.0 * x * x - 3.0) * x + 0.3 * (2.0 * x * x - 1.0));
  if (config_.noise > 0.0) code += config_.noise * noise.gaussian();
  return static_cast<std::uint16_t>(std::min(std::max(code, 0.0), kLast) + 0.5);
}

}  // namespace stillspin::plant
