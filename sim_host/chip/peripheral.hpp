// The seam inside the virtual chip: what the core offers a peripheral, and what a peripheral offers the core.
//
// Time is passed in; a peripheral owns no clock. Its counters are lazy: it remembers a value and the tick at which it
// was right, and computes the present value when asked. Only what somebody outside can notice (a pin, an interrupt, a
// start of conversion, a sample instant, a shadow load that a later event depends on) is an event.
//
// What the core guarantees
//  * t never decreases from one call to the next, over all functions of one peripheral.
//  * Events come in order of time, each at its exact tick: before an access or any other call at t is made, every event
//    due at or before t has been run. At one tick the order is: world, PLL, ePWM, ADC, eQEP, SCI, I2C, eCAN, CPU
//    timers, watchdog. So a start of conversion reaches the ADC in the tick in which the ePWM made it.
//  * Peripherals see only accesses that the bus lets through: EALLOW protection and clock gating (PCLKCR0/1) are the
//    core's business, so are the access times. Unknown offsets may arrive: read 0, ignore writes.
//  * A 32-bit access arrives as two 16-bit calls at one tick, low word (even offset) first.
//
// What the core expects
//  * next_event() is cheap and may change only inside calls made to that very peripheral other than read(); I2C's
//    read() may, as an octet that is taken lets the next one begin. (The core caches it and asks again after each of
//    them.) kNever when nothing is due; never less than the latest call's tick.
//  * run_event(t) is called with t == next_event() and handles everything due at t. If something new comes due at t,
//    leave it in next_event(): run_event(t) is called again.
//  * Nothing throws: there are C frames of the firmware below. An impossible situation goes to model_error(), which
//    ends the run as soon as control is back in the core.
//  * No allocation, no std::function after construction: these calls are the inner loop of every simulation.
//    Declare the classes `final` so that the core can call them directly.
//
// Classes that the core instantiates (one constructor argument, the services):
//    epwm.hpp: EPwmBank(ChipServices&)      adc.hpp: Adc(ChipServices&)      eqep.hpp: EQep(ChipServices&, int
//    instance 1..2)      sci.hpp: Sci(ChipServices&)      i2c.hpp: I2c(ChipServices&)

#ifndef STILLSPIN_SIM_HOST_CHIP_PERIPHERAL_HPP
#define STILLSPIN_SIM_HOST_CHIP_PERIPHERAL_HPP

#include <cstdint>

#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

/// What the core does for a peripheral. Valid from the peripheral's construction on; reset() is called before use.
class ChipServices {
 public:
  /// Latch the interrupt's flag. `vector` is a VECTOR_x of hal/f2808/registers.h: a PIE channel or VECTOR_TINT2.
  /// It is the pulse a peripheral sends: whether it may send one (enable bits, its own flags) the peripheral decides.
  virtual void raise_interrupt(unsigned vector, Tick t) = 0;

  /// From the ePWM to the ADC: SOCA (true) or SOCB (false) pulse, already OR-ed over the modules.
  virtual void start_of_conversion(bool soca, Tick t) = 0;

  /// Levels of ePWM output pair `module` (0..5) after dead band, chopper and trip zone changed; a pin in high impedance
  /// counts as low. Call only on change. The core applies the pin multiplexer and tells the world.
  virtual void pwm_outputs(int module, bool a, bool b, Tick t) = 0;

  /// The code (0..4095) that the sample-and-hold of `channel` (0..7 ADCINA0..7, 8..15 ADCINB0..7) takes at t. The tick
  /// may not lie in the future: make the sample instant an event.
  virtual std::uint16_t sample(int channel, Tick t) = 0;

  /// Signed quadrature edges since power-on that reached the eQEP1 pins (GPIO20/21 routed to it); stands still while
  /// the pins are not routed. The index pulse lies at every multiple of the counts per turn.
  virtual std::int64_t encoder_edges(Tick t) = 0;

