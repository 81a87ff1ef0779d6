#include "sim_host/bench/loader_board.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "firmware/flash_kernel/kernel.h"
#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"
#include "hal/hal_flash.h"
#include "hal/hal_image.h"
#include "sim_host/chip/boot_rom.hpp"
#include "sim_host/chip/memory.hpp"

namespace stillspin::bench {
namespace {

constexpr Tick kFirstStep = 10'000;  // 100 us
constexpr Tick kLongestStep = 50'000'000;
constexpr Tick kRest = 30'000;  // longer than an octet takes at 38400 bit/s
constexpr std::uint16_t kMoment = 10'000;

void wait_for_reset() {
  target_eallow();
  target_write16(REG_WDCR, 5u << WDCR_WDCHK_LSB | WDCR_WDDIS_MASK);
  target_edis();
  for (;;) target_elapse(kMoment);
}

}  // namespace

const char* words_of(Running running) {
  switch (running) {
    case Running::kBootRom:
      return "boot ROM";
    case Running::kKernel:
      return "kernel";
    case Running::kDrive:
      return "drive";
    case Running::kWaiting:
      return "waiting";
    case Running::kUnknown:
      break;
  }
  return "unknown";
}

LoaderBoard::LoaderBoard(LoadedProgram kernel) : kernel_(std::move(kernel)) { switch_on(); }

void LoaderBoard::switch_on() {
  running_ = Running::kBootRom;
  serial_ = devices::SerialLine();
  chip_ = std::make_unique<chip::Chip>(static_cast<chip::World&>(*this), chip::boot_rom);
  chip_->on_jump([this](std::uint32_t entry) { return at(entry); });
}

void LoaderBoard::power_cycle() {
  std::vector<std::uint16_t> cells = flash();
  off_ += chip_->now();
  switch_on();
  set_flash(std::move(cells));
}

// ---- what runs where the boot ROM jumps to ---------------------------------------------------------------

chip::Chip::Firmware LoaderBoard::at(std::uint32_t entry) {
  if (entry == chip::kFlashEntry) return boot_code();
  running_ = entry == kernel_.entry && holds_kernel() ? Running::kKernel : Running::kUnknown;
  return running_ == Running::kKernel ? flash_kernel_main : wait_for_reset;
}

bool LoaderBoard::holds_kernel() {
  for (const auto& [start, words] : kernel_.blocks) {
    for (std::uint32_t k = 0; k < words.size(); ++k) {
      if (chip_->memory().ram(start + k) != words[k]) return false;
    }
  }
  return true;
}

chip::Chip::Firmware LoaderBoard::boot_code() {
  const auto cell = [this](std::uint32_t address) { return chip_->memory().flash().read(address); };
  if (cell(HAL_FLASH_BOOT_ENTRY) == HAL_FLASH_ERASED) {
    running_ = Running::kUnknown;
  } else {
    running_ = cell(HAL_FLASH_IMAGE_IDENTITY) == HAL_IMAGE_MARK ? Running::kDrive : Running::kWaiting;
  }
  return wait_for_reset;
}

// ---- time --------------------------------------------------------------------------------------------------

void LoaderBoard::advance(Tick ticks) {
  if (ticks < 0) throw std::invalid_argument("time does not go back: ticks must not be negative");
  chip_->run_until(chip_->now() + ticks);
}

// In steps that grow while nothing comes: an erase takes ten seconds.
bool LoaderBoard::advance_until_heard(Tick ticks) {
  const Tick end = chip_->now() + ticks;
  const std::uint64_t before = serial_.counts().received;
  for (Tick step = kFirstStep; chip_->now() < end && serial_.counts().received == before;
       step = std::min(2 * step, kLongestStep)) {
    advance(std::min(step, end - chip_->now()));
  }
  if (serial_.counts().received == before) return false;
  for (std::uint64_t heard = before; serial_.counts().received != heard;) {
    heard = serial_.counts().received;
    advance(kRest);
  }
  return true;
}

// ---- plugs ---------------------------------------------------------------------------------------------------

bool LoaderBoard::pin_level(Tick t, int pin) {
  if (pin == 28) return serial_.level(t);
  for (unsigned k = 0; k < 3; ++k) {
    if (pin == chip::kBootPins[k]) return (static_cast<unsigned>(jumpers_) >> (2 - k) & 1u) != 0;
  }
  return false;
}

const std::vector<std::uint16_t>& LoaderBoard::flash() { return chip_->memory().flash().words(); }

void LoaderBoard::set_flash(std::vector<std::uint16_t> words) {
  if (words.size() != flash().size()) {
    throw std::invalid_argument("the flash holds " + std::to_string(flash().size()) + " words, not " +
                                std::to_string(words.size()));
  }
  chip_->memory().flash().words() = std::move(words);
}

}  // namespace stillspin::bench
