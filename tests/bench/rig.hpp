// Chip, board and plant under a firmware that does as the test says: it holds constant pulses through the drivers of
// hal/ and keeps the gate enable alive, and nothing else. It protects nothing, so that what stops the current is the
// board.

#ifndef STILLSPIN_TESTS_BENCH_RIG_HPP
#define STILLSPIN_TESTS_BENCH_RIG_HPP

#include <array>
#include <vector>

#include "hal/hal_pwm.h"
#include "sim_host/bench/board.hpp"
#include "sim_host/chip/chip.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::bench {

/// Between the test and the firmware's control interrupt, which looks at it once a period.
struct RigFirmware {
  hal_pwm_frame_t frame{};
  bool gates_on = false;       // asks for them once; the firmware clears it
  bool gates_refused = false;  // hal_pwm_gates_on has returned false
  bool toggle = true;          // keep the gate enable alive
  bool tripped_by_pin = false;
  std::uint64_t periods = 0;  // control interrupts so far
};

extern RigFirmware rig_firmware;

/// Leg a switched high for `ticks` of every period, legs b and c for `base`: a constant voltage along phase a.
hal_pwm_frame_t pulses_along_a(std::uint16_t ticks, std::uint16_t base);

/// Motor A, ideal, with its rotor clamped: the current along phase a is that of a resistor and Ld.
plant::PlantConfig clamped_rotor();

/// What the pins of the legs carry, and what the firmware had counted at each period start.
class Rig final : public PeriodListener {
 public:
  explicit Rig(const plant::PlantConfig& config);

  void on_period(Tick t) override;

  /// On in steps of 10 us, noting the highest true phase current.
  void run_until(Tick t);
  void run_for(Tick ticks) { run_until(chip.now() + ticks); }

  double current_a();
  bool any_pin_high() const;

  struct PeriodStart {
    Tick tick;
    unsigned counter;       // of ePWM1
    std::uint64_t control;  // interrupts that have begun
  };
  std::vector<PeriodStart> starts;
  double peak = 0.0;  // A
  Tick last_edge = 0;
  std::array<bool, 6> pins{};

  class SpyBoard final : public Board {
   public:
    SpyBoard(const plant::PlantConfig& config, Rig& owner) : Board(config, owner), rig(owner) {}
    void on_pwm_pins(Tick t, int module, bool a, bool b) override;
    Rig& rig;
  };

  SpyBoard board;
  chip::Chip chip;
};

inline constexpr std::uint16_t kRigDeadBand = 20;  // ticks: small, so that small pulses still drive a current
inline constexpr std::uint16_t kRigBurst = 7000;   // tick of the window's last burst: after every pulse
inline constexpr Tick kRigReady = 3'000'000;       // 30 ms: clock, PWM and ADC are up, control interrupts come

}  // namespace stillspin::bench

#endif
