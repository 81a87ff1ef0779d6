#include "sim_host/chip/sci.hpp"

#include "hal/f2808/registers.h"
#include "sim_host/chip/register_field.hpp"

namespace stillspin::chip {

namespace {

constexpr std::uint16_t kTransmitFifoReset = 0xA000;
constexpr std::uint16_t kReceiveFifoReset = 0x201F;

constexpr unsigned kControl1Kept =
    SCI_CTL1_RXENA_MASK | SCI_CTL1_TXENA_MASK | SCI_CTL1_SWRESET_MASK | SCI_CTL1_RXERRINTENA_MASK;
constexpr unsigned kTransmitFifoKept = SCI_FFTX_TXFFIL_MASK | SCI_FFTX_TXFFIENA_MASK | SCI_FFTX_TXFIFOXRESET_MASK |
                                       SCI_FFTX_SCIFFENA_MASK | SCI_FFTX_SCIRST_MASK;
constexpr unsigned kReceiveFifoKept = SCI_FFRX_RXFFIL_MASK | SCI_FFRX_RXFFIENA_MASK | SCI_FFRX_RXFIFORESET_MASK;
constexpr unsigned kErrors = SCI_RXST_PE_MASK | SCI_RXST_OE_MASK | SCI_RXST_FE_MASK | SCI_RXST_BRKDT_MASK;

std::uint16_t word(unsigned bits) { return static_cast<std::uint16_t>(bits); }

}  // namespace

void Sci::reset(Tick t) {
  format_ = control1_ = control2_ = baud_ = errors_ = delay_ = priority_ = 0;
  transmit_fifo_ = kTransmitFifoReset;
  receive_fifo_ = kReceiveFifoReset;
  received_.clear();
  to_send_.clear();
  receive_buffer_ = transmit_buffer_ = 0;
  receive_ready_ = transmit_full_ = false;
  measuring_ = rate_locked_ = false;
  frame_end_ = kNever;
  receiver_.stop();
  running_ = false;
  adapt(t);
}

// ---- state -------------------------------------------------------------------------------------------

bool Sci::running() const {
  return services_.sci_clock() && bit_set(control1_, SCI_CTL1_SWRESET_MASK) &&
         bit_set(transmit_fifo_, SCI_FFTX_SCIRST_MASK);
}

bool Sci::fifo_mode() const { return bit_set(transmit_fifo_, SCI_FFTX_SCIFFENA_MASK); }
bool Sci::loopback() const { return bit_set(format_, SCI_CCR_LOOPBKENA_MASK); }

SciFormat Sci::format() const {
  SciFormat f;
  f.data_bits = field(format_, SCI_CCR_SCICHAR_MASK, SCI_CCR_SCICHAR_LSB) + 1;
  f.parity = bit_set(format_, SCI_CCR_PARITYENA_MASK);
  f.even = bit_set(format_, SCI_CCR_PARITY_MASK);
  f.stop_bits = bit_set(format_, SCI_CCR_STOPBITS_MASK) ? 2 : 1;
  const Tick cycles = baud_ == 0 ? 2 : baud_ + Tick{1};
  f.sample = cycles * services_.lspclk_divider() * services_.sysclk_period();
  return f;
}

// Brings a port that has been reset, clocked or reconfigured into the state that its registers ask for.
void Sci::adapt(Tick t) {
  if (running() == running_ && loopback() == loopback_ && format() == in_use_) return;
  running_ = running();
  loopback_ = loopback();
  in_use_ = format();
  if (!running_) {
    errors_ = 0;
    receive_ready_ = transmit_full_ = false;
    frame_end_ = kNever;
  }
  if (!running_ || loopback_ || bit_set(errors_, SCI_RXST_BRKDT_MASK)) {
    receiver_.stop();
  } else if (measuring_) {
    receiver_.measure(in_use_, services_.lspclk_divider() * services_.sysclk_period(), t);
  } else {
    receiver_.listen(in_use_, t);
  }
}

// The receiver has found 'A' or 'a' and reads on with its length of a bit.
void Sci::lock_rate() {
  measuring_ = false;
  rate_locked_ = true;
  const Tick cycle = services_.lspclk_divider() * services_.sysclk_period();
  baud_ = word(static_cast<unsigned>(std::max(receiver_.format().sample / cycle, Tick{2}) - 1));
  in_use_ = format();
}

void Sci::write_autobaud(std::uint16_t value, Tick t) {
  if (bit_set(value, SCI_FFCT_ABDCLR_MASK)) rate_locked_ = false;
  const bool measure = bit_set(value, SCI_FFCT_CDC_MASK);
  if (measure != measuring_) {
    measuring_ = measure;
    running_ = !running();  // adapt begins anew
  }
  adapt(t);
}

void Sci::clocks_changed(Tick t) {
  if (!(format() == in_use_)) frame_end_ = kNever;
  adapt(t);
  send_next(t);
  check_levels(t);
}

void Sci::run_event(Tick t) {
  if (frame_end_ <= t) finish_frame(t);
  if (receiver_.next_event() > t) return;
  switch (receiver_.run_event(t)) {
    case SciReceiver::Outcome::kCharacter:
      if (measuring_) lock_rate();
      take_character(receiver_.character(), t);
      break;
    case SciReceiver::Outcome::kBreak:
      take_break(t);
      break;
    case SciReceiver::Outcome::kNothing:
      break;
  }
}

// ---- receiving ---------------------------------------------------------------------------------------

void Sci::interrupt_receive(bool enabled, Tick t) {
  if (enabled) services_.raise_interrupt(VECTOR_SCIRXINTA, t);
}

void Sci::take_character(const SciCharacter& c, Tick t) {
  if (!bit_set(control1_, SCI_CTL1_RXENA_MASK)) return;
  errors_ = word(errors_ | (c.parity_error ? SCI_RXST_PE_MASK : 0u) | (c.framing_error ? SCI_RXST_FE_MASK : 0u));
  bool failed = c.parity_error || c.framing_error;
  if (fifo_mode()) {
    fill_fifo(word(c.data | (c.parity_error ? SCI_RXBUF_SCIFFPE_MASK : 0u) |
                   (c.framing_error ? SCI_RXBUF_SCIFFFE_MASK : 0u)));
    check_levels(t);
  } else {
    if (receive_ready_) errors_ = word(errors_ | SCI_RXST_OE_MASK);
    failed = failed || receive_ready_;
    receive_buffer_ = c.data;
    receive_ready_ = true;
    interrupt_receive(bit_set(control2_, SCI_CTL2_RXBKINTENA_MASK), t);
  }
  interrupt_receive(failed && bit_set(control1_, SCI_CTL1_RXERRINTENA_MASK), t);
}

void Sci::fill_fifo(std::uint16_t value) {
  if (!bit_set(receive_fifo_, SCI_FFRX_RXFIFORESET_MASK)) return;
  if (received_.full()) {
    received_.pop();
    receive_fifo_ = word(receive_fifo_ | SCI_FFRX_RXFFOVF_MASK);
  }
  received_.push(value);
}

void Sci::take_break(Tick t) {
  errors_ = word(errors_ | SCI_RXST_BRKDT_MASK);
  interrupt_receive(bit_set(control2_, SCI_CTL2_RXBKINTENA_MASK) || bit_set(control1_, SCI_CTL1_RXERRINTENA_MASK), t);
}

std::uint16_t Sci::read_buffer() {
  if (fifo_mode()) return received_.pop();
  receive_ready_ = false;
  return receive_buffer_;
}

std::uint16_t Sci::receive_status() const {
  const bool ready = fifo_mode() ? !received_.empty() : receive_ready_;
  return word(errors_ | (ready ? SCI_RXST_RXRDY_MASK : 0u) | (bit_set(errors_, kErrors) ? SCI_RXST_RXERROR_MASK : 0u));
}

// ---- transmitting ------------------------------------------------------------------------------------

void Sci::put(std::uint16_t value) {
  if (!fifo_mode()) {
    transmit_buffer_ = value;
    transmit_full_ = true;
  } else if (bit_set(transmit_fifo_, SCI_FFTX_TXFIFOXRESET_MASK) && !to_send_.full()) {
    to_send_.push(value);
  }
}

// Moves the next word to the shift register, which leaves room behind it.
void Sci::send_next(Tick t) {
  const bool waiting = fifo_mode() ? !to_send_.empty() : transmit_full_;
  if (!running() || !bit_set(control1_, SCI_CTL1_TXENA_MASK) || sending() || !waiting) return;
  const std::uint16_t value = fifo_mode() ? to_send_.pop() : transmit_buffer_;
  const SciFormat f = format();
  frame_data_ = word(value & ((1u << f.data_bits) - 1u));
  unsigned levels = frame_data_ << 1;  // the start bit is low
  unsigned length = 1 + f.data_bits;
  if (f.parity) levels |= (sci_parity_bit(frame_data_, f.even) ? 1u : 0u) << length++;
  levels |= ((1u << f.stop_bits) - 1u) << length;
  frame_ = SerialFrame{t, f.bit(), f.frame_bits(), levels};
  const Tick pause = fifo_mode() ? field(delay_, SCI_FFCT_FFTXDLY_MASK, SCI_FFCT_FFTXDLY_LSB) : 0;
  frame_end_ = t + (f.frame_bits() + pause) * f.bit();
  if (!fifo_mode()) {
    transmit_full_ = false;
    if (bit_set(control2_, SCI_CTL2_TXINTENA_MASK)) services_.raise_interrupt(VECTOR_SCITXINTA, t);
  }
}

void Sci::finish_frame(Tick t) {
  frame_end_ = kNever;
  if (loopback()) {
    take_character(SciCharacter{frame_data_, false, false}, t);
  } else {
    services_.serial_frame(frame_, t);
  }
  send_next(t);
  check_levels(t);
}

std::uint16_t Sci::control2() const {
  const bool ready = fifo_mode() ? !to_send_.full() : !transmit_full_;
  const bool empty = !sending() && (fifo_mode() ? to_send_.empty() : !transmit_full_);
  return word(control2_ | (ready ? SCI_CTL2_TXRDY_MASK : 0u) | (empty ? SCI_CTL2_TXEMPTY_MASK : 0u));
}

// ---- FIFO levels -------------------------------------------------------------------------------------

void Sci::check_levels(Tick t) {
  if (!fifo_mode() || !bit_set(transmit_fifo_, SCI_FFTX_SCIRST_MASK)) return;
  const bool few = to_send_.count() <= field(transmit_fifo_, SCI_FFTX_TXFFIL_MASK, SCI_FFTX_TXFFIL_LSB);
  if (few && !bit_set(transmit_fifo_, SCI_FFTX_TXFFINT_MASK)) {
    transmit_fifo_ = word(transmit_fifo_ | SCI_FFTX_TXFFINT_MASK);
    if (bit_set(transmit_fifo_, SCI_FFTX_TXFFIENA_MASK)) services_.raise_interrupt(VECTOR_SCITXINTA, t);
  }
  const bool many = received_.count() >= field(receive_fifo_, SCI_FFRX_RXFFIL_MASK, SCI_FFRX_RXFFIL_LSB);
  if (many && !bit_set(receive_fifo_, SCI_FFRX_RXFFINT_MASK)) {
    receive_fifo_ = word(receive_fifo_ | SCI_FFRX_RXFFINT_MASK);
    interrupt_receive(bit_set(receive_fifo_, SCI_FFRX_RXFFIENA_MASK), t);
  }
}

// An interrupt that is enabled finds its flag anew, so that one which is up already is sent.
void Sci::write_transmit_fifo(std::uint16_t value) {
  const bool enabled = bit_set(value & ~transmit_fifo_, SCI_FFTX_TXFFIENA_MASK);
  const bool kept = !enabled && !bit_set(value, SCI_FFTX_TXFFINTCLR_MASK);
  transmit_fifo_ = word((value & kTransmitFifoKept) | (kept ? transmit_fifo_ & SCI_FFTX_TXFFINT_MASK : 0u));
  if (!bit_set(value, SCI_FFTX_TXFIFOXRESET_MASK) || !bit_set(value, SCI_FFTX_SCIRST_MASK)) to_send_.clear();
  if (!bit_set(value, SCI_FFTX_SCIRST_MASK)) received_.clear();
}

void Sci::write_receive_fifo(std::uint16_t value) {
  const bool enabled = bit_set(value & ~receive_fifo_, SCI_FFRX_RXFFIENA_MASK);
  const bool kept = !enabled && !bit_set(value, SCI_FFRX_RXFFINTCLR_MASK);
  const bool overflow_kept = !bit_set(value, SCI_FFRX_RXFFOVRCLR_MASK);
  receive_fifo_ = word((value & kReceiveFifoKept) | (kept ? receive_fifo_ & SCI_FFRX_RXFFINT_MASK : 0u) |
                       (overflow_kept ? receive_fifo_ & SCI_FFRX_RXFFOVF_MASK : 0u));
  if (!bit_set(value, SCI_FFRX_RXFIFORESET_MASK)) received_.clear();
}

// ---- registers ---------------------------------------------------------------------------------------

void Sci::write_control2(std::uint16_t value, Tick t) {
  const bool rises = bit_set(value & ~control2_, SCI_CTL2_TXINTENA_MASK);
  control2_ = word(value & (SCI_CTL2_TXINTENA_MASK | SCI_CTL2_RXBKINTENA_MASK));
  if (rises && !fifo_mode() && !transmit_full_) services_.raise_interrupt(VECTOR_SCITXINTA, t);
}

void Sci::write_register(std::uint16_t offset, std::uint16_t value, Tick t) {
  switch (offset) {
    case SCI_CCR:
      if (bit_set(value, SCI_CCR_ADDRIDLE_MODE_MASK)) {
        services_.model_error("SCI: address-bit mode is not modelled, SCICCR", value);
      }
      format_ = value & 0x00FFu;
      break;
    case SCI_CTL1:
      if (bit_set(value, SCI_CTL1_SLEEP_MASK | SCI_CTL1_TXWAKE_MASK)) {
        services_.model_error("SCI: SLEEP and TXWAKE are not modelled, SCICTL1", value);
      }
      control1_ = word(value & kControl1Kept);
      break;
    case SCI_HBAUD:
      baud_ = with_bits(baud_, 0xFF00u, static_cast<unsigned>(value) << 8);
      break;
    case SCI_LBAUD:
      baud_ = with_bits(baud_, 0x00FFu, value);
      break;
    case SCI_CTL2:
      write_control2(value, t);
      break;
    case SCI_TXBUF:
      put(value & 0x00FFu);
      break;
    case SCI_FFTX:
      write_transmit_fifo(value);
      break;
    case SCI_FFRX:
      write_receive_fifo(value);
      break;
    case SCI_FFCT:
      write_autobaud(value, t);
      delay_ = value & SCI_FFCT_FFTXDLY_MASK;
      break;
    case SCI_PRI:
      priority_ = value & (SCI_PRI_FREE_MASK | SCI_PRI_SOFT_MASK);
      break;
    default:
      break;
  }
}

void Sci::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  write_register(offset, value, t);
  adapt(t);
  send_next(t);
  check_levels(t);
}

std::uint16_t Sci::read(std::uint16_t offset, Tick /*t*/) {
  switch (offset) {
    case SCI_CCR:
      return format_;
    case SCI_CTL1:
      return control1_;
    case SCI_HBAUD:
      return word(baud_ >> 8);
    case SCI_LBAUD:
      return baud_ & 0x00FFu;
    case SCI_CTL2:
      return control2();
    case SCI_RXST:
      return receive_status();
    case SCI_RXEMU:
      return fifo_mode() ? received_.front() : receive_buffer_;
    case SCI_RXBUF:
      return read_buffer();
    case SCI_FFTX:
      return word(transmit_fifo_ | to_send_.count() << SCI_FFTX_TXFFST_LSB);
    case SCI_FFRX:
      return word(receive_fifo_ | received_.count() << SCI_FFRX_RXFFST_LSB);
    case SCI_FFCT:
      return word(delay_ | (measuring_ ? SCI_FFCT_CDC_MASK : 0u) | (rate_locked_ ? SCI_FFCT_ABD_MASK : 0u));
    case SCI_PRI:
      return priority_;
    default:
      return 0;
  }
}

}  // namespace stillspin::chip
