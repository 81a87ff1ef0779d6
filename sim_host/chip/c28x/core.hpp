// The C28x core, object mode 1 and address mode 0: it executes machine code word by word on memory behind a Bus.
//
// It follows TI's description of the instruction set (SPRU430F), one instruction after another: an instruction sees
// everything that the one before it did, which the hardware's protected pipeline guarantees for registers and memory.
// What that protection, the memories and the fetches cost is added to the cycles that the table has (timing.hpp).

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_CORE_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_CORE_HPP

#include <cstdint>
#include <memory>
#include <vector>

#include "sim_host/chip/c28x/instruction.hpp"
#include "sim_host/chip/c28x/mapped_memory.hpp"
#include "sim_host/chip/c28x/profile.hpp"
#include "sim_host/chip/c28x/registers.hpp"
#include "sim_host/chip/c28x/timing.hpp"
#include "sim_host/chip/c28x/watch.hpp"

namespace stillspin::c28x {

enum class Stop : std::uint8_t {
  kNone,        // the cycles are used up
  kIdle,        // IDLE, and no enabled interrupt is there
  kBreakpoint,  // ESTOP0, where breakpoints stop the core, or the watch; the program counter is at the instruction
  kUnmodelled   // AMODE was set: location fields mean what is not modelled
};

enum Vector : unsigned { kVectorNmi = 18, kVectorIllegal = 19 };

class Core : public MappedMemory, public Timing {
 public:
  explicit Core(Bus& bus);

  /// Registers as after a reset, the program counter from the reset vector.
  void reset();
  /// Executes until `cycles` reaches `until` or something stops it. What was begun is finished, RPT with its repeats.
  Stop run(std::uint64_t until);
  /// Notes from now on where cycles are spent; entries of interrupts are the bus's to note.
  void take_profile() { profile_ = std::make_unique<Profile>(); }
  /// What was noted, nullptr for nothing.
  Profile* profile() const { return profile_.get(); }
  /// Where to stop and what to trace; it costs time from the first call on.
  Watch& watch() {
    if (watch_ == nullptr) watch_ = std::make_unique<Watch>();
    return *watch_;
  }

  /// Stops where it is told to no longer.
  void stop_nowhere() {
    watch().stop_nowhere();
    watches_data_ = false;
  }
  /// Stops behind the instruction that reads or writes this word (Watch::kRead, kWrite or both).
  void stop_on(std::uint32_t address, std::uint8_t kinds) {
    watch().stop_on(address, readable_word(address), kinds);
    watches_data_ = true;
  }

  /// The address of the instruction that is being executed, for the bus; at the entry into an interrupt, and in a jump
  /// that goes on elsewhere, the program counter may be all that is known.
  std::uint32_t executing() const;
  /// Ends `run` after the instruction that is being executed; for the bus.
  void yield() { until_ = 0; }
  /// One instruction, or the entry into one interrupt.
  Stop step() { return run(cycles + 1); }

  /// A request of CPU interrupt 1..16 (INT1..INT14, DLOGINT, RTOSINT).
  void request(unsigned interrupt) { r.ifr = static_cast<std::uint16_t>(r.ifr | 1U << (interrupt - 1)); }
  void request_nmi() { nmi_ = true; }

  /// From a request to the first instruction, without waits of memories; 8 of them are the CPU's own, to save its
  /// context.
  void set_interrupt_cycles(std::uint32_t count) { interrupt_cycles_ = count; }
  void set_stop_at_breakpoint(bool stop) { stop_at_breakpoint_ = stop; }
  /// With that also before what is no instruction traps.
  void set_stop_at_illegal(bool stop) { stop_at_illegal_ = stop; }
  bool stops_at_illegal() const { return stop_at_illegal_; }

  Registers r;
  std::uint64_t instructions = 0;
  /// How often each form was executed, in the order of kForms; repeats count as one.
  std::vector<std::uint32_t> executed;

  // --- for the operations ------------------------------------------------------------------------------------------