  /// World::serial_reaches for the pin that SCIRXDA is routed to; a line that is routed to none rests.
  virtual Tick serial_reaches(Tick t, bool level) = 0;

  /// A frame that SCITXDA has sent. The core tells the world when the pin is routed.
  virtual void serial_frame(const SerialFrame& frame, Tick t) = 0;

  /// I2C: what the module does with its lines (true lets go, false pulls low; call only on change), and the lines
  /// themselves. Pins that are not routed to it read high.
  virtual void i2c_pins(bool sda, bool scl, Tick t) = 0;
  virtual bool sda_level(Tick t) = 0;
  virtual bool scl_level(Tick t) = 0;

  /// SYSCLKOUT period in ticks of 10 ns (1 at 100 MHz, 10 after reset).
  virtual Tick sysclk_period() const = 0;

  /// HSPCLK = SYSCLKOUT / this (1, 2, 4 .. 14): the ADC's clock source.
  virtual unsigned hspclk_divider() const = 0;

  /// LSPCLK = SYSCLKOUT / this (1, 2, 4 .. 14): the serial port's clock source.
  virtual unsigned lspclk_divider() const = 0;

  /// Clock gates of PCLKCR0/1, for peripherals whose counters must stand still while gated.
  virtual bool epwm_clock(int module) const = 0;  // 0..5
  virtual bool adc_clock() const = 0;
  virtual bool eqep_clock(int instance) const = 0;  // 1..2
  virtual bool sci_clock() const = 0;
  virtual bool i2c_clock() const = 0;

  /// The model cannot go on (or would go on wrongly): text is a literal, value is what was seen.
  virtual void model_error(const char* text, std::int64_t value) = 0;

 protected:
  ~ChipServices() = default;  // never owned through this type
};

/// A peripheral with one frame of 16-bit registers. `offset` counts words from the base in hal/f2808/registers.h.
/// The ADC's zero-wait result mirror (REG_MIRROR_ADCRESULT0) arrives as offset kAdcMirrorOffset + n.
class Peripheral {
 public:
  virtual ~Peripheral() = default;

  /// Power-on or chip reset (watchdog): all registers to their reset values, outputs low, no event pending.
  virtual void reset(Tick t) = 0;

  /// Register access that takes effect at t. Reads may have side effects (clear on read, latches).
  virtual std::uint16_t read(std::uint16_t offset, Tick t) = 0;
  virtual void write(std::uint16_t offset, std::uint16_t value, Tick t) = 0;

  /// Tick of the earliest event, kNever if none.
  virtual Tick next_event() const = 0;
  virtual void run_event(Tick t) = 0;

  /// SYSCLKOUT, HSPCLK, LSPCLK or a clock gate changed at t: settle counters with the old clock (remember it!), ask the
  /// services for the new one and go on from there.
  virtual void clocks_changed(Tick t) = 0;
};

inline constexpr std::uint16_t kAdcMirrorOffset = 0x100;

// Calls beyond this interface:
//
// class Adc final : public Peripheral
//    void start_of_conversion(bool soca, Tick t);      // the pulse that the ePWM bank sent through the services
//
// class Sci final : public Peripheral
//    void line_changed(Tick t);                        // serial_reaches may have a new answer
//
// class EPwmBank final                                  // all six modules: the sync chain ties them together
//    void reset(Tick t);
//    std::uint16_t read(int module, std::uint16_t offset, Tick t);              // module 0..5
//    void write(int module, std::uint16_t offset, std::uint16_t value, Tick t);
//    Tick next_event() const;  void run_event(Tick t);  void clocks_changed(Tick t);
//    void set_time_base_clock(bool running, Tick t);    // PCLKCR0.TBCLKSYNC: all time bases start in the same tick
//    void set_trip_pins(unsigned active_mask, Tick t);  // bit n-1: TZn is active (its pin is low and routed)

}  // namespace stillspin::chip

#endif
