// Fields of a 16-bit register, with the x_MASK and x_LSB pairs of hal/f2808/registers.h.

#ifndef STILLSPIN_SIM_HOST_CHIP_REGISTER_FIELD_HPP
#define STILLSPIN_SIM_HOST_CHIP_REGISTER_FIELD_HPP

#include <cstdint>

namespace stillspin::chip {

constexpr unsigned field(unsigned word, unsigned mask, unsigned lsb) { return (word & mask) >> lsb; }

constexpr bool bit_set(unsigned word, unsigned mask) { return (word & mask) != 0; }

constexpr std::uint16_t with_bits(unsigned word, unsigned mask, unsigned bits) {
  return static_cast<std::uint16_t>((word & ~mask) | (bits & mask));
}

}  // namespace stillspin::chip

#endif
