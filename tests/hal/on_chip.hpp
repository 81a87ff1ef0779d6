// A small firmware on the virtual chip that uses every driver, and the board around it.

#ifndef STILLSPIN_TESTS_HAL_ON_CHIP_HPP
#define STILLSPIN_TESTS_HAL_ON_CHIP_HPP

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "hal/f2808/registers.h"
#include "hal/hal_adc.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sampling_timer.h"
#include "sim_host/chip/chip.hpp"
#include "tests/hal/bench_world.hpp"

namespace stillspin::test {

using chip::Tick;

inline constexpr Tick kPeriod = HAL_PWM_PERIOD_TICKS;
inline constexpr Tick kMillisecond = 100'000;
inline constexpr Tick kStarted = 15 * kMillisecond;  // 6.6 ms PLL, 5 ms ADC, some set-up
inline constexpr std::uint16_t kDeadBand = 200;

// The firmware under the drivers: C functions, so its state is global; every test starts with a fresh one.
struct Firmware {
  hal_pwm_frame_t frame;
  std::uint16_t deadline;
  std::uint16_t window_cycles;   // arithmetic in the window interrupt
  std::uint16_t control_cycles;  // arithmetic in the control interrupt
  std::uint16_t write_at_tick;   // the control interrupt waits for this tick before it writes; 0: at once
  bool gates_on;
  bool retry_gates;
  bool watchdog;
  bool service_watchdog;
  std::uint16_t slice_ticks;  // slices in place of windows; 0: none

  bool init_ok;
  bool gates_ok;
  std::vector<hal_adc_window_t> windows;
  std::vector<std::uint16_t> window_ticks;   // TBCTR at the end of the window interrupt
  std::vector<std::uint16_t> control_ticks;  // at its entry
  std::vector<std::uint16_t> write_ticks;    // time that hal_pwm_write took
  std::vector<bool> in_time;
  bool control_running;
  int preemptions;
  std::uint32_t encoder_count;
  bool sliced;
  std::vector<hal_timed_samples_t> slices;
  std::vector<std::uint16_t> slice_ends;  // TBCTR at the end of the slice interrupt
};
extern Firmware fw;

/// The image's entry.
void image();

class OnChip : public ::testing::Test {
 protected:
  void SetUp() override {
    fw = Firmware{};
    fw.frame = hal_pwm_frame_t{{1000, 2000, 3000, 7000, 6000, 5000}, {300, 3300, 7200}, {700, 4300, 8000}};
    fw.deadline = 9800;
    fw.gates_on = true;
  }

  /// A run that broke no rule of the chip.
  void expect_clean() {
    EXPECT_TRUE(fw.init_ok);
    const chip::Statistics& s = board.statistics();
    EXPECT_EQ(s.protected_writes_lost, 0u) << std::hex << s.last_protected_address;
    EXPECT_EQ(s.gated_accesses, 0u) << std::hex << s.last_gated_address;
    EXPECT_EQ(s.unmodelled_accesses, 0u) << std::hex << s.last_unmodelled_address;
    EXPECT_EQ(s.spurious_interrupts, 0u);
    EXPECT_EQ(hal_irq_unexpected_count(), 0u);
  }

  /// Tick of the start of the period that is running now.
  Tick period_start() { return board.now() - board.inspect(EPWM_BASE(1) + EPWM_TBCTR); }

  /// Ticks from `from` on at which a pin rose (or fell).
  std::vector<Tick> edges(int module, bool upper, bool rising, Tick from) {
    std::vector<Tick> out;
    bool level = false;
    for (const BenchWorld::Pins& p : world.pins) {
      if (p.module != module) {
        continue;
      }
      const bool now = upper ? p.a : p.b;
      if (now != level && now == rising && p.t >= from) {
        out.push_back(p.t - from);
      }
      level = now;
    }
    return out;
  }

  BenchWorld world;
  chip::Chip board{world, image};
};

}  // namespace stillspin::test

#endif
