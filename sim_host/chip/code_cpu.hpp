// The C28x core in the place of the native firmware: it executes the words that are in the chip's memory.
//
// It runs on the firmware's stack, as the firmware would, and reaches peripherals through the same bus with the same
// waits and gates. RAM and flash it reads by itself. Time is its own: the chip's events are run up to the cycle of an
// access, and at the latest in the instruction in whose time they fall; interrupts are seen between instructions. The
// flash's waits are those of FBANKWAIT and FOPT, an interrupt takes 14 cycles from the flag.
//
// Not modelled: memory that the security module keeps from code that runs elsewhere, stuck bits of RAM, a program that
// is told to fail. Of the boot ROM there are the vectors, and what Memory::load_rom was given.

#ifndef STILLSPIN_SIM_HOST_CHIP_CODE_CPU_HPP
#define STILLSPIN_SIM_HOST_CHIP_CODE_CPU_HPP

#include <array>
#include <cstdint>

#include "sim_host/chip/c28x/core.hpp"
#include "sim_host/chip/code_flash_library.hpp"
#include "sim_host/chip/in_vain.hpp"
#include "sim_host/chip/world.hpp"

namespace stillspin::chip {

class Core;

class CodeCpu final : private c28x::Bus {
 public:
  explicit CodeCpu(Core& chip);
  CodeCpu(const CodeCpu&) = delete;
  CodeCpu& operator=(const CodeCpu&) = delete;

  /// Executes from `entry` on, with the registers as the boot ROM leaves them. Only a reset ends it.
  [[noreturn]] void run(std::uint32_t entry);

  c28x::Core& cpu() { return cpu_; }

  /// Carries out TI's flash library on the chip's cells where the program has it.
  void replace_flash_library(const FlashLibrary& places);

  /// An access of the program for which the chip has neither register nor memory. Fetches are none: what runs there is
  /// told as a program that ran away.
  void note_unmodelled(std::uint32_t address, bool write) {
    if (address - cpu_.r.pc > 1) note(in_vain_.unmodelled, address, write);
  }
  /// A write to a protected register with EALLOW clear, and an access to a peripheral whose clock is off: both are
  /// lost.
  void note_protected(std::uint32_t address) { note(in_vain_.unallowed, address, true); }
  void note_gated(std::uint32_t address) { note(in_vain_.unclocked, address, true); }
  const InVain& in_vain() const { return in_vain_; }

  /// The table of vectors in the PIE's RAM, which is no register of the chip's.
  static bool is_vector(std::uint32_t address) { return address - kVectors < 0x100; }
  std::uint16_t vector_word(std::uint32_t address) const { return vectors_[address - kVectors]; }

 private:
  std::uint16_t read(std::uint32_t address) override;
  void write(std::uint32_t address, std::uint16_t value) override;
  std::uint32_t read_pair(std::uint32_t address) override;
  void write_pair(std::uint32_t address, std::uint32_t value) override;
  std::uint32_t vector(unsigned number, std::uint32_t listed) override;

  void note(Uses& uses, std::uint32_t address, bool write) {
    uses.note(address, write, {cpu_.executing(), cpu_.cycles});
  }

  template <typename Access>
  void at_the_bus(Access access);
  void map();
  void note_flash_waits();
  void settle();
  void collect();
  void sleep();
  void note_passed(Tick begin);
  void halt();
  bool is_in_rom(std::uint32_t address) const;

  static constexpr std::uint32_t kVectors = 0x0D00;

  Core& chip_;
  c28x::Core cpu_;
  FlashLibrary flash_library_;
  std::uint64_t settled_ = 0;  // the cycle at which the chip's time stands
  std::array<std::uint16_t, 256> vectors_{};
  std::array<c28x::Region, 5> ram_;
  c28x::Region flash_, frames_, rom_;
  InVain in_vain_;
};

}  // namespace stillspin::chip

#endif
