// The CPU's side: registers, flags, interrupts, FIFOs.

#include <algorithm>

#include "hal/f2808/registers.h"
#include "sim_host/chip/i2c.hpp"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {
namespace {

constexpr unsigned kWritableFlags = I2C_STR_AL_MASK | I2C_STR_NACK_MASK | I2C_STR_ARDY_MASK | I2C_STR_RRDY_MASK |
                                    I2C_STR_SCD_MASK | I2C_STR_NACKSNT_MASK;
constexpr unsigned kClearedByReading = I2C_STR_AL_MASK | I2C_STR_NACK_MASK | I2C_STR_SCD_MASK;
// In the order of the codes of I2CISRC, 1 and up; the lower goes first.
constexpr unsigned kSources[] = {I2C_STR_AL_MASK,   I2C_STR_NACK_MASK, I2C_STR_ARDY_MASK, I2C_STR_RRDY_MASK,
                                 I2C_STR_XRDY_MASK, I2C_STR_SCD_MASK,  I2C_STR_AAS_MASK};
constexpr unsigned kEnableOfSource[] = {I2C_IER_AL_MASK,   I2C_IER_NACK_MASK, I2C_IER_ARDY_MASK, I2C_IER_RRDY_MASK,
                                        I2C_IER_XRDY_MASK, I2C_IER_SCD_MASK,  I2C_IER_AAS_MASK};
constexpr unsigned kFifoStored = I2C_FFTX_TXFFIL_MASK | I2C_FFTX_TXFFIENA_MASK | I2C_FFTX_TXFFRST_MASK;

}  // namespace

unsigned I2c::capacity() const { return bit_set(fifo_transmit_, I2C_FFTX_I2CFFEN_MASK) ? Fifo::kDepth : 1u; }

// ---- flags
// -----------------------------------------------------------------------------------------------------------

void I2c::set_flag(unsigned mask, Tick t) {
  if (mask != I2C_STR_XRDY_MASK) flags_ |= mask;  // XRDY follows the buffer
  for (unsigned n = 0; n < std::size(kSources); ++n) {
    if (kSources[n] != mask || !bit_set(interrupt_enable_, kEnableOfSource[n])) continue;
    pending_ |= mask;
    services_.raise_interrupt(VECTOR_I2CINT1A, t);
  }
}

/// The FIFOs' flags follow their levels; an interrupt comes when one rises.
void I2c::note_levels(Tick t) {
  if (capacity() == 1) return;
  const bool room = to_send_.count() <= field(fifo_transmit_, I2C_FFTX_TXFFIL_MASK, I2C_FFTX_TXFFIL_LSB);
  const bool full = got_.count() > 0 && got_.count() >= field(fifo_receive_, I2C_FFRX_RXFFIL_MASK, I2C_FFRX_RXFFIL_LSB);
  const bool rises = (room && !fifo_transmit_flag_ && bit_set(fifo_transmit_, I2C_FFTX_TXFFIENA_MASK)) ||
                     (full && !fifo_receive_flag_ && bit_set(fifo_receive_, I2C_FFRX_RXFFIENA_MASK));
  fifo_transmit_flag_ |= room;
  fifo_receive_flag_ |= full;
  if (rises) services_.raise_interrupt(VECTOR_I2CINT2A, t);
}

std::uint16_t I2c::status() const {
  const bool holds_transmit = phase_ == Phase::kHoldData && !receive_;
  const bool holds_receive = phase_ == Phase::kHoldData && receive_;
  unsigned word = flags_;
  if (to_send_.count() == 0) word |= I2C_STR_XRDY_MASK;
  if (!holds_transmit) word |= I2C_STR_XSMT_MASK;
  if (holds_receive) word |= I2C_STR_RSFULL_MASK;
  if (busy_) word |= I2C_STR_BB_MASK;
  return static_cast<std::uint16_t>(word);
}

std::uint16_t I2c::read_source() {
  for (unsigned n = 0; n < std::size(kSources); ++n) {
    if (!bit_set(pending_, kSources[n])) continue;
    pending_ &= ~kSources[n];
    flags_ &= ~(kSources[n] & kClearedByReading);
    return static_cast<std::uint16_t>(n + 1);
  }
  return 0;
}

