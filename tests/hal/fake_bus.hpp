// A register bus that remembers what the drivers did, in order: the target_ functions without a chip behind them.
//
// Registers keep what is written. Only what a driver waits for or reads back behaves: the PLL locks, CPU timer 2
// counts, trip flags follow TZFRC and TZCLR. Two rules of the chip are watched at every write: protected registers need
// EALLOW, peripherals need their clock.

#ifndef STILLSPIN_TESTS_HAL_FAKE_BUS_HPP
#define STILLSPIN_TESTS_HAL_FAKE_BUS_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "hal/f2808/target.h"

namespace stillspin::test {

enum class Op {
  kWrite,
  kRead,
  kEallow,
  kEdis,
  kEnableInterrupts,
  kDisableInterrupts,
  kWriteIer,
  kClearIfr,
  kSetVector,
  kIdle
};

struct Step {
  Op op;
  std::uint32_t address;  // or the vector number
  std::uint32_t value;
};

class FakeBus {
 public:
  /// The bus that the target_ functions act on: the one made last.
  static FakeBus& current();

  FakeBus();
  ~FakeBus();
  FakeBus(const FakeBus&) = delete;
  FakeBus& operator=(const FakeBus&) = delete;

  std::map<std::uint32_t, std::uint16_t> words;  // by address; absent reads 0
  std::vector<Step> steps;
  std::vector<std::string> violations;  // broken rules, in words
  std::map<std::uint16_t, target_isr_t> vectors;
  bool protection_lifted = false;
  std::uint16_t ier = 0;
  std::uint64_t cycles = 0;
  bool pll_locks = true;
  std::function<void()> between;                       // comes behind every write, as an interrupt would
  std::function<std::uint16_t(std::uint16_t)> spoils;  // what becomes of a word that is read

  /// Marks everything clocked, as after hal_clock_init, and forgets the steps.
  void power_all();
  void forget_steps() { steps.clear(); }

  std::uint32_t word32(std::uint32_t address) const;
  void set32(std::uint32_t address, std::uint32_t value);

  /// What was written to the address, in turn.
  std::vector<std::uint32_t> written(std::uint32_t address) const;

  /// Index of the first or last step that writes the address (with these bits set); npos if there is none.
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  std::size_t first_write(std::uint32_t address, std::uint32_t bits = 0) const;
  std::size_t last_write(std::uint32_t address) const;
  /// And of the first one, from a step on, that reads it.
  std::size_t first_read(std::uint32_t address, std::size_t from = 0) const;
  std::size_t first(Op op) const;
  std::size_t count_writes() const;
  std::size_t last_write_of_all() const;

  std::uint16_t read16(std::uint32_t address);
  void write16(std::uint32_t address, std::uint16_t value);
  void record(Op op, std::uint32_t address, std::uint32_t value) { steps.push_back(Step{op, address, value}); }

 private:
  void watch_rules(std::uint32_t address);
  void behave(std::uint32_t address, std::uint16_t value);

  FakeBus* previous_;
};

}  // namespace stillspin::test

#endif
