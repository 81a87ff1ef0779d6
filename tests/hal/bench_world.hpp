// The least board around the virtual chip that the drivers can be watched on: records edges and samples, drives pins.

#ifndef STILLSPIN_TESTS_HAL_BENCH_WORLD_HPP
#define STILLSPIN_TESTS_HAL_BENCH_WORLD_HPP

#include <cstdint>
#include <vector>

#include "sim_host/chip/world.hpp"
#include "sim_host/devices/serial_line.hpp"

namespace stillspin::test {

class BenchWorld final : public chip::World {
 public:
  struct Pins {
    chip::Tick t;
    int module;
    bool a, b;
  };
  struct Sample {
    chip::Tick t;
    int channel;
  };
  struct Output {
    chip::Tick t;
    int pin;
    bool level;
  };

  std::vector<Pins> pins;
  std::vector<Sample> samples;
  std::vector<Output> outputs;
  chip::Tick over_current_from = chip::kNever;  // the comparator pulls GPIO12 low in this span
  chip::Tick over_current_to = chip::kNever;
  std::int64_t edges_per_100_us = 0;
  devices::SerialLine serial;

  void on_pwm_pins(chip::Tick t, int module, bool a, bool b) override { pins.push_back(Pins{t, module, a, b}); }

  /// The code tells channel and instant: where in the period, in pairs of ticks, is enough to recognise the sample.
  std::uint16_t adc_sample(chip::Tick t, int channel) override {
    samples.push_back(Sample{t, channel});
    return code_at(t, channel);
  }
  static std::uint16_t code_at(chip::Tick t, int channel) {
    return static_cast<std::uint16_t>((t / 4 + 37 * channel) & 0xFFF);
  }

  bool pin_level(chip::Tick t, int pin) override {
    if (pin == 28) return serial.level(t);
    return !(pin == 12 && t >= over_current_from && t < over_current_to);
  }
  void on_output_pin(chip::Tick t, int pin, bool level) override { outputs.push_back(Output{t, pin, level}); }
  std::int64_t encoder_edges(chip::Tick t) override { return edges_per_100_us * (t / 10000); }

  chip::Tick serial_reaches(chip::Tick t, bool level) override { return serial.reaches(t, level); }
  void on_serial_frame(chip::Tick, const chip::SerialFrame& frame) override { serial.receive(frame); }

  chip::Tick next_call() const override {
    return over_current_from > called_ ? over_current_from : over_current_to > called_ ? over_current_to : chip::kNever;
  }
  void call(chip::Tick t) override { called_ = t; }

 private:
  chip::Tick called_ = -1;
};

}  // namespace stillspin::test

#endif
