#include "sim_host/chip/gpio.hpp"

#include "hal/f2808/registers.h"

namespace stillspin::chip {
namespace {

constexpr std::uint16_t offset_of(std::uint32_t address) { return static_cast<std::uint16_t>(address - kGpioFrame); }

constexpr std::uint16_t kData = offset_of(REG_GPADAT);
constexpr std::uint16_t kDataEnd = offset_of(REG_GPBTOGGLE) + 2;
constexpr std::uint16_t kSelect = offset_of(REG_GPIOXINT1SEL);
constexpr std::uint16_t kPortSpan = 8;  // words from GPADAT to GPBDAT

constexpr unsigned kFunctionGpio = 0;
constexpr unsigned kFunctionPwm = 1;

struct TripRoute {
  unsigned pin;
  unsigned function;
  unsigned trip;  // 1..6
};
constexpr TripRoute kTripRoutes[] = {{12, 1, 1}, {13, 1, 2}, {14, 1, 3}, {15, 1, 4},
                                     {16, 3, 5}, {28, 3, 5}, {17, 3, 6}, {29, 3, 6}};
unsigned trip_of(unsigned pin) {
  const TripRoute* route = kTripRoutes;
  while (route->pin != pin) ++route;
  return route->trip;
}
constexpr unsigned kEncoderPinA = 20;
constexpr unsigned kEncoderPinB = 21;
constexpr unsigned kFunctionEncoder = 1;
constexpr unsigned kSerialPinIn = 28;
constexpr unsigned kSerialPinOut = 29;
constexpr unsigned kFunctionSerial = 1;
constexpr unsigned kFunctionI2c = 1;
constexpr unsigned kCanReceivePin = 30;
constexpr unsigned kCanTransmitPin = 31;
constexpr unsigned kFunctionCan = 1;

// GPAMUX1 holds pins 0-15 in two words, GPAMUX2 16-31, GPBMUX1 32-34.
unsigned mux_word(unsigned pin) {
  constexpr std::uint16_t bases[] = {offset_of(REG_GPAMUX1), offset_of(REG_GPAMUX2), offset_of(REG_GPBMUX1)};
  return bases[pin / 16] + pin % 16 / 8;
}
unsigned direction_word(unsigned pin) {
  return pin < 32 ? offset_of(REG_GPADIR) + pin / 16 : offset_of(REG_GPBDIR) + (pin - 32) / 16;
}

}  // namespace

void Gpio::reset(Tick t) {
  control_.fill(0);
  select_.fill(0);
  latch_.fill(0);
  control_[offset_of(REG_GPAPUD)] = 0x0FFF;  // the ePWM pins come up without pull-up
  update_routes();
  drive_pwm_pins(t);  // all in one tick; a line that falls must not let through what goes with it
  drive(t);
}

bool Gpio::is_protected(std::uint16_t offset) { return offset < kData || offset >= kDataEnd; }

int Gpio::level_word(std::uint16_t offset) {
  if (offset < kData || offset >= kDataEnd) return -1;
  const int within = (offset - kData) % kPortSpan;
  const int word = (offset - kData) / kPortSpan * 2 + within;
  return within > 1 || 16 * word >= static_cast<int>(kPins) ? -1 : word;
}

unsigned Gpio::function(unsigned pin) const { return control_[mux_word(pin)] >> (pin % 8 * 2) & 3u; }

bool Gpio::is_output(unsigned pin) const { return (control_[direction_word(pin)] >> pin % 16 & 1u) != 0; }

bool Gpio::level(unsigned pin, Tick t) {
  if ((outputs_ >> pin & 1u) != 0) return (latch_[pin / 16] >> pin % 16 & 1u) != 0;
  if (pin < kPwmPins && (pwm_routed_ >> pin & 1u) != 0) return (pwm_pins_ >> pin & 1u) != 0;
  return world_.pin_level(t, static_cast<int>(pin));
}

std::uint16_t Gpio::read_levels(unsigned half, Tick t) {
  unsigned levels = 0;
  for (unsigned bit = 0; bit < 16 && 16 * half + bit < kPins; ++bit) {
    levels |= (level(16 * half + bit, t) ? 1u : 0u) << bit;
  }
  return static_cast<std::uint16_t>(levels);
}

std::uint16_t Gpio::read(std::uint16_t offset, Tick t) {
  if (offset < control_.size()) return control_[offset];
  if (offset >= kSelect) return offset - kSelect < static_cast<int>(select_.size()) ? select_[offset - kSelect] : 0;
  if (offset < kData || offset >= kDataEnd) return 0;
  const unsigned within = static_cast<unsigned>(offset - kData) % kPortSpan;
  if (within > 1) return 0;  // set, clear and toggle read as 0
  return read_levels(static_cast<unsigned>(offset - kData) / kPortSpan * 2 + within, t);
}

void Gpio::write(std::uint16_t offset, std::uint16_t value, Tick t) {
  if (offset < control_.size()) {
    control_[offset] = value;
    update_routes();
    drive(t);
    drive_pwm_pins(t);
  } else if (offset >= kData && offset < kDataEnd) {
    write_latch(offset, value);
    drive(t);
  } else if (offset >= kSelect && offset - kSelect < static_cast<int>(select_.size())) {
    select_[offset - kSelect] = value;
  }
}

void Gpio::write_latch(std::uint16_t offset, std::uint16_t value) {
  const unsigned position = static_cast<unsigned>(offset - kData);
  std::uint16_t& latch = latch_[position / kPortSpan * 2 + position % 2];
  switch (position % kPortSpan / 2) {
    case 0:
      latch = value;
      break;
    case 1:
      latch = static_cast<std::uint16_t>(latch | value);
      break;
    case 2:
      latch = static_cast<std::uint16_t>(latch & ~value);
      break;
    default:
      latch = static_cast<std::uint16_t>(latch ^ value);
      break;
  }
}

void Gpio::update_routes() {
  outputs_ = 0;
  pwm_routed_ = 0;
  for (unsigned pin = 0; pin < kPins; ++pin) {
    if (function(pin) == kFunctionGpio && is_output(pin)) outputs_ |= std::uint64_t{1} << pin;
    if (pin < kPwmPins && function(pin) == kFunctionPwm) pwm_routed_ |= 1u << pin;
  }
  trip_pins_ = 0;
  for (const TripRoute& route : kTripRoutes) {
    if (function(route.pin) == route.function) trip_pins_ |= std::uint64_t{1} << route.pin;
  }
  encoder_routed_ = function(kEncoderPinA) == kFunctionEncoder && function(kEncoderPinB) == kFunctionEncoder;
  serial_in_routed_ = function(kSerialPinIn) == kFunctionSerial;
  serial_out_routed_ = function(kSerialPinOut) == kFunctionSerial;
  can_routed_ = function(kCanReceivePin) == kFunctionCan && function(kCanTransmitPin) == kFunctionCan;
}

void Gpio::drive(Tick t) {
  const std::uint64_t latched =
      latch_[0] | std::uint64_t{latch_[1]} << 16 | std::uint64_t{latch_[2]} << 32 | std::uint64_t{latch_[3]} << 48;
  const std::uint64_t levels = latched & outputs_;
  for (std::uint64_t changed = levels ^ driven_; changed != 0; changed &= changed - 1) {
    const auto pin = static_cast<unsigned>(__builtin_ctzll(changed));
    driven_ ^= std::uint64_t{1} << pin;
    world_.on_output_pin(t, static_cast<int>(pin), (levels >> pin & 1u) != 0);
  }
  drive_i2c(t);
}

void Gpio::i2c_outputs(bool sda, bool scl, Tick t) {
  i2c_sda_ = sda;
  i2c_scl_ = scl;
  drive_i2c(t);
}

bool Gpio::line_level(unsigned pin, Tick t) {
  return function(pin) != kFunctionI2c || world_.pin_level(t, static_cast<int>(pin));
}

// As a general purpose output that is low the pin pulls its line, too.
bool Gpio::lets_go(unsigned pin, bool module) const {
  if (function(pin) == kFunctionI2c) return module;
  return (outputs_ >> pin & 1u) == 0 || (latch_[pin / 16] >> pin % 16 & 1u) != 0;
}

void Gpio::drive_i2c(Tick t) {
  const bool sda = lets_go(kPinSda, i2c_sda_);
  const bool scl = lets_go(kPinScl, i2c_scl_);
  if (sda == line_sda_ && scl == line_scl_) return;
  line_sda_ = sda;
  line_scl_ = scl;
  world_.on_i2c_pins(t, sda, scl);
}

void Gpio::drive_pwm_pins(Tick t) {
  for (int module = 0; module < static_cast<int>(kPwmPins) / 2; ++module) drive_pwm(module, t);
}

void Gpio::pwm_outputs(int module, bool a, bool b, Tick t) {
  const unsigned shift = 2 * static_cast<unsigned>(module);
  pwm_levels_ = (pwm_levels_ & ~(3u << shift)) | ((a ? 1u : 0u) | (b ? 2u : 0u)) << shift;
  drive_pwm(module, t);
}

void Gpio::drive_pwm(int module, Tick t) {
  const unsigned shift = 2 * static_cast<unsigned>(module);
  const unsigned pair = 3u << shift;
  const unsigned levels = ((pwm_levels_ & pwm_routed_) | (pulled_up_ & ~pwm_routed_)) & pair;
  if (levels == (pwm_pins_ & pair)) return;
  pwm_pins_ = (pwm_pins_ & ~pair) | levels;
  world_.on_pwm_pins(t, module, (levels >> shift & 1u) != 0, (levels >> shift & 2u) != 0);
}

unsigned Gpio::active_trips(Tick t) {
  unsigned active = 0;
  for (std::uint64_t left = trip_pins_; left != 0; left &= left - 1) {
    const int pin = __builtin_ctzll(left);
    if (!world_.pin_level(t, pin)) active |= 1u << (trip_of(static_cast<unsigned>(pin)) - 1);
  }
  return active;
}

}  // namespace stillspin::chip
