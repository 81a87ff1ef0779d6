#include "tests/hal/fake_bus.hpp"

#include <cstdio>
#include <utility>

#include "hal/f2808/registers.h"

namespace stillspin::test {

namespace {

FakeBus* the_bus = nullptr;

constexpr std::uint32_t kEPwmFrame = 0x40;
constexpr std::uint32_t kEPwmEnd = 0x6980;
constexpr std::uint32_t kEQep1End = 0x6B40;
constexpr std::uint32_t kAccessCycles = 2;

bool in(std::uint32_t address, std::uint32_t first, std::uint32_t last) { return address >= first && address <= last; }
bool is_epwm(std::uint32_t address) { return in(address, EPWM_BASE(1), kEPwmEnd - 1); }

// From the register list of the chip, written down a second time here on purpose.
bool needs_eallow(std::uint32_t address) {
  if (is_epwm(address)) {
    const std::uint32_t offset = (address - EPWM_BASE(1)) % kEPwmFrame;
    return in(offset, 0x12, 0x18) || offset == 0x20;  // trip zone, high resolution
  }
  return in(address, 0x7010, 0x702F) || in(address, 0x0A80, 0x0A87) || in(address, 0x6F80, 0x6FBF) ||
         in(address, 0x6FE0, 0x6FFF);
}

}  // namespace

FakeBus& FakeBus::current() { return *the_bus; }

FakeBus::FakeBus() : previous_(the_bus) {
  the_bus = this;
  words[REG_WDCR] = 0;
  words[REG_GPADAT] = 0xFFFF;  // inputs have pull-ups
  words[REG_GPADAT + 1] = 0xFFFF;
}

FakeBus::~FakeBus() { the_bus = previous_; }

void FakeBus::power_all() {
  words[REG_PCLKCR0] = PCLKCR0_ADCENCLK_MASK | PCLKCR0_SCIAENCLK_MASK;
  words[REG_PCLKCR1] = 0xFFFF;
  steps.clear();
}

std::uint32_t FakeBus::word32(std::uint32_t address) const {
  const auto low = words.find(address);
  const auto high = words.find(address + 1);
  return (low == words.end() ? 0u : low->second) |
         (high == words.end() ? 0u : static_cast<std::uint32_t>(high->second) << 16);
}

void FakeBus::set32(std::uint32_t address, std::uint32_t value) {
  words[address] = static_cast<std::uint16_t>(value & 0xFFFFu);
  words[address + 1] = static_cast<std::uint16_t>(value >> 16);
}

std::vector<std::uint32_t> FakeBus::written(std::uint32_t address) const {
  std::vector<std::uint32_t> values;
  for (const Step& step : steps) {
    if (step.op == Op::kWrite && step.address == address) values.push_back(step.value);
  }
  return values;
}

std::size_t FakeBus::first_write(std::uint32_t address, std::uint32_t bits) const {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].op == Op::kWrite && steps[i].address == address && (steps[i].value & bits) == bits) {
      return i;
    }
  }
  return npos;
}

std::size_t FakeBus::last_write(std::uint32_t address) const {
  std::size_t found = npos;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    found = steps[i].op == Op::kWrite && steps[i].address == address ? i : found;
  }
  return found;
}

std::size_t FakeBus::first_read(std::uint32_t address, std::size_t from) const {
  for (std::size_t i = from; i < steps.size(); ++i) {
    if (steps[i].op == Op::kRead && steps[i].address == address) {
      return i;
    }
  }
  return npos;
}

std::size_t FakeBus::first(Op op) const {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].op == op) {
      return i;
    }
  }
  return npos;
}

std::size_t FakeBus::count_writes() const {
  std::size_t count = 0;
  for (const Step& step : steps) {
    count += step.op == Op::kWrite ? 1 : 0;
  }
  return count;
}

std::size_t FakeBus::last_write_of_all() const {
  std::size_t found = npos;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    found = steps[i].op == Op::kWrite ? i : found;
  }
  return found;
}

