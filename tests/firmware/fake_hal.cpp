#include "tests/firmware/fake_hal.hpp"

#include <algorithm>

#include "hal/hal_can.h"
#include "hal/hal_clock.h"
#include "hal/hal_digital_io.h"
#include "hal/hal_encoder.h"
#include "hal/hal_flash.h"
#include "hal/hal_irq.h"
#include "hal/hal_nvm.h"
#include "hal/hal_profile.h"
#include "hal/hal_safety.h"
#include "hal/hal_sci.h"
#include "hal/hal_selftest.h"
#include "hal/hal_time.h"

namespace stillspin::test {
FakeBoard board;
}

using stillspin::test::board;

extern "C" {

bool hal_pwm_set_dead_band(std::uint16_t ticks) {
  board.dead_band = ticks;
  return board.dead_band_fits;
}
bool hal_pwm_init(std::uint16_t ticks) { return hal_pwm_set_dead_band(ticks); }

bool hal_pwm_write(const hal_pwm_frame_t* frame, std::uint16_t) {
  bool in_time;
  if (board.plays_frame != nullptr && board.plays_frame(*frame, &in_time)) return in_time;
  if (board.late) return false;
  board.frame = *frame;
  board.frames++;
  return true;
}

bool hal_pwm_gates_on(void) {
  board.gates_on = !board.pin_low;
  return board.gates_on;
}

void hal_pwm_gates_off(void) {
  board.gates_on = false;
  board.gates_off_calls++;
  if (board.held_off == 0 && board.control_begins == board.control_ends) board.off_unheld++;
}

std::uint16_t hal_pwm_period_tick(void) { return board.pwm_tick; }
bool hal_pwm_is_tripped(void) { return !board.gates_on; }
bool hal_pwm_was_tripped_by_pin(void) { return board.tripped_by_pin; }

void hal_adc_power_up(void) {}
bool hal_adc_is_up(void) { return board.adc_looks-- <= 0; }
void hal_adc_set_up(void) { board.adc_set_up = true; }
void hal_adc_choose_slow(bool speed) { board.slow_is_speed = speed; }
void hal_adc_measure_reference(std::uint16_t* ground, std::uint16_t* reference) {
  *ground = board.ground;
  *reference = board.reference;
}

void hal_digital_io_init(void) { board.digital_io_wired++; }
void hal_digital_io_relay(bool on) { board.relay = on; }
void hal_digital_io_brake(bool on) { board.brake = on; }
void hal_digital_io_wire_emergency(void) { board.emergency_wired++; }
bool hal_digital_io_emergency(void) { return board.emergency; }
bool hal_digital_io_run(void) { return board.run; }
bool hal_digital_io_gates_pass(void) { return board.gates_pass; }

bool hal_selftest_ram(std::uint16_t pair) { return pair != board.bad_pair; }
std::uint16_t hal_selftest_watchdog_count(void) { return board.watchdog_count; }
bool hal_selftest_gates_are_off(void) { return board.gate_pins_off; }
bool hal_watchdog_caused_reset(void) { return board.reset_by_watchdog; }
std::uint16_t hal_flash_read(std::uint32_t address) {
  const auto word = board.flash.find(address);
  return word == board.flash.end() ? HAL_FLASH_ERASED : word->second;
}
void hal_adc_read_window(hal_adc_window_t* window) {
  if (board.plays_window != nullptr && board.plays_window(window)) return;
  *window = {};
  if (board.adc.empty()) return;  // a window that a host in the loop has invented
  *window = board.adc.front();
  board.adc.pop_front();
}

bool hal_sampling_timer_begin(std::uint16_t ticks) {
  board.slice_ticks = ticks;
  return true;
}
void hal_sampling_timer_end(void) { board.slice_ticks = 0; }
void hal_sampling_timer_read(hal_timed_samples_t* slice) { *slice = board.slice; }
void hal_sampling_timer_set_legs(std::uint16_t state) { board.legs = state; }

void hal_irq_install(hal_isr_t control, hal_isr_t window) {
  board.control_interrupt = control;
  board.window_interrupt = window;
  board.interrupts_enabled = false;
}
void hal_irq_enable(void) { board.interrupts_enabled = true; }
std::uint16_t hal_irq_disable(void) {
  board.interrupt_holds++;
  return board.held_off++;
}
void hal_irq_restore(std::uint16_t state) { board.held_off = state; }
std::uint16_t hal_irq_unexpected_count(void) { return board.unexpected_interrupts; }
void hal_profile_step(std::uint16_t cycles) { board.profile.push_back(cycles); }
std::uint32_t hal_time_cycles() { return board.cycles; }
void hal_irq_control_begin(void) { board.control_begins++; }
void hal_irq_control_end(void) { board.control_ends++; }
static void belongs_into_control(void) {
  if (board.control_begins == board.control_ends) board.outside_control++;
}
void hal_safety_toggle_enable(void) {
  board.enable_toggles++;
  belongs_into_control();
}
bool hal_clock_init(void) { return board.clock_runs; }
void hal_time_init(void) {}
void hal_idle(void) { board.on_idle(); }
void hal_watchdog_start(void) { board.watchdog = true; }
void hal_watchdog_service(void) { board.watchdog_services++; }
void hal_safety_init(void) { board.safety = true; }
void hal_safety_fault_lamp(bool on) {
  board.lamp = on;
  board.lit_with_gates_on = board.lit_with_gates_on || (on && board.gates_on);
}
void hal_encoder_init(std::uint32_t counts) { board.encoder_counts = counts; }
std::uint32_t hal_encoder_count(void) { return board.encoder; }

bool hal_can_init(std::uint32_t bitrate, const hal_can_group_t* groups, std::uint16_t count) {
  board.can_groups.assign(groups, groups + count);
  board.can_rate = bitrate;
  board.can_set_ups++;
  return bitrate != 0;
}
void hal_can_off(void) { board.can_rate = 0; }
void hal_can_service(void) {}
bool hal_can_receive(std::uint16_t group, hal_can_frame_t* frame) {
  std::deque<hal_can_frame_t>& waiting = board.can_in[group];
  if (waiting.empty()) return false;
  *frame = waiting.front();
  waiting.pop_front();
  return true;
}
bool hal_can_send(const hal_can_frame_t* frame, std::uint16_t priority) {
  EXPECT_LT(priority, HAL_CAN_PRIORITIES);
  EXPECT_LE(frame->length, 8);
  EXPECT_TRUE(std::all_of(frame->data, frame->data + frame->length, [](unsigned octet) { return octet <= 0xFF; }));
  if (!board.can_drains && board.can_out.size() >= board.can_room) return false;
  board.can_priority[frame->id] = priority;
  board.can_out.push_back(*frame);
  return true;
}
void hal_can_cancel(std::uint16_t priority) {
  const auto waits = [&](const hal_can_frame_t& frame) { return board.can_priority[frame.id] == priority; };
  board.can_out.erase(std::remove_if(board.can_out.begin(), board.can_out.end(), waits), board.can_out.end());
  board.can_cancels++;
}
std::uint16_t hal_can_waiting(std::uint16_t priority) {
  if (board.can_drains) return 0;
  const auto waits = [&](const hal_can_frame_t& frame) { return board.can_priority[frame.id] == priority; };
  return static_cast<std::uint16_t>(std::count_if(board.can_out.begin(), board.can_out.end(), waits));
}
hal_can_status_t hal_can_status(void) { return board.can_status; }
void hal_can_recover(void) { board.can_recoveries++; }

bool hal_sci_init(std::uint32_t baud) {
  board.baud_calls++;
  if (baud == 0 || baud > HAL_SCI_MAX_BAUD) return false;
  board.baud = baud;
  return true;
}
void hal_sci_service(void) {
  board.serial_services++;
  belongs_into_control();
}
std::uint16_t hal_sci_read(std::uint16_t* octets, std::uint16_t room) {
  std::uint16_t taken = 0;
  for (; taken < room && !board.serial_in.empty(); ++taken) {
    octets[taken] = board.serial_in.front();
    board.serial_in.pop_front();
  }
  return taken;
}
std::uint16_t hal_sci_write(const std::uint16_t* octets, std::uint16_t count) {
  const std::uint16_t put = count < board.serial_room ? count : board.serial_room;
  board.serial_out.insert(board.serial_out.end(), octets, octets + put);
  board.serial_room = static_cast<std::uint16_t>(board.serial_room - put);
  return put;
}
std::uint16_t hal_sci_room(void) { return board.serial_room; }
bool hal_sci_take_break(void) {
  if (board.serial_break < 0) return false;
  board.serial_in.erase(board.serial_in.begin(), board.serial_in.begin() + board.serial_break);
  board.serial_break = -1;
  return true;
}
hal_sci_errors_t hal_sci_errors(void) { return board.serial_errors; }
}
