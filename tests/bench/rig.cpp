#include "tests/bench/rig.hpp"

#include <algorithm>
#include <cmath>

#include "hal/f2808/registers.h"
#include "hal/hal_adc.h"
#include "hal/hal_clock.h"
#include "hal/hal_irq.h"
#include "hal/hal_safety.h"
#include "hal/hal_time.h"

namespace stillspin::bench {

RigFirmware rig_firmware;

namespace {

constexpr Tick kStep = 1'000;
constexpr std::uint16_t kDeadBand = kRigDeadBand;

extern "C" void rig_control() {
  rig_firmware.periods++;
  hal_irq_control_begin();
  if (rig_firmware.toggle) hal_safety_toggle_enable();
  if (rig_firmware.gates_on) {
    rig_firmware.gates_on = false;
    rig_firmware.gates_refused = !hal_pwm_gates_on();
  }
  rig_firmware.tripped_by_pin = hal_pwm_was_tripped_by_pin();
  (void)hal_pwm_write(&rig_firmware.frame, HAL_PWM_LAST_TICK - HAL_PWM_WRITE_TICKS);
  hal_irq_control_end();
}

extern "C" void rig_window() {
  hal_adc_window_t window;
  hal_adc_read_window(&window);
}

void rig_main() {
  if (hal_clock_init()) {
    hal_time_init();
    hal_safety_init();
    (void)hal_pwm_init(kDeadBand);
    hal_adc_power_up();
    while (!hal_adc_is_up()) {
    }
    hal_adc_set_up();
    hal_irq_install(rig_control, rig_window);
    hal_irq_enable();
  }
  for (;;) hal_idle();
}

}  // namespace

hal_pwm_frame_t pulses_along_a(std::uint16_t ticks, std::uint16_t base) {
  hal_pwm_frame_t f{};
  const std::uint16_t on[3] = {ticks, base, base};
  for (int leg = 0; leg < 3; ++leg) {
    f.edge_tick[leg] = static_cast<std::uint16_t>(5000 - on[leg] / 2);
    f.edge_tick[HAL_PWM_LEGS + leg] = static_cast<std::uint16_t>(f.edge_tick[leg] + on[leg]);
    f.burst_start_tick[leg] = HAL_PWM_NONE;
    f.burst_end_tick[leg] = HAL_PWM_NONE;
  }
  f.burst_start_tick[0] = kRigBurst - 300;
  f.burst_end_tick[0] = kRigBurst;
  return f;
}

plant::PlantConfig clamped_rotor() {
  plant::PlantConfig config = plant::PlantConfig::ideal();
  config.mechanics.locked = true;
  config.initial.angle = 0.0;  // the d-axis on phase a: the current makes no torque and sees Ld
  return config;
}

void Rig::SpyBoard::on_pwm_pins(Tick t, int module, bool a, bool b) {
  Board::on_pwm_pins(t, module, a, b);
  if (module >= 3) return;
  rig.last_edge = t;
  rig.pins[2 * static_cast<std::size_t>(module)] = a;
  rig.pins[2 * static_cast<std::size_t>(module) + 1] = b;
}

Rig::Rig(const plant::PlantConfig& config) : board(config, *this), chip(board, rig_main) {
  rig_firmware = RigFirmware{};
  rig_firmware.frame = pulses_along_a(1000, 1000);
  board.attach(chip);
}

void Rig::on_period(Tick t) { starts.push_back({t, chip.inspect(EPWM_BASE(1) + EPWM_TBCTR), rig_firmware.periods}); }

void Rig::run_until(Tick t) {
  while (chip.now() < t) {
    chip.run_until(std::min(chip.now() + kStep, t));
    board.plant().advance(chip.now());
    for (const double i : board.plant().state().current) peak = std::max(peak, std::fabs(i));
  }
}

double Rig::current_a() { return board.plant().state().current[0]; }

bool Rig::any_pin_high() const {
  return std::any_of(pins.begin(), pins.end(), [](bool level) { return level; });
}

}  // namespace stillspin::bench
