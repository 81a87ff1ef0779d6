#include "sim_host/chip/epwm_module.hpp"

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

namespace {

constexpr std::uint16_t kControlAfterReset = 0x0083;  // stopped, HSPCLKDIV = /2

Tick clock_divider(std::uint16_t control) {
  const unsigned high_speed = field(control, EPWM_TBCTL_HSPCLKDIV_MASK, EPWM_TBCTL_HSPCLKDIV_LSB);
  const unsigned power = field(control, EPWM_TBCTL_CLKDIV_MASK, EPWM_TBCTL_CLKDIV_LSB);
  return static_cast<Tick>(high_speed == 0 ? 1u : 2u * high_speed) << power;
}

}  // namespace

void EPwmModule::reset(Tick t) {
  const Tick sysclk_period = sysclk_period_;
  const bool gate_open = gate_open_;
  *this = EPwmModule{};
  base_.reset(t);
  control_ = kControlAfterReset;
  set_clock(sysclk_period, gate_open, t);
}

void EPwmModule::set_clock(Tick sysclk_period, bool gate_open, Tick t) {
  sysclk_period_ = sysclk_period;
  gate_open_ = gate_open;
  apply_clock(t);
}

void EPwmModule::apply_clock(Tick t) {
  const auto mode = static_cast<CountMode>(field(control_, EPWM_TBCTL_CTRMODE_MASK, EPWM_TBCTL_CTRMODE_LSB));
  base_.configure(mode, sysclk_period_ * clock_divider(control_), gate_open_, t);
  reschedule(t);
}

bool EPwmModule::period_is_shadowed() const { return !bit_set(control_, EPWM_TBCTL_PRDLD_MASK); }

unsigned EPwmModule::load_events(unsigned mode_lsb, unsigned shadow_off_mask) const {
  constexpr unsigned kEvents[] = {kCountZero, kCountPeriod, kCountZero | kCountPeriod, 0};
  return bit_set(compare_control_, shadow_off_mask) ? 0u : kEvents[(compare_control_ >> mode_lsb) & 3u];
}

/// Which counts matter follows from the registers; call after each change of one that is not a mere shadow.
void EPwmModule::reschedule(Tick t) {
  const unsigned sync_out = field(control_, EPWM_TBCTL_SYNCOSEL_MASK, EPWM_TBCTL_SYNCOSEL_LSB);
  sync_out_events_ = sync_out == kSyncOutZero       ? unsigned{kCountZero}
                     : sync_out == kSyncOutCompareB ? unsigned{kCountBUp} | unsigned{kCountBDown}
                                                    : 0u;
  load_a_events_ = load_events(EPWM_CMPCTL_LOADAMODE_LSB, EPWM_CMPCTL_SHDWAMODE_MASK);
  load_b_events_ = load_events(EPWM_CMPCTL_LOADBMODE_LSB, EPWM_CMPCTL_SHDWBMODE_MASK);
  base_.set_interest(action_.used_events() | action_.load_events() | trigger_.used_events() | sync_out_events_ |
                     load_a_events_ | load_b_events_);
  base_.schedule(t);
  base_.poke(t);
}

void EPwmModule::feed_dead_band(Tick t) {
  dead_band_.input(action_.level(0), action_.level(1), base_.clock_period(), t);
}

unsigned EPwmModule::run_event(Tick t) {
  unsigned effects = 0;
  bool loaded = false;
  if (sync_load_ <= t) {
    sync_load_ = kNever;
    loaded = base_.load_phase(phase_, bit_set(control_, EPWM_TBCTL_PHSDIR_MASK), t);
  }
  if (!loaded && base_.next_stop() <= t && base_.starting() && base_.count(t) == 0) {
    load_shadows(kCountZero, t);
  }
  if (loaded || base_.next_stop() <= t) {
    effects = take_count(base_.take_stop(t), t);
  }
  if (dead_band_.next_event() <= t) {
    dead_band_.run_event(t);
    effects |= kEffectPins;
  }
  return effects;
}

unsigned EPwmModule::take_count(unsigned events, Tick t) {
  unsigned effects = trigger_.count(events) | ((events & sync_out_events_) != 0 ? kEffectSyncOut : 0u);
  const bool up = base_.mode() != CountMode::up_down || base_.counting_up(t);
  if (action_.act(events, base_.mode(), up)) {
    feed_dead_band(t);
    effects |= kEffectPins;
  }
  if ((events & kCountZero) != 0 && trip_.counter_zero()) {
    effects |= kEffectPins;
  }
  if ((events & (kCountZero | load_a_events_ | load_b_events_)) != 0) {
    load_shadows(events, t);
  }
  return effects;
}

void EPwmModule::load_shadows(unsigned events, Tick t) {
  bool changed = false;
  if ((events & kCountZero) != 0 && period_is_shadowed() && period_shadow_.value != base_.period()) {
    base_.set_period(period_shadow_.value, t);
    changed = true;
  }
  if ((events & load_a_events_) != 0) {
    changed = changed || compare_a_shadow_.value != base_.compare_a();
    base_.set_compare_a(compare_a_shadow_.value);
    compare_a_shadow_.full = false;
  }
  if ((events & load_b_events_) != 0) {
    changed = changed || compare_b_shadow_.value != base_.compare_b();
    base_.set_compare_b(compare_b_shadow_.value);
    compare_b_shadow_.full = false;
  }
  if (changed) {
    base_.schedule(t);
  }
}

bool EPwmModule::sync_in(Tick t) {
  if (bit_set(control_, EPWM_TBCTL_PHSEN_MASK)) {
    // TI: two SYSCLKOUT from the source to the target, or one TBCLK if TBCLK is slower than SYSCLKOUT.
    const Tick period = base_.clock_period();
    const Tick due = base_.last_edge(t) + (period == sysclk_period_ ? 2 * period : period);
    const bool up = bit_set(control_, EPWM_TBCTL_PHSDIR_MASK);
    if (!base_.running()) {
      base_.load_phase(phase_, up, t);
    } else if (base_.would_move(phase_, up, due)) {
      sync_load_ = due;
    }
  }
  return field(control_, EPWM_TBCTL_SYNCOSEL_MASK, EPWM_TBCTL_SYNCOSEL_LSB) == kSyncOutPass;
}

unsigned EPwmModule::set_trip_pins(unsigned active_mask) {
  trip_.set_pins(active_mask);
  return trip_effects() | kEffectPins;
}

}  // namespace stillspin::chip
