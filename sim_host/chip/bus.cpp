// Register accesses: what they cost, address decode, write protection (EALLOW) and clock gates.

#include "hal/f2808/registers.h"
#include "sim_host/chip/bus_pages.hpp"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

// Cycles of an access. Writes and frame 0 need no wait states; reads of peripheral frames 1 and 2 have two (SPRS230).
// Frame 2 has a 16-bit bus, a 32-bit access makes two. What lies above is memory (bus_memory.cpp).
constexpr Tick kWriteCycles = 1;
constexpr Tick kFrame0ReadCycles = 1;
constexpr Tick kFrame12ReadCycles = 3;
constexpr std::uint32_t kFrame1Start = 0x6000;
constexpr std::uint32_t kFrame2Start = 0x7000;
constexpr std::uint32_t kFramesEnd = 0x8000;

std::uint16_t offset_in_page(std::uint32_t address) { return static_cast<std::uint16_t>(address & kPageMask); }
int epwm_module(std::uint32_t address) { return static_cast<int>((address - EPWM_BASE(1)) >> kPageShift); }

Tick halves(std::uint32_t address) { return address >= kFrame2Start ? 2 : 1; }

bool epwm_register_protected(std::uint16_t offset) {
  constexpr std::uint64_t mask = 1ull << EPWM_TZSEL | 1ull << EPWM_TZCTL | 1ull << EPWM_TZEINT | 1ull << EPWM_TZCLR |
                                 1ull << EPWM_TZFRC | 1ull << EPWM_HRCNFG;
  return (mask >> offset & 1u) != 0;
}

}  // namespace

inline Tick Core::read_cycles(std::uint32_t address) const {
  if (address < kFrame1Start) return kFrame0ReadCycles;
  return address < kFramesEnd ? kFrame12ReadCycles : memory_cycles(address);
}

// Most reads are of results of the ADC.
inline std::uint16_t Core::read_word(std::uint32_t address) {
  const std::uint32_t result = address - REG_MIRROR_ADCRESULT0;
  return result < kAdcMirrorWords && system_.adc_clock() ? adc_.result(result, now_) : bus_read(address);
}

// ---- the four accesses ---------------------------------------------------------------------------------

std::uint16_t Core::read16(std::uint32_t address) {
  spend(read_cycles(address));
  ++statistics_.reads;
  std::uint16_t value = 0;
  try {
    value = read_word(address);
    if (world_touched_) after_world();
  } catch (...) {
    fail_with_current_exception();
  }
  finish_access();
  return value;
}

void Core::write16(std::uint32_t address, std::uint16_t value) {
  spend(kWriteCycles);
  ++statistics_.writes;
  try {
    bus_write(address, value);
    if (world_touched_) after_world();
  } catch (...) {
    fail_with_current_exception();
  }
  finish_access();
}

std::uint32_t Core::read32(std::uint32_t address) {
  spend(read_cycles(address) * halves(address));
  ++statistics_.reads;
  std::uint32_t value = 0;
  try {
    if (device_at(address) == Device::kCan && has_register(address)) {
      value = read_can32(address);
    } else {
      value = read_word(address);
      value |= static_cast<std::uint32_t>(read_word(address + 1)) << 16;
    }
    if (world_touched_) after_world();
  } catch (...) {
    fail_with_current_exception();
  }
  finish_access();
  return value;
}

void Core::write32(std::uint32_t address, std::uint32_t value) {
  spend(kWriteCycles * halves(address));
  ++statistics_.writes;
  try {
    if (device_at(address) == Device::kCan && has_register(address)) {
      write_can(address, value, true);
    } else {
      bus_write(address, static_cast<std::uint16_t>(value & 0xFFFFu));
      bus_write(address + 1, static_cast<std::uint16_t>(value >> 16));
    }
    if (world_touched_) after_world();
  } catch (...) {
    fail_with_current_exception();
  }
  finish_access();
}

// ---- what stands in the way of an access ---------------------------------------------------------------

bool Core::protection_stops(std::uint32_t address) {
  if (eallow_) return false;
  ++statistics_.protected_writes_lost;
  statistics_.last_protected_address = address;
  if (code_ != nullptr) code_->note_protected(address);
  return true;
}

