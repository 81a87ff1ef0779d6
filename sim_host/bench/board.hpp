// The inverter board: what lies between the chip's pins and the plant.
//
// What is soldered where, and which level means what, is that of hal/hal_board.h, the file from which the firmware has
// it, too. The gates pass only while the enable line has been toggled within the last milliseconds, so that a chip that
// hangs loses the power stage. A comparator pulls the over-current input low when a true phase current has exceeded its
// share of the sensors' range, and holds it for 10 us.
// The serial port has a line with a far end; a CAN bus may hang on its two pins. An EEPROM may be fitted on the I2C
// lines, which are pulled up.

#ifndef STILLSPIN_SIM_HOST_BENCH_BOARD_HPP
#define STILLSPIN_SIM_HOST_BENCH_BOARD_HPP

#include <algorithm>
#include <array>

#include "sim_host/bench/board_options.hpp"
#include "sim_host/bench/waveform.hpp"
#include "sim_host/chip/chip.hpp"
#include "sim_host/devices/bootstrap.hpp"
#include "sim_host/devices/can_bus.hpp"
#include "sim_host/devices/eeprom.hpp"
#include "sim_host/devices/serial_line.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::bench {

using chip::Tick;

inline constexpr Tick kComparatorHold = 1'000;
inline constexpr Tick kPeriod = 10'000;
inline constexpr Tick kWatch = 2'500;
extern const Tick kEnableTimeout;  // of the board's file
extern const int kPinEnable;

/// Told at the start of every PWM period, before the control interrupt runs.
class PeriodListener {
 public:
  virtual ~PeriodListener() = default;
  virtual void on_period(Tick t) = 0;
};

class Board : public chip::World {
 public:
  /// `can` may be nullptr: no transceiver is fitted. It must outlive the chip.
  Board(const plant::PlantConfig& config, PeriodListener& listener, devices::CanBus* can = nullptr);

  /// The chip that sits on the board; needed before it runs.
  void attach(chip::Chip& chip);

  /// Before the chip runs; the board does not own it.
  void fit(devices::Eeprom& eeprom) { eeprom_ = &eeprom; }

  /// What hangs on it, before any time has passed.
  void equip(const BoardOptions& options);

  /// From now on.
  void set_inputs(const BoardInputs& inputs);
  const BoardInputs& inputs() const { return inputs_; }
  bool relay_closed() const { return relay_; }
  bool brake_on() const { return brake_; }
  std::uint64_t lockouts() const;

  plant::Plant& plant() { return plant_; }
  WaveformProbe& probe() { return probe_; }
  devices::SerialLine& serial() { return serial_; }
  const devices::SerialLine& serial() const { return serial_; }
  /// Faults of the chip's surroundings: conversions that are not triggered, interrupts taken late in every period
  /// (ticks below a period; 0 is in time, a period is never).
  void lose_triggers(bool on) { chip_->block_adc_triggers(on); }
  void delay_interrupts(Tick ticks) { interrupt_delay_ = ticks; }

  bool gates_enabled() const { return enabled_; }
  /// Whether a device is told to be on, by its pin and the gate enable; since when none has been; when the chip has
  /// last toggled the enable line.
  bool any_device_on() const { return device_on_; }
  Tick devices_off_since() const { return devices_off_since_; }
  Tick enable_toggled() const { return last_toggle_; }
  std::uint64_t trips() const { return trips_; }

  /// What an oscilloscope would see since power-on: a hash over time and levels of every edge of a gate (FNV-1a), and
  /// the earliest and latest tick of a period at which the control interrupt has toggled the enable line.
  std::uint64_t gate_edges() const { return gate_edges_; }
  Tick enable_earliest() const { return enable_earliest_; }
  Tick enable_latest() const { return enable_latest_; }

  /// Share of the computing time that went into the plant, from every 64th period; 0 before the first.
  double plant_share() const { return period_ns_ > 0 ? double(plant_ns_) / double(period_ns_) : 0.0; }

  void on_pwm_pins(Tick t, int module, bool a, bool b) override;
  bool pwm_pins_pulled_up() const override;
  std::uint16_t adc_sample(Tick t, int channel) override;
  bool pin_level(Tick t, int pin) override;
  void on_output_pin(Tick t, int pin, bool level) override;
  void on_i2c_pins(Tick t, bool sda, bool scl) override;
  std::int64_t encoder_edges(Tick t) override;
  Tick serial_reaches(Tick t, bool level) override { return serial_.reaches(t, level); }
  void on_serial_frame(Tick, const chip::SerialFrame& frame) override { serial_.receive(frame); }
  chip::CanLine* can_line() override { return can_; }
  Tick next_call() const override {
    const Tick own = std::min(next_call_, probe_.next());
    return can_ == nullptr ? own : std::min(own, can_->next_event());
  }
  void call(Tick t) override;

 private:
  class PlantTimer;
  void time_periods();
  void align(Tick t);
  void watch_enable(Tick t);
  void look(Tick t);
  void begin_period(Tick t);
  void call_between(Tick t);
  void compare(Tick t, double amps) {
    if (!(amps <= comparator_amps_)) trip(t);
  }
  void trip(Tick t);
  void drive_leg(Tick t, int leg);
  void watch_devices(Tick t);

  std::uint16_t auxiliary_code(Tick t);
  std::uint16_t current_code(Tick t, std::size_t input);
  int wire_of(int leg) const;

  BoardOptions options_;
  BoardInputs inputs_;
  std::array<devices::Bootstrap, 3> bootstrap_;
  bool relay_ = false, brake_ = false;
  double comparator_amps_;
  std::uint16_t revision_;  // of the chip's silicon
  plant::Plant plant_;
  PeriodListener& listener_;
  WaveformProbe probe_;
  devices::SerialLine serial_;
  devices::CanBus* can_;
  chip::Chip* chip_ = nullptr;
  devices::Eeprom* eeprom_ = nullptr;
  bool sda_ = true, scl_ = true;  // the chip lets go of the I2C lines
  std::array<bool, 3> upper_{};
  std::array<bool, 3> lower_{};
  Tick next_call_ = 0;
  Tick next_period_ = 0;
  Tick interrupt_delay_ = 0;
  Tick release_ = 0;
  Tick last_toggle_;
  Tick tripped_until_ = -1;
  std::uint64_t trips_ = 0;
  std::uint64_t gate_edges_ = 0xCBF29CE484222325u;
  Tick enable_earliest_ = kPeriod;
  Tick enable_latest_ = 0;
  std::uint64_t periods_ = 0;
  std::int64_t period_begin_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t plant_ns_ = 0;
  bool timing_ = false;
  bool enabled_ = false;
  bool device_on_ = false;
  Tick devices_off_since_ = 0;
  bool aligned_ = false;
};

}  // namespace stillspin::bench

#endif
