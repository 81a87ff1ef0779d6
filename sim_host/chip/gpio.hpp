// General purpose pins: function select, direction, output latches, and the routing between pins and peripherals.
//
// A pin belongs to the function that its two mux bits name. As GPIO it is an input (the world's level) or an output
// (the latch's). ePWM outputs reach the world only when routed to their pins; trip inputs and the encoder only count
// when routed. An ePWM pin that nobody drives has the level to which the board pulls it; the two I2C lines,
// which are pulled up and only pulled low by the chip, go to the world by a call of their own. Not modelled: input
// qualification (a level is seen at once), pull-ups, XINT selection, wake-up selection (stored). Source: SPRU712
// (GPIO); gpio mux table of the data manual SPRS230.

#ifndef STILLSPIN_SIM_HOST_CHIP_GPIO_HPP
#define STILLSPIN_SIM_HOST_CHIP_GPIO_HPP

#include <array>
#include <cstdint>

#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

class Gpio {
 public:
  explicit Gpio(World& world)
      : world_(world), pulled_up_(world.pwm_pins_pulled_up() ? (1u << kPwmPins) - 1u : 0u), pwm_pins_(pulled_up_) {}

  void reset(Tick t);
  std::uint16_t read(std::uint16_t offset, Tick t);  // offset from kGpioFrame
  void write(std::uint16_t offset, std::uint16_t value, Tick t);

  /// Whether a register needs EALLOW: all but the data registers do.
  static bool is_protected(std::uint16_t offset);

  /// Which of the words of levels is read there, from that of pins 0 to 15; -1 for another register.
  static int level_word(std::uint16_t offset);
  /// Its pins that the chip drives, as general purpose outputs or from the ePWM.
  std::uint16_t driven_here(int word) const {
    return static_cast<std::uint16_t>((outputs_ | pwm_routed_) >> 16 * word & 0xFFFFu);
  }

  /// Output of an ePWM module (0..5), on its way to the pins GPIO2m and GPIO2m+1.
  void pwm_outputs(int module, bool a, bool b, Tick t);

  /// What the I2C module does with its lines: true lets go.
  void i2c_outputs(bool sda, bool scl, Tick t);
  bool sda_level(Tick t) { return line_level(kPinSda, t); }
  bool scl_level(Tick t) { return line_level(kPinScl, t); }

  /// TZ1..TZ6 that are routed to a pin which is low now: bit n-1 for TZn.
  unsigned active_trips(Tick t);
  bool trips_routed() const { return trip_pins_ != 0; }
  bool encoder_routed() const { return encoder_routed_; }
  bool serial_in_routed() const { return serial_in_routed_; }
  bool serial_out_routed() const { return serial_out_routed_; }
  /// Both pins of eCAN-A.
  bool can_routed() const { return can_routed_; }

 private:
  static constexpr unsigned kPins = 35;
  static constexpr unsigned kPwmPins = 12;
  static constexpr unsigned kPinSda = 32;
  static constexpr unsigned kPinScl = 33;

  unsigned function(unsigned pin) const;
  bool is_output(unsigned pin) const;
  bool level(unsigned pin, Tick t);
  std::uint16_t read_levels(unsigned half, Tick t);
  void write_latch(std::uint16_t offset, std::uint16_t value);
  void update_routes();
  void drive(Tick t);
  bool line_level(unsigned pin, Tick t);
  bool lets_go(unsigned pin, bool module) const;
  void drive_i2c(Tick t);
  void drive_pwm_pins(Tick t);
  void drive_pwm(int module, Tick t);

  World& world_;
  const unsigned pulled_up_;                   // ePWM pins that the board pulls up while nobody drives them
  std::array<std::uint16_t, 0x20> control_{};  // GPACTRL .. GPBPUD
  std::array<std::uint16_t, 0x20> select_{};   // GPIOXINT1SEL .. GPIOLPMSEL
  std::array<std::uint16_t, 4> latch_{};       // pins 0-15, 16-31, 32-47, 48-63
  std::uint64_t outputs_ = 0;                  // pins that are general purpose outputs
  std::uint64_t driven_ = 0;                   // levels of those, as the world knows them
  unsigned pwm_levels_ = 0;                    // ePWM outputs, bit 2m for A of module m, 2m+1 for B
  unsigned pwm_routed_ = 0;
  unsigned pwm_pins_;                       // what the world knows
  std::uint64_t trip_pins_ = 0;             // pins that are routed to a trip zone
  bool i2c_sda_ = true, i2c_scl_ = true;    // what the module does
  bool line_sda_ = true, line_scl_ = true;  // and the pins, as the world knows it
  bool encoder_routed_ = false;
  bool serial_in_routed_ = false;
  bool serial_out_routed_ = false;
  bool can_routed_ = false;
};

inline constexpr std::uint32_t kGpioFrame = 0x6F80;

}  // namespace stillspin::chip

#endif
