// The board under the firmware: what it was told, and what it shall answer.

#ifndef STILLSPIN_TESTS_FIRMWARE_FAKE_HAL_HPP
#define STILLSPIN_TESTS_FIRMWARE_FAKE_HAL_HPP

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <map>
#include <numeric>
#include <vector>

#include "hal/hal_adc.h"
#include "hal/hal_can.h"
#include "hal/hal_irq.h"
#include "hal/hal_pwm.h"
#include "hal/hal_sampling_timer.h"
#include "hal/hal_sci.h"
#include "tests/control/quantities.hpp"
#include "tests/firmware/edition.hpp"
#include "tests/firmware/inside.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/position.h"
#include "firmware/drive/reset.h"
#include "firmware/drive/sampling.h"
#include "firmware/drive/steps.h"
#include "firmware/interfaces/config_part.h"
#include "firmware/mode/mode.h"
}

namespace stillspin::test {

struct FakeBoard {
  bool gates_on = false, lamp = false;
  bool lit_with_gates_on = false;  // the lamp before the gates were off
  bool tripped_by_pin = false, pin_low = false;
  bool clock_runs = true;
  void (*on_idle)(void) = nullptr;  // what happens while the background level sleeps
  bool watchdog = false, safety = false;
  int watchdog_services = 0;
  int adc_looks = 0;  // until the converter is up
  bool adc_set_up = false;
  bool late = false;  // hal_pwm_write comes too late
  int gates_off_calls = 0, frames = 0, enable_toggles = 0;
  hal_pwm_frame_t frame = {};
  std::deque<hal_adc_window_t> adc;  // what hal_adc_read_window gives next
  // What the drivers do with a recording, where a test wants it (hil_host.hpp). True when it has played.
  bool (*plays_frame)(const hal_pwm_frame_t& frame, bool* in_time) = nullptr;
  bool (*plays_window)(hal_adc_window_t* window) = nullptr;
  std::uint32_t encoder = 0, encoder_counts = 0;
  std::uint16_t dead_band = 0;  // as last set
  bool dead_band_fits = true;
  bool relay = false, brake = false, emergency = false, gates_pass = false, run = false;
  int digital_io_wired = 0, emergency_wired = 0;
  std::uint16_t unexpected_interrupts = 0;
  hal_isr_t control_interrupt = nullptr, window_interrupt = nullptr;  // installed
  bool interrupts_enabled = false;
  std::uint32_t cycles = 0;    // the clock: no time passes by itself
  bool slow_is_speed = false;  // what the converter's last place reads
  bool gate_pins_off = true;
  bool reset_by_watchdog = false;
  int bad_pair = -1;                             // of RAM
  std::map<std::uint32_t, std::uint16_t> flash;  // words by address, erased where there is none
  std::uint16_t watchdog_count = 10;             // at a service
  std::uint16_t ground = 0, reference = 2048;
  std::uint16_t slice_ticks = 0;  // 0: pulses
  std::uint16_t legs = 0;
  hal_timed_samples_t slice = {2048, 2048, 2731};   // no current, 300 V
  std::deque<std::uint16_t> serial_in, serial_out;  // octets for the firmware, and from it
  int serial_break = -1;                            // a break came behind so many of them; -1: none
  std::uint16_t serial_room = 512;                  // of the transmit ring, taken octets deducted
  std::uint32_t baud = 0;
  int baud_calls = 0;
  int serial_services = 0;
  std::vector<std::uint16_t> profile;        // what the chip's model was told of run times
  int control_begins = 0, control_ends = 0;  // of the control interrupt
  int outside_control = 0;                   // what belongs between these two and was not
  int interrupt_holds = 0;                   // how often both interrupts were held off
  std::uint16_t held_off = 0;                // they are now
  int off_unheld = 0;                        // gates switched off where the control interrupt could have come between
  std::uint16_t pwm_tick = 0;                // of the running period
  hal_sci_errors_t serial_errors = {};
  std::deque<hal_can_frame_t> can_in[HAL_CAN_GROUPS_MAX], can_out;
  std::vector<hal_can_group_t> can_groups;
  std::uint32_t can_rate = 0;  // 0: off
  std::size_t can_room = 16;   // mailboxes for can_out
  bool can_drains = true;      // what is sent leaves its mailbox at once
  hal_can_status_t can_status = {HAL_CAN_ACTIVE, 0, 0, 0, 0, 0};
  std::map<std::uint32_t, std::uint16_t> can_priority;  // with which an identifier was sent last
  int can_recoveries = 0, can_cancels = 0, can_set_ups = 0;
};
extern FakeBoard board;

/// Cycles that steps have said they take since the profile was cleared.
inline std::uint32_t spent() { return std::accumulate(board.profile.begin(), board.profile.end(), 0u); }

/// Codes of a board at rest: no current, 300 V.
inline hal_adc_window_t still_window(double link = 300.0) {
  hal_adc_window_t w = {};
  w.start_a = w.start_b = 4 * 2048;
  w.end_a = w.end_b = 3 * 2048;
  w.link = static_cast<std::uint16_t>(std::lround(link / 450.0 * 4096.0));
  return w;
}

/// The lowest electrical speed that is shown as this mechanical one, rpm.
inline std::int32_t bpp_of(int rpm) {
  const auto shown = [](std::int32_t bpp) { return drive_rpm_q16(&drive, bpp); };
  std::int32_t bpp =
      static_cast<std::int32_t>(static_cast<std::int64_t>(rpm) * inside::config().bpp_per_rpm_q8 / 256) - 4;
  while (shown(bpp) < rpm * 65536) bpp++;
  return bpp;
}

/// What the exchange of the configuration gives the interrupts of the parameters as they are, at once.
inline void use_parameters() {
#define CONFIG_VALUE(name) inside::config().values.name = parameters.name;
#include "firmware/interfaces/all_config_values.h"
#undef CONFIG_VALUE
  drive_config_t beside = inside::config();  // a part may change what the drive's own parameters have made
  for (const config_part_t* const* part = edition_config_parts; *part != nullptr; ++part) {
    const bool fits = (*part)->make == nullptr || (*part)->make(&beside) == PACKED_NONE;
    if (fits && (*part)->take != nullptr) (*part)->take();
  }
}

/// Whether the edition has a position source.
inline bool has_source(std::int32_t source) { return position_sources[source] != nullptr; }

/// Another position source, at once.
inline void use_source(std::int32_t source) {
  ASSERT_TRUE(has_source(source)) << "a test that needs it says so: edition.hpp";
  parameters.position_source = source;
  if (source == POSITION_PAPER && parameters.id_low_speed == 0) parameters.id_low_speed = raw(-1.0, 20);
  inside::source() = position_sources[source];
}

class Drive : public ::testing::Test {
 protected:
  void SetUp() override {
    board = FakeBoard{};
    drive_reset();
    parameters.wiring_check = 0;  // no motor is there, and no current flows
    use_parameters();
  }
  void TearDown() override { EXPECT_EQ(board.held_off, 0) << "interrupts that nobody has let through again"; }