void FakeBus::watch_rules(std::uint32_t address) {
  char where[16];
  std::snprintf(where, sizeof where, "0x%04X", static_cast<unsigned>(address));
  if (needs_eallow(address) && !protection_lifted) {
    violations.push_back(std::string("protected register written without EALLOW: ") + where);
  }
  const bool adc = in(address, REG_ADCTRL1, REG_ADCOFFTRIM);
  if (adc && (words[REG_PCLKCR0] & PCLKCR0_ADCENCLK_MASK) == 0) {
    violations.push_back(std::string("ADC written without a clock: ") + where);
  }
  const bool epwm = is_epwm(address);
  const std::uint32_t module = epwm ? (address - EPWM_BASE(1)) / kEPwmFrame : 0;
  if (epwm && (words[REG_PCLKCR1] & (1u << module)) == 0) {
    violations.push_back(std::string("ePWM written without a clock: ") + where);
  }
  if (in(address, SCI_BASE(1), SCI_BASE(1) + SCI_PRI) && (words[REG_PCLKCR0] & PCLKCR0_SCIAENCLK_MASK) == 0) {
    violations.push_back(std::string("SCI-A written without a clock: ") + where);
  }
  if (in(address, EQEP_BASE(1), kEQep1End - 1) && (words[REG_PCLKCR1] & PCLKCR1_EQEP1ENCLK_MASK) == 0) {
    violations.push_back(std::string("eQEP1 written without a clock: ") + where);
  }
}

void FakeBus::behave(std::uint32_t address, std::uint16_t value) {
  if (address == REG_PLLCR) {
    words[REG_PLLSTS] = static_cast<std::uint16_t>(words[REG_PLLSTS] | (pll_locks ? PLLSTS_PLLLOCKS_MASK : 0u));
  }
  if (is_epwm(address)) {
    const std::uint32_t offset = (address - EPWM_BASE(1)) % kEPwmFrame;
    std::uint16_t& flags = words[address - offset + EPWM_TZFLG];
    if (offset == EPWM_TZFRC) {
      flags = static_cast<std::uint16_t>(flags | value);
    } else if (offset == EPWM_TZCLR) {
      flags = static_cast<std::uint16_t>(flags & ~value);
    }
  }
}

std::uint16_t FakeBus::read16(std::uint32_t address) {
  cycles += kAccessCycles;
  record(Op::kRead, address, 0);
  return spoils ? spoils(words[address]) : words[address];
}

void FakeBus::write16(std::uint32_t address, std::uint16_t value) {
  cycles += kAccessCycles;
  watch_rules(address);
  words[address] = value;
  behave(address, value);
  if (const std::function<void()> comes = std::exchange(between, nullptr)) {
    comes();
    between = comes;
  }
}

}  // namespace stillspin::test

using stillspin::test::FakeBus;
using stillspin::test::Op;

std::uint16_t target_read16(std::uint32_t address) { return FakeBus::current().read16(address); }

void target_write16(std::uint32_t address, std::uint16_t value) {
  FakeBus::current().record(Op::kWrite, address, value);
  FakeBus::current().write16(address, value);
}

std::uint32_t target_read32(std::uint32_t address) {
  FakeBus& bus = FakeBus::current();
  if (address == CPUTIMER_BASE(2) + CPUTIMER_TIM) {
    bus.cycles += 2;
    return 0xFFFFFFFFu - static_cast<std::uint32_t>(bus.cycles);
  }
  const std::uint32_t low = bus.read16(address);
  return low | static_cast<std::uint32_t>(bus.words[address + 1]) << 16;
}

void target_write32(std::uint32_t address, std::uint32_t value) {
  FakeBus& bus = FakeBus::current();
  bus.record(Op::kWrite, address, value);
  bus.write16(address, static_cast<std::uint16_t>(value & 0xFFFFu));
  bus.write16(address + 1, static_cast<std::uint16_t>(value >> 16));
}

void target_eallow() {
  FakeBus::current().record(Op::kEallow, 0, 0);
  FakeBus::current().protection_lifted = true;
}

void target_edis() {
  FakeBus::current().record(Op::kEdis, 0, 0);
  FakeBus::current().protection_lifted = false;
}

void target_enable_interrupts() { FakeBus::current().record(Op::kEnableInterrupts, 0, 0); }
void target_disable_interrupts() { FakeBus::current().record(Op::kDisableInterrupts, 0, 0); }
std::uint16_t target_read_ier() { return FakeBus::current().ier; }

void target_write_ier(std::uint16_t mask) {
  FakeBus::current().record(Op::kWriteIer, 0, mask);
  FakeBus::current().ier = mask;
}

void target_clear_ifr() { FakeBus::current().record(Op::kClearIfr, 0, 0); }

void target_set_vector(std::uint16_t vector, target_isr_t isr) {
  FakeBus& bus = FakeBus::current();
  bus.record(Op::kSetVector, vector, 0);
  if (!bus.protection_lifted) {
    bus.violations.push_back("vector written without EALLOW");
  }
  bus.vectors[vector] = isr;
}

void target_idle() { FakeBus::current().record(Op::kIdle, 0, 0); }
void target_elapse(std::uint16_t cycles) { FakeBus::current().cycles += cycles; }
