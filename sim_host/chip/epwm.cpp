#include "sim_host/chip/epwm.hpp"

#include <algorithm>

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

void EPwmBank::refresh_next_event() { next_event_ = *std::min_element(next_, next_ + kModules); }

/// Tell the core the pins if they changed.
void EPwmBank::publish(int module, Tick t) {
  const EPwmModule& source = modules_[module];
  const bool a = source.a();
  const bool b = source.b();
  const auto pins = static_cast<std::uint8_t>((a ? 1u : 0u) | (b ? 2u : 0u));
  if (pins != pins_[module]) {
    pins_[module] = pins;
    services_.pwm_outputs(module, a, b, t);
  }
}

void EPwmBank::send_sync(int source, Tick t) {
  for (int m = source + 1; m < kModules; ++m) {
    modules_[m].mark_sync_input();
    const bool passed_on = modules_[m].sync_in(t);
    next_[m] = modules_[m].next_event();
    if (!passed_on) {
      break;
    }
  }
}

/// What a call to a module brought about: its interrupts and pins.
void EPwmBank::tell(int module, unsigned effects, Tick t) {
  if ((effects & kEffectInterrupt) != 0) {
    services_.raise_interrupt(VECTOR_EPWM1_INT + static_cast<unsigned>(module), t);
  }
  if ((effects & kEffectTripInterrupt) != 0) {
    services_.raise_interrupt(VECTOR_EPWM1_TZINT + static_cast<unsigned>(module), t);
  }
  if ((effects & kEffectPins) != 0) {
    publish(module, t);
  }
}

void EPwmBank::run_event(Tick t) {
  unsigned all_effects = 0;
  unsigned sync_sources = 0;
  Tick nearest = kNever;
  for (int m = 0; m < kModules; ++m) {
    if (next_[m] <= t) {
      const unsigned effects = modules_[m].run_event(t);
      all_effects |= effects;
      sync_sources |= (effects & kEffectSyncOut) != 0 ? 1u << m : 0u;
      carry_out(m, effects, t);
    }
    nearest = std::min(nearest, next_[m]);
  }
  next_event_ = nearest;
  if (sync_sources != 0) {
    for (int m = 0; m < kModules; ++m) {
      if ((sync_sources & (1u << m)) != 0) {
        send_sync(m, t);
      }
    }
    refresh_next_event();
  }
  if ((all_effects & kEffectSoca) != 0) {
    services_.start_of_conversion(true, t);
  }
  if ((all_effects & kEffectSocb) != 0) {
    services_.start_of_conversion(false, t);
  }
}

void EPwmBank::reset(Tick t) {
  time_base_clock_ = false;
  for (int m = 0; m < kModules; ++m) {
    modules_[m].reset(t);
    modules_[m].set_clock(services_.sysclk_period(), false, t);
    next_[m] = modules_[m].next_event();
    publish(m, t);
  }
  refresh_next_event();
}

std::uint16_t EPwmBank::read(int module, std::uint16_t offset, Tick t) const {
  return modules_[module].read(offset, t);
}

void EPwmBank::write(int module, std::uint16_t offset, std::uint16_t value, Tick t) {
  if (offset == EPWM_PCCTL && bit_set(value, EPWM_PCCTL_CHPEN_MASK)) {
    services_.model_error("the ePWM chopper (PCCTL.CHPEN) is not modelled", value);
  }
  const Tick before = next_[module];
  const unsigned effects = modules_[module].write(offset, value, t);
  carry_out(module, effects, t);
  if (effects == 0 && next_[module] == before) {
    return;  // most writes go to a shadow
  }
  if ((effects & kEffectSyncOut) != 0) {
    send_sync(module, t);
  }
  refresh_next_event();
  if ((effects & kEffectSoca) != 0) {
    services_.start_of_conversion(true, t);
  }
  if ((effects & kEffectSocb) != 0) {
    services_.start_of_conversion(false, t);
  }
}

void EPwmBank::clocks_changed(Tick t) {
  for (int m = 0; m < kModules; ++m) {
    modules_[m].set_clock(services_.sysclk_period(), time_base_clock_ && services_.epwm_clock(m), t);
    next_[m] = modules_[m].next_event();
  }
  refresh_next_event();
}

void EPwmBank::set_time_base_clock(bool running, Tick t) {
  time_base_clock_ = running;
  clocks_changed(t);
}

void EPwmBank::set_trip_pins(unsigned active_mask, Tick t) {
  for (int m = 0; m < kModules; ++m) {
    const unsigned effects = modules_[m].set_trip_pins(active_mask);
    carry_out(m, effects, t);
  }
  refresh_next_event();
}

}  // namespace stillspin::chip
