// Which peripheral answers where, and which words of its frame are registers of the model.
//
// Data space below 0x8000 in pages of 64 words: the finest grain at which the F2808's peripherals are laid out.

#ifndef STILLSPIN_SIM_HOST_CHIP_BUS_PAGES_HPP
#define STILLSPIN_SIM_HOST_CHIP_BUS_PAGES_HPP

#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/system_control.hpp"

namespace stillspin::chip {

enum class Device : std::uint8_t {
  kNone,
  kIdentity,
  kFlash,
  kSecurity,
  kAdcMirror,
  kTimers,
  kPie,
  kEPwm,
  kEQep1,
  kSci,
  kGpio,
  kSystem,
  kAdc,
  kI2c,
  kCan
};

constexpr unsigned kPageShift = 6;
constexpr std::uint32_t kPageMask = 0x3F;
constexpr std::uint32_t kPageCount = 0x8000 >> kPageShift;
constexpr std::uint32_t kAdcFrame = 0x7100;
constexpr std::uint32_t kAdcMirrorWords = 16;
constexpr std::uint32_t kCanEnd = 0x6200;
constexpr std::uint64_t kEveryWord = ~std::uint64_t{0};

/// The words from `first` to `last` of a page, a bit each.
constexpr std::uint64_t words(std::uint32_t first, std::uint32_t last) {
  return kEveryWord >> (kPageMask - (last & kPageMask)) & kEveryWord << (first & kPageMask);
}

struct PageTable {
  Device device[kPageCount] = {};
  std::uint64_t registers[kPageCount] = {};
  constexpr void set(std::uint32_t address, Device to, std::uint64_t which) {
    device[address >> kPageShift] = to;
    registers[address >> kPageShift] = which;
  }
};

constexpr PageTable make_page_table() {
  PageTable table;
  table.set(REG_DEVICECNF, Device::kIdentity, words(REG_DEVICECNF, REG_REVID));
  table.set(REG_FOPT, Device::kFlash, words(REG_FOPT, REG_FOPT) | words(REG_FPWR, REG_FOTPWAIT));
  table.set(REG_KEY(0), Device::kSecurity, words(REG_KEY(0), REG_KEY(7)) | words(REG_CSMSCR, REG_CSMSCR));
  table.set(REG_MIRROR_ADCRESULT0, Device::kAdcMirror, words(0, kAdcMirrorWords - 1));
  table.set(CPUTIMER_BASE(0), Device::kTimers,
            words(0x00, 0x04) | words(0x06, 0x0C) | words(0x0E, 0x14) | words(0x16, 0x17));
  table.set(REG_PIECTRL, Device::kPie, words(REG_PIECTRL, REG_PIEIFR(12)));
  for (unsigned n = 1; n <= 6; ++n) {
    table.set(EPWM_BASE(n), Device::kEPwm,
              words(EPWM_TBCTL, EPWM_TBPRD) | words(EPWM_CMPCTL, EPWM_TZSEL) | words(EPWM_TZCTL, EPWM_PCCTL) |
                  words(EPWM_HRCNFG, EPWM_HRCNFG));
  }
  // Without its watchdog and the timer and period of the capture unit.
  table.set(EQEP_BASE(1), Device::kEQep1, words(EQEP_QPOSCNT, EQEP_QUPRD + 1) | words(EQEP_QDECCTL, EQEP_QEPSTS));
  // SPI-A and the external interrupts share its page.
  table.set(SCI_BASE(1), Device::kSci,
            (words(SCI_CCR, SCI_RXBUF) | words(SCI_TXBUF, SCI_FFCT) | words(SCI_PRI, SCI_PRI))
                << (SCI_BASE(1) & kPageMask));
  table.set(REG_GPACTRL, Device::kGpio, words(REG_GPACTRL, REG_GPAPUD + 1) | words(REG_GPBCTRL, REG_GPBPUD + 1));
  table.set(REG_GPADAT, Device::kGpio,
            words(REG_GPADAT, REG_GPBTOGGLE + 1) | words(REG_GPIOXINT1SEL, REG_GPIOXNMISEL) |
                words(REG_GPIOLPMSEL, REG_GPIOLPMSEL + 1));
  table.set(kSystemFrame, Device::kSystem,
            words(REG_XCLK, REG_PLLSTS) | words(REG_HISPCP, REG_LPMCR0) | words(REG_PLLCR, REG_WDCNTR) |
                words(REG_WDKEY, REG_WDKEY) | words(REG_WDCR, REG_WDCR));
  table.set(kAdcFrame, Device::kAdc, words(REG_ADCTRL1, REG_ADCST) | words(REG_ADCREFSEL, REG_ADCOFFTRIM));
  table.set(I2C_BASE, Device::kI2c, words(I2C_OAR, I2C_ISRC) | words(I2C_PSC, I2C_PSC) | words(I2C_FFTX, I2C_FFRX));
  table.set(REG_CANME, Device::kCan, words(REG_CANME, REG_CANTOS + 1));
  for (std::uint32_t address = REG_CANLAM(0); address < kCanEnd; address += kPageMask + 1) {
    table.set(address, Device::kCan, kEveryWord);
  }
  return table;
}

constexpr PageTable kPages = make_page_table();

constexpr Device device_at(std::uint32_t address) {
  const std::uint32_t page = address >> kPageShift;
  return page < kPageCount ? kPages.device[page] : Device::kNone;
}

/// False where a modelled peripheral has no such register; what lies in no such peripheral's page is memory's to say.
constexpr bool has_register(std::uint32_t address) {
  return device_at(address) == Device::kNone ||
         (kPages.registers[address >> kPageShift] >> (address & kPageMask) & 1) != 0;
}

}  // namespace stillspin::chip

#endif
