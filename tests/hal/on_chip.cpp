#include "tests/hal/on_chip.hpp"

#include "hal/hal_clock.h"
#include "hal/hal_encoder.h"
#include "hal/hal_profile.h"
#include "hal/hal_safety.h"
#include "hal/hal_time.h"

namespace stillspin::test {

Firmware fw;

namespace {

// A level pattern that goes round: one leg after the other.
void slice_function() {
  hal_timed_samples_t slice;
  hal_sampling_timer_read(&slice);
  hal_sampling_timer_set_legs(static_cast<std::uint16_t>(1u << (fw.slices.size() % 3)));
  fw.slices.push_back(slice);
  hal_profile_step(fw.window_cycles);
  fw.slice_ends.push_back(hal_pwm_period_tick());
}

void choose_slices() {
  if (fw.slice_ticks != 0 && !fw.sliced) fw.sliced = hal_sampling_timer_begin(fw.slice_ticks);
  if (fw.slice_ticks == 0 && fw.sliced) {
    hal_sampling_timer_end();
    fw.sliced = false;
  }
}

void window_function() {
  if (fw.sliced) {
    slice_function();
    return;
  }
  hal_adc_window_t window;
  hal_adc_read_window(&window);
  fw.windows.push_back(window);
  hal_profile_step(fw.window_cycles);
  fw.preemptions += fw.control_running ? 1 : 0;
  fw.window_ticks.push_back(hal_pwm_period_tick());
}

void control_function() {
  fw.control_ticks.push_back(hal_pwm_period_tick());
  hal_irq_control_begin();
  fw.control_running = true;
  hal_profile_step(fw.control_cycles);
  while (hal_pwm_period_tick() < fw.write_at_tick) {
  }
  choose_slices();
  const std::uint32_t before = hal_time_cycles();
  if (!fw.sliced) fw.in_time.push_back(hal_pwm_write(&fw.frame, fw.deadline));
  fw.write_ticks.push_back(static_cast<std::uint16_t>(hal_time_cycles() - before));
  fw.encoder_count = hal_encoder_count();
  hal_safety_toggle_enable();
  fw.control_running = false;
  hal_irq_control_end();
}

}  // namespace

void image() {
  fw.init_ok = hal_clock_init();
  hal_time_init();
  hal_safety_init();
  fw.init_ok = hal_pwm_init(kDeadBand) && fw.init_ok;
  hal_adc_power_up();
  while (!hal_adc_is_up()) {
  }
  hal_adc_set_up();
  hal_encoder_init(4096);
  hal_irq_install(control_function, window_function);
  if (fw.watchdog) {
    hal_watchdog_start();
  }
  hal_irq_enable();
  if (fw.gates_on) {
    hal_idle();  // the first frame is on its way before the gates follow
    hal_idle();
    fw.gates_ok = hal_pwm_gates_on();
  }
  for (;;) {
    hal_idle();
    if (fw.retry_gates && hal_pwm_is_tripped()) {
      fw.gates_ok = hal_pwm_gates_on();
    }
    if (fw.service_watchdog) {
      hal_watchdog_service();
    }
  }
}

}  // namespace stillspin::test
