// The board on the desk: time that passes when told, plugs, and a control that serial traffic does not disturb.

#include "sim_host/bench/virtual_board.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "firmware/store/store.h"
#include "hal/hal_sci.h"
#include "sim_host/bench/run.hpp"

namespace stillspin::bench {
namespace {

constexpr Tick kMillisecond = 100'000;
constexpr Tick kReady = 60 * kMillisecond;  // clock, offsets

double quantity(const std::vector<Quantity>& list, const std::string& name) {
  for (const Quantity& q : list) {
    if (name == q.name) return q.value;
  }
  ADD_FAILURE() << "there is no " << name;
  return 0.0;
}

BoardRequest request() {
  BoardRequest r;
  r.setup.nominal = plant::PlantConfig();  // bench inverter, noise
  r.setup.solver = 1;                      // fixed steps
  return r;
}

void start_running(VirtualBoard& board) {
  board.advance(kReady);
  ASSERT_EQ(drive_signals().state, DRIVE_READY);
  drive_command_speed(300 << 16);
  drive_command_start();
  for (int k = 0; k < 2000 && drive_signals().state != DRIVE_RUN; ++k) board.advance(kMillisecond);
  ASSERT_EQ(drive_signals().state, DRIVE_RUN);
}

TEST(VirtualBoard, TimePassesOnlyWhenTold) {
  VirtualBoard board(request());
  EXPECT_EQ(board.now(), 0);
  board.advance(12345);
  EXPECT_EQ(board.now(), 12345);
  board.advance(0);
  EXPECT_EQ(board.now(), 12345);
  EXPECT_THROW(board.advance(-1), std::invalid_argument);
}

TEST(VirtualBoard, OneAtATimeInAProcess) {
  VirtualBoard board(request());
  EXPECT_THROW(VirtualBoard{request()}, std::logic_error);
  EXPECT_THROW(check_parameters({}), std::logic_error);
  EXPECT_THROW(run(RunRequest{}), std::logic_error);
}

TEST(VirtualBoard, ParametersAreToldOnceTheDriveIsReady) {
  BoardRequest r = request();
  r.parameters = {{"speed_ramp", 1234.0}};
  unsigned id = 0;
  const std::int32_t raw = parameter_raw("speed_ramp", 1234.0, Scale(), id);
  VirtualBoard board(r);
  EXPECT_NE(parameter_get(static_cast<std::uint16_t>(id)), raw);
  board.advance(kReady);
  EXPECT_EQ(parameter_get(static_cast<std::uint16_t>(id)), raw);
  EXPECT_THROW(VirtualBoard({request().setup, {{"no_such", 1.0}}, {}}), std::exception);
}

// Saved at its default, a value is a saved value like any other.
TEST(VirtualBoard, WhatIsSavedOverrulesTheProfile) {
  BoardRequest r = request();
  r.parameters = {{"speed_ramp", 1234.0}};
  unsigned id = 0;
  (void)parameter_raw("speed_ramp", 1234.0, Scale(), id);
  const auto ramp = static_cast<std::uint16_t>(id);
  const std::int32_t initial = parameter_initial(parameter_by_id(ramp));
  std::vector<std::uint8_t> memory;
  {
    VirtualBoard board(r);
    board.advance(kReady);
    ASSERT_EQ(parameter_set(ramp, initial), SET_OK);
    ASSERT_TRUE(store_save());
    board.advance(300 * kMillisecond);
    ASSERT_EQ(store_state(), STORE_SAVED);
    memory = board.eeprom();
  }
  VirtualBoard board(r);
  board.set_eeprom(memory);
  board.advance(kReady + 40 * kMillisecond);
  ASSERT_EQ(drive_signals().state, DRIVE_READY);
  EXPECT_EQ(parameter_get(ramp), initial);
}

TEST(VirtualBoard, CutsOfTimeDoNotChangeTheRun) {
  std::vector<std::vector<Quantity>> ends;
  for (const Tick slice : {Tick{1'000'000}, Tick{12'345}}) {
    VirtualBoard board(request());
    start_running(board);
    const Tick end = 150 * kMillisecond + kReady + 2000 * kMillisecond;
    while (board.now() < end) board.advance(std::min(slice, end - board.now()));
    ends.push_back(board.truth());
  }
  for (std::size_t k = 0; k < ends[0].size(); ++k) EXPECT_EQ(ends[0][k].value, ends[1][k].value) << ends[0][k].name;
}

TEST(VirtualBoard, LoadBrakesTheShaft) {
  VirtualBoard board(request());
  start_running(board);
  board.advance(400 * kMillisecond);
  EXPECT_NEAR(quantity(board.truth(), "speed"), 300.0, 15.0);
  board.set_load(3.0);
  board.advance(1 * kMillisecond);
  EXPECT_EQ(quantity(board.truth(), "load_torque"), 3.0);
  board.advance(300 * kMillisecond);
  double mean = 0.0;  // the torque of an instant has the excitation's ripple in it
  for (int n = 0; n < 100; ++n, board.advance(kMillisecond * 37 / 100))
    mean += quantity(board.truth(), "torque") / 100.0;
  EXPECT_NEAR(mean, 3.0 + 0.003 * 31.4, 0.15) << "the drive holds against load and friction";
  EXPECT_NEAR(quantity(VirtualBoard::signals(), "speed"), 300.0, 15.0);
  EXPECT_THROW(board.set_load(1e6), std::invalid_argument);
}

std::vector<std::uint8_t> octets_of(const std::string& text) { return {text.begin(), text.end()}; }

/// 130 ms of octets with errors, a break, and then a question whose answer fills the line the other way for 0.4 s.
void flood_line(devices::SerialLine& line, Tick now) {
  line.set_noise(0.02, 7);
  line.send(std::vector<std::uint8_t>(1500, 0xA5), now);
  line.send_break(40, now);
  line.set_noise(0.0, 7);
  line.send(octets_of("\x03\rlist\r"), now + 150 * kMillisecond);
}

// Not one value of the machine differs, whatever comes in and goes out: the port is served behind what the pulses wait
// for, and what the octets mean is looked at in the background.
TEST(VirtualBoard, SerialFloodDoesNotTouchTheControl) {
  std::vector<std::vector<Quantity>> quiet;
  for (const bool flood : {false, true}) {
    VirtualBoard board(request());
    start_running(board);
    board.serial().take();
    if (flood) flood_line(board.serial(), board.now());
    for (int k = 0; k < 400; ++k) {
      board.advance(kMillisecond);
      const std::vector<Quantity> now = board.truth();
      if (!flood) {
        quiet.push_back(now);
        continue;
      }
      for (std::size_t q = 0; q < now.size(); ++q) {
        ASSERT_EQ(now[q].value, quiet[static_cast<std::size_t>(k)][q].value) << now[q].name << " after " << k << " ms";
      }
    }
    const hal_sci_errors_t e = hal_sci_errors();
    EXPECT_EQ(e.framing > 0, flood);
    EXPECT_EQ(e.breaks, flood ? 1u : 0u);
    if (flood) {
      EXPECT_GT(board.serial().take().size(), 2600u) << "0.25 s of a full line are 2890 octets";
    }
    EXPECT_EQ(board.statistics().resets, 0u);
  }
}

}  // namespace
}  // namespace stillspin::bench