std::uint16_t I2c::fifo_register(std::uint16_t stored, const Fifo& fifo, bool flag) const {
  return static_cast<std::uint16_t>(stored | fifo.count() << I2C_FFTX_TXFFST_LSB |
                                    (flag ? unsigned{I2C_FFTX_TXFFINT_MASK} : 0u));
}

// ---- registers
// -------------------------------------------------------------------------------------------------------

std::uint16_t I2c::read(std::uint16_t offset, Tick t) {
  switch (offset) {
    case I2C_OAR:
      return own_address_;
    case I2C_IER:
      return interrupt_enable_;
    case I2C_STR:
      return status();
    case I2C_CLKL:
      return clock_low_;
    case I2C_CLKH:
      return clock_high_;
    case I2C_CNT:
      return count_;
    case I2C_DRR:
      if (got_.count() > 0) received_ = got_.pop();
      if (got_.count() == 0) flags_ &= ~unsigned{I2C_STR_RRDY_MASK};
      if (phase_ == Phase::kHoldData) go_on(t);
      return received_;
    case I2C_SAR:
      return slave_address_;
    case I2C_DXR:
      return transmit_;
    case I2C_MDR:
      return mode_;
    case I2C_ISRC:
      return read_source();
    case I2C_PSC:
      return prescale_;
    case I2C_FFTX:
      return fifo_register(fifo_transmit_, to_send_, fifo_transmit_flag_);
    case I2C_FFRX:
      return fifo_register(fifo_receive_, got_, fifo_receive_flag_);
    default:
      return 0;
  }
}

void I2c::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  switch (offset) {
    case I2C_OAR:
      own_address_ = value & 0x3FF;
      break;
    case I2C_IER:
      interrupt_enable_ = value & 0x7F;
      break;
    case I2C_STR:
      flags_ &= ~(value & kWritableFlags);
      break;
    case I2C_CLKL:
      clock_low_ = value;
      break;
    case I2C_CLKH:
      clock_high_ = value;
      break;
    case I2C_CNT:
      count_ = value;
      break;
    case I2C_SAR:
      slave_address_ = value & 0x3FF;
      break;
    case I2C_DXR:
      transmit_ = value & 0xFF;
      if (to_send_.count() < capacity()) to_send_.push(transmit_);
      note_levels(t);
      if (phase_ == Phase::kHoldData) go_on(t);
      break;
    case I2C_MDR:
      write_mode(value, t);
      break;
    case I2C_PSC:
      if (!mode(I2C_MDR_IRS_MASK)) prescale_ = value & I2C_PSC_IPSC_MASK;
      break;
    case I2C_FFTX:
      write_fifo_transmit(value, t);
      break;
    case I2C_FFRX:
      write_fifo_receive(value, t);
      break;
    default:
      break;
  }
}

void I2c::write_mode(std::uint16_t value, Tick t) {
  mode_ = value;
  if (mode(I2C_MDR_IRS_MASK)) {
    command(t);
  } else {
    release_bus(t);
  }
}

void I2c::write_fifo_transmit(std::uint16_t value, Tick t) {
  fifo_transmit_ = static_cast<std::uint16_t>(value & (kFifoStored | I2C_FFTX_I2CFFEN_MASK));
  if (!bit_set(value, I2C_FFTX_TXFFRST_MASK)) to_send_.clear();
  if (bit_set(value, I2C_FFTX_TXFFINTCLR_MASK)) fifo_transmit_flag_ = false;
  note_levels(t);
}

void I2c::write_fifo_receive(std::uint16_t value, Tick t) {
  fifo_receive_ = static_cast<std::uint16_t>(value & kFifoStored);
  if (!bit_set(value, I2C_FFRX_RXFFRST_MASK)) got_.clear();
  if (bit_set(value, I2C_FFRX_RXFFINTCLR_MASK)) fifo_receive_flag_ = false;
  note_levels(t);
}

}  // namespace stillspin::chip
