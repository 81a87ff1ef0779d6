// Accesses to memory and to the chip's identity, and what the manufacturer's own code needs of the core: a jump, and
// time for the flash.

#include "hal/f2808/registers.h"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

constexpr std::uint16_t kPartNumber = 0x003C;  // of the F2808
constexpr std::uint32_t kDeviceConfiguration = DEVICECNF_VMAPS_MASK | DEVICECNF_XRSn_MASK | DEVICECNF_ENPROT_MASK;

}  // namespace

void Core::set_revision(std::uint16_t revision) {
  revision_ = revision;
  adc_.set_crosstalk(revision < kRevisionC);
}

std::uint16_t Core::read_identity(std::uint32_t address) const {
  switch (address) {
    case REG_DEVICECNF:
      return static_cast<std::uint16_t>(kDeviceConfiguration & 0xFFFFu);
    case REG_DEVICECNF + 1:
      return static_cast<std::uint16_t>(kDeviceConfiguration >> 16);
    case REG_PARTID:
      return kPartNumber;
    case REG_REVID:
      return revision_;
    default:
      return 0;
  }
}

// RAM has no wait states; the flash those of FBANKWAIT, without the prefetch buffer, which is for code.
Tick Core::memory_cycles(std::uint32_t address) const {
  constexpr Tick kRamCycles = 1;
  if (!FlashArray::owns(address)) return kRamCycles;
  return 1 + ((flash_.bank_wait() & FBANKWAIT_RANDWAIT_MASK) >> FBANKWAIT_RANDWAIT_LSB);
}

std::uint16_t Core::read_memory(std::uint32_t address) {
  if (const auto word = memory_.read(address)) return *word;
  note_unmodelled(address, false);
  return 0;
}

void Core::write_memory(std::uint32_t address, std::uint16_t value) {
  if (!memory_.write(address, value)) note_unmodelled(address, true);
}

std::uint16_t Core::inspect_memory(std::uint32_t address) {
  if (FlashArray::owns(address)) return memory_.flash().read(address);
  return memory_.ram(address).value_or(memory_.rom(address).value_or(0));
}

void Core::jump(std::uint32_t entry) {
  const Chip::Firmware program = jump_ ? jump_(entry) : nullptr;
  if (program == nullptr && code_ != nullptr) code_->run(entry);
  if (program == nullptr) {
    model_error("nothing stands in for the code at this address", entry);
    leave_firmware();
  }
  program();
}

c28x::Core& Core::execute_code() {
  if (code_ == nullptr) code_ = std::make_unique<CodeCpu>(*this);
  return code_->cpu();
}

void Core::replace_flash_library(const FlashLibrary& places) {
  execute_code();
  code_->replace_flash_library(places);
}

const InVain& Core::in_vain() {
  execute_code();
  return code_->in_vain();
}

void Core::pass(Tick ticks) {
  advance(now_ + ticks);
  finish_access();
}

}  // namespace stillspin::chip
