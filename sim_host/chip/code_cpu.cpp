#include "sim_host/chip/code_cpu.hpp"

#include <algorithm>

#include "hal/f2808/registers.h"
#include "sim_host/chip/core.hpp"

namespace stillspin::chip {
namespace {

constexpr std::uint32_t kInterruptCycles = 14;
constexpr std::uint16_t kStack = 0x0400;
constexpr std::uint32_t kRomVectors = 0x3FFFC0;
constexpr std::uint32_t kRomTargets = 0x000040;  // vectors of the boot ROM point into M0, two words each
constexpr std::uint32_t kFrames = 0x6000;        // peripheral frames 1 and 2
constexpr std::uint32_t kFramesWords = 0x2000;
constexpr std::uint32_t kSecondMapping = 0x3F0000;
constexpr unsigned kFlashBlock = 0x80;
constexpr unsigned kRomBlock = 0x40;
constexpr std::uint32_t kRomTimed = 0xC00;  // words; the vectors behind are in an interrupt's cycles
constexpr unsigned kPieLines = 12;

struct Block {
  std::uint32_t first, words;
  bool twice;  // again at the top of memory
};
constexpr Block kRam[] = {{0x0000, 0x400, false},
                          {0x0400, 0x400, false},
                          {0x8000, 0x1000, true},
                          {0x9000, 0x1000, true},
                          {0xA000, 0x2000, true}};

bool is_flash_register(std::uint32_t address) { return address >= REG_FOPT && address <= REG_FOTPWAIT; }

}  // namespace

CodeCpu::CodeCpu(Core& chip) : chip_(chip), cpu_(*this) {
  cpu_.set_interrupt_cycles(kInterruptCycles);
  map();
}

void CodeCpu::map() {
  for (std::size_t k = 0; k < ram_.size(); ++k) {
    const Block& block = kRam[k];
    ram_[k].block = static_cast<std::uint8_t>(k + 1);
    for (const std::uint32_t base : {0U, kSecondMapping}) {
      if (base != 0 && !block.twice) continue;
      cpu_.map(base + block.first, block.words, chip_.memory_.ram_words(block.first), true);
      cpu_.set_region(base + block.first, block.words, ram_[k]);
    }
  }
  cpu_.map(kFlashStart, kFlashEnd - kFlashStart, chip_.memory_.flash().words().data(), false);
  flash_.block = kFlashBlock;
  cpu_.set_region(kFlashStart, kFlashEnd - kFlashStart, flash_);
  rom_.block = kRomBlock;
  rom_.read_waits = 1;
  rom_.fetch_first = rom_.fetch_next = 2;
  cpu_.set_region(kBootRom, kRomTimed, rom_);
  frames_.ordered = true;
  cpu_.set_region(kFrames, kFramesWords, frames_);
}

// With its pipeline on, a fetch brings 64 bits and two more are kept beside the CPU's queue of eight words; without it
// the queue is filled by 32 bits.
void CodeCpu::note_flash_waits() {
  const unsigned waits = chip_.flash_.bank_wait();
  const unsigned random = (waits & FBANKWAIT_RANDWAIT_MASK) >> FBANKWAIT_RANDWAIT_LSB;
  const unsigned paged = (waits & FBANKWAIT_PAGEWAIT_MASK) >> FBANKWAIT_PAGEWAIT_LSB;
  flash_.read_waits = static_cast<std::uint8_t>(random);
  flash_.fetch_first = static_cast<std::uint8_t>(random + 1);
  flash_.fetch_next = static_cast<std::uint8_t>(paged + 1);
  flash_.fetch_shift = (chip_.flash_.read(REG_FOPT) & FOPT_ENPIPE_MASK) != 0 ? 2 : 1;
}

void CodeCpu::run(std::uint32_t entry) {
  cpu_.reset();
  cpu_.r.objmode = true;
  cpu_.r.sp = kStack;
  cpu_.jump(entry);
  settled_ = cpu_.cycles;
  note_flash_waits();
  for (;;) {
    settle();
    const Tick free = (chip_.horizon_ - chip_.now_) / chip_.period_;
    const c28x::Stop stop = cpu_.run(cpu_.cycles + static_cast<std::uint64_t>(std::max<Tick>(free, 1)));
    if (stop == c28x::Stop::kIdle) sleep();
    if (stop == c28x::Stop::kBreakpoint) halt();
    if (stop == c28x::Stop::kUnmodelled) {
      chip_.model_error("address mode 1 is not modelled, and the program sets AMODE", 1);
      chip_.leave_firmware();
    }
  }
}

// Brings the chip to the cycle in which the core is. An access may have taken it further than the instruction lasts.
void CodeCpu::settle() {
  if (cpu_.cycles > settled_) {
    const auto passed = static_cast<Tick>(cpu_.cycles - settled_);
    settled_ = cpu_.cycles;
    chip_.spend(passed);
  }
  collect();
}

void CodeCpu::collect() {
  if (chip_.interrupts_.ifr() == 0 || chip_.interrupts_.held()) return;
  cpu_.r.ifr = static_cast<std::uint16_t>(cpu_.r.ifr | chip_.interrupts_.ifr());
  chip_.interrupts_.clear_ifr();
}

void CodeCpu::sleep() {
  settle();
  if (chip_.system_.low_power_mode_selected()) {
    chip_.model_error("IDLE with a low-power mode selected in LPMCR0 is not modelled", 0);
  }
  const Tick begin = chip_.now_;
  const Tick idle = chip_.statistics_.idle_ticks;
  const std::uint64_t cycles = cpu_.cycles;
  chip_.idle_ = true;
  while ((cpu_.r.ifr & cpu_.r.ier) == 0) {
    if (chip_.now_ >= chip_.limit_) chip_.coroutine_.suspend();  // whoever looks then sees how long it has slept
    const bool held = chip_.interrupts_.held();
    chip_.interrupts_.set_ier(held ? std::uint16_t{0} : cpu_.r.ier);
    chip_.wait_for_interrupt(chip_.limit_, false);
    chip_.statistics_.idle_ticks = idle + (chip_.now_ - begin);
    cpu_.cycles = cycles;
    note_passed(begin);
    collect();
  }
  chip_.idle_ = false;
}

// The chip's time has gone on by itself.
void CodeCpu::note_passed(Tick begin) {
  cpu_.cycles += static_cast<std::uint64_t>((chip_.now_ - begin) / chip_.period_);
  settled_ = cpu_.cycles;
}

// Before an instruction: the host has the word until it lets time pass again.
void CodeCpu::halt() {
  settle();
  c28x::Watch& watch = cpu_.watch();
  if (watch.is_replaced()) {
    const Tick begin = chip_.now_;
    flash_library_.carry_out(chip_, cpu_);
    note_passed(begin);
    if (chip_.stop_) chip_.leave_firmware();
    return;
  }
  watch.halted = true;
  chip_.coroutine_.suspend();
  watch.halted = false;
}

void CodeCpu::replace_flash_library(const FlashLibrary& places) {
  flash_library_ = places;
  for (const std::uint32_t place : places.functions()) cpu_.watch().replace_code_at(place);
}

// ---- the bus -------------------------------------------------------------------------------------------------

// The access is at the instruction's place in time, with the waits that the bus counts; what it changes may let events
// come earlier, so the core looks at them after the instruction.
template <typename Access>
void CodeCpu::at_the_bus(Access access) {
  settle();
  chip_.eallow_ = cpu_.r.eallow;
  const Tick period = chip_.period_;
  const Tick begin = chip_.now_;
  access();
  const auto spent = static_cast<std::uint64_t>((chip_.now_ - begin) / period);
  settled_ += spent;
  if (spent > 1) cpu_.wait_for_data(spent - 1);
  collect();
  cpu_.yield();
}

bool CodeCpu::is_in_rom(std::uint32_t address) const {
  return address >= kBootRom && (address >= kRomVectors || chip_.memory_.rom(address));
}

std::uint16_t CodeCpu::read(std::uint32_t address) {
  if (is_vector(address)) return vectors_[address - kVectors];
  if (is_in_rom(address)) {
    const std::uint32_t target = address % 2 == 0 ? kRomTargets + address - kRomVectors : 0;
    return chip_.memory_.rom(address).value_or(static_cast<std::uint16_t>(target));
  }
  std::uint16_t value = 0;
  at_the_bus([&] { value = chip_.read16(address); });
  return value;
}

std::uint32_t CodeCpu::read_pair(std::uint32_t address) {
  if (is_vector(address) || is_in_rom(address)) return Bus::read_pair(address);
  std::uint32_t value = 0;
  at_the_bus([&] { value = chip_.read32(address); });
  return value;
}

void CodeCpu::write(std::uint32_t address, std::uint16_t value) {
  if (is_vector(address)) {
    chip_.eallow_ = cpu_.r.eallow;
    if (!chip_.protection_stops(address)) vectors_[address - kVectors] = value;
    return;
  }
  at_the_bus([&] { chip_.write16(address, value); });
  if (is_flash_register(address)) note_flash_waits();
}

void CodeCpu::write_pair(std::uint32_t address, std::uint32_t value) {
  if (is_vector(address)) return Bus::write_pair(address, value);
  at_the_bus([&] { chip_.write32(address, value); });
}

// From the table in the PIE's RAM, where that is on.
std::uint32_t CodeCpu::vector(unsigned number, std::uint32_t listed) {
  if (number == 0) return listed;  // the reset, which the boot ROM has dealt with
  settle();
  ++chip_.statistics_.interrupts;
  unsigned chosen = number;
  if (number >= 1 && number <= kPieLines) {
    bool spurious = false;
    chosen = chip_.interrupts_.fetch(number - 1, spurious);
    if (spurious) ++chip_.statistics_.spurious_interrupts;
  }
  const std::size_t at = 2 * std::size_t{chosen};
  const std::uint32_t routine =
      chip_.interrupts_.table_enabled() ? c28x::joined(vectors_[at + 1], vectors_[at]) : listed;
  if (cpu_.profile() != nullptr) cpu_.profile()->enter(chosen, routine, cpu_.cycles);
  return routine;
}

}  // namespace stillspin::chip
