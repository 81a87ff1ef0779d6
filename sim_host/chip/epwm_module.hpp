// One ePWM module (type 0): time base, compare shadows, action qualifier, dead band, trip zone and event trigger put
// together behind its register frame. The bank (epwm.hpp) owns six of them and ties them together.
//
// At one count, in this order: phase load by a synchronisation pulse, compare events with the compare values active so
// far, outputs, event trigger, then the shadow loads. So a compare value 0 loaded at zero does not act in that period,
// which is why TI's guide asks for values of at least 1 with loads at zero. A counter that has been standing at zero
// and starts there has its shadows loaded first: what was configured before the start holds from the first count on.
//
// Not modelled: high-resolution edges (CMPAHR, TBPHSHR and HRCNFG are stored), the chopper (the bank reports an error
// when it is switched on), emulation halt (FREE_SOFT).

#ifndef STILLSPIN_SIM_HOST_CHIP_EPWM_MODULE_HPP
#define STILLSPIN_SIM_HOST_CHIP_EPWM_MODULE_HPP

#include <algorithm>
#include <cstdint>

#include "sim_host/chip/epwm_action.hpp"
#include "sim_host/chip/epwm_dead_band.hpp"
#include "sim_host/chip/epwm_event_trigger.hpp"
#include "sim_host/chip/epwm_time_base.hpp"
#include "sim_host/chip/epwm_trip_zone.hpp"
#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

/// What a call to a module makes others do. The first three are the ETFLG bits.
enum EPwmEffect : unsigned {
  kEffectInterrupt = EPWM_ETFLG_INT_MASK,
  kEffectSoca = EPWM_ETFLG_SOCA_MASK,
  kEffectSocb = EPWM_ETFLG_SOCB_MASK,
  kEffectTripInterrupt = 1u << 4,
  kEffectSyncOut = 1u << 5,
  kEffectPins = 1u << 6,  // may have changed
};

class EPwmModule {
 public:
  void reset(Tick t);
  std::uint16_t read(std::uint16_t offset, Tick t) const;
  unsigned write(std::uint16_t offset, std::uint16_t value, Tick t);

  Tick next_event() const { return std::min(std::min(base_.next_stop(), sync_load_), dead_band_.next_event()); }
  unsigned run_event(Tick t);

  /// SYSCLKOUT period in ticks, and whether TBCLK reaches the counter (clock gate and TBCLKSYNC).
  void set_clock(Tick sysclk_period, bool gate_open, Tick t);

  /// TZn active on bit n-1.
  unsigned set_trip_pins(unsigned active_mask);

  /// A pulse at the synchronisation input. True if it goes on to the output (SYNCOSEL = 0).
  bool sync_in(Tick t);
  void mark_sync_input() { sync_input_seen_ = true; }

  bool a() const { return trip_.a(dead_band_.a()); }
  bool b() const { return trip_.b(dead_band_.b()); }

 private:
  static constexpr unsigned kSyncOutPass = 0;  // TBCTL.SYNCOSEL
  static constexpr unsigned kSyncOutZero = 1;
  static constexpr unsigned kSyncOutCompareB = 2;

  struct Shadow {
    std::uint16_t value = 0;
    bool full = false;
  };

  unsigned take_count(unsigned events, Tick t);
  void load_shadows(unsigned events, Tick t);
  unsigned write_time_base(std::uint16_t offset, std::uint16_t value, Tick t);
  void write_compare(std::uint16_t offset, std::uint16_t value, Tick t);
  void write_outputs(std::uint16_t offset, std::uint16_t value, Tick t);
  unsigned write_trip_zone(std::uint16_t offset, std::uint16_t value);
  unsigned write_event_trigger(std::uint16_t offset, std::uint16_t value, Tick t);
  std::uint16_t read_time_base(std::uint16_t offset, Tick t) const;
  std::uint16_t read_compare(std::uint16_t offset) const;
  std::uint16_t read_trip_zone(std::uint16_t offset) const;
  std::uint16_t read_status(Tick t) const;
  void reschedule(Tick t);
  void apply_clock(Tick t);
  void feed_dead_band(Tick t);
  unsigned trip_effects() { return trip_.take_interrupt() ? kEffectTripInterrupt : 0u; }
  bool period_is_shadowed() const;
  unsigned load_events(unsigned mode_lsb, unsigned shadow_off_mask) const;

  TimeBase base_;
  ActionQualifier action_;
  DeadBand dead_band_;
  TripZone trip_;
  EventTrigger trigger_;

  std::uint16_t control_ = 0;          // TBCTL
  std::uint16_t phase_ = 0;            // TBPHS
  std::uint16_t phase_hr_ = 0;         // TBPHSHR
  std::uint16_t compare_control_ = 0;  // CMPCTL without the full flags
  std::uint16_t compare_a_hr_ = 0;     // CMPAHR
  std::uint16_t chopper_ = 0;          // PCCTL
  std::uint16_t high_resolution_ = 0;  // HRCNFG
  Shadow period_shadow_;
  Shadow compare_a_shadow_;
  Shadow compare_b_shadow_;
  unsigned load_a_events_ = kCountZero;
  unsigned load_b_events_ = kCountZero;
  unsigned sync_out_events_ = 0;
  bool sync_input_seen_ = false;
  Tick sync_load_ = kNever;
  Tick sysclk_period_ = 1;
  bool gate_open_ = false;
};

}  // namespace stillspin::chip

#endif
