// The serial port SCI-A: registers, FIFOs, flags, interrupts and transmitter; the receiver is sci_receiver.hpp.
//
// A bit lasts 8 * (BRR + 1) cycles of LSPCLK, 16 with BRR = 0. With SCIFFENA set the port works with two FIFOs of 16
// words, else with one buffer each way. A word that comes to a full receive FIFO pushes the oldest one out (RXFFOVF);
// without FIFO it overwrites the buffer (OE). A word written to a full transmit FIFO is lost. The FIFO flags rise when
// the level is reached, and again at once when they are cleared while it still is.
// A break (BRKDT) stops the receiver until SWRESET has been 0. SWRESET also cuts what is being sent; the FIFOs keep
// their words. The world gets a frame when it is complete.
// Autobaud: with CDC set the next 'A' or 'a' sets divider and ABD and arrives as a character.
// Not modelled: address-bit and idle-line modes, sleep (switching them on ends the run), emulation halt; a
// clock that changes cuts frames under way; with TXENA off the words in the buffer wait.
// Source: SPRU051 (SCI), from memory.

#ifndef STILLSPIN_SIM_HOST_CHIP_SCI_HPP
#define STILLSPIN_SIM_HOST_CHIP_SCI_HPP

#include <algorithm>
#include <cstdint>

#include "sim_host/chip/peripheral.hpp"
#include "sim_host/chip/sci_fifo.hpp"
#include "sim_host/chip/sci_receiver.hpp"

namespace stillspin::chip {

class Sci final : public Peripheral {
 public:
  explicit Sci(ChipServices& services) : services_(services), receiver_(services) {}

  void reset(Tick t) override;
  std::uint16_t read(std::uint16_t offset, Tick t) override;
  void write(std::uint16_t offset, std::uint16_t value, Tick t) override;
  Tick next_event() const override { return std::min(receiver_.next_event(), frame_end_); }
  void run_event(Tick t) override;
  void clocks_changed(Tick t) override;

  /// What the world wrote on the line since may reach the receiver.
  void line_changed(Tick t) { receiver_.line_changed(t); }

 private:
  bool running() const;
  bool fifo_mode() const;
  bool loopback() const;
  SciFormat format() const;
  void adapt(Tick t);
  void lock_rate();
  void write_autobaud(std::uint16_t value, Tick t);
  void write_register(std::uint16_t offset, std::uint16_t value, Tick t);

  // Receiving.
  void take_character(const SciCharacter& character, Tick t);
  void fill_fifo(std::uint16_t word);
  void take_break(Tick t);
  void interrupt_receive(bool enabled, Tick t);
  std::uint16_t read_buffer();
  std::uint16_t receive_status() const;

  // Transmitting.
  bool sending() const { return frame_end_ != kNever; }
  void put(std::uint16_t value);
  void send_next(Tick t);
  void finish_frame(Tick t);
  std::uint16_t control2() const;

  // FIFO levels.
  void check_levels(Tick t);
  void write_transmit_fifo(std::uint16_t value);
  void write_receive_fifo(std::uint16_t value);
  void write_control2(std::uint16_t value, Tick t);

  ChipServices& services_;
  SciReceiver receiver_;

  std::uint16_t format_ = 0;         // SCICCR
  std::uint16_t control1_ = 0;       // SCICTL1
  std::uint16_t control2_ = 0;       // SCICTL2, the enables
  std::uint16_t baud_ = 0;           // SCIHBAUD:SCILBAUD
  std::uint16_t errors_ = 0;         // SCIRXST without RXRDY and RXERROR
  std::uint16_t transmit_fifo_ = 0;  // SCIFFTX: level, enables, resets, TXFFINT
  std::uint16_t receive_fifo_ = 0;   // SCIFFRX: likewise, RXFFOVF
  std::uint16_t delay_ = 0;          // SCIFFCT, its delay
  std::uint16_t priority_ = 0;       // SCIPRI, stored

  bool running_ = false;  // what the receiver was last told
  bool loopback_ = false;
  bool measuring_ = false;    // CDC
  bool rate_locked_ = false;  // ABD
  SciFormat in_use_;

  SciFifo received_;
  SciFifo to_send_;
  std::uint16_t receive_buffer_ = 0;  // without FIFO
  bool receive_ready_ = false;
  std::uint16_t transmit_buffer_ = 0;
  bool transmit_full_ = false;
  SerialFrame frame_{};      // in the shift register
  Tick frame_end_ = kNever;  // of it, with the delay that follows
  std::uint16_t frame_data_ = 0;
};

}  // namespace stillspin::chip

#endif
