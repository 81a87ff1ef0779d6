#include "sim_host/chip/epwm_action.hpp"

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

namespace {

constexpr unsigned kClear = 1;
constexpr unsigned kSet = 2;
constexpr unsigned kToggle = 3;
constexpr unsigned kForceLow = 1;
constexpr unsigned kForceHigh = 2;

// Positions of the CountEvent bits, highest priority first; -1 ends a list.
constexpr std::int8_t kZeroBit = 0, kPeriodBit = 1, kAUpBit = 2, kADownBit = 3, kBUpBit = 4, kBDownBit = 5;
constexpr std::int8_t kPriorityUp[] = {kPeriodBit, kBUpBit, kAUpBit, kZeroBit, -1};
constexpr std::int8_t kPriorityDown[] = {kZeroBit, kBDownBit, kADownBit, kPeriodBit, -1};
constexpr std::int8_t kPriorityUpDownRising[] = {kBUpBit, kAUpBit, kZeroBit, kBDownBit, kADownBit, -1};
constexpr std::int8_t kPriorityUpDownFalling[] = {kBDownBit, kADownBit, kPeriodBit, kBUpBit, kAUpBit, -1};

const std::int8_t* priority(CountMode mode, bool up) {
  switch (mode) {
    case CountMode::down:
      return kPriorityDown;
    case CountMode::up_down:
      return up ? kPriorityUpDownRising : kPriorityUpDownFalling;
    case CountMode::up:
    case CountMode::stopped:
      break;
  }
  return kPriorityUp;
}

}  // namespace

void ActionQualifier::write_control(int output, std::uint16_t value) {
  control_[output] = value;
  used_[output] = 0;
  for (unsigned event = 0; event < 6; ++event) {
    used_[output] |= ((value >> (2 * event)) & 3u) != 0 ? 1u << event : 0u;
  }
}

void ActionQualifier::take(int output, unsigned action) {
  if (action == kClear) {
    level_[output] = false;
  } else if (action == kSet) {
    level_[output] = true;
  } else if (action == kToggle) {
    level_[output] = !level_[output];
  }
}

void ActionQualifier::apply_continuous_force() {
  for (int output = 0; output < 2; ++output) {
    const unsigned force = (force_active_ >> (2 * output)) & 3u;
    if (force == kForceLow || force == kForceHigh) {
      level_[output] = force == kForceHigh;
    }
  }
}

void ActionQualifier::write_software_force(std::uint16_t value) {
  constexpr unsigned kOneShot = EPWM_AQSFRC_OTSFA_MASK | EPWM_AQSFRC_OTSFB_MASK;
  software_force_ = static_cast<std::uint16_t>(value & 0xFFu & ~kOneShot);
  if (bit_set(value, EPWM_AQSFRC_OTSFA_MASK)) {
    take(0, field(value, EPWM_AQSFRC_ACTSFA_MASK, EPWM_AQSFRC_ACTSFA_LSB));
  }
  if (bit_set(value, EPWM_AQSFRC_OTSFB_MASK)) {
    take(1, field(value, EPWM_AQSFRC_ACTSFB_MASK, EPWM_AQSFRC_ACTSFB_LSB));
  }
  apply_continuous_force();
}

void ActionQualifier::write_continuous_force(std::uint16_t value) {
  force_shadow_ = static_cast<std::uint16_t>(value & (EPWM_AQCSFRC_CSFA_MASK | EPWM_AQCSFRC_CSFB_MASK));
  if (load_events() == 0) {
    force_active_ = force_shadow_;
    apply_continuous_force();
  }
}

unsigned ActionQualifier::load_events() const {
  constexpr unsigned kEvents[] = {kCountZero, kCountPeriod, kCountZero | kCountPeriod, 0};
  return kEvents[field(software_force_, EPWM_AQSFRC_RLDCSF_MASK, EPWM_AQSFRC_RLDCSF_LSB)];
}

bool ActionQualifier::act_on(unsigned events, CountMode mode, bool up) {
  const bool before[2] = {level_[0], level_[1]};
  for (int output = 0; output < 2; ++output) {
    const unsigned acting = events & used_[output];
    if (acting == 0) {
      continue;
    }
    for (const std::int8_t* bit = priority(mode, up); *bit >= 0; ++bit) {
      if ((acting & (1u << *bit)) != 0) {
        take(output, (control_[output] >> (2 * *bit)) & 3u);
        break;
      }
    }
  }
  if ((events & load_events()) != 0) {
    force_active_ = force_shadow_;
  }
  if (force_active_ != 0) {
    apply_continuous_force();
  }
  return level_[0] != before[0] || level_[1] != before[1];
}

}  // namespace stillspin::chip