  /// Where a location is: an address, or kInRegister with the code of a register. The pointer is stepped.
  static constexpr std::uint32_t kInRegister = 0x80000000;
  std::uint16_t read16(std::uint32_t address) {
    note_read(address, 1);
    if (watches_data_) note_access(address, 1, Watch::kRead);
    return MappedMemory::read16(address);
  }
  std::uint32_t read32(std::uint32_t address) {
    note_read(address & ~1U, 2);
    if (watches_data_) note_access(address & ~1U, 2, Watch::kRead);
    return MappedMemory::read32(address);
  }
  void write16(std::uint32_t address, std::uint16_t value) {
    note_write(address, 1);
    if (watches_data_) note_access(address, 1, Watch::kWrite);
    MappedMemory::write16(address, value);
  }
  void write32(std::uint32_t address, std::uint32_t value) {
    note_write(address & ~1U, 2);
    if (watches_data_) note_access(address & ~1U, 2, Watch::kWrite);
    MappedMemory::write32(address, value);
  }
  std::uint32_t locate(unsigned loc, unsigned step);
  /// Of the byte moves: an address, and whether the upper byte is meant.
  struct BytePlace {
    std::uint32_t place;
    bool upper;
  };
  BytePlace locate_byte(unsigned loc);
  std::uint16_t load16(std::uint32_t place) {
    return (place & kInRegister) == 0 ? read16(place) : register16(place & 0xF);
  }
  void store16(std::uint32_t place, std::uint16_t value) {
    if ((place & kInRegister) == 0) return write16(place, value);
    set_register16(place & 0xF, value);
  }
  std::uint32_t load32(std::uint32_t place) {
    return (place & kInRegister) == 0 ? read32(place) : *register32(place & 0xF);
  }
  void store32(std::uint32_t place, std::uint32_t value) {
    if ((place & kInRegister) == 0) return write32(place, value);
    *register32(place & 0xF) = value;
  }
  std::uint16_t loc16(const Instruction& i) { return load16(locate(i.loc, 1)); }
  std::uint32_t loc32(const Instruction& i) { return load32(locate(i.loc, 2)); }

  /// What *, *++, *--, *0++ and *0-- (0..4) do to the auxiliary register that ARP selects.
  void step_pointer(unsigned kind, std::uint32_t& pointer, unsigned step) const;

  bool holds(unsigned condition);
  void jump(std::uint32_t address) {
    r.pc = address & kProgramMask;
    jump_to(r.pc);
  }
  void not_taken(const Instruction& i) { cycles -= i.cycles - i.cycles_not_taken; }

  void push16(std::uint16_t value) { write16(r.sp++, value); }
  std::uint16_t pop16() { return read16(--r.sp); }
  void push32(std::uint32_t value);
  std::uint32_t pop32();

  /// RPT: the next instruction `count` times more, without an interrupt between; once if it is not repeatable.
  void repeat(std::uint32_t count);
  /// How many times the instruction was repeated before: addresses in program memory advance by it.
  std::uint32_t repeats_done = 0;

  void take_interrupt(unsigned vector);
  /// The instruction is none: what led to it can be looked at (Watch::traced).
  void note_trap(const Instruction& i);
  void return_from_interrupt();
  void wait_for_interrupt() { idle_ = r.idlestat = true; }
  /// Whether it stops here, where a debugger wants that.
  bool breakpoint(const Instruction& i);
  void stop_unmodelled() { stop_ = Stop::kUnmodelled; }

 private:
  std::uint16_t register16(unsigned code) const;
  void set_register16(unsigned code, std::uint16_t value);
  std::uint32_t* register32(unsigned code);
  std::uint32_t locate_indirect(unsigned loc, unsigned step);
  const Instruction& fetch(std::uint32_t address);
  void execute(const Instruction& i);
  void carry_out(const Instruction& i);
  bool serve_interrupts();
  void note_access(std::uint32_t address, std::uint32_t words, std::uint8_t kind);
  void enter_interrupt(unsigned vector);

  static constexpr std::uint32_t kDecoded = 1U << 14;

  Spent spent() const { return {cycles, waits.registers, waits.data, waits.fetch}; }

  std::unique_ptr<Profile> profile_;
  Spent repeated_;  // of what RPT repeats, noted apart from it
  bool is_repeated_ = false;
  std::unique_ptr<Watch> watch_;
  std::uint64_t until_ = 0;
  std::uint32_t interrupt_cycles_ = 8;
  bool idle_ = false;
  bool nmi_ = false;
  bool stop_at_breakpoint_ = false;
  bool stop_at_illegal_ = false;
  bool watches_data_ = false;
  Stop stop_ = Stop::kNone;
  std::vector<Instruction>
      decoded_;  // by the lowest bits of the address, each checked against the words that are there
};

}  // namespace stillspin::c28x

#endif
