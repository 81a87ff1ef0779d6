#include "sim_host/chip/chip.hpp"

#include <stdexcept>
#include <utility>

#include "sim_host/chip/core.hpp"
#include "sim_host/chip/memory.hpp"

namespace stillspin::chip {
namespace {

void put(Memory& memory, const CodeBlocks& blocks, bool (Memory::*load)(std::uint32_t, std::uint16_t),
         const char* missing) {
  for (const auto& [first, words] : blocks) {
    for (std::size_t k = 0; k < words.size(); ++k) {
      const auto address = static_cast<std::uint32_t>(first + k);
      if (!(memory.*load)(address, words[k])) {
        throw std::invalid_argument(std::string("the chip has ") + missing + " at address " + std::to_string(address));
      }
    }
  }
}

}  // namespace

Chip::Chip(World& world, Firmware firmware) : core_(std::make_unique<Core>(world, firmware)) {}
Chip::~Chip() = default;

void Chip::run_until(Tick t) { core_->run_until(t); }
Tick Chip::now() const { return core_->now(); }
Statistics Chip::statistics() const { return core_->statistics(); }
const std::string& Chip::error() const { return core_->error(); }
void Chip::pins_changed() { core_->pins_changed(); }
void Chip::set_revision(std::uint16_t revision) { core_->set_revision(revision); }
void Chip::block_adc_triggers(bool on) { core_->block_adc_triggers(on); }
void Chip::hold_interrupts(bool on) { core_->hold_interrupts(on); }
void Chip::fail(Failure failure) { core_->fail(failure); }
void Chip::stop_can_transmission() { core_->stop_can_transmission(); }
bool Chip::is_idle() const { return core_->is_idle(); }
void Chip::on_jump(Jump jump) { core_->on_jump(std::move(jump)); }
c28x::Core& Chip::execute_code() { return core_->execute_code(); }
void Chip::replace_flash_library(const FlashLibrary& places) { core_->replace_flash_library(places); }
Recording& Chip::recording() { return core_->recording(); }
void Chip::raise_interrupt(unsigned vector) {
  if (core_->raise_from_outside(vector)) return;
  throw std::invalid_argument("no interrupt line has vector " + std::to_string(vector) + ": 13, 14, 32 to 127");
}
void Chip::load(const CodeBlocks& blocks) { put(core_->memory(), blocks, &Memory::load, "neither flash nor RAM"); }
void Chip::load_rom(const CodeBlocks& blocks) { put(core_->memory(), blocks, &Memory::load_rom, "no boot ROM"); }
const InVain& Chip::in_vain() const { return core_->in_vain(); }
Memory& Chip::memory() { return core_->memory(); }
std::uint16_t Chip::inspect(std::uint32_t address) { return core_->inspect(address); }

}  // namespace stillspin::chip
