// The cells of the flash: 64 K words in four sectors, D C B A from 0x3E8000 on. They keep their contents without power.
//
// Programming turns ones into zeros, word by word; only erasing turns zeros into ones, a sector at a time. Both take
// time, and a word or sector that lost its power on the way holds something: some of a word's bits are still ones, an
// erased sector's words are whatever they are (here: pseudo-random, the same in every run).
// Source: SPRS230 (sectors; times, typical, from memory), SPRU712.

#ifndef STILLSPIN_SIM_HOST_CHIP_FLASH_ARRAY_HPP
#define STILLSPIN_SIM_HOST_CHIP_FLASH_ARRAY_HPP

#include <cstdint>
#include <vector>

#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

inline constexpr std::uint32_t kFlashStart = 0x3E8000;
inline constexpr std::uint32_t kFlashEnd = 0x3F8000;
inline constexpr std::uint32_t kFlashEntry = 0x3F7FF6;
inline constexpr std::uint32_t kPasswords = 0x3F7FF8;
inline constexpr unsigned kPasswordWords = 8;
inline constexpr std::uint32_t kSectorWords = 0x4000;
inline constexpr unsigned kSectors = 4;
inline constexpr std::uint16_t kErased = 0xFFFF;

class FlashArray {
 public:
  static constexpr Tick kProgramTime = 5'000;        // 50 us a word
  static constexpr Tick kEraseTime = 1'000'000'000;  // 10 s a sector

  static bool owns(std::uint32_t address) { return address - kFlashStart < kFlashEnd - kFlashStart; }
  /// Where a sector begins; 0 is A, the uppermost.
  static std::uint32_t sector_start(unsigned sector) { return kFlashEnd - (sector + 1) * kSectorWords; }

  std::uint16_t read(std::uint32_t address) const { return words_[address - kFlashStart]; }

  /// A word on its way from what it is to what it can become, and there.
  void begin_program(std::uint32_t address, std::uint16_t value);
  void finish_program(std::uint32_t address, std::uint16_t value);
  /// A sector between the cells it had and all ones, and there.
  void begin_erase(unsigned sector);
  void finish_erase(unsigned sector);

  /// All cells, as a programmer on the JTAG connector would write or read them.
  std::vector<std::uint16_t>& words() { return words_; }
  const std::vector<std::uint16_t>& words() const { return words_; }

 private:
  std::uint16_t noise();

  std::vector<std::uint16_t> words_ = std::vector<std::uint16_t>(kFlashEnd - kFlashStart, kErased);
  std::uint32_t noise_ = 0x2545F491;
};

}  // namespace stillspin::chip

#endif