  /// One period: as many window interrupts as the pattern has windows, then the control interrupt.
  void period(const hal_adc_window_t& w = still_window(), int missing = 0) {
    const int count = inside::sampled_pattern().window_count - missing;
    for (int k = 0; k < count; ++k) {
      board.adc.push_back(w);
      drive_window_interrupt();
    }
    drive_control_interrupt();
  }

  void periods(int n) {
    for (int k = 0; k < n; ++k) period();
  }
  /// As many as it takes.
  void periods_until(const std::function<bool()>& done) {
    for (int k = 0; k < 400 && !done(); ++k) period();
    ASSERT_TRUE(done());
  }

  /// Ready, calibrated.
  void make_ready() {
    periods(400);
    ASSERT_EQ(inside::state(), DRIVE_READY);
  }

  /// Running, with the encoder and without the polarity test, which needs a machine behind it.
  /// What is learnt of windows without a machine behind them would soon be a fault.
  static void forget_windows() {
    if (!drive_is_energised() || inside::state() == DRIVE_START) return;
    inside::preset(0, 0);
    inside::sensor_trim().mismatch_q30 = 0;
    inside::supervision() = drive_supervision_t{};
  }
  void make_run() {
    use_source(0);
    parameters.polarity_check = 0;
    use_parameters();
    make_ready();
    drive_command_start();
    for (int n = 0; n < 350 && inside::state() != DRIVE_RUN; ++n) period();
    ASSERT_EQ(inside::state(), DRIVE_RUN) << inside::fault();
    forget_windows();
    inside::ramped_bpp() = 0;
    periods(20);
  }
};

}  // namespace stillspin::test

#endif
