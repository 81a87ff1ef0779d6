// A decoded instruction, the form it is of, and the decoder. The forms are made from instructions.csv at build time
// (toolchain/c28x_table.py), so that the decoder, the assembler and the disassembler have one table.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_INSTRUCTION_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_INSTRUCTION_HPP

#include <cstddef>
#include <cstdint>

namespace stillspin::c28x {

class Core;
struct Instruction;
using Operation = void (*)(Core&, const Instruction&);

/// Where a field is in the one or two words of a form, which are read as one number.
struct Field {
  std::uint8_t shift = 0;
  std::uint8_t width = 0;  // 0: the form has no such field
};

/// When a form needs and changes the registers of addresses (stillspin/c28x/pipeline.py): masks, and what of its fields
/// counts.
struct Phases {
  std::uint16_t early;
  std::uint16_t late;
  bool early_reg;
  bool late_reg;
  bool location_early;
  bool location_late;
};

struct Form {
  const char* syntax;
  std::uint32_t opcode;
  std::uint32_t mask;
  Operation run;
  std::uint8_t words;
  bool repeatable;
  std::uint8_t cycles;            // of one execution, of a branch that is taken
  std::uint8_t cycles_not_taken;  // the same as `cycles` for what is no branch
  std::uint8_t loc_bits;          // 16 or 32, 0 without a location
  bool memory_only;               // a register is no operand of it
  bool signed_constant;
  std::uint8_t shift_bias;  // a field of #1..16 has one less
  Field loc, ax, reg, reg2, constant, shift, condition, bit;
  // What a form has instead of a field.
  std::uint8_t fixed_loc, fixed_reg, fixed_shift, fixed_condition, fixed_constant;
  Phases phases;
};

extern const Form kForms[];
extern const std::size_t kFormCount;

struct Instruction {
  Operation run = nullptr;
  std::uint32_t address = 0xFFFFFFFF;
  std::uint32_t constant = 0;
  std::uint16_t form = 0;
  std::uint16_t word0 = 0;
  std::uint16_t word1 = 0;
  std::uint8_t words = 1;
  std::uint8_t loc = 0;
  std::uint8_t reg = 0;
  std::uint8_t reg2 = 0;
  std::uint8_t shift = 0;
  std::uint8_t condition = 0;
  std::uint8_t bit = 0;
  bool high = false;  // AH rather than AL
  bool repeatable = false;
  std::uint8_t cycles = 1;
  std::uint8_t cycles_not_taken = 1;
  std::uint16_t early = 0;  // registers that its address needs, kUses...
  std::uint16_t late = 0;   // those that it changes at the end of its execution
};

/// Bits of the masks of registers; 0 to 7 are XAR0 to XAR7.
constexpr std::uint16_t kUsesSp = 1U << 8;
constexpr std::uint16_t kUsesDp = 1U << 9;
/// The one that ARP selects; the bits of all are set beside it.
constexpr std::uint16_t kUsesCurrent = 1U << 15;

/// `form` of an instruction that is none: its operation is the illegal-instruction trap.
constexpr std::uint16_t kNoForm = 0xFFFF;

/// Of several forms that fit, the one with the most fixed bits is meant. The second word is looked at only where the
/// first one leaves the choice open or has its operands there.
Instruction decode(std::uint32_t address, std::uint16_t word0, std::uint16_t word1);

}  // namespace stillspin::c28x

#endif
