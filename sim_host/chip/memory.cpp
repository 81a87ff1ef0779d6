#include "sim_host/chip/memory.hpp"

#include <algorithm>

#include "hal/f2808/registers.h"

namespace stillspin::chip {
namespace {

constexpr std::uint32_t kLowRamEnd = 0x800;      // M0, M1
constexpr std::uint32_t kSecuredStart = 0x8000;  // L0, L1
constexpr std::uint32_t kHighRamStart = 0xA000;  // H0
constexpr std::uint32_t kRamEnd = 0xC000;
constexpr std::uint32_t kSecondMapping = 0x3F0000;  // L0, L1 and H0 are there, too
constexpr std::uint32_t kOtpStart = 0x3D7800;
constexpr std::uint32_t kOtpEnd = 0x3D7C00;
constexpr unsigned kAllPasswords = (1u << kPasswordWords) - 1u;

// Data address of a word of RAM: the mapping at the top of memory folded down.
std::uint32_t fold(std::uint32_t address) {
  const std::uint32_t low = address - kSecondMapping;
  return low >= kSecuredStart && low < kRamEnd ? low : address;
}

// Index of a word of RAM; nothing where there is none.
std::optional<std::uint32_t> ram_index(std::uint32_t address) {
  if (address < kLowRamEnd) return address;
  if (address >= kSecuredStart && address < kRamEnd) return address - kSecuredStart + kLowRamEnd;
  return std::nullopt;
}

bool secured(std::uint32_t address) { return address >= kSecuredStart && address < kHighRamStart; }

}  // namespace

void Memory::reset() {
  keys_.fill(0);
  passwords_read_ = 0;
  locked_ = true;
}

std::optional<std::uint16_t> Memory::read(std::uint32_t address) {
  if (FlashArray::owns(address)) {
    const std::uint16_t word = locked_ ? 0 : flash_.read(address);
    if (address >= kPasswords) look_at_password(address - kPasswords);
    return word;
  }
  if (address >= kOtpStart && address < kOtpEnd) return locked_ ? 0 : kErased;
  const std::uint32_t low = fold(address);
  const auto index = ram_index(low);
  if (!index) return rom(address);
  if (locked_ && secured(low)) return std::uint16_t{0};
  return *index == broken_ ? static_cast<std::uint16_t>(ram_[*index] | stuck_) : ram_[*index];
}

void Memory::break_ram(std::uint32_t address, std::uint16_t stuck) {
  broken_ = ram_index(fold(address)).value_or(kRamWords);
  stuck_ = stuck;
}

bool Memory::write(std::uint32_t address, std::uint16_t value) {
  if (FlashArray::owns(address)) return true;
  const std::uint32_t low = fold(address);
  const auto index = ram_index(low);
  if (!index) return false;
  if (!(locked_ && secured(low))) ram_[*index] = value;
  return true;
}

std::optional<std::uint16_t> Memory::ram(std::uint32_t address) const {
  const auto index = ram_index(fold(address));
  return index ? std::optional<std::uint16_t>(ram_[*index]) : std::nullopt;
}

bool Memory::load(std::uint32_t address, std::uint16_t word) {
  const auto index = ram_index(fold(address));
  if (!FlashArray::owns(address) && !index) return false;
  (index ? ram_[*index] : flash_.words()[address - kFlashStart]) = word;
  return true;
}

bool Memory::load_rom(std::uint32_t address, std::uint16_t word) {
  if (address - kBootRom >= kBootRomWords) return false;
  rom_.resize(kBootRomWords);
  rom_[address - kBootRom] = word;
  return true;
}

std::optional<std::uint16_t> Memory::rom(std::uint32_t address) const {
  const std::uint32_t index = address - kBootRom;
  return index < rom_.size() ? rom_[index] : std::nullopt;
}

std::uint16_t* Memory::ram_words(std::uint32_t address) { return ram_.data() + ram_index(fold(address)).value(); }

// ---- code security -------------------------------------------------------------------------------------

void Memory::look_at_password(unsigned index) {
  passwords_read_ |= 1u << index;
  if (!locked_ || passwords_read_ != kAllPasswords) return;
  bool open = true, zero = true, match = true;
  for (unsigned n = 0; n < kPasswordWords; ++n) {
    const std::uint16_t word = flash_.read(kPasswords + n);
    open = open && word == kErased;
    zero = zero && word == 0;
    match = match && word == keys_[n];
  }
  if (!zero && (open || match)) locked_ = false;
}

std::uint16_t Memory::read_security(std::uint32_t address) const {
  return address == REG_CSMSCR && locked_ ? CSMSCR_SECURE_MASK : 0;  // keys read as 0 here
}

void Memory::write_security(std::uint32_t address, std::uint16_t value) {
  if (address >= REG_KEY(0) && address < REG_KEY(kPasswordWords)) {
    keys_[address - REG_KEY(0)] = value;
    passwords_read_ = 0;
  } else if (address == REG_CSMSCR && (value & CSMSCR_FORCESEC_MASK) != 0) {
    reset();
  }
}

}  // namespace stillspin::chip
