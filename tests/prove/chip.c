// The chip's drivers that the interrupts and the set-up call, with any contents of every register at every access and
// any octets, rates, frames and ticks from above, in any order.

#include "hal/hal_adc.h"
#include "hal/hal_clock.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_encoder.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_replay.h"
#include "hal/hal_safety.h"
#include "hal/hal_sampling_timer.h"
#include "hal/hal_sci.h"
#include "hal/hal_time.h"
#include "tests/prove/any.h"

// The recording in any state.
hal_replay_t hal_replay;
void replay_pass_call(void) {}
uint16_t replay_take(void) { return any_u16; }
uint16_t replay_note(uint16_t value) { return value; }
void replay_output(replay_output_t what, const uint16_t* words, uint16_t count) {
  (void)what;
  for (uint16_t k = 0; k < count; k++) any_u16 = words[k];
}
void replay_take_results(uint16_t* results, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) results[k] = any_u16;
}
void replay_note_results(const uint16_t* results, uint16_t count) {
  for (uint16_t k = 0; k < count; k++) any_u16 = results[k];
}

static void nothing(void) {}

static void set_up(void) {
  (void)hal_clock_init();
  hal_time_init();
  hal_safety_init();
  hal_digital_io_init();
  (void)hal_pwm_init(any_u16);
  (void)hal_sci_init(any_u32);
  hal_adc_power_up();
  hal_adc_set_up();
  hal_encoder_init(any_u32);
  hal_irq_install(nothing, nothing);
  hal_irq_enable();
}

static void convert(void) {
  hal_adc_window_t window;
  hal_timed_samples_t slice;
  uint16_t ground, reference;
  (void)hal_adc_is_up();
  hal_adc_read_window(&window);
  hal_adc_choose_slow(any_bool());
  hal_adc_measure_reference(&ground, &reference);
  (void)hal_sampling_timer_begin(any_u16);
  hal_sampling_timer_read(&slice);
  hal_sampling_timer_set_legs(any_u16);
  hal_sampling_timer_end();
}

static void switch_gates(void) {
  hal_pwm_frame_t frame;
  for (uint16_t k = 0; k < HAL_PWM_LEGS; k++) frame.edge_tick[k] = frame.edge_tick[HAL_PWM_LEGS + k] = any_u16;
  for (uint16_t k = 0; k < HAL_PWM_WINDOWS; k++) frame.burst_start_tick[k] = frame.burst_end_tick[k] = any_u16;
  (void)hal_pwm_write(&frame, any_u16);
  (void)hal_pwm_set_dead_band(any_u16);
  (void)hal_pwm_period_tick();
  (void)hal_pwm_gates_on();
  hal_pwm_gates_off();
  (void)hal_pwm_is_tripped();
  (void)hal_pwm_was_tripped_by_pin();
}

static void exchange_octets(void) {
  static uint16_t octets[HAL_SCI_TRANSMIT_RING];
  if (any_bool()) (void)hal_sci_init(any_u32);
  hal_sci_service();
  (void)hal_sci_read(octets, any_up_to(HAL_SCI_TRANSMIT_RING));
  (void)hal_sci_write(octets, any_up_to(HAL_SCI_TRANSMIT_RING));
  (void)hal_sci_room();
  (void)hal_sci_errors();
}

static void look_at_pins(void) {
  (void)hal_encoder_count();
  (void)hal_digital_io_emergency();
  (void)hal_digital_io_run();
  (void)hal_digital_io_gates_pass();
  hal_digital_io_relay(any_bool());
  hal_digital_io_brake(any_bool());
  hal_digital_io_wire_emergency();
  hal_safety_fault_lamp(any_bool());
  hal_safety_toggle_enable();
  (void)hal_time_cycles();
}

static void interrupt(void) {
  hal_irq_control_begin();
  hal_irq_restore(hal_irq_disable());
  (void)hal_irq_unexpected_count();
  hal_irq_control_end();
}

void prove_chip(void) {
  set_up();
  while (any_bool()) {
    hal_replay.mode = (replay_mode_t)any_up_to(REPLAY_PLAYS);
    convert();
    switch_gates();
    exchange_octets();
    look_at_pins();
    interrupt();
  }
}
