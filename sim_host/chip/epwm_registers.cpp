// The register frame of one ePWM module: which write changes what, and what a read gives.

#include "hal/f2808/registers.h"
#include "sim_host/chip/epwm_module.hpp"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

unsigned EPwmModule::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  if (offset <= EPWM_TBPRD) {
    return write_time_base(offset, value, t);
  }
  if (offset <= EPWM_CMPB) {
    write_compare(offset, value, t);
    return 0;
  }
  if (offset <= EPWM_DBFED) {
    write_outputs(offset, value, t);
    return kEffectPins;
  }
  if (offset <= EPWM_TZFRC) {
    return write_trip_zone(offset, value) | kEffectPins;
  }
  if (offset <= EPWM_ETFRC) {
    return write_event_trigger(offset, value, t);
  }
  if (offset == EPWM_PCCTL) {
    chopper_ = value;
  } else if (offset == EPWM_HRCNFG) {
    high_resolution_ = value;
  }
  return 0;
}

unsigned EPwmModule::write_time_base(std::uint16_t offset, std::uint16_t value, Tick t) {
  switch (offset) {
    case EPWM_TBCTL:
      control_ = static_cast<std::uint16_t>(value & ~EPWM_TBCTL_SWFSYNC_MASK);
      apply_clock(t);
      break;
    case EPWM_TBSTS:
      sync_input_seen_ = sync_input_seen_ && !bit_set(value, EPWM_TBSTS_SYNCI_MASK);
      if (bit_set(value, EPWM_TBSTS_CTRMAX_MASK)) {
        base_.clear_max();
      }
      break;
    case EPWM_TBPHS_TBPHSHR:
      phase_hr_ = value;
      break;
    case EPWM_TBPHS_TBPHS:
      phase_ = value;
      break;
    case EPWM_TBCTR:
      base_.write_count(value, t);
      reschedule(t);
      break;
    case EPWM_TBPRD:
      period_shadow_.value = value;
      if (!period_is_shadowed()) {
        base_.set_period(value, t);
        reschedule(t);
      }
      base_.poke(t);
      break;
    default:
      break;
  }
  // A forced pulse acts like one at the input, if the input is what goes through the module.
  const bool forced = offset == EPWM_TBCTL && bit_set(value, EPWM_TBCTL_SWFSYNC_MASK) &&
                      field(value, EPWM_TBCTL_SYNCOSEL_MASK, EPWM_TBCTL_SYNCOSEL_LSB) == kSyncOutPass;
  return forced && sync_in(t) ? kEffectSyncOut : 0u;
}

void EPwmModule::write_compare(std::uint16_t offset, std::uint16_t value, Tick t) {
  constexpr unsigned kWritable =
      EPWM_CMPCTL_LOADAMODE_MASK | EPWM_CMPCTL_LOADBMODE_MASK | EPWM_CMPCTL_SHDWAMODE_MASK | EPWM_CMPCTL_SHDWBMODE_MASK;
  const bool immediate_a = bit_set(compare_control_, EPWM_CMPCTL_SHDWAMODE_MASK);
  const bool immediate_b = bit_set(compare_control_, EPWM_CMPCTL_SHDWBMODE_MASK);
  switch (offset) {
    case EPWM_CMPCTL:
      compare_control_ = static_cast<std::uint16_t>(value & kWritable);
      reschedule(t);
      break;
    case EPWM_CMPA_CMPAHR:
      compare_a_hr_ = value;
      break;
    case EPWM_CMPA_CMPA:
      compare_a_shadow_ = Shadow{value, !immediate_a};
      if (immediate_a) {
        base_.set_compare_a(value);
        reschedule(t);
      }
      base_.poke(t);
      break;
    case EPWM_CMPB:
      compare_b_shadow_ = Shadow{value, !immediate_b};
      if (immediate_b) {
        base_.set_compare_b(value);
        reschedule(t);
      }
      base_.poke(t);
      break;
    default:
      break;
  }
}

void EPwmModule::write_outputs(std::uint16_t offset, std::uint16_t value, Tick t) {
  switch (offset) {
    case EPWM_AQCTLA:
    case EPWM_AQCTLB:
      action_.write_control(offset == EPWM_AQCTLA ? 0 : 1, static_cast<std::uint16_t>(value & 0x0FFFu));
      reschedule(t);
      break;
    case EPWM_AQSFRC:
      action_.write_software_force(value);
      reschedule(t);
      break;
    case EPWM_AQCSFRC:
      action_.write_continuous_force(value);
      base_.poke(t);
      break;
    case EPWM_DBCTL:
      dead_band_.control = static_cast<std::uint16_t>(value & 0x003Fu);
      break;
    case EPWM_DBRED:
      dead_band_.rising_delay = static_cast<std::uint16_t>(value & EPWM_DBRED_DEL_MASK);
      break;
    case EPWM_DBFED:
      dead_band_.falling_delay = static_cast<std::uint16_t>(value & EPWM_DBFED_DEL_MASK);
      break;
    default:
      break;
  }
  feed_dead_band(t);
}

