#include "sim_host/chip/system_control.hpp"

namespace stillspin::chip {
namespace {

constexpr Tick kLockCycles = 131072;  // of OSCCLK
constexpr unsigned kMaxMultiplier = 10;
constexpr std::uint16_t kStatusWritable =
    PLLSTS_CLKINDIV_MASK | PLLSTS_PLLOFF_MASK | PLLSTS_OSCOFF_MASK | PLLSTS_MCLKOFF_MASK;
constexpr std::uint16_t kGates0Mask = 0xCFDC;  // the gates that exist on the F2808
constexpr std::uint16_t kGates1Mask = 0xCF3F;
constexpr std::uint16_t kLowPowerReset = 0x00FC;
constexpr std::uint16_t kXclkMask = XCLK_XCLKOUTDIV_MASK;

constexpr std::uint16_t offset_of(std::uint32_t address) { return static_cast<std::uint16_t>(address - kSystemFrame); }

}  // namespace

void SystemControl::reset() {
  xclk_ = status_ = gates0_ = gates1_ = multiplier_ = 0;
  hispcp_ = 1;
  lospcp_ = 2;
  low_power_ = kLowPowerReset;
  lock_ = kNever;
  update_clock();
}

unsigned SystemControl::divider() const { return (status_ & PLLSTS_CLKINDIV_MASK) != 0 ? 1u : 2u; }

bool SystemControl::ratio_is_whole(unsigned multiplier) const {
  return (kOscillatorPeriod * divider()) % static_cast<Tick>(multiplier) == 0;
}

unsigned SystemControl::update_clock() {
  const bool locking = lock_ != kNever;
  const unsigned multiplier = multiplier_ == 0 || locking ? 1u : multiplier_;
  if (!ratio_is_whole(multiplier)) {
    services_.model_error("SYSCLKOUT period is not a whole number of 10 ns ticks with this PLLCR and PLLSTS.CLKINDIV",
                          multiplier);
    return kNothing;
  }
  const Tick period = kOscillatorPeriod * divider() / multiplier;
  const bool changed = period != period_;
  period_ = period;
  return changed ? kClocks : kNothing;
}

unsigned SystemControl::run_event() {
  lock_ = kNever;
  return update_clock();
}

bool SystemControl::eqep_clock(int instance) const {
  return (gates1_ >> (PCLKCR1_EQEP1ENCLK_LSB + instance - 1) & 1u) != 0;
}
bool SystemControl::time_base_clock() const { return (gates0_ & PCLKCR0_TBCLKSYNC_MASK) != 0; }
bool SystemControl::low_power_mode_selected() const { return (low_power_ & LPMCR0_LPM_MASK) != 0; }

std::uint16_t SystemControl::read(std::uint16_t offset) const {
  switch (offset) {
    case offset_of(REG_XCLK):
      return xclk_;
    case offset_of(REG_PLLSTS):
      return static_cast<std::uint16_t>(status_ | (lock_ == kNever ? PLLSTS_PLLLOCKS_MASK : 0));
    case offset_of(REG_HISPCP):
      return hispcp_;
    case offset_of(REG_LOSPCP):
      return lospcp_;
    case offset_of(REG_PCLKCR0):
      return gates0_;
    case offset_of(REG_PCLKCR1):
      return gates1_;
    case offset_of(REG_LPMCR0):
      return low_power_;
    case offset_of(REG_PLLCR):
      return multiplier_;
    default:
      return 0;
  }
}

unsigned SystemControl::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  switch (offset) {
    case offset_of(REG_XCLK):
      xclk_ = value & kXclkMask;
      return kNothing;
    case offset_of(REG_PLLSTS):
      return write_status(value);
    case offset_of(REG_HISPCP):
      hispcp_ = value & HISPCP_HSPCLK_MASK;
      return kClocks;
    case offset_of(REG_LOSPCP):
      lospcp_ = value & LOSPCP_LSPCLK_MASK;
      return kClocks;
    case offset_of(REG_PCLKCR0):
      gates0_ = value & kGates0Mask;
      return kClocks | kTimeBase;
    case offset_of(REG_PCLKCR1):
      gates1_ = value & kGates1Mask;
      return kClocks;
    case offset_of(REG_LPMCR0):
      low_power_ = value;
      return kNothing;
    case offset_of(REG_PLLCR):
      return write_multiplier(value & PLLCR_DIV_MASK, t);
    default:
      return kNothing;
  }
}

unsigned SystemControl::write_status(std::uint16_t value) {
  status_ = value & kStatusWritable;
  return update_clock();
}

unsigned SystemControl::write_multiplier(std::uint16_t value, Tick t) {
  if ((status_ & PLLSTS_CLKINDIV_MASK) != 0) {
    services_.model_error("PLLCR written while PLLSTS.CLKINDIV is set: clear CLKINDIV first", value);
    return kNothing;
  }
  if (value > kMaxMultiplier || (value != 0 && !ratio_is_whole(value))) {
    services_.model_error("PLLCR not possible: at OSCCLK 20 MHz only 0, 1, 2, 5, 10 give whole 10 ns ticks", value);
    return kNothing;
  }
  multiplier_ = value;
  lock_ = value == 0 ? kNever : t + kLockCycles * kOscillatorPeriod;
  return update_clock();
}

}  // namespace stillspin::chip
