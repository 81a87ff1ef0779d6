#include "sim_host/bench/virtual_board.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "firmware/api/status.h"
#include "firmware/boot/main.h"
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/signals.h"
#include "firmware/hil/hil.h"
#include "firmware/mode/commands.h"
#include "firmware/store/store.h"
#include "sim_host/bench/run.hpp"
#include "sim_host/bench/texts.hpp"
#include "sim_host/chip/boot_rom.hpp"
#include "sim_host/chip/memory.hpp"

namespace stillspin::bench {
namespace {

constexpr double kSecondsPerTick = 1e-8;
constexpr double kPi = 3.14159265358979323846;
constexpr double kRpmPerRads = 30.0 / kPi;
constexpr double kLargestLoad = 1e4;
constexpr Tick kSerialBits = 10;
constexpr Tick kFrameBits = 135;  // the longest frame with stuff bits and intermission

// A saved set has every parameter: nothing of it is overruled, also where it says what the default says.
bool saved_values_are_in_force() {
  const store_state_t state = store_state();
  return state == STORE_LOADED || state == STORE_MIGRATED || state == STORE_OLDER;
}

}  // namespace

VirtualBoard::VirtualBoard(const BoardRequest& request)
    : brake_until_run_(request.setup.brake_until_run),
      locked_(request.setup.nominal.mechanics.locked),
      faults_(request.setup.fault),
      board_(request.setup.plant(), *this, &can_bus_),
      chip_(board_, request.image.empty() ? firmware_main : chip::boot_rom) {
  for (const auto& [name, value] : request.parameters) {
    unsigned id = 0;
    const std::int32_t raw = parameter_raw(name, value, Scale::of(request.parameters), id);
    parameters_.push_back({static_cast<std::uint16_t>(id), raw});
  }
  if (!request.image.empty()) {
    chip_.execute_code();
    chip_.load(request.image);
    executes_ = true;
  }
  board_.attach(chip_);
  board_.fit(eeprom_);
  board_.equip(request.setup.board);
  if (brake_until_run_) board_.plant().set_locked(true);
}

void VirtualBoard::set_eeprom(std::vector<std::uint8_t> content) {
  if (content.size() != devices::Eeprom::kSize) {
    throw std::invalid_argument("the EEPROM holds " + std::to_string(devices::Eeprom::kSize) + " octets, not " +
                                std::to_string(content.size()));
  }
  if (now() > 0) throw std::logic_error("the EEPROM can only be exchanged before any time has passed");
  eeprom_.memory() = std::move(content);
}

void VirtualBoard::advance(Tick ticks) {
  if (ticks < 0) throw std::invalid_argument("time does not go back: ticks must not be negative");
  chip_.run_until(chip_.now() + ticks);
  if (const auto fault = board_.plant().shoot_through()) {
    throw std::runtime_error("both devices of leg " + std::to_string(fault->leg) + " conducted at tick " +
                             std::to_string(fault->tick));
  }
}

bool VirtualBoard::advance_until_heard(Tick ticks) {
  const Tick end = now() + ticks;
  const Tick rest = rest_periods();
  std::uint64_t before = heard();
  Tick rested = -1;  // periods; none has been heard yet
  while (now() < end && rested < rest) {
    advance(std::min(kPeriod, end - now()));
    const std::uint64_t all = heard();
    if (all != before) {
      rested = 0;
    } else if (rested >= 0) {
      rested++;
    }
    before = all;
  }
  return rested >= 0;
}

// Periods that pass without anything new while the drive sends: of a frame on the bus, of an octet of the port. It
// fills its rings and mailboxes in every period.
Tick VirtualBoard::rest_periods() const {
  const Tick frame = kFrameBits * can_host_.can_bit_time();
  const Tick octet =
      static_cast<Tick>(kSerialBits * static_cast<double>(chip::kTicksPerSecond) / board_.serial().rate());
  return 1 + std::max(frame, octet) / kPeriod;
}

bool VirtualBoard::in_loop() { return feature_status.stepped; }

chip::Chip& VirtualBoard::executing() {
  if (!executes_) throw std::logic_error("this board runs the firmware that was compiled for the computer: no image");
  return chip_;
}

void VirtualBoard::begin_run() {
  if (first_run_ >= 0) return;
  first_run_ = now();
  board_.plant().advance(first_run_);
  if (brake_until_run_) board_.plant().set_locked(locked_);
}

void VirtualBoard::on_period(Tick t) {
  if (!executes_) follow_drive();
  const double since_start = first_run_ < 0 ? -1.0 : static_cast<double>(t - first_run_) * kSecondsPerTick;
  faults_.step(since_start, static_cast<double>(t) * kSecondsPerTick, board_);
}

void VirtualBoard::follow_drive() {
  const drive_signals_t s = drive_signals();
  const std::uint64_t resets = chip_.statistics().resets;
  if (resets != resets_) told_ = false;
  resets_ = resets;
  if (!told_ && s.state == DRIVE_READY) tell_parameters();
  if (s.state == DRIVE_RUN) begin_run();
}

void VirtualBoard::tell_parameters() {
  told_ = true;
  if (saved_values_are_in_force()) return;
  for (const Told& p : parameters_) (void)parameter_set(p.id, p.raw);
}

void VirtualBoard::set_load(double torque) {
  if (!(std::fabs(torque) <= kLargestLoad)) throw std::invalid_argument("a load torque must be -1e4 to 1e4 N m");
  board_.plant().advance(chip_.now());
  board_.plant().set_load({{chip_.now(), torque}});
}

void VirtualBoard::set_input(const std::string& name, double value) {
  BoardInputs inputs = board_.inputs();
  if (name == "emergency") {
    inputs.emergency = value != 0.0;
  } else if (name == "run") {
    inputs.run = value != 0.0;
  } else if (name == "speed") {
    inputs.speed_volts = value;
  } else if (name == "heat_sink") {
    inputs.heat_sink = value;
  } else if (name == "reference") {
    inputs.reference_codes = value;
  } else if (name == "broken_ram") {
    chip_.memory().break_ram(static_cast<std::uint32_t>(value), 1u);
  } else {
    throw std::invalid_argument("the board has no input '" + name +
                                "': emergency, run, speed, heat_sink, reference, broken_ram");
  }
  board_.set_inputs(inputs);
}

std::vector<Quantity> VirtualBoard::outputs() const {
  return {{"relay", "", board_.relay_closed() ? 1.0 : 0.0},
          {"brake", "", board_.brake_on() ? 1.0 : 0.0},
          {"gates_pass", "", board_.gates_enabled() ? 1.0 : 0.0},
          {"lockouts", "", static_cast<double>(board_.lockouts())}};
}

std::vector<Quantity> VirtualBoard::truth() {
  board_.plant().advance(chip_.now());
  const plant::PlantState s = board_.plant().state();
  return {{"angle", "rad", s.angle_m},
          {"speed", "rpm", s.speed_m * kRpmPerRads},
          {"torque", "Nm", s.torque},
          {"load_torque", "Nm", s.load},
          {"i_a", "A", s.current[0]},
          {"i_b", "A", s.current[1]},
          {"i_c", "A", s.current[2]},
          {"i_d", "A", s.current_d},
          {"i_q", "A", s.current_q},
          {"electrical_angle", "rad", s.angle_e},
          {"link_voltage", "V", s.link_voltage},
          {"load_angle", "rad", std::atan2(s.flux_q, s.flux_d)}};
}

std::vector<Quantity> VirtualBoard::signals() {
  const drive_signals_t s = drive_signals();
  return {
#define SIGNAL(name, unit, q, of, value, meaning) \
  {#name, unit_name(UNIT_##unit), std::ldexp(static_cast<double>(s.name), unit_exponent(UNIT_##unit) - (q))},
#include "firmware/dictionary/all_signals.h"
#undef SIGNAL
  };
}

}  // namespace stillspin::bench
