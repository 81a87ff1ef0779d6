// The far end of the board's serial port: what a computer with an adapter puts on the wire, and what it makes of what
// comes back.
//
// Octets travel as 8N1 frames with the far end's own bit rate, one behind the other, never before the tick at which
// they were handed over. The rate need not be the port's: each side samples the levels of the other, so a wrong rate
// gives wrong octets and framing errors as on a wire. Breaks can be sent, short ones are glitches, and seeded noise can
// turn bits over. The direction to the far end has no noise; after a frame's end its line counts as idle.

#ifndef STILLSPIN_SIM_HOST_DEVICES_SERIAL_LINE_HPP
#define STILLSPIN_SIM_HOST_DEVICES_SERIAL_LINE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <random>
#include <vector>

#include "sim_host/chip/world.hpp"

namespace stillspin::devices {

using chip::Tick;

class SerialLine {
 public:
  /// What the far end has seen.
  struct Counts {
    std::uint64_t sent = 0;            // octets towards the chip
    std::uint64_t received = 0;        // octets from the chip
    std::uint64_t framing_errors = 0;  // frames from the chip without a stop bit
  };

  /// Bits per second of the far end, 10 to 10 million; throws std::invalid_argument outside.
  void set_rate(double bits_per_second);
  double rate() const { return rate_; }

  /// Probability that a bit towards the chip is turned over, 0..1. Octets that are sent from now on.
  void set_noise(double flips_per_bit, std::uint64_t seed);

  // ---- the far end
  void send(const std::vector<std::uint8_t>& octets, Tick t);
  /// Hold the line low for this many bit times.
  void send_break(double bits, Tick t);
  /// The octets that have arrived since the last call.
  std::vector<std::uint8_t> take();
  /// When everything that was handed over will have left; t when it has.
  Tick sent_until(Tick t) const;
  const Counts& counts() const { return counts_; }
  /// Bit rate of the last frame from the chip, 0 before the first.
  double chip_rate() const { return chip_rate_; }

  // ---- the chip's end, see chip::World
  Tick reaches(Tick t, bool level);
  bool level(Tick t) const;
  void receive(const chip::SerialFrame& frame);

 private:
  static constexpr unsigned kFrameBits = 10;  // start, eight data bits, stop

  // A stretch of bits of one length; the line rests high between stretches.
  struct Stretch {
    double begin;
    double bit;  // ticks
    unsigned bits;
    unsigned levels;
    std::array<Tick, kFrameBits + 1> edges;  // the first tick of each bit; last the end

    Stretch(double begin, double bit, unsigned bits, unsigned levels);
    Tick edge(unsigned index) const { return edges[index]; }
    Tick end() const { return edges[bits]; }
    bool level(Tick t) const;
  };

  void append(unsigned levels, unsigned bits, double bit, Tick t);
  unsigned noisy(unsigned levels, unsigned bits);
  static Tick in_stretch(const Stretch& stretch, Tick t, bool level);

  double rate_ = 115200.0;
  double chip_rate_ = 0.0;
  double flips_ = 0.0;
  std::mt19937_64 random_;
  std::deque<Stretch> stretches_;  // those that have not ended when last asked, in order
  std::vector<std::uint8_t> arrived_;
  Counts counts_;
};

}  // namespace stillspin::devices

#endif
