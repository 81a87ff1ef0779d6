// Stand-ins for the core of the virtual chip, for tests of one peripheral: records what the peripheral says, and runs
// its events in order of time as the core would.

#ifndef STILLSPIN_TESTS_CHIP_PERIPHERAL_HPP
#define STILLSPIN_TESTS_CHIP_PERIPHERAL_HPP

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim_host/chip/peripheral.hpp"

namespace stillspin::chip::testing {

struct PinEdge {
  Tick t;
  int module;
  bool a;
  bool b;
  bool operator==(const PinEdge& o) const { return t == o.t && module == o.module && a == o.a && b == o.b; }
};
inline std::ostream& operator<<(std::ostream& out, const PinEdge& e) {
  return out << "{t " << e.t << ", module " << e.module << ", A " << e.a << ", B " << e.b << "}";
}

template <typename What>
struct Stamped {
  What what;
  Tick t;
  bool operator==(const Stamped& o) const { return what == o.what && t == o.t; }
};
template <typename What>
std::ostream& operator<<(std::ostream& out, const Stamped<What>& s) {
  return out << "{" << s.what << " at " << s.t << "}";
}

class RecordingServices final : public ChipServices {
 public:
  std::vector<Stamped<unsigned>> interrupts;
  std::vector<Stamped<bool>> starts;  // true SOCA
  std::vector<Stamped<int>> samples;
  std::vector<PinEdge> edges;
  std::vector<std::string> errors;
  std::function<std::uint16_t(int, Tick)> code = [](int channel, Tick) {
    return static_cast<std::uint16_t>(100 + channel);
  };
  std::vector<Stamped<SerialFrame>> frames;
  std::function<Tick(Tick, bool)> line = [](Tick t, bool level) { return level ? t : kNever; };
  std::function<void(Tick, bool, bool)> on_i2c;  // SDA, SCL let go
  std::function<bool(Tick)> sda_line, scl_line;  // levels; high when not given
  std::int64_t encoder = 0;
  Tick sysclk = 1;
  unsigned hspclk = 1;
  unsigned lspclk = 1;
  bool clocked = true;

  /// Interrupts with this vector, as times.
  std::vector<Tick> times_of(unsigned vector) const {
    std::vector<Tick> out;
    for (const auto& i : interrupts) {
      if (i.what == vector) out.push_back(i.t);
    }
    return out;
  }

  void raise_interrupt(unsigned vector, Tick t) override { interrupts.push_back({vector, t}); }
  void start_of_conversion(bool soca, Tick t) override { starts.push_back({soca, t}); }
  void pwm_outputs(int module, bool a, bool b, Tick t) override { edges.push_back({t, module, a, b}); }
  std::uint16_t sample(int channel, Tick t) override {
    samples.push_back({channel, t});
    return code(channel, t);
  }
  std::int64_t encoder_edges(Tick) override { return encoder; }
  Tick serial_reaches(Tick t, bool level) override { return line(t, level); }
  void serial_frame(const SerialFrame& frame, Tick t) override { frames.push_back({frame, t}); }
  void i2c_pins(bool sda, bool scl, Tick t) override {
    if (on_i2c) on_i2c(t, sda, scl);
  }
  bool sda_level(Tick t) override { return sda_line ? sda_line(t) : true; }
  bool scl_level(Tick t) override { return scl_line ? scl_line(t) : true; }
  Tick sysclk_period() const override { return sysclk; }
  unsigned hspclk_divider() const override { return hspclk; }
  unsigned lspclk_divider() const override { return lspclk; }
  bool epwm_clock(int) const override { return clocked; }
  bool adc_clock() const override { return clocked; }
  bool eqep_clock(int) const override { return clocked; }
  bool sci_clock() const override { return clocked; }
  bool i2c_clock() const override { return clocked; }
  void model_error(const char* text, std::int64_t) override { errors.emplace_back(text); }

  void forget() {
    interrupts.clear();
    starts.clear();
    samples.clear();
    edges.clear();
  }
};

/// Run everything that is due up to and including `until`.
template <typename Peripheral>
void run_until(Peripheral& peripheral, Tick until) {
  while (peripheral.next_event() <= until) {
    peripheral.run_event(peripheral.next_event());
  }
}

}  // namespace stillspin::chip::testing

#endif
