#include <algorithm>
#include <array>
#include <bitset>
#include <vector>

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/instruction.hpp"

namespace stillspin::c28x {
namespace {

constexpr unsigned kFirstWords = 0x10000;

std::uint16_t first_word(std::uint32_t bits, unsigned words) {
  return static_cast<std::uint16_t>(words == 2 ? bits >> 16 : bits);
}

// The forms that each first word leaves open, those with the most fixed bits first.
class Candidates {
 public:
  Candidates() {
    std::vector<std::uint16_t> order(kFormCount);
    for (std::size_t k = 0; k < kFormCount; ++k) order[k] = static_cast<std::uint16_t>(k);
    std::stable_sort(order.begin(), order.end(), [](std::uint16_t a, std::uint16_t b) { return fixed(a) > fixed(b); });
    std::vector<std::vector<std::uint16_t>> open(kFirstWords);
    for (const std::uint16_t form : order) {
      const std::uint16_t value = first_word(kForms[form].opcode, kForms[form].words);
      const std::uint16_t free = static_cast<std::uint16_t>(~first_word(kForms[form].mask, kForms[form].words));
      std::uint16_t bits = 0;
      do {  // every pattern of the free bits
        open[value | bits].push_back(form);
        bits = static_cast<std::uint16_t>((bits - free) & free);
      } while (bits != 0);
    }
    for (unsigned word = 0; word < kFirstWords; ++word) {
      begin_[word] = static_cast<std::uint32_t>(forms_.size());
      forms_.insert(forms_.end(), open[word].begin(), open[word].end());
    }
    begin_[kFirstWords] = static_cast<std::uint32_t>(forms_.size());
  }

  std::uint16_t find(std::uint16_t word0, std::uint16_t word1) const {
    const std::uint32_t both = static_cast<std::uint32_t>(word0) << 16 | word1;
    for (std::uint32_t k = begin_[word0]; k < begin_[word0 + 1U]; ++k) {
      const Form& form = kForms[forms_[k]];
      const std::uint32_t bits = form.words == 2 ? both : word0;
      if ((bits & form.mask) == form.opcode) return forms_[k];
    }
    return kNoForm;
  }

 private:
  // A form of one word has sixteen fixed bits more than its mask shows: nothing of the second word can decide.
  static std::size_t fixed(std::uint16_t form) {
    return std::bitset<32>(kForms[form].mask).count() + (kForms[form].words == 1 ? 16 : 0);
  }

  std::array<std::uint32_t, kFirstWords + 1> begin_{};
  std::vector<std::uint16_t> forms_;
};

std::uint32_t value_of(const Field& field, std::uint32_t bits, std::uint32_t otherwise) {
  if (field.width == 0) return otherwise;
  return bits >> field.shift & (0xFFFFFFFFU >> (32U - field.width));
}

// AH, PH and SP have no 32 bits, and the last two codes before the C2xLP modes address memory.
bool is_location(const Form& form, unsigned loc) {
  const bool is_register = loc >= 0xA0 && loc <= 0xAD;
  if (!is_register) return true;
  if (form.memory_only) return false;
  return form.loc_bits == 16 || (loc != 0xA8 && loc != 0xAA && loc != 0xAD);
}

// What a location needs for its address. A register in the place of a location is needed where its form says so.
unsigned needed_by_location(unsigned loc, bool register_too) {
  const unsigned pointer = 1U << (loc & 7U);
  switch (loc >> 3) {
    case 0x10:
    case 0x11:
      return pointer;
    case 0x12:
      return pointer | 1U;
    case 0x13:
      return pointer | 2U;
    case 0x14:
      return register_too ? pointer : 0U;
    default:
      break;
  }
  if (loc < 0x40) return kUsesDp;
  if (loc < 0x80) return kUsesSp;
  if (loc >= 0xC0) return pointer;
  if (loc == 0xBF) return 1U << 6 | 1U << 1;          // *AR6%++
  if (loc == 0xBD || loc == 0xBE) return kUsesSp;     // *SP++, *--SP
  if (loc >= 0xAE) return kUsesCurrent | 0xFFU;       // by ARP, some with the index AR0
  return loc == 0xAD && register_too ? kUsesSp : 0U;  // @SP
}

void note_phases(Instruction& made, const Form& form) {
  const Phases& phases = form.phases;
  unsigned early = phases.early, late = phases.late;
  if (phases.early_reg) early |= 1U << made.reg;
  if (phases.late_reg) late |= 1U << made.reg;
  if (form.reg2.width != 0) early |= 1U << made.reg2;
  const bool has_location = form.loc.width != 0 || form.fixed_loc != 0;
  if (has_location) early |= needed_by_location(made.loc, phases.location_early);
  if (has_location && phases.location_late) {
    if (made.loc >> 3 == 0x14) late |= 1U << (made.loc & 7U);
    if (made.loc == 0xAD) late |= kUsesSp;
  }
  made.early = static_cast<std::uint16_t>(early);
  made.late = static_cast<std::uint16_t>(late);
}

}  // namespace

Instruction decode(std::uint32_t address, std::uint16_t word0, std::uint16_t word1) {
  static const Candidates candidates;
  Instruction made;
  made.address = address;
  made.word0 = word0;
  made.word1 = word1;
  made.form = candidates.find(word0, word1);
  made.run = operations::illegal;
  made.cycles = made.cycles_not_taken = 8;
  if (made.form == kNoForm) return made;
  const Form& form = kForms[made.form];
  const std::uint32_t bits = form.words == 2 ? static_cast<std::uint32_t>(word0) << 16 | word1 : word0;
  made.loc = static_cast<std::uint8_t>(value_of(form.loc, bits, form.fixed_loc));
  if (form.loc.width != 0 && !is_location(form, made.loc)) {
    made.form = kNoForm;
    return made;
  }
  made.run = form.run;
  made.words = form.words;
  made.repeatable = form.repeatable;
  made.cycles = form.cycles;
  made.cycles_not_taken = form.cycles_not_taken;
  made.high = value_of(form.ax, bits, 0) != 0;
  made.reg = static_cast<std::uint8_t>(value_of(form.reg, bits, form.fixed_reg));
  made.reg2 = static_cast<std::uint8_t>(value_of(form.reg2, bits, 0));
  const bool has_shift = form.shift.width != 0;
  made.shift =
      static_cast<std::uint8_t>(has_shift ? value_of(form.shift, bits, 0) + form.shift_bias : form.fixed_shift);
  made.condition = static_cast<std::uint8_t>(value_of(form.condition, bits, form.fixed_condition));
  made.bit = static_cast<std::uint8_t>(value_of(form.bit, bits, 0));
  made.constant = value_of(form.constant, bits, form.fixed_constant);
  if (form.signed_constant && (made.constant >> (form.constant.width - 1U) & 1U) != 0) {
    made.constant |= 0xFFFFFFFFU << form.constant.width;
  }
  note_phases(made, form);
  return made;
}

}  // namespace stillspin::c28x
