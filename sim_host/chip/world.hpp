// What is soldered around the chip: the seam between the virtual F2808 and everything outside its package.
//
// The chip calls; the world answers. Times are ticks of 10 ns counted from power-on and never decrease from one call
// to the next, so that a world may integrate its continuous state lazily up to the time it is given.

#ifndef STILLSPIN_SIM_HOST_CHIP_WORLD_HPP
#define STILLSPIN_SIM_HOST_CHIP_WORLD_HPP

#include <cstdint>
#include <limits>

#include "sim_host/chip/can_line.hpp"

namespace stillspin::chip {

using Tick = std::int64_t;  // 10 ns
inline constexpr Tick kTicksPerSecond = 100'000'000;
inline constexpr Tick kNever = std::numeric_limits<Tick>::max();

/// What an asynchronous transmitter has put on its line: level of bit k (0 is the start bit) is bit k of `levels`.
struct SerialFrame {
  Tick begin;
  Tick bit;  // ticks a bit lasts
  unsigned bits;
  unsigned levels;
};

class World {
 public:
  virtual ~World() = default;

  /// The pins of ePWM1..6 changed: `module` 0..5; levels as seen at the pin. A pin that is not driven (not muxed to the
  /// ePWM) has the level to which the board pulls it.
  virtual void on_pwm_pins(Tick t, int module, bool a, bool b) = 0;
  virtual bool pwm_pins_pulled_up() const { return false; }

  /// The sample-and-hold of `channel` (0..7 = ADCINA0..7, 8..15 = ADCINB0..7) opens at t: the 12-bit code it will give.
  virtual std::uint16_t adc_sample(Tick t, int channel) = 0;

  /// Level at a pin used as an input (0..34), asked when firmware reads it.
  virtual bool pin_level(Tick t, int pin) = 0;

  /// A pin used as a general purpose output changed.
  virtual void on_output_pin(Tick t, int pin, bool level) = 0;

  /// What the chip does with the I2C pins (GPIO32 SDA, GPIO33 SCL), as I2C or as general purpose pins: true lets the
  /// line go, false pulls it low. pin_level gives the lines themselves.
  virtual void on_i2c_pins(Tick /*t*/, bool /*sda*/, bool /*scl*/) {}

  /// Quadrature edges counted since power-on by the encoder on eQEP1 (signed), and the count at the last index pulse.
  virtual std::int64_t encoder_edges(Tick t) = 0;

  /// The line at the serial port's receiver (SCIRXDA): the first tick at or after t at which it has this level, kNever
  /// when it keeps the other one for all that is known. A line at rest is high. The port asks about the past (the frame
  /// that has just ended), but never for an earlier t than before. What the world adds to the line later lies in the
  /// future; the chip looks again after World::call, at the start of each run and after Chip::pins_changed.
  virtual Tick serial_reaches(Tick t, bool level) { return level ? t : kNever; }

  /// The serial port's transmitter (SCITXDA) has completed a frame.
  virtual void on_serial_frame(Tick /*t*/, const SerialFrame& /*frame*/) {}

  /// The bus behind the pins of eCAN-A (GPIO30, 31), nullptr for none. Asked once; it lives as long as the chip.
  virtual CanLine* can_line() { return nullptr; }

  /// When the world next wants to be called on its own account (kNever when not), and that call.
  virtual Tick next_call() const = 0;
  virtual void call(Tick t) = 0;
};

}  // namespace stillspin::chip

#endif
