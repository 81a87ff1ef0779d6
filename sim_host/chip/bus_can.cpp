// Accesses to the eCAN: the only peripheral for which one access of 32 bits is not two of 16.

#include "hal/f2808/registers.h"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

std::uint16_t can_offset(std::uint32_t address) { return static_cast<std::uint16_t>(address - REG_CANME); }

}  // namespace

std::uint16_t Core::read_can16(std::uint32_t address) {
  return gate_stops(system_.can_clock(), address) ? 0 : ecan_.read16(can_offset(address), now_);
}

std::uint32_t Core::read_can32(std::uint32_t address) {
  return gate_stops(system_.can_clock(), address) ? 0 : ecan_.read32(can_offset(address), now_);
}

void Core::write_can(std::uint32_t address, std::uint32_t value, bool wide) {
  const std::uint16_t offset = can_offset(address);
  if (gate_stops(system_.can_clock(), address)) return;
  if (ECan::is_protected(offset) && protection_stops(address)) return;
  if (wide) {
    ecan_.write32(offset, value, now_);
  } else {
    ecan_.write16(offset, static_cast<std::uint16_t>(value), now_);
  }
  set_due(kECanA, ecan_.next_event());
  world_touched_ = true;  // the bus may have something to do now
}

}  // namespace stillspin::chip
