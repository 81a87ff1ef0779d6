// The event trigger of one ePWM: interrupt and start-of-conversion pulses on every 1st to 3rd selected event.
//
// A counter runs up to its period. The interrupt leaves when it is enabled and ETFLG.INT is clear, else the full
// counter waits: so one further interrupt can be pending while the last is being served. A start of conversion does not
// look at its flag. Writing ETPS clears the counters; a bit in ETFRC counts as one event; period 0 switches a counter
// off.
// Source: TI SPRUG04 (TMS320x28xx) event-trigger submodule.

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_EVENT_TRIGGER_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_EVENT_TRIGGER_HPP

#include <cstdint>

#include "hal/f2808/registers.h"
#include "sim_host/chip/epwm_time_base.hpp"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

class EventTrigger {
 public:
  /// What goes out, as ETFLG bits.
  using Pulses = unsigned;

  std::uint16_t select() const { return select_; }  // ETSEL
  std::uint16_t flags() const { return flags_; }    // ETFLG
  std::uint16_t prescale() const {                  // ETPS
    return static_cast<std::uint16_t>(prescale_ | (count_[0] << EPWM_ETPS_INTCNT_LSB) |
                                      (count_[1] << EPWM_ETPS_SOCACNT_LSB) | (count_[2] << EPWM_ETPS_SOCBCNT_LSB));
  }

  unsigned used_events() const { return used_; }

  Pulses write_select(std::uint16_t value) {
    select_ = value;
    update();
    return pulses();
  }

  void write_prescale(std::uint16_t value) {
    constexpr unsigned kPeriods = EPWM_ETPS_INTPRD_MASK | EPWM_ETPS_SOCAPRD_MASK | EPWM_ETPS_SOCBPRD_MASK;
    prescale_ = static_cast<std::uint16_t>(value & kPeriods);
    count_[0] = count_[1] = count_[2] = 0;
    update();
  }

  Pulses clear(std::uint16_t word) {  // ETCLR
    flags_ = static_cast<std::uint16_t>(flags_ & ~word);
    return pulses();
  }

  Pulses force(std::uint16_t word) {  // ETFRC
    for (int i = 0; i < 3; ++i) {
      advance(i, bit_set(word, kFlag[i]));
    }
    return pulses();
  }

  Pulses count(unsigned events) {
    if ((events & used_events()) == 0) {
      return 0;
    }
    for (int i = 0; i < 3; ++i) {
      advance(i, (events & event_[i]) != 0);
    }
    return pulses();
  }

 private:
  static constexpr unsigned kFlag[3] = {EPWM_ETFLG_INT_MASK, EPWM_ETFLG_SOCA_MASK, EPWM_ETFLG_SOCB_MASK};
  static constexpr unsigned kEnable[3] = {EPWM_ETSEL_INTEN_MASK, EPWM_ETSEL_SOCAEN_MASK, EPWM_ETSEL_SOCBEN_MASK};

  void update() {
    constexpr unsigned kEvent[8] = {0, kCountZero, kCountPeriod, 0, kCountAUp, kCountADown, kCountBUp, kCountBDown};
    constexpr unsigned kSelectLsb[3] = {EPWM_ETSEL_INTSEL_LSB, EPWM_ETSEL_SOCASEL_LSB, EPWM_ETSEL_SOCBSEL_LSB};
    constexpr unsigned kPeriodLsb[3] = {EPWM_ETPS_INTPRD_LSB, EPWM_ETPS_SOCAPRD_LSB, EPWM_ETPS_SOCBPRD_LSB};
    for (int i = 0; i < 3; ++i) {
      period_[i] = static_cast<std::uint8_t>((prescale_ >> kPeriodLsb[i]) & 3u);
      event_[i] = period_[i] != 0 ? kEvent[(select_ >> kSelectLsb[i]) & 7u] : 0u;
    }
    used_ = event_[0] | event_[1] | event_[2];
  }

  void advance(int i, bool event) {
    count_[i] = static_cast<std::uint8_t>(count_[i] + (event && count_[i] < period_[i] ? 1 : 0));
  }

  Pulses pulses() {
    Pulses out = 0;
    for (int i = 0; i < 3; ++i) {
      const bool full = period_[i] != 0 && count_[i] >= period_[i];
      const bool held = i == 0 && bit_set(flags_, EPWM_ETFLG_INT_MASK);
      if (full && !held && bit_set(select_, kEnable[i])) {
        count_[i] = 0;
        out |= kFlag[i];
      }
    }
    flags_ = static_cast<std::uint16_t>(flags_ | out);
    return out;
  }

  std::uint16_t select_ = 0;
  std::uint16_t prescale_ = 0;
  std::uint16_t flags_ = 0;
  std::uint8_t count_[3] = {0, 0, 0};
  std::uint8_t period_[3] = {0, 0, 0};
  unsigned event_[3] = {0, 0, 0};
  unsigned used_ = 0;
};

}  // namespace stillspin::chip

#endif
