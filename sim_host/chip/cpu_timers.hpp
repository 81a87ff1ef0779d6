// CPU timers 0, 1, 2: 32-bit down-counters behind a 16-bit prescaler, clocked by SYSCLKOUT.
//
// Counter and prescaler together are one number of cycles x = TIM * (TDDR + 1) + PSC that falls by one each cycle and
// wraps after 0 to (PRD + 1) * (TDDR + 1) - 1. TIM reaches zero, which sets TIF and requests the interrupt, when x
// reaches TDDR. The count is computed when read; only a flag that will change something is an event.
// Not modelled: a new TDDR acts at once instead of at the next reload (firmware stops the timer or reloads it anyway).
// Source: SPRU712 (CPU timers).

#ifndef STILLSPIN_SIM_HOST_CHIP_CPU_TIMERS_HPP
#define STILLSPIN_SIM_HOST_CHIP_CPU_TIMERS_HPP

#include <array>
#include <cstdint>

#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

class CpuTimers final : public Peripheral {
 public:
  explicit CpuTimers(ChipServices& services) : services_(services) {}

  void reset(Tick t) override;
  std::uint16_t read(std::uint16_t offset, Tick t) override;  // offset from CPUTIMER_BASE(0)
  void write(std::uint16_t offset, std::uint16_t value, Tick t) override;
  Tick next_event() const override { return next_event_; }
  void run_event(Tick t) override;
  void clocks_changed(Tick t) override;

 private:
  struct Timer {
    std::uint32_t period = 0xFFFF;  // PRD
    std::uint32_t prescale = 0;     // TDDRH:TDDR
    std::int64_t cycles = 0xFFFF;   // x at `since`
    Tick since = 0;
    Tick zero = kNever;         // when TIM next reaches zero, if that matters
    std::uint16_t control = 0;  // FREE, SOFT, TIE, TSS
    bool flag = false;          // TIF

    bool running() const;
    std::int64_t wrap() const { return (std::int64_t{period} + 1) * (std::int64_t{prescale} + 1); }
    std::int64_t counted(Tick t, Tick clock) const;
    std::uint32_t count(Tick t, Tick clock) const;  // TIM
    std::uint32_t psc(Tick t, Tick clock) const;
    void settle(Tick t, Tick clock);
    void load(std::uint32_t tim, std::uint32_t psc);
    void plan(Tick clock);
  };

  void replan(Timer& timer);
  void write_control(Timer& timer, std::uint16_t value);
  void write_register(Timer& timer, std::uint16_t reg, std::uint16_t value);

  ChipServices& services_;
  std::array<Timer, 3> timers_{};
  Tick clock_ = 1;
  Tick next_event_ = kNever;
};

}  // namespace stillspin::chip

#endif
