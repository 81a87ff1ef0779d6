// An ePWM bank with the recording services and short ways to reach its registers. Modules are numbered 0..5.

#ifndef STILLSPIN_TESTS_CHIP_EPWM_HPP
#define STILLSPIN_TESTS_CHIP_EPWM_HPP

#include <gtest/gtest.h>

#include "hal/f2808/registers.h"
#include "sim_host/chip/epwm.hpp"
#include "tests/chip/peripheral.hpp"

namespace stillspin::chip::testing {

constexpr std::uint16_t kUp = 0, kDown = 1, kUpDown = 2, kFrozen = 3;  // TBCTL.CTRMODE with TBCLK = SYSCLKOUT
constexpr std::uint16_t kClear = 1, kSet = 2, kToggle = 3;             // action qualifier
constexpr std::uint16_t action(std::uint16_t what, unsigned lsb) { return static_cast<std::uint16_t>(what << lsb); }

class EPwmBench : public ::testing::Test {
 protected:
  RecordingServices services;
  EPwmBank bank{services};
  Tick now = 0;

  void SetUp() override { bank.reset(0); }

  void run(Tick until) {
    run_until(bank, until);
    now = until;
  }
  void write(int module, std::uint16_t offset, unsigned value) {
    bank.write(module, offset, static_cast<std::uint16_t>(value), now);
  }
  std::uint16_t read(int module, std::uint16_t offset) { return bank.read(module, offset, now); }
  void start() {
    bank.set_time_base_clock(true, now);
    run(now);
  }

  /// The drive's use of a leg: up-count, A set at CMPA and cleared at CMPB, both loaded at zero.
  void configure_leg(int module, std::uint16_t period, unsigned rise, unsigned fall) {
    write(module, EPWM_TBPRD, period);
    write(module, EPWM_TBCTL, kUp);
    write(module, EPWM_CMPCTL, 0);
    write(module, EPWM_CMPA_CMPA, rise);
    write(module, EPWM_CMPB, fall);
    write(module, EPWM_AQCTLA, action(kSet, EPWM_AQCTLA_CAU_LSB) | action(kClear, EPWM_AQCTLA_CBU_LSB));
  }

  /// Active-high complementary dead band, A feeds both lines.
  void configure_dead_band(int module, std::uint16_t rising, std::uint16_t falling) {
    write(module, EPWM_DBRED, rising);
    write(module, EPWM_DBFED, falling);
    write(module, EPWM_DBCTL, 3u | (2u << EPWM_DBCTL_POLSEL_LSB));
  }
};

using Edges = std::vector<PinEdge>;
using Starts = std::vector<Stamped<bool>>;
using Times = std::vector<Tick>;

}  // namespace stillspin::chip::testing

#endif
