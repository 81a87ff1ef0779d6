// System control: PLL and SYSCLKOUT, peripheral clock gates and prescalers, low-power mode selection.
//
// The board's crystal gives OSCCLK = 20 MHz. A bypassed PLL (PLLCR = 0, also the state after reset) gives OSCCLK / 2,
// or OSCCLK with CLKINDIV set; otherwise SYSCLKOUT = OSCCLK * PLLCR / 2. Time is counted in ticks of 10 ns, so only
// ratios with a whole number of ticks per cycle can be simulated: at 20 MHz PLLCR = 1, 2, 5, 10. Others are a model
// error. A write to PLLCR drops SYSCLKOUT to OSCCLK / 2 until the PLL has locked, 131072 OSCCLK cycles later. Source:
// SPRU712 (clocking), TI's DSP280x_SysCtrl.c (order of the writes).

#ifndef STILLSPIN_SIM_HOST_CHIP_SYSTEM_CONTROL_HPP
#define STILLSPIN_SIM_HOST_CHIP_SYSTEM_CONTROL_HPP

#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

inline constexpr Tick kOscillatorPeriod = 5;  // OSCCLK 20 MHz

class SystemControl {
 public:
  /// What a write or an event means for the rest of the chip; flags may be combined.
  enum Effect : unsigned { kNothing = 0, kClocks = 1, kTimeBase = 2 };

  explicit SystemControl(ChipServices& services) : services_(services) {}

  void reset();
  std::uint16_t read(std::uint16_t offset) const;  // from kSystemFrame
  unsigned write(std::uint16_t offset, std::uint16_t value, Tick t);

  /// The PLL locks.
  Tick next_event() const { return lock_; }
  unsigned run_event();

  Tick sysclk_period() const { return period_; }
  unsigned hspclk_divider() const { return hispcp_ == 0 ? 1u : 2u * hispcp_; }
  unsigned lspclk_divider() const { return lospcp_ == 0 ? 1u : 2u * lospcp_; }
  bool adc_clock() const { return (gates0_ & PCLKCR0_ADCENCLK_MASK) != 0; }
  bool can_clock() const { return (gates0_ & PCLKCR0_ECANAENCLK_MASK) != 0; }
  bool epwm_clock(int module) const { return (gates1_ >> module & 1u) != 0; }
  bool eqep_clock(int instance) const;
  bool sci_clock() const { return (gates0_ & PCLKCR0_SCIAENCLK_MASK) != 0; }
  bool i2c_clock() const { return (gates0_ & PCLKCR0_I2CAENCLK_MASK) != 0; }
  bool time_base_clock() const;
  bool low_power_mode_selected() const;

 private:
  unsigned write_status(std::uint16_t value);
  unsigned write_multiplier(std::uint16_t value, Tick t);
  unsigned update_clock();
  bool ratio_is_whole(unsigned multiplier) const;
  unsigned divider() const;

  ChipServices& services_;
  std::uint16_t xclk_ = 0;
  std::uint16_t status_ = 0;  // PLLSTS without PLLLOCKS
  std::uint16_t hispcp_ = 1;
  std::uint16_t lospcp_ = 2;
  std::uint16_t gates0_ = 0;
  std::uint16_t gates1_ = 0;
  std::uint16_t low_power_ = 0;
  std::uint16_t multiplier_ = 0;  // PLLCR
  Tick lock_ = kNever;
  Tick period_ = 2 * kOscillatorPeriod;
};

inline constexpr std::uint32_t kSystemFrame = 0x7000;

}  // namespace stillspin::chip

#endif
