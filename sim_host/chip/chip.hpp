// The virtual TMS320F2808: runs the unchanged firmware against models of the peripherals it uses.
//
// Firmware runs on a stack of its own, up to an exact tick, and reaches the chip through the target_* functions of
// hal/f2808/target.h. Time passes only in those: every register access costs cycles, events (PWM edges, conversions,
// timers, the world's own) run in order at their exact ticks, and interrupts are taken after an access, in target_idle,
// in target_elapse and at the return from an interrupt.
//
//     Chip chip(world, firmware_main);
//     chip.run_until(50'000'000);            // half a second
//     chip.statistics().interrupts;
//
// Exactness: run_until(t) runs every event and every access up to and including t and leaves now() == t. How a run is
// cut into calls does not change it. Start: tick 0 is the moment the boot ROM would jump to the flash entry point. A
// watchdog reset discards the firmware's stack and enters firmware_main again; C variables keep their values, so
// firmware must initialise what it relies on (the DSP's start-up code does not zero them either). Threads: a chip is
// used by one thread at a time. The world's callbacks run on the firmware's stack (1 MiB), may throw C++ exceptions
// (run_until passes them on), and must not call run_until. Errors: what the real chip could not survive (an unset
// interrupt vector, an impossible PLL ratio) ends the run: run_until throws std::runtime_error, then and at every later
// call.

#ifndef STILLSPIN_SIM_HOST_CHIP_CHIP_HPP
#define STILLSPIN_SIM_HOST_CHIP_CHIP_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/chip/code_flash_library.hpp"
#include "sim_host/chip/in_vain.hpp"
#include "sim_host/chip/recording.hpp"
#include "sim_host/chip/world.hpp"

namespace stillspin::c28x {
class Core;
}

namespace stillspin::chip {

class Core;
class Memory;

/// Words from an address on.
using CodeBlocks = std::vector<std::pair<std::uint32_t, std::vector<std::uint16_t>>>;

/// What happened since power-on. Lost writes are firmware mistakes that the real chip hides.
struct Statistics {
  std::uint64_t reads = 0;  // register accesses by the firmware
  std::uint64_t writes = 0;
  std::uint64_t events = 0;
  std::uint64_t interrupts = 0;
  std::uint64_t spurious_interrupts = 0;    // the request had been withdrawn: channel 1 of its group ran
  std::uint64_t protected_writes_lost = 0;  // written without EALLOW
  std::uint32_t last_protected_address = 0;
  std::uint64_t gated_accesses = 0;  // peripheral clock off: reads gave 0, writes were lost
  std::uint32_t last_gated_address = 0;
  std::uint64_t unmodelled_accesses = 0;  // no register of the model there
  std::uint32_t last_unmodelled_address = 0;
  std::uint64_t resets = 0;  // after power-on
  Tick idle_ticks = 0;       // asleep in target_idle

  std::uint64_t conversions = 0;          // ADC sequences completed
  std::uint64_t conversions_delayed = 0;  // the trigger found the converter busy and waited
  std::uint64_t conversions_lost = 0;     // the trigger found another one waiting
  std::uint64_t conversions_aborted = 0;  // ended by a sequencer reset

  std::uint64_t narrow_can_accesses = 0;  // to control registers that take 32-bit accesses only
};

/// How a program may fail.
enum class Failure {
  kNone,
  kBackgroundHangs,     // below the interrupts, which are still taken
  kInterruptHangs,      // one that runs then or comes next does not return
  kIllegalInstruction,  // below the interrupts; that of the instruction leads back to it, over and over
  kHalted  // by a debugger: both levels and the watchdog stand, and the PWM's counters as FREE_SOFT = 0 has it
};

class Chip {
 public:
  using Firmware = void (*)();
  using Jump = std::function<Firmware(std::uint32_t entry)>;

  /// `firmware` is the image's entry; it must not return. The world must outlive the chip.
  Chip(World& world, Firmware firmware);
  ~Chip();
  Chip(const Chip&) = delete;
  Chip& operator=(const Chip&) = delete;

  void run_until(Tick t);
  Tick now() const;

  Statistics statistics() const;

  /// What ended the run, empty while all is well.
  const std::string& error() const;

  /// A level that pin_level() gives may have changed: the chip looks at its trip inputs again, in the tick in which a
  /// callback of the world says so. After World::call it looks anyway.
  void pins_changed();

  /// The silicon's revision; 0, A, B, C are 0 to 3, and C it is at first. Erratum of those before C: in simultaneous
  /// sampling ADCINBn reads high by ADCINAn / 256.
  void set_revision(std::uint16_t revision);

  /// Erratum: eCAN-A sends nothing from now on, until its CCR bit has been set and cleared.
  void stop_can_transmission();

  /// Faults. The ADC does not see the ePWM's triggers; the CPU takes no interrupt, as while other code masks them.
  void block_adc_triggers(bool on);
  void hold_interrupts(bool on);

  /// The program fails at the next place where its code takes time; a reset ends it.
  void fail(Failure failure);

  /// Whether the CPU is asleep in target_idle.
  bool is_idle() const;

  /// For a chip whose firmware is boot_rom: what runs natively in place of the code at an address, which cannot.
  /// Without an answer (nullptr) the run ends, unless code is executed.
  void on_jump(Jump jump);

  /// For a chip whose firmware is boot_rom: the code that is in its memory is executed by a C28x core, where nothing
  /// runs in its place. The core is there to be looked at and stopped; the chip runs it. Where its watch stops it,
  /// run_until returns early, now() being the time of the instruction that comes next; the next call goes on.
  c28x::Core& execute_code();
  /// Where the program has TI's flash library, the model's cells do what it would.
  void replace_flash_library(const FlashLibrary& places);
  /// From the first call on what the converter sees and what is written to the ePWM modules is noted; codes that are
  /// given to it go to the converter.
  Recording& recording();
  /// A request as if the vector's peripheral had made it; std::invalid_argument for a vector that has no line.
  void raise_interrupt(unsigned vector);
  /// Words by address into flash and RAM; std::invalid_argument where there is none.
  void load(const CodeBlocks& blocks);
  /// The same into the boot ROM, of which the model has nothing but the loaders and the vectors.
  void load_rom(const CodeBlocks& blocks);
  /// For a chip that executes code: what the program accessed in vain.
  const InVain& in_vain() const;

  /// RAM, security, and the flash, whose cells outlive resets.
  Memory& memory();

  /// A register's content without an access: no time passes, protection and gates apply. For tests and inspection.
  std::uint16_t inspect(std::uint32_t address);

 private:
  std::unique_ptr<Core> core_;
};

}  // namespace stillspin::chip

#endif