bool Core::gate_stops(bool clocked, std::uint32_t address) {
  if (clocked) return false;
  ++statistics_.gated_accesses;
  statistics_.last_gated_address = address;
  if (code_ != nullptr && !inspecting_) code_->note_gated(address);
  return true;
}

void Core::note_unmodelled(std::uint32_t address, bool write) {
  ++statistics_.unmodelled_accesses;
  statistics_.last_unmodelled_address = address;
  if (code_ != nullptr) code_->note_unmodelled(address, write);
}

// ---- reads ---------------------------------------------------------------------------------------------

std::uint16_t Core::bus_read(std::uint32_t address) {
  if (!has_register(address)) {
    note_unmodelled(address, false);
    return 0;
  }
  switch (device_at(address)) {
    case Device::kEPwm:
      return read_epwm(address);
    case Device::kAdc:
      return gate_stops(system_.adc_clock(), address) ? 0 : adc_.read(offset_in_page(address), now_);
    case Device::kAdcMirror:
      if (gate_stops(system_.adc_clock(), address)) return 0;
      return adc_.result(offset_in_page(address), now_);
    case Device::kPie:
      return interrupts_.read(static_cast<std::uint16_t>(address - REG_PIECTRL));
    case Device::kTimers:
      return timers_.read(offset_in_page(address), now_);
    case Device::kGpio:
      world_touched_ = true;
      return read_gpio(static_cast<std::uint16_t>(address - kGpioFrame));
    case Device::kEQep1:
      return gate_stops(system_.eqep_clock(1), address) ? 0 : eqep1_.read(offset_in_page(address), now_);
    case Device::kSci:
      return read_sci(address);
    case Device::kCan:
      return read_can16(address);
    case Device::kSystem:
      return read_system(offset_in_page(address));
    case Device::kI2c:
      return read_i2c(address);
    case Device::kFlash:
      return flash_.read(address);
    case Device::kIdentity:
      return read_identity(address);
    case Device::kSecurity:
      return memory_.read_security(address);
    case Device::kNone:
      break;
  }
  return read_memory(address);
}

std::uint16_t Core::read_epwm(std::uint32_t address) {
  const int module = epwm_module(address);
  if (gate_stops(system_.epwm_clock(module), address)) return 0;
  return epwm_.read(module, offset_in_page(address), now_);
}

std::uint16_t Core::read_sci(std::uint32_t address) {
  return gate_stops(system_.sci_clock(), address) ? 0
                                                  : sci_.read(static_cast<std::uint16_t>(address - SCI_BASE(1)), now_);
}

// Taking a received octet lets the next one begin.
std::uint16_t Core::read_i2c(std::uint32_t address) {
  if (gate_stops(system_.i2c_clock(), address)) return 0;
  const std::uint16_t value = i2c_.read(offset_in_page(address), now_);
  set_due(kI2c, i2c_.next_event());
  return value;
}

std::uint16_t Core::read_system(std::uint16_t offset) const {
  return Watchdog::owns(offset) ? watchdog_.read(offset, now_) : system_.read(offset);
}

std::uint16_t Core::inspect(std::uint32_t address) {
  if (code_ != nullptr && CodeCpu::is_vector(address)) return code_->vector_word(address);
  if (device_at(address) == Device::kNone) return inspect_memory(address);
  if (!has_register(address)) return 0;
  const Inspection inspection(*this);
  if (device_at(address) != Device::kCan) return bus_read(address);
  return static_cast<std::uint16_t>(read_can32(address & ~1u) >> 16 * (address & 1u));
}

// ---- writes --------------------------------------------------------------------------------------------