unsigned EPwmModule::write_trip_zone(std::uint16_t offset, std::uint16_t value) {
  switch (offset) {
    case EPWM_TZSEL:
      trip_.select = static_cast<std::uint16_t>(value & 0x3F3Fu);
      trip_.sense();
      break;
    case EPWM_TZCTL:
      trip_.control = static_cast<std::uint16_t>(value & (EPWM_TZCTL_TZA_MASK | EPWM_TZCTL_TZB_MASK));
      break;
    case EPWM_TZEINT:
      trip_.enable = static_cast<std::uint16_t>(value & (EPWM_TZEINT_CBC_MASK | EPWM_TZEINT_OST_MASK));
      break;
    case EPWM_TZCLR:
      trip_.clear(value);
      break;
    case EPWM_TZFRC:
      trip_.force(value);
      break;
    default:
      break;
  }
  return trip_effects();
}

unsigned EPwmModule::write_event_trigger(std::uint16_t offset, std::uint16_t value, Tick t) {
  unsigned effects = 0;
  switch (offset) {
    case EPWM_ETSEL:
      effects = trigger_.write_select(value);
      reschedule(t);
      break;
    case EPWM_ETPS:
      trigger_.write_prescale(value);
      reschedule(t);
      break;
    case EPWM_ETCLR:
      effects = trigger_.clear(value);
      break;
    case EPWM_ETFRC:
      effects = trigger_.force(value);
      break;
    default:
      break;
  }
  return effects;
}

std::uint16_t EPwmModule::read(std::uint16_t offset, Tick t) const {
  if (offset <= EPWM_TBPRD) {
    return read_time_base(offset, t);
  }
  if (offset <= EPWM_CMPB) {
    return read_compare(offset);
  }
  if (offset >= EPWM_TZSEL && offset <= EPWM_TZFRC) {
    return read_trip_zone(offset);
  }
  switch (offset) {
    case EPWM_AQCTLA:
    case EPWM_AQCTLB:
      return action_.control(offset == EPWM_AQCTLA ? 0 : 1);
    case EPWM_AQSFRC:
      return action_.software_force();
    case EPWM_AQCSFRC:
      return action_.continuous_force();
    case EPWM_DBCTL:
      return dead_band_.control;
    case EPWM_DBRED:
      return dead_band_.rising_delay;
    case EPWM_DBFED:
      return dead_band_.falling_delay;
    case EPWM_ETSEL:
      return trigger_.select();
    case EPWM_ETPS:
      return trigger_.prescale();
    case EPWM_ETFLG:
      return trigger_.flags();
    case EPWM_PCCTL:
      return chopper_;
    case EPWM_HRCNFG:
      return high_resolution_;
    default:
      return 0;
  }
}

std::uint16_t EPwmModule::read_trip_zone(std::uint16_t offset) const {
  switch (offset) {
    case EPWM_TZSEL:
      return trip_.select;
    case EPWM_TZCTL:
      return trip_.control;
    case EPWM_TZEINT:
      return trip_.enable;
    case EPWM_TZFLG:
      return trip_.flags();
    default:
      return 0;  // TZCLR and TZFRC are write-only
  }
}

std::uint16_t EPwmModule::read_status(Tick t) const {
  return static_cast<std::uint16_t>((base_.counting_up(t) ? EPWM_TBSTS_CTRDIR_MASK : 0u) |
                                    (sync_input_seen_ ? EPWM_TBSTS_SYNCI_MASK : 0u) |
                                    (base_.reached_max() ? EPWM_TBSTS_CTRMAX_MASK : 0u));
}

std::uint16_t EPwmModule::read_time_base(std::uint16_t offset, Tick t) const {
  switch (offset) {
    case EPWM_TBCTL:
      return control_;
    case EPWM_TBSTS:
      return read_status(t);
    case EPWM_TBPHS_TBPHSHR:
      return phase_hr_;
    case EPWM_TBPHS_TBPHS:
      return phase_;
    case EPWM_TBCTR:
      return base_.count(t);
    case EPWM_TBPRD:
      return period_is_shadowed() ? period_shadow_.value : base_.period();
    default:
      return 0;
  }
}

std::uint16_t EPwmModule::read_compare(std::uint16_t offset) const {
  switch (offset) {
    case EPWM_CMPCTL:
      return static_cast<std::uint16_t>(compare_control_ | (compare_a_shadow_.full ? EPWM_CMPCTL_SHDWAFULL_MASK : 0u) |
                                        (compare_b_shadow_.full ? EPWM_CMPCTL_SHDWBFULL_MASK : 0u));
    case EPWM_CMPA_CMPAHR:
      return compare_a_hr_;
    case EPWM_CMPA_CMPA:
      return compare_a_shadow_.value;
    case EPWM_CMPB:
      return compare_b_shadow_.value;
    default:
      return 0;
  }
}

}  // namespace stillspin::chip
