// A board in the state in which it gets its firmware: chip with boot ROM and flash, mode jumpers, serial port. No power
// stage: its pins hang in the air.
//
//     LoaderBoard board(kernel);
//     board.set_jumpers(BootMode::kSerial);
//     board.power_cycle();
//     board.serial().send(octets, board.now());
//     board.advance_until_heard(1'000'000);
//
// The boot ROM's model loads and jumps. Words that were downloaded are C28x code and cannot run here: where the boot
// ROM jumps to the entry of the kernel's image and RAM holds exactly that image, the kernel's C runs in its place;
// where it jumps to the flash, the boot code's decision is looked up (hal/f2808/image/boot.asm). Anything else is code
// that nobody knows, and the board only waits for its next reset.

#ifndef STILLSPIN_SIM_HOST_BENCH_LOADER_BOARD_HPP
#define STILLSPIN_SIM_HOST_BENCH_LOADER_BOARD_HPP

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "sim_host/bench/firmware_lease.hpp"
#include "sim_host/chip/chip.hpp"
#include "sim_host/devices/serial_line.hpp"

namespace stillspin::bench {

using chip::Tick;

/// Levels of GPIO18, GPIO29 and GPIO34 while the chip comes out of reset.
enum class BootMode : unsigned { kFlash = 7, kSerial = 6 };

/// What the chip runs.
enum class Running {
  kBootRom,
  kKernel,
  kDrive,    // the mark was there: the drive would run
  kWaiting,  // the boot code stays, watchdog off: there is no complete image
  kUnknown   // code that cannot be told, such as an erased boot entry
};
const char* words_of(Running running);

/// A program as the boot ROM loads it.
struct LoadedProgram {
  std::uint32_t entry = 0;
  std::vector<std::pair<std::uint32_t, std::vector<std::uint16_t>>> blocks;
};

class LoaderBoard final : private chip::World {
 public:
  /// std::logic_error when a virtual drive runs in this process.
  explicit LoaderBoard(LoadedProgram kernel);

  void set_jumpers(BootMode mode) { jumpers_ = mode; }
  /// Off and on, at any moment: RAM is gone, the flash stays as it is. Time goes on.
  void power_cycle();

  void advance(Tick ticks);
  /// Until the chip has sent something and then nothing for a while, at most so many ticks; false when it has not.
  bool advance_until_heard(Tick ticks);
  Tick now() const { return off_ + chip_->now(); }

  devices::SerialLine& serial() { return serial_; }
  Tick serial_now() const { return chip_->now(); }  // the line's time begins with the supply
  Running running() const { return running_; }

  /// How often a pin of a gate, or a general purpose one, has been driven to another level than that of its pull-down.
  std::uint64_t driven() const { return driven_; }

  /// All cells from 0x3E8000 on, as a JTAG probe sees them.
  const std::vector<std::uint16_t>& flash();
  /// std::invalid_argument for a wrong size.
  void set_flash(std::vector<std::uint16_t> words);

 private:
  void switch_on();
  chip::Chip::Firmware at(std::uint32_t entry);
  chip::Chip::Firmware boot_code();
  bool holds_kernel();

  void on_pwm_pins(Tick, int, bool a, bool b) override { driven_ += a || b ? 1 : 0; }
  std::uint16_t adc_sample(Tick, int) override { return 0; }
  bool pin_level(Tick t, int pin) override;
  void on_output_pin(Tick, int, bool) override { ++driven_; }
  std::int64_t encoder_edges(Tick) override { return 0; }
  Tick serial_reaches(Tick t, bool level) override { return serial_.reaches(t, level); }
  void on_serial_frame(Tick, const chip::SerialFrame& frame) override { serial_.receive(frame); }
  Tick next_call() const override { return chip::kNever; }
  void call(Tick) override {}

  FirmwareLease lease_;
  LoadedProgram kernel_;
  BootMode jumpers_ = BootMode::kFlash;
  Running running_ = Running::kBootRom;
  devices::SerialLine serial_;
  std::uint64_t driven_ = 0;
  Tick off_ = 0;  // board time at which the chip was switched on
  std::unique_ptr<chip::Chip> chip_;
};

}  // namespace stillspin::bench

#endif
