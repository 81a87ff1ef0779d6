#include "sim_host/chip/code_flash_library.hpp"

#include <algorithm>

#include "hal/f2808/flash_library.h"
#include "sim_host/chip/c28x/core.hpp"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

constexpr std::uint16_t kReturn = 0x0006;      // LRETR
constexpr std::uint16_t kVerifyFailed = 40;    // the library's status; the drive has no use for it
constexpr std::uint16_t kStatusOnStack = 4;    // words below SP: the return address takes two, a pointer two
constexpr std::uint32_t kMostWords = 0x10000;  // all of the flash

using Place = std::uint32_t;

void write_status(c28x::Core& cpu, Place place, const flash_library_status_t& status) {
  cpu.write32(place, status.first_failed);
  cpu.write16(place + 2, status.expected);
  cpu.write16(place + 3, status.actual);
}

// What the library is given to read: a buffer in any memory.
std::vector<std::uint16_t> words_at(c28x::Core& cpu, Place from, std::uint32_t count) {
  std::vector<std::uint16_t> words;
  for (std::uint32_t k = 0; k < count; ++k) words.push_back(cpu.read16(from + k));
  return words;
}

std::uint16_t compare(Core& chip, Place to, const std::vector<std::uint16_t>& words, flash_library_status_t& status) {
  status = {};
  const auto count = static_cast<std::uint32_t>(words.size());
  if (count == 0 || !FlashArray::owns(to) || !FlashArray::owns(to + count - 1)) return FLASH_LIBRARY_ADDRESS;
  if (chip.memory().locked()) return FLASH_LIBRARY_LOCKED;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint16_t there = chip.memory().flash().read(to + k);
    if (there == words[k]) continue;
    status = {to + k, words[k], there};
    return kVerifyFailed;
  }
  return FLASH_LIBRARY_DONE;
}

}  // namespace

std::vector<std::uint32_t> FlashLibrary::functions() const {
  std::vector<std::uint32_t> there;
  for (const std::uint32_t place : {erase, program, verify}) {
    if (place != 0) there.push_back(place);
  }
  return there;
}

void FlashLibrary::carry_out(Core& chip, c28x::Core& cpu) const {
  const Place at = cpu.r.pc;
  if (FlashArray::owns(at)) chip.model_error("the flash library is called in the flash, not copied to RAM, at", at);
  flash_library_status_t status{};
  std::uint16_t result = 0;
  Flash_CPUScaleFactor = scale != 0 ? cpu.read32(scale) : 0;
  if (at == erase) {
    result = Flash2808_Erase(c28x::low_half(cpu.r.acc), &status);
    write_status(cpu, cpu.r.xar[4], status);
  } else {
    const Place to = cpu.r.xar[4];
    const std::uint32_t count = std::min(cpu.r.acc, kMostWords);
    std::vector<std::uint16_t> words = words_at(cpu, cpu.r.xar[5], count);
    const Place status_at = cpu.read32(static_cast<std::uint32_t>(cpu.r.sp - kStatusOnStack));
    // The stand-in takes an address of the chip as a pointer.
    auto* const cells = reinterpret_cast<std::uint16_t*>(static_cast<std::uintptr_t>(to));
    result = at == program ? Flash2808_Program(cells, words.data(), count, &status) : compare(chip, to, words, status);
    write_status(cpu, status_at, status);
  }
  cpu.r.set_ax(false, result);
  const c28x::Instruction back = c28x::decode(at, kReturn, 0);
  back.run(cpu, back);
}

}  // namespace stillspin::chip
