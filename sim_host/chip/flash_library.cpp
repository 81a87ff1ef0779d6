// Stands in for TI's flash library: the same functions, on the model's cells. What the caller owes the library
// (hal/f2808/flash_library.h) is checked: a library that is called otherwise destroys a chip, here it ends the run.

#include "hal/f2808/flash_library.h"

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"
#include "sim_host/chip/core.hpp"

// The library's own variables; the program has to set them.
extern "C" {
uint32_t Flash_CPUScaleFactor = 0;
void (*Flash_CallbackPtr)(void) = nullptr;
}

namespace stillspin::chip {
namespace {

constexpr Tick kSlowest = 10;  // ticks of a cycle at 10 MHz

void stop_watchdog() {
  target_eallow();
  target_write16(REG_WDCR, 5u << WDCR_WDCHK_LSB | WDCR_WDDIS_MASK);
  target_edis();
}

void check_duties(Core& core) {
  const Tick period = core.sysclk_period();
  if (period > kSlowest) core.model_error("flash library: SYSCLKOUT below 10 MHz, ticks of a cycle", period);
  if (Flash_CPUScaleFactor != FLASH_LIBRARY_SCALE(100u) / static_cast<std::uint32_t>(period)) {
    core.model_error("flash library: Flash_CPUScaleFactor does not fit SYSCLKOUT", Flash_CPUScaleFactor);
  }
  if ((core.inspect(REG_SCSR) & SCSR_WDOVERRIDE_MASK) == 0) {
    core.model_error("flash library: the watchdog cannot be stopped, SCSR", core.inspect(REG_SCSR));
  }
  stop_watchdog();
}

std::uint16_t program_word(Core& core, std::uint32_t address, std::uint16_t value, flash_library_status_t& status) {
  FlashArray& flash = core.memory().flash();
  status = {address, value, flash.read(address)};
  if ((value & ~status.actual) != 0) return FLASH_LIBRARY_ZERO_BIT;
  flash.begin_program(address, value);
  core.pass(FlashArray::kProgramTime);
  flash.finish_program(address, value);
  return FLASH_LIBRARY_DONE;
}

}  // namespace
}  // namespace stillspin::chip

using stillspin::chip::Core;
using stillspin::chip::FlashArray;
using stillspin::chip::kSectors;

uint16_t Flash2808_Erase(uint16_t sectors, flash_library_status_t* status) {
  Core& core = Core::running();
  *status = {};
  if ((sectors & ((1u << kSectors) - 1u)) == 0) return FLASH_LIBRARY_NO_SECTOR;
  if (core.memory().locked()) return FLASH_LIBRARY_LOCKED;
  stillspin::chip::check_duties(core);
  for (unsigned sector = 0; sector < kSectors; ++sector) {
    if ((sectors >> sector & 1u) == 0) continue;
    core.memory().flash().begin_erase(sector);
    core.pass(FlashArray::kEraseTime);
    core.memory().flash().finish_erase(sector);
  }
  return FLASH_LIBRARY_DONE;
}

uint16_t Flash2808_Program(uint16_t* to, uint16_t* from, uint32_t words, flash_library_status_t* status) {
  Core& core = Core::running();
  const auto address = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(to));
  *status = {};
  if (words == 0 || !FlashArray::owns(address) || !FlashArray::owns(address + words - 1)) return FLASH_LIBRARY_ADDRESS;
  if (core.memory().locked()) return FLASH_LIBRARY_LOCKED;
  stillspin::chip::check_duties(core);
  for (std::uint32_t k = 0; k < words; ++k) {
    const auto result = stillspin::chip::program_word(core, address + k, from[k], *status);
    if (result != FLASH_LIBRARY_DONE) return result;
  }
  *status = {};
  return FLASH_LIBRARY_DONE;
}
