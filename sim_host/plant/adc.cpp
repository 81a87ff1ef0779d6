#include "sim_host/plant/adc.hpp"

namespace stillspin::plant {

Adc::Adc(const AdcConfig& c)
    : config_(c),
      codes_per_ampere_(kMiddle / c.current_range),
      codes_per_volt_(2.0 * kMiddle * c.voltage_gain / c.voltage_range),
      noise_{Noise(c.seed, 0), Noise(c.seed, 1), Noise(c.seed, 2), Noise(c.seed, 3)} {}

}  // namespace stillspin::plant
