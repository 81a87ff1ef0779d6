// The bus side: bits, octets, start and stop.

#include "sim_host/chip/i2c.hpp"

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {
namespace {

constexpr unsigned kAcknowledgeBit = 8;
constexpr std::uint32_t kCountOfZero = 65536;

}  // namespace

void I2c::reset(Tick t) {
  own_address_ = interrupt_enable_ = clock_low_ = clock_high_ = count_ = mode_ = prescale_ = 0;
  slave_address_ = 0x3FF;
  fifo_transmit_ = fifo_receive_ = transmit_ = received_ = 0;
  fifo_transmit_flag_ = fifo_receive_flag_ = false;
  to_send_.clear();
  got_.clear();
  release_bus(t);
  bus_free_from_ = t;
  rest_ = kNever;
  clocked_ = false;
  clocks_changed(t);
}

void I2c::clocks_changed(Tick t) {
  sysclk_period_ = services_.sysclk_period();
  const bool was_clocked = clocked_;
  clocked_ = services_.i2c_clock();
  if (was_clocked && !clocked_) {
    rest_ = next_event_ == kNever ? kNever : next_event_ - t;
    next_event_ = kNever;
  } else if (clocked_ && !was_clocked && rest_ != kNever) {
    next_event_ = t + rest_;
    rest_ = kNever;
  }
}

Tick I2c::module_clocks(unsigned divider) const {
  const unsigned prescale = field(prescale_, I2C_PSC_IPSC_MASK, I2C_PSC_IPSC_LSB);
  const unsigned extra = prescale == 0 ? 7 : prescale == 1 ? 6 : 5;
  return Tick{divider + extra} * (prescale + 1) * sysclk_period_;
}

void I2c::lines(bool sda, bool scl, Tick t) {
  if (sda == sda_ && scl == scl_) return;
  sda_ = sda;
  scl_ = scl;
  services_.i2c_pins(sda, scl, t);
}

void I2c::enter(Phase phase, Tick until) {
  phase_ = phase;
  next_event_ = until;
}

/// Lets go of everything, as the module's reset does.
void I2c::release_bus(Tick t) {
  enter(Phase::kIdle, kNever);
  flags_ = pending_ = 0;
  busy_ = false;
  lines(true, true, t);
}

// ---- start and stop ----------------------------------------------------------------------------------------------

bool I2c::is_supported() const {
  constexpr unsigned kOther =
      I2C_MDR_BC_MASK | I2C_MDR_FDF_MASK | I2C_MDR_DLB_MASK | I2C_MDR_XA_MASK | I2C_MDR_STB_MASK;
  return !mode(kOther);
}

/// MDR has been written: what it asks for is begun where the module waits for it.
void I2c::command(Tick t) {
  const bool starts = mode(I2C_MDR_STT_MASK) && mode(I2C_MDR_MST_MASK);
  if (starts && !is_supported()) services_.model_error("I2C: only master, 7-bit addresses and octets: I2CMDR", mode_);
  if (phase_ == Phase::kIdle) {
    if (starts) try_start(t);
  } else if (phase_ == Phase::kHoldCommand) {
    flags_ &= ~unsigned{I2C_STR_ARDY_MASK};
    if (starts) {
      lines(true, false, t);
      enter(Phase::kRestartLow, t + low_time());
    } else if (mode(I2C_MDR_STP_MASK)) {
      begin_stop(t);
    } else {
      flags_ |= I2C_STR_ARDY_MASK;
    }
  } else if (phase_ == Phase::kHoldData) {
    go_on(t);
  }
}

void I2c::try_start(Tick t) {
  const bool free = t >= bus_free_from_ && services_.sda_level(t) && services_.scl_level(t);
  if (free) {
    put_start(t);
  } else {
    enter(Phase::kWaitFree, t + low_time());
  }
}

void I2c::put_start(Tick t) {
  busy_ = true;
  flags_ &= ~unsigned{I2C_STR_ARDY_MASK};
  mode_ = static_cast<std::uint16_t>(mode_ & ~I2C_MDR_STT_MASK);
  receive_ = !mode(I2C_MDR_TRX_MASK);
  left_ = count_ == 0 ? kCountOfZero : count_;
  lines(false, true, t);
  enter(Phase::kStartHold, t + high_time());
}

void I2c::begin_stop(Tick t) {
  lines(false, false, t);
  enter(Phase::kStopLow, t + low_time());
}

void I2c::end_stop(Tick t) {
  lines(true, true, t);
  enter(Phase::kIdle, kNever);
  busy_ = false;
  bus_free_from_ = t + low_time();
  mode_ = static_cast<std::uint16_t>(mode_ & ~(I2C_MDR_MST_MASK | I2C_MDR_STP_MASK));
  set_flag(I2C_STR_SCD_MASK, t);
  command(t);  // a start that was asked for meanwhile
}

void I2c::lose_arbitration(Tick t) {
  lines(true, true, t);
  enter(Phase::kIdle, kNever);
  busy_ = false;
  mode_ = static_cast<std::uint16_t>(mode_ & ~(I2C_MDR_MST_MASK | I2C_MDR_STP_MASK | I2C_MDR_STT_MASK));
  set_flag(I2C_STR_AL_MASK, t);
}

// ---- bits ----------------------------------------------------------------------------------------------------------

void I2c::run_event(Tick t) {
  switch (phase_) {
    case Phase::kWaitFree:
      try_start(t);
      break;
    case Phase::kStartHold:
      lines(false, false, t);
      address_ = true;
      begin_octet(static_cast<unsigned>(slave_address_ & 0x7F) << 1 | (receive_ ? 1u : 0u), t);
      break;
    case Phase::kLow:
      release_clock(Phase::kHigh, t);
      break;
    case Phase::kRestartLow:
      release_clock(Phase::kRestartHigh, t);
      break;
    case Phase::kStopLow:
      release_clock(Phase::kStopHigh, t);
      break;
    case Phase::kStretched:
      release_clock(after_stretch_, t);
      break;
    case Phase::kHigh:
      end_bit(t);
      break;
    case Phase::kRestartHigh:
      if (services_.sda_level(t)) {
        put_start(t);
      } else {
        lose_arbitration(t);
      }
      break;
    case Phase::kStopHigh:
      end_stop(t);
      break;
    case Phase::kIdle:
    case Phase::kHoldData:
    case Phase::kHoldCommand:
      next_event_ = kNever;
      break;
  }
}

void I2c::release_clock(Phase then, Tick t) {
  lines(sda_, true, t);
  if (services_.scl_level(t)) {
    enter(then, t + high_time());
  } else {
    after_stretch_ = then;
    enter(Phase::kStretched, t + low_time());
  }
}

/// The module sends the octet's bits unless it receives, and the acknowledge only if it receives.
void I2c::begin_bit(Tick t) {
  const bool sends = address_ || !receive_;
  const bool acknowledge = bit_ == kAcknowledgeBit;
  bool level = true;
  if (sends != acknowledge) level = acknowledge ? !acknowledged_ : (shift_ >> (7 - bit_) & 1u) != 0;
  lines(level, false, t);
  enter(Phase::kLow, t + low_time());
}

void I2c::end_bit(Tick t) {
  const bool level = services_.sda_level(t);
  const bool sends = address_ || !receive_;
  if (sends && bit_ < kAcknowledgeBit && sda_ && !level) {
    lose_arbitration(t);
    return;
  }
  lines(sda_, false, t);
  if (bit_ < kAcknowledgeBit) {
    if (!sends) shift_ = (shift_ << 1 | (level ? 1u : 0u)) & 0xFFu;
    if (++bit_ == kAcknowledgeBit && !sends) acknowledged_ = !is_last();
    begin_bit(t);
    return;
  }
  if (sends) acknowledged_ = !level;
  end_octet(t);
}

// ---- octets --------------------------------------------------------------------------------------------------------

void I2c::begin_octet(unsigned octet, Tick t) {
  shift_ = octet;
  bit_ = 0;
  begin_bit(t);
}

/// Whether the octet that is being received is to be the last one.
bool I2c::is_last() const {
  if (mode(I2C_MDR_NACKMOD_MASK)) return true;
  return mode(I2C_MDR_RM_MASK) ? mode(I2C_MDR_STP_MASK | I2C_MDR_STT_MASK) : left_ == 1;
}

bool I2c::is_finished() const {
  if (mode(I2C_MDR_RM_MASK)) return mode(I2C_MDR_STP_MASK | I2C_MDR_STT_MASK) && (receive_ || to_send_.count() == 0);
  return left_ == 0;
}

void I2c::end_octet(Tick t) {
  const bool was_address = address_;
  address_ = false;
  if (was_address || !receive_) {
    if (!was_address && left_ > 0) --left_;
    if (!acknowledged_) {
      enter(Phase::kHoldCommand, kNever);
      set_flag(I2C_STR_NACK_MASK, t);
      set_flag(I2C_STR_ARDY_MASK, t);
      if (mode(I2C_MDR_STP_MASK)) begin_stop(t);
      return;
    }
  } else {
    if (left_ > 0) --left_;
    if (!acknowledged_) {
      mode_ = static_cast<std::uint16_t>(mode_ & ~I2C_MDR_NACKMOD_MASK);
      flags_ |= I2C_STR_NACKSNT_MASK;
    }
    got_.push(static_cast<std::uint16_t>(shift_));
    set_flag(I2C_STR_RRDY_MASK, t);
    note_levels(t);
  }
  go_on(t);
}

/// The next octet, or what comes behind the last one; SCL is low.
void I2c::go_on(Tick t) {
  if (is_finished()) {
    enter(Phase::kHoldCommand, kNever);
    if (mode(I2C_MDR_STP_MASK) && !mode(I2C_MDR_STT_MASK)) {
      begin_stop(t);
    } else if (mode(I2C_MDR_STT_MASK)) {
      command(t);
    } else {
      set_flag(I2C_STR_ARDY_MASK, t);
    }
    return;
  }
  const bool waits = receive_ ? got_.count() >= capacity() : to_send_.count() == 0;
  if (waits) {
    enter(Phase::kHoldData, kNever);
    return;
  }
  const unsigned octet = receive_ ? 0u : to_send_.pop();
  if (!receive_) {
    set_flag(I2C_STR_XRDY_MASK, t);
    note_levels(t);
  }
  begin_octet(octet, t);
}

}  // namespace stillspin::chip
