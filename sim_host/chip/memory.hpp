// Memory beside the registers: SARAM, the flash's cells as the CPU reads them, and the code security module (CSM) that
// stands before flash, L0 and L1.
//
// After a reset the chip is locked. Reading the eight passwords opens it when they are all ones; else the key registers
// have to hold the same words as the passwords before those are read. All zeros never open. A locked read gives 0, a
// locked write is lost. A plain write to the flash does nothing.
// Not modelled: OTP (reads as erased), code that runs from secured memory and may read it (nothing runs from memory
// here), the emulation logic. Source: SPRU712 (CSM), SPRS230 (memory map).

#ifndef STILLSPIN_SIM_HOST_CHIP_MEMORY_HPP
#define STILLSPIN_SIM_HOST_CHIP_MEMORY_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim_host/chip/flash_array.hpp"

namespace stillspin::chip {

constexpr std::uint32_t kBootRom = 0x3FF000;
constexpr std::uint32_t kBootRomWords = 0x1000;

class Memory {
 public:
  /// RAM keeps its contents, security is back.
  void reset();

  /// A word, when there is memory; what the CPU would get.
  std::optional<std::uint16_t> read(std::uint32_t address);
  /// False when there is no memory.
  bool write(std::uint32_t address, std::uint16_t value);

  std::uint16_t read_security(std::uint32_t address) const;
  void write_security(std::uint32_t address, std::uint16_t value);
  bool locked() const { return locked_; }

  /// A word of RAM whose bits in `stuck` read as 1 from now on, whatever is written.
  void break_ram(std::uint32_t address, std::uint16_t stuck);

  FlashArray& flash() { return flash_; }
  /// A word of RAM as it is, for inspection; nothing where there is none.
  std::optional<std::uint16_t> ram(std::uint32_t address) const;
  /// Puts a word into flash or RAM as a probe does, whatever is locked. False when there is neither.
  bool load(std::uint32_t address, std::uint16_t word);
  /// A word of the boot ROM, which is no part of the model: tables and code of whoever has them. False outside of it.
  bool load_rom(std::uint32_t address, std::uint16_t word);
  /// That word; nothing where none was given.
  std::optional<std::uint16_t> rom(std::uint32_t address) const;
  /// The words of RAM from an address of RAM on, up to the end of M1 or of H0.
  std::uint16_t* ram_words(std::uint32_t address);

 private:
  static constexpr std::uint32_t kRamWords = 0x800 + 0x4000;  // M0 and M1; L0, L1 and H0

  void look_at_password(unsigned index);

  FlashArray flash_;
  std::array<std::uint16_t, kRamWords> ram_{};
  std::vector<std::optional<std::uint16_t>> rom_;  // empty until something is loaded
  std::array<std::uint16_t, kPasswordWords> keys_{};
  std::uint32_t broken_ = kRamWords;  // index
  std::uint16_t stuck_ = 0;
  unsigned passwords_read_ = 0;  // bit n: PSWDn since the last reset or lock
  bool locked_ = true;
};

}  // namespace stillspin::chip

#endif
