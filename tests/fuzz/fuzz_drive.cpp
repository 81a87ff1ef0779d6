#include "tests/fuzz/fuzz_drive.hpp"

#include <array>

#include "tests/firmware/fake_nvm.hpp"

extern "C" {
#include "firmware/hil/hil.h"
#include "firmware/link/link.h"
}

namespace stillspin::test {
namespace {

constexpr int kCalibration = 400, kStart = 350;  // periods that are more than enough

void period() {
  for (int k = 0; k < drive.modulation.sampled.window_count; ++k) {
    board.adc.push_back(still_window());
    drive_window_interrupt();
  }
  drive_control_interrupt();
}

void background() {
  if (!hil_is_active()) background_step(&drive);
}

void periods_until(drive_state_t state, int most) {
  for (int k = 0; k < most && drive.state != state; ++k) {
    period();
    background();
  }
}

void power_on() {
  board = FakeBoard{};
  nvm = FakeNvm{};
  drive_reset();
  hil_reset();
  link_reset();
}

using States = std::array<drive_t, kDriveStates>;

// The machine stands, so the drive runs with an encoder and does not ask which way round its magnet is.
States reach_states() {
  States s;
  power_on();
  s[DRIVE_BOOT] = drive;
  period();
  s[DRIVE_CALIBRATE] = drive;
  periods_until(DRIVE_READY, kCalibration);
  s[DRIVE_READY] = drive;
  drive_command_commission();
  periods_until(DRIVE_COMMISSION, kStart);
  s[DRIVE_COMMISSION] = drive;
  drive_command_coast();
  period();
  parameters.position_source = 0;
  parameters.polarity_check = 0;
  drive_parameters_changed();
  background();
  drive_command_speed(300L << 16);
  drive_command_start();
  periods_until(DRIVE_START, 1);
  s[DRIVE_START] = drive;
  periods_until(DRIVE_RUN, kStart);
  for (int k = 0; k < 20; ++k) period();
  s[DRIVE_RUN] = drive;
  drive_command_stop();
  period();
  s[DRIVE_STOP] = drive;
  drive_raise(&drive, FAULT_OVER_CURRENT);
  period();
  s[DRIVE_FAULT] = drive;
  return s;
}

const States& states() {
  static const States reached = reach_states();
  return reached;
}

}  // namespace

void fuzz_power_on() {
  const States& reached = states();
  power_on();
  drive = reached[DRIVE_READY];
}

void fuzz_put_into(drive_state_t state) {
  if (hil_is_active()) return;  // it is a simulation's drive
  const drive_t now = drive;
  drive = states()[static_cast<std::size_t>(state)];
  drive.time_ms = now.time_ms;
  drive.heartbeat = now.heartbeat;
  drive.request = now.request;
  drive.config = now.config;
  drive.config_valid = now.config_valid;
  drive_parameters_changed();
  board.gates_on = drive_is_energised();
}

void fuzz_fault(unsigned which) {
  static constexpr drive_fault_t faults[] = {
#define FAULT(number, name, words, remedy) FAULT_##name,
#include "firmware/fault_list.h"
#undef FAULT
  };
  const drive_fault_t fault = faults[which % std::size(faults)];
  if (fault != FAULT_NONE) drive_raise(&drive, fault);
}

void fuzz_pass(int ms) {
  if (hil_is_active()) return;  // its time is the simulation's
  drive.time_ms += static_cast<std::uint32_t>(ms - 1);
  drive.schedule.period = DRIVE_PERIODS_PER_MS - 1u;
  period();
  background();
}

std::string fuzz_parameter_out_of_range() {
  std::uint16_t k = 0;
  const auto is_wrong = [&k](std::int32_t raw) {
    const parameter_info_t& p = *parameter_info(k++);
    return raw < p.minimum || raw > p.maximum;
  };
#define PARAMETER(id, name, unit, q, decimals, minimum, maximum, initial, access, meaning) \
  if (is_wrong(parameters.name)) return #name;
#include "firmware/parameter_list.h"
#undef PARAMETER
  return "";
}

}  // namespace stillspin::test
