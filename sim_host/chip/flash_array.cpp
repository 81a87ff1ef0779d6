#include "sim_host/chip/flash_array.hpp"

#include <algorithm>

namespace stillspin::chip {

// Marsaglia's xorshift32.
std::uint16_t FlashArray::noise() {
  noise_ ^= noise_ << 13;
  noise_ ^= noise_ >> 17;
  noise_ ^= noise_ << 5;
  return static_cast<std::uint16_t>(noise_ >> 16);
}

void FlashArray::begin_program(std::uint32_t address, std::uint16_t value) {
  std::uint16_t& word = words_[address - kFlashStart];
  word = static_cast<std::uint16_t>(word & (value | noise()));
}

void FlashArray::finish_program(std::uint32_t address, std::uint16_t value) {
  std::uint16_t& word = words_[address - kFlashStart];
  word = static_cast<std::uint16_t>(word & value);
}

void FlashArray::begin_erase(unsigned sector) {
  const auto first = words_.begin() + (sector_start(sector) - kFlashStart);
  std::generate(first, first + kSectorWords, [this] { return noise(); });
}

void FlashArray::finish_erase(unsigned sector) {
  const auto first = words_.begin() + (sector_start(sector) - kFlashStart);
  std::fill(first, first + kSectorWords, kErased);
}

}  // namespace stillspin::chip