void Core::bus_write(std::uint32_t address, std::uint16_t value) {
  if (!has_register(address)) {
    note_unmodelled(address, true);
    return;
  }
  switch (device_at(address)) {
    case Device::kEPwm:
      write_epwm(address, value);
      return;
    case Device::kAdc:
      write_adc(address, value);
      return;
    case Device::kPie:
      interrupts_.write(static_cast<std::uint16_t>(address - REG_PIECTRL), value);
      return;
    case Device::kGpio:
      write_gpio(address, value);
      return;
    case Device::kTimers:
      timers_.write(offset_in_page(address), value, now_);
      set_due(kTimers, timers_.next_event());
      return;
    case Device::kEQep1:
      write_eqep1(address, value);
      return;
    case Device::kSci:
      write_sci(address, value);
      return;
    case Device::kI2c:
      write_i2c(address, value);
      return;
    case Device::kCan:
      write_can(address, value, false);
      return;
    case Device::kSystem:
      if (!protection_stops(address)) write_system(offset_in_page(address), value);
      return;
    case Device::kFlash:
      write_flash(address, value);
      return;
    case Device::kIdentity:
      if (address != REG_PARTID && address != REG_REVID)
        protection_stops(address);  // those two cannot be written at all
      return;                       // nothing there is worth changing
    case Device::kAdcMirror:
      return;  // read-only
    case Device::kSecurity:
      if (!protection_stops(address)) memory_.write_security(address, value);
      return;
    case Device::kNone:
      write_memory(address, value);
      return;
  }
}

// What the chip drives itself is never another run's.
std::uint16_t Core::read_gpio(std::uint16_t offset) {
  const std::uint16_t seen = gpio_.read(offset, now_);
  const int word = Gpio::level_word(offset);
  if (recording_ == nullptr || word < 0) return seen;
  const std::uint16_t own = gpio_.driven_here(word);
  const std::int64_t from_outside = recording_->look(Recording::kPins + static_cast<unsigned>(word), seen & ~own);
  return static_cast<std::uint16_t>((from_outside & ~own) | (seen & own));
}

void Core::write_epwm(std::uint32_t address, std::uint16_t value) {
  const int module = epwm_module(address);
  const std::uint16_t offset = offset_in_page(address);
  if (gate_stops(system_.epwm_clock(module), address)) return;
  if (epwm_register_protected(offset) && protection_stops(address)) return;
  if (recording_ != nullptr) recording_->write(address, value, code_ != nullptr ? code_->cpu().r.pc : 0);
  epwm_.write(module, offset, value, now_);
  set_due(kEPwm, epwm_.next_event());
}

void Core::write_adc(std::uint32_t address, std::uint16_t value) {
  if (gate_stops(system_.adc_clock(), address)) return;
  adc_.write(offset_in_page(address), value, now_);
  set_due(kAdc, adc_.next_event());
}

void Core::write_eqep1(std::uint32_t address, std::uint16_t value) {
  if (gate_stops(system_.eqep_clock(1), address)) return;
  eqep1_.write(offset_in_page(address), value, now_);
  set_due(kEQep1, eqep1_.next_event());
}

void Core::write_sci(std::uint32_t address, std::uint16_t value) {
  if (gate_stops(system_.sci_clock(), address)) return;
  sci_.write(static_cast<std::uint16_t>(address - SCI_BASE(1)), value, now_);
  set_due(kSci, sci_.next_event());
}

void Core::write_i2c(std::uint32_t address, std::uint16_t value) {
  if (gate_stops(system_.i2c_clock(), address)) return;
  i2c_.write(offset_in_page(address), value, now_);
  set_due(kI2c, i2c_.next_event());
}

void Core::write_gpio(std::uint32_t address, std::uint16_t value) {
  const auto offset = static_cast<std::uint16_t>(address - kGpioFrame);
  const bool protected_register = Gpio::is_protected(offset);
  if (protected_register && protection_stops(address)) return;
  gpio_.write(offset, value, now_);
  world_touched_ = true;
  if (!protected_register) return;
  pins_dirty_ = true;  // trip inputs may have been routed
  ecan_.set_routed(gpio_.can_routed(), now_);
  set_due(kECanA, ecan_.next_event());
}

void Core::write_flash(std::uint32_t address, std::uint16_t value) {
  if (protection_stops(address)) return;
  flash_.write(address, value);
  check_flash_waits();
}

void Core::write_system(std::uint16_t offset, std::uint16_t value) {
  if (!Watchdog::owns(offset)) {
    apply(system_.write(offset, value, now_));
    return;
  }
  if (watchdog_.write(offset, value, now_) == Watchdog::Outcome::kReset) request_reset();
  set_due(kWatchdog, watchdog_.next_event());
}

}  // namespace stillspin::chip
