// An ADC with the recording services, powered and clocked as the drive does: ADCCLK 12.5 MHz = 8 ticks.

#ifndef STILLSPIN_TESTS_CHIP_ADC_HPP
#define STILLSPIN_TESTS_CHIP_ADC_HPP

#include <gtest/gtest.h>

#include "hal/f2808/registers.h"
#include "sim_host/chip/adc.hpp"
#include "tests/chip/peripheral.hpp"

namespace stillspin::chip::testing {

constexpr Tick kAdcClock = 8;
constexpr Tick kTriggerToHold = 28;  // (2.5 + 1) ADCCLK
constexpr Tick kPairToPair = 24;     // 3 ADCCLK
constexpr Tick kHoldToResultA = 32;  // 4 ADCCLK
constexpr Tick kHoldToResultB = 40;  // 5 ADCCLK
constexpr Tick burst(int pairs) { return kTriggerToHold + (pairs - 1) * kPairToPair + kHoldToResultB; }

constexpr unsigned kPowered = ADCTRL3_ADCPWDN_MASK | ADCTRL3_ADCBGRFDN_MASK;
constexpr unsigned kBothTriggers = ADCTRL2_EPWM_SOCA_SEQ1_MASK | ADCTRL2_EPWM_SOCB_SEQ2_MASK;

class AdcBench : public ::testing::Test {
 protected:
  RecordingServices services;
  Adc adc{services};
  Tick now = 0;

  void SetUp() override {
    adc.reset(0);
    services.hspclk = 8;  // ADCCLKPS 0, CPS 0: ADCCLK = HSPCLK
    write(REG_ADCTRL3, kPowered | ADCTRL3_SMODE_SEL_MASK);
    now = Adc::kPowerUpTicks;
  }

  void run(Tick until) {
    run_until(adc, until);
    now = until;
  }
  static std::uint16_t offset(std::uint32_t address) { return static_cast<std::uint16_t>(address - REG_ADCTRL1); }
  void write(std::uint32_t address, unsigned value) {
    adc.write(offset(address), static_cast<std::uint16_t>(value), now);
  }
  std::uint16_t read(std::uint32_t address) { return adc.read(offset(address), now); }
  unsigned result(int n) { return adc.read(static_cast<std::uint16_t>(kAdcMirrorOffset + n), now); }
  void trigger(bool soca) {
    adc.start_of_conversion(soca, now);
    run(now);
  }

  /// SEQ1: four pairs (A0, B0). SEQ2: three pairs (A0, B0), then (A1, B1).
  void configure_for_the_drive() {
    write(REG_ADCMAXCONV, 3u | (3u << ADCMAXCONV_MAX_CONV2_LSB));
    write(REG_ADCCHSELSEQ1, 0x0000);
    write(REG_ADCCHSELSEQ3, 0x1000);
    write(REG_ADCTRL2, kBothTriggers | ADCTRL2_INT_ENA_SEQ1_MASK | ADCTRL2_INT_ENA_SEQ2_MASK);
  }
};

using Samples = std::vector<Stamped<int>>;
using Times = std::vector<Tick>;

}  // namespace stillspin::chip::testing

#endif
