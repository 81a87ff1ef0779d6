// The board as a thing on the desk: it has a supply, plugs and a shaft, and its time goes on only when it is told so.
//
//     VirtualBoard desk(request);
//     desk.serial().send(octets, desk.now());
//     desk.advance(100'000);                       // a millisecond
//     desk.serial().take();
//
// What is handed over at the plugs between two calls of advance takes effect at the tick at which the board stands, so
// a sequence of calls gives the same run each time. A watchdog reset is part of the run; what the real chip could not
// survive makes advance throw std::runtime_error, then and ever after.

#ifndef STILLSPIN_SIM_HOST_BENCH_VIRTUAL_BOARD_HPP
#define STILLSPIN_SIM_HOST_BENCH_VIRTUAL_BOARD_HPP

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim_host/bench/board.hpp"
#include "sim_host/bench/fault_plan.hpp"
#include "sim_host/bench/firmware_lease.hpp"
#include "sim_host/bench/setup.hpp"
#include "sim_host/chip/c28x/core.hpp"
#include "sim_host/devices/can_host.hpp"

namespace stillspin::bench {

struct BoardRequest {
  Setup setup;
  /// Firmware parameters of a board that nobody has set up, in the table's units: told to the drive when it is first
  /// ready after power-on or a reset, unless it has found saved ones in its memory.
  std::map<std::string, double> parameters;
  /// Machine code instead of the firmware: words by address, as a probe would put them into flash and RAM. Empty: the
  /// firmware runs.
  chip::CodeBlocks image;
};

/// A true or a measured quantity of the present.
struct Quantity {
  const char* name;
  const char* unit;
  double value;
};

class VirtualBoard final : private PeriodListener {
 public:
  /// Powers the board. Throws std::invalid_argument for an impossible request, std::logic_error when another virtual
  /// drive runs in this process.
  explicit VirtualBoard(const BoardRequest& request);

  /// Lets this many ticks of 10 ns pass; not negative.
  void advance(Tick ticks);
  /// Lets time pass until the drive has said something at one of its plugs and has rested since for longer than an
  /// octet or a frame takes; at most so many ticks. False when it has said nothing.
  bool advance_until_heard(Tick ticks);
  Tick now() const { return chip_.now(); }
  /// Whether the drive is stepped by a computer (firmware/hil/hil.h).
  static bool in_loop();

  // ---- plugs
  devices::SerialLine& serial() { return board_.serial(); }
  /// The other node on the CAN bus; off until it has a bit rate. Unplugged, the drive is alone.
  devices::CanHost& can_host() { return can_host_; }
  devices::CanBus& can_bus() { return can_bus_; }

  /// What the EEPROM on the board holds, Eeprom::kSize octets; a new one is blank. Another content, as of a board that
  /// was in use before, can be given before any time has passed: std::invalid_argument for a wrong size,
  /// std::logic_error later.
  const std::vector<std::uint8_t>& eeprom() const { return eeprom_.memory(); }
  void set_eeprom(std::vector<std::uint8_t> content);

  // ---- inputs of the board: emergency, run (0, 1), speed (V), heat_sink (degrees C), reference (codes),
  // broken_ram (address of a word whose lowest bit is stuck at 1)
  /// From now on; std::invalid_argument for a name that is none.
  void set_input(const std::string& name, double value);
  /// What it does: relay, brake, gates_pass (0, 1), and how often an upper driver had no supply.
  std::vector<Quantity> outputs() const;

  // ---- shaft
  /// Load torque from now on, N m, -1e4..1e4; positive opposes positive rotation.
  void set_load(double torque);
  /// The start procedure is over: a brake that holds until then lets go, and times of faults count from now. Of the
  /// firmware the board sees it itself; of an image somebody has to say so. Again: nothing.
  void begin_run();
  /// The true machine: angle and speed of the shaft, currents, torques, DC link.
  std::vector<Quantity> truth();

  /// Its program fails; what that is, the chip says.
  void fail(chip::Failure failure) { chip_.fail(failure); }

  // ---- inspection, without an effect on the run
  /// The firmware's signals as of its last control interrupt, scaled; angles in turns.
  static std::vector<Quantity> signals();
  chip::Statistics statistics() const { return chip_.statistics(); }
  std::uint64_t trips() const { return board_.trips(); }
  const Board& pins() const { return board_; }
  std::uint16_t inspect(std::uint32_t address) { return chip_.inspect(address); }
  /// chip::Chip::recording, of the firmware or of an image.
  chip::Recording& recording() { return chip_.recording(); }
  bool executes() const { return executes_; }
  /// The chip that executes the image; std::logic_error where the firmware runs. Where its core's watch stops it,
  /// advance returns early.
  chip::Chip& executing();
  c28x::Core& code() { return executing().execute_code(); }

 private:
  Tick rest_periods() const;
  std::uint64_t heard() { return serial().counts().received + can_host_.heard(); }

  struct Told {
    std::uint16_t id;
    std::int32_t raw;
  };

  void on_period(Tick t) override;
  void follow_drive();
  void tell_parameters();

  FirmwareLease lease_;
  std::vector<Told> parameters_;
  bool executes_ = false;  // an image, of which only pins are known
  bool brake_until_run_;
  bool locked_;
  FaultPlayer faults_;
  devices::CanBus can_bus_;
  devices::CanHost can_host_{can_bus_, 0};
  devices::Eeprom eeprom_;
  Board board_;
  chip::Chip chip_;
  bool told_ = false;
  std::uint64_t resets_ = 0;
  Tick first_run_ = -1;
};

}  // namespace stillspin::bench

#endif
