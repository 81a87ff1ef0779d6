#include "sim_host/chip/watchdog.hpp"

#include "hal/f2808/registers.h"
#include "sim_host/chip/system_control.hpp"

namespace stillspin::chip {
namespace {

constexpr Tick kBaseStep = 512 * kOscillatorPeriod;
constexpr Tick kInterruptPulse = 512 * kOscillatorPeriod;
constexpr std::uint16_t kCounts = 256;
constexpr std::uint16_t kCheck = 5u << WDCR_WDCHK_LSB;
constexpr std::uint16_t kFirstKey = 0x55;
constexpr std::uint16_t kSecondKey = 0xAA;

constexpr std::uint16_t offset_of(std::uint32_t address) { return static_cast<std::uint16_t>(address - kSystemFrame); }

// WDPS 0 and 1 both mean no division.
constexpr Tick step_for(std::uint16_t prescale) { return kBaseStep << (prescale == 0 ? 0 : prescale - 1); }

}  // namespace

bool Watchdog::owns(std::uint16_t offset) {
  return offset == offset_of(REG_SCSR) || offset == offset_of(REG_WDCNTR) || offset == offset_of(REG_WDKEY) ||
         offset == offset_of(REG_WDCR);
}

void Watchdog::reset(Tick t, bool by_watchdog) {
  prescale_ = 0;
  disabled_ = false;
  flag_ = by_watchdog;
  override_ = true;
  interrupt_mode_ = false;
  armed_ = false;
  interrupt_end_ = 0;
  start(0, t);
}

std::uint16_t Watchdog::count(Tick t) const {
  if (disabled_) return count_;
  return static_cast<std::uint16_t>((count_ + (t - since_) / step_) % kCounts);
}

void Watchdog::start(std::uint16_t count, Tick t) {
  count_ = count;
  since_ = t;
  step_ = step_for(prescale_);
  overflow_ = disabled_ ? kNever : t + (kCounts - count) * step_;
}

Watchdog::Outcome Watchdog::expire(Tick t) {
  if (!interrupt_mode_) return Outcome::kReset;
  interrupt_end_ = t + kInterruptPulse;
  services_.raise_interrupt(VECTOR_WAKEINT, t);
  return Outcome::kNothing;
}

Watchdog::Outcome Watchdog::run_event(Tick t) {
  start(0, t);
  return expire(t);
}

std::uint16_t Watchdog::read(std::uint16_t offset, Tick t) const {
  switch (offset) {
    case offset_of(REG_SCSR):
      return static_cast<std::uint16_t>((override_ ? SCSR_WDOVERRIDE_MASK : 0) |
                                        (interrupt_mode_ ? SCSR_WDENINT_MASK : 0) |
                                        (t >= interrupt_end_ ? SCSR_WDINTS_MASK : 0));
    case offset_of(REG_WDCNTR):
      return count(t);
    case offset_of(REG_WDKEY):  // a read of the key port gives the control register
    case offset_of(REG_WDCR):
      return static_cast<std::uint16_t>(prescale_ | (disabled_ ? WDCR_WDDIS_MASK : 0) | (flag_ ? WDCR_WDFLAG_MASK : 0));
    default:
      return 0;
  }
}

Watchdog::Outcome Watchdog::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  switch (offset) {
    case offset_of(REG_SCSR):
      write_scsr(value);
      return Outcome::kNothing;
    case offset_of(REG_WDKEY):
      write_key(value, t);
      return Outcome::kNothing;
    case offset_of(REG_WDCR):
      return write_control(value, t);
    default:
      return Outcome::kNothing;  // WDCNTR is read-only
  }
}

void Watchdog::write_scsr(std::uint16_t value) {
  if ((value & SCSR_WDOVERRIDE_MASK) != 0) override_ = false;
  interrupt_mode_ = (value & SCSR_WDENINT_MASK) != 0;
}

void Watchdog::write_key(std::uint16_t value, Tick t) {
  const std::uint16_t key = value & WDKEY_WDKEY_MASK;
  if (key == kSecondKey && armed_ && !disabled_) start(0, t);
  armed_ = key == kFirstKey;
}

Watchdog::Outcome Watchdog::write_control(std::uint16_t value, Tick t) {
  if ((value & WDCR_WDCHK_MASK) != kCheck) return expire(t);
  const std::uint16_t now = count(t);
  const std::uint16_t prescale = value & WDCR_WDPS_MASK;
  const bool disabled = override_ ? (value & WDCR_WDDIS_MASK) != 0 : disabled_;
  if ((value & WDCR_WDFLAG_MASK) != 0) flag_ = false;                            // write 1 clears
  if (prescale == prescale_ && disabled == disabled_) return Outcome::kNothing;  // keeps the started count
  prescale_ = prescale;
  disabled_ = disabled;
  start(now, t);
  return Outcome::kNothing;
}

}  // namespace stillspin::chip
