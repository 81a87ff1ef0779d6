// Flash wait states and power: registers only, plus the one mistake that a model can notice.
//
// A wait count that is too small for the clock makes the real chip execute garbage; here it is a model error.
// Access times: 36 ns flash (paged and random), 60 ns OTP. Source: SPRS230, SPRU712.

#ifndef STILLSPIN_SIM_HOST_CHIP_FLASH_CONTROL_HPP
#define STILLSPIN_SIM_HOST_CHIP_FLASH_CONTROL_HPP

#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

class FlashControl {
 public:
  void reset() { *this = FlashControl{}; }

  std::uint16_t read(std::uint32_t address) const {
    switch (address) {
      case REG_FOPT:
        return option_;
      case REG_FPWR:
        return power_;
      case REG_FSTATUS:
        return power_;  // a mode is reached at once
      case REG_FSTDBYWAIT:
        return standby_wait_;
      case REG_FACTIVEWAIT:
        return active_wait_;
      case REG_FBANKWAIT:
        return bank_wait_;
      case REG_FOTPWAIT:
        return otp_wait_;
      default:
        return 0;
    }
  }

  void write(std::uint32_t address, std::uint16_t value) {
    switch (address) {
      case REG_FOPT:
        option_ = value & FOPT_ENPIPE_MASK;
        break;
      case REG_FPWR:
        power_ = value & FPWR_PWR_MASK;
        break;
      case REG_FSTDBYWAIT:
        standby_wait_ = value & FSTDBYWAIT_STDBYWAIT_MASK;
        break;
      case REG_FACTIVEWAIT:
        active_wait_ = value & FACTIVEWAIT_ACTIVEWAIT_MASK;
        break;
      case REG_FBANKWAIT:
        bank_wait_ = value & (FBANKWAIT_RANDWAIT_MASK | FBANKWAIT_PAGEWAIT_MASK);
        break;
      case REG_FOTPWAIT:
        otp_wait_ = value & FOTPWAIT_OTPWAIT_MASK;
        break;
      default:
        break;
    }
  }

  std::uint16_t bank_wait() const { return bank_wait_; }

  /// Whether every wait count covers its access time at this SYSCLK period.
  bool waits_suffice(Tick sysclk_period) const {
    constexpr Tick kNanosecondsPerTick = 10;
    constexpr Tick kFlashAccess = 36;
    constexpr Tick kOtpAccess = 60;
    const Tick cycle = sysclk_period * kNanosecondsPerTick;
    const Tick random = (bank_wait_ & FBANKWAIT_RANDWAIT_MASK) >> FBANKWAIT_RANDWAIT_LSB;
    const Tick paged = (bank_wait_ & FBANKWAIT_PAGEWAIT_MASK) >> FBANKWAIT_PAGEWAIT_LSB;
    return (random + 1) * cycle >= kFlashAccess && (paged + 1) * cycle >= kFlashAccess &&
           (otp_wait_ + 1) * cycle >= kOtpAccess;
  }

 private:
  std::uint16_t option_ = 0;
  std::uint16_t power_ = 0;
  std::uint16_t standby_wait_ = 0x01FF;
  std::uint16_t active_wait_ = 0x01FF;
  std::uint16_t bank_wait_ = 0x0F0F;
  std::uint16_t otp_wait_ = 0x001F;
};

}  // namespace stillspin::chip

#endif
