// Watchdog: an 8-bit counter at OSCCLK / 512 / prescale that resets the chip when it overflows.
//
// Writing 0x55 and then 0xAA to WDKEY clears the counter. Any other value does nothing but break the sequence.
// Each write to WDCR must carry 101 in WDCHK, or the chip is reset at once. WDOVERRIDE, once cleared by writing 1 to
// it, locks WDDIS until the next reset. With SCSR.WDENINT the overflow raises WAKEINT instead of a reset.
// WDFLAG outlives the reset and tells its cause.
// Source: SPRU712 (watchdog); key sequence: TI's table of example WDKEY sequences.

#ifndef STILLSPIN_SIM_HOST_CHIP_WATCHDOG_HPP
#define STILLSPIN_SIM_HOST_CHIP_WATCHDOG_HPP

#include <cstdint>

#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class Watchdog {
 public:
  enum class Outcome { kNothing, kReset };

  explicit Watchdog(ChipServices& services) : services_(services) {}

  /// `by_watchdog` sets WDFLAG; counting starts at t.
  void reset(Tick t, bool by_watchdog);
  std::uint16_t read(std::uint16_t offset, Tick t) const;  // from kSystemFrame
  Outcome write(std::uint16_t offset, std::uint16_t value, Tick t);
  Tick next_event() const { return overflow_; }
  Outcome run_event(Tick t);

  /// Whether an offset in the system frame is one of the watchdog's.
  static bool owns(std::uint16_t offset);

 private:
  std::uint16_t count(Tick t) const;
  void start(std::uint16_t count, Tick t);
  Outcome expire(Tick t);
  Outcome write_control(std::uint16_t value, Tick t);
  void write_key(std::uint16_t value, Tick t);
  void write_scsr(std::uint16_t value);

  ChipServices& services_;
  std::uint16_t prescale_ = 0;  // WDPS
  bool disabled_ = false;
  bool flag_ = false;
  bool override_ = true;
  bool interrupt_mode_ = false;
  bool armed_ = false;       // 0x55 was the last key
  std::uint16_t count_ = 0;  // at since_
  Tick since_ = 0;
  Tick step_ = 1;  // ticks per count
  Tick overflow_ = kNever;
  Tick interrupt_end_ = 0;  // WDINTS is low until then
};

}  // namespace stillspin::chip

#endif
