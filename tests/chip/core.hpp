// A bench for the chip's core: a world that records what reaches it, and the pieces of firmware that most tests need.

#ifndef STILLSPIN_TESTS_CHIP_CORE_HPP
#define STILLSPIN_TESTS_CHIP_CORE_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "hal/f2808/registers.h"
#include "hal/f2808/target.h"
#include "sim_host/chip/chip.hpp"

namespace core_bench {

using stillspin::chip::Chip;
using stillspin::chip::kNever;
using stillspin::chip::Tick;

struct PinChange {
  Tick t;
  int pin;
  bool level;
  bool operator==(const PinChange& o) const { return t == o.t && pin == o.pin && level == o.level; }
};

struct PwmChange {
  Tick t;
  int module;
  bool a, b;
  bool operator==(const PwmChange& o) const { return t == o.t && module == o.module && a == o.a && b == o.b; }
};

class RecordingWorld final : public stillspin::chip::World {
 public:
  void on_pwm_pins(Tick t, int module, bool a, bool b) override { pwm.push_back({t, module, a, b}); }
  std::uint16_t adc_sample(Tick t, int channel) override {
    samples.emplace_back(t, channel);
    return static_cast<std::uint16_t>(channel * 100);
  }
  bool pin_level(Tick, int pin) override { return levels[static_cast<std::size_t>(pin)]; }
  void on_output_pin(Tick t, int pin, bool level) override { pins.push_back({t, pin, level}); }
  std::int64_t encoder_edges(Tick) override { return edges; }
  Tick next_call() const override { return calls.empty() ? kNever : calls.front(); }
  void call(Tick t) override {
    called.push_back(t);
    calls.erase(calls.begin());
    if (on_call) on_call(t);
  }

  std::array<bool, 35> levels{};
  std::int64_t edges = 0;
  std::vector<Tick> calls;  // ascending
  std::function<void(Tick)> on_call;

  std::vector<PwmChange> pwm;
  std::vector<PinChange> pins;
  std::vector<std::pair<Tick, int>> samples;  // tick, channel
  std::vector<Tick> called;
};

// ---- firmware pieces: to be called from firmware functions only ----------------------------------------

inline void write_protected(std::uint32_t address, std::uint16_t value) {
  target_eallow();
  target_write16(address, value);
  target_edis();
}

inline void disable_watchdog() { write_protected(REG_WDCR, 0x0068); }

/// SYSCLKOUT 100 MHz, watchdog off.
inline void start_clock() {
  disable_watchdog();
  write_protected(REG_PLLCR, 10);
  while ((target_read16(REG_PLLSTS) & PLLSTS_PLLLOCKS_MASK) == 0) {
  }
}

inline void install(unsigned vector, target_isr_t isr) {
  target_eallow();
  target_set_vector(static_cast<std::uint16_t>(vector), isr);
  target_edis();
  if (vector < VECTOR_PIE_FIRST) return;
  const unsigned group = (vector - VECTOR_PIE_FIRST) / 8 + 1;
  const auto enabled = target_read16(REG_PIEIER(group));
  target_write16(REG_PIEIER(group), static_cast<std::uint16_t>(enabled | 1u << (vector - VECTOR_PIE_FIRST) % 8));
}

inline void enable_pie() { target_write16(REG_PIECTRL, PIECTRL_ENPIE_MASK); }

inline std::uint16_t group_bit(unsigned group) { return static_cast<std::uint16_t>(1u << (group - 1)); }

/// Sets a PIE flag by hand, as a peripheral would.
inline void raise_by_hand(unsigned vector) {
  target_write16(REG_PIEIFR((vector - VECTOR_PIE_FIRST) / 8 + 1),
                 static_cast<std::uint16_t>(1u << (vector - VECTOR_PIE_FIRST) % 8));
}

[[noreturn]] inline void sleep_for_ever() {
  for (;;) target_elapse(1000);
}

}  // namespace core_bench

#endif
