// What the receiver of the serial port (SCI) makes of the level of its line: characters, framing errors and breaks.
//
// The receiver samples with a clock of eight cycles a bit. A start bit is a line that stays low for four of them; every
// bit then has the value that two of its samples 4, 5 and 6 agree on. A sender with another bit rate, a glitch or a
// late start therefore act as they do on the chip. A first stop bit that reads low is a framing error; when the line
// stays low for ten more bits it is a break, and the receiver then waits for a reset of the port.
// The samples are taken when the frame is over: the line is asked about the past, but never backwards.
// Autobaud: the first low stretch of a character counts as one bit, which it is in 'A' and 'a'; the character is then
// read with that length, and the rate is locked when it was one of the two. Anything else is passed over.
// Source: SPRU051 (SCI), from memory.

#ifndef STILLSPIN_SIM_HOST_CHIP_SCI_RECEIVER_HPP
#define STILLSPIN_SIM_HOST_CHIP_SCI_RECEIVER_HPP

#include <cstdint>

#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip {

/// How a character lies on the line, and how long a bit lasts.
struct SciFormat {
  unsigned data_bits = 1;
  bool parity = false;
  bool even = false;
  unsigned stop_bits = 1;
  Tick sample = 1;  // ticks of an eighth of a bit

  Tick bit() const { return 8 * sample; }
  unsigned frame_bits() const { return 1 + data_bits + (parity ? 1 : 0) + stop_bits; }
  bool operator==(const SciFormat& o) const {
    return data_bits == o.data_bits && parity == o.parity && even == o.even && stop_bits == o.stop_bits &&
           sample == o.sample;
  }
};

/// The parity bit that belongs to the data.
bool sci_parity_bit(unsigned data, bool even);

struct SciCharacter {
  std::uint16_t data = 0;
  bool parity_error = false;
  bool framing_error = false;
};

class SciReceiver {
 public:
  enum class Outcome { kNothing, kCharacter, kBreak };

  explicit SciReceiver(ChipServices& services) : services_(services) {}

  /// Deaf, as in reset or without a clock.
  void stop();
  /// Wait for a start bit from t on; a line that is low already counts as one.
  void listen(const SciFormat& format, Tick t);
  /// Wait for 'A' or 'a' at any rate; `cycle` is the period of LSPCLK.
  void measure(const SciFormat& format, Tick cycle, Tick t);
  /// Of the character that was taken last.
  const SciFormat& format() const { return format_; }
  bool listening() const { return state_ != State::kOff; }
  /// The line has been written on: look again when it falls or rises.
  void line_changed(Tick t);

  Tick next_event() const { return next_event_; }
  Outcome run_event(Tick t);
  const SciCharacter& character() const { return character_; }

 private:
  enum class State { kOff, kIdle, kStart, kMeasure, kFrame, kLow };

  bool level(Tick t) const { return services_.serial_reaches(t, true) == t; }
  bool bit(unsigned index) const;
  void wait_for_start(Tick t);
  void wait_for_rise(Tick t);
  void check_start(Tick t);
  void take_length(Tick t);
  void await_frame();
  Outcome read_frame(Tick t);
  Outcome end_low(Tick t);

  ChipServices& services_;
  SciFormat format_;
  SciCharacter character_;
  State state_ = State::kOff;
  Tick start_ = 0;     // of the frame
  Tick cycle_ = 0;     // of LSPCLK while a rate is measured, else 0
  Tick break_at_ = 0;  // when a line that is still low is a break
  Tick next_event_ = kNever;
};

}  // namespace stillspin::chip

#endif
