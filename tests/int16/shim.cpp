// Puts the drive that was compiled with a 16-bit int (toolchain/int16) in the place of the native one: the linker leads
// the bench's calls here (-Wl,--wrap). Tables and words stay the native ones; what sets parameters goes to both, and
// both must give the same answer. The recording is not for this drive.

#include <cstdio>
#include <cstdlib>

#include "sim_host/bench/texts.hpp"

extern "C" {
#include "firmware/commissioning/outcome.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/mode.h"
#include "hal/hal_replay.h"
}

namespace {

constexpr int kWindowWords = 8;

[[noreturn]] void differ(const char* what) {
  std::fprintf(stderr, "int16: the two drives differ: %s\n", what);
  std::abort();
}

}  // namespace

extern "C" {

// An int of the other drive is a short here.
void int16_firmware_main(void);
void int16_drive_reset(void);
drive_signals_t int16_drive_signals(void);
void int16_drive_command_start(void);
void int16_drive_command_stop(void);
void int16_drive_command_coast(void);
void int16_drive_command_reset(void);
void int16_drive_command_commission(void);
void int16_drive_command_speed(int32_t rpm_q16);
short int16_parameter_set(uint16_t id, int32_t raw);
int32_t int16_parameter_get(uint16_t id);
short int16_parameter_conflict(void);
short int16_drive_commissioning_outcome(void);
short int16_drive_commissioning_phase(void);
int32_t int16_drive_commissioning_progress(void);
uint16_t int16_drive_commissioning_count(void);
uint16_t int16_samples_out(int32_t* flat);
void int16_commissioning_out(uint16_t index, int32_t* flat);

void __real_drive_reset(void);
parameter_result_t __real_parameter_set(uint16_t id, int32_t raw);
packed_text_t __real_parameter_conflict(void);

void __wrap_firmware_main(void) { int16_firmware_main(); }

void __wrap_drive_reset(void) {
  __real_drive_reset();
  int16_drive_reset();
}

// The record also looks at the windows.
drive_signals_t __wrap_drive_signals(void) {
  int32_t flat[ESTIMATOR_WINDOWS * kWindowWords];
  drive.samples.count = int16_samples_out(flat);
  const int32_t* f = flat;
  for (estimator_window_t& w : drive.samples.windows) {
    w.change_q19 = {f[0], f[1]};
    w.current_q20 = {f[2], f[3]};
    w.voltage_q19 = {f[4], f[5]};
    w.middle_tick = static_cast<int16_t>(f[6]);
    w.span_ticks = static_cast<int16_t>(f[7]);
    f += kWindowWords;
  }
  return int16_drive_signals();
}

void __wrap_drive_command_start(void) { int16_drive_command_start(); }
void __wrap_drive_command_stop(void) { int16_drive_command_stop(); }
void __wrap_drive_command_coast(void) { int16_drive_command_coast(); }
void __wrap_drive_command_reset(void) { int16_drive_command_reset(); }
void __wrap_drive_command_commission(void) { int16_drive_command_commission(); }
void __wrap_drive_command_speed(int32_t rpm_q16) { int16_drive_command_speed(rpm_q16); }

parameter_result_t __wrap_parameter_set(uint16_t id, int32_t raw) {
  return static_cast<parameter_result_t>(int16_parameter_set(id, raw));
}
int32_t __wrap_parameter_get(uint16_t id) { return int16_parameter_get(id); }

// The native drive has to come to the same, so it needs the parameters, too.
packed_text_t __wrap_parameter_conflict(void) {
  for (uint16_t k = 0; k < parameter_count(); k++) {
    const parameter_info_t* const info = parameter_info(k);
    if (__real_parameter_set(info->id, int16_parameter_get(info->id)) != SET_OK) {
      differ(stillspin::bench::text_of(parameter_name(info)).c_str());
    }
  }
  const packed_text_t native = __real_parameter_conflict();
  if (native != int16_parameter_conflict()) differ("parameter_conflict");
  return native;
}

commissioning_outcome_t __wrap_drive_commissioning_outcome(void) {
  return static_cast<commissioning_outcome_t>(int16_drive_commissioning_outcome());
}
commissioning_phase_t __wrap_drive_commissioning_phase(void) {
  return static_cast<commissioning_phase_t>(int16_drive_commissioning_phase());
}
int32_t __wrap_drive_commissioning_progress(void) { return int16_drive_commissioning_progress(); }
uint16_t __wrap_drive_commissioning_count(void) { return int16_drive_commissioning_count(); }
const commissioning_result_t* __wrap_drive_commissioning_result(uint16_t index) {
  static commissioning_result_t result;
  int32_t flat[4];
  if (index >= int16_drive_commissioning_count()) return nullptr;
  int16_commissioning_out(index, flat);
  result = {static_cast<uint16_t>(flat[0]), flat[1], flat[2], static_cast<commissioning_verdict_t>(flat[3])};
  return &result;
}

void __wrap_hal_replay_start(replay_mode_t mode, void (*)(void)) {
  if (mode != REPLAY_OFF) differ("no recording of the drive with a 16-bit int");
}

}  // extern "C"
