// The 64-bit group on ACC:P, the shifts of ACC, AH and AL, and the normalisation.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

constexpr std::uint64_t kMost64 = 0x7FFFFFFFFFFFFFFF;
constexpr std::uint64_t kLeast64 = 0x8000000000000000;

// C is the last bit that leaves, and is cleared where none does.
template <typename Word>
Word left(Registers& r, Word value, unsigned shift) {
  constexpr unsigned width = 8 * sizeof(Word);
  r.c = shift != 0 && (value >> (width - shift) & 1U) != 0;
  return shift >= width ? Word{0} : static_cast<Word>(value << shift);
}
template <typename Word>
Word right(Registers& r, Word value, unsigned shift, bool arithmetic) {
  constexpr unsigned width = 8 * sizeof(Word);
  r.c = shift != 0 && (value >> (shift - 1) & 1U) != 0;
  const bool fill = arithmetic && value >> (width - 1) != 0;
  if (shift == 0) return value;
  const Word ones = fill ? static_cast<Word>(~Word{0}) : Word{0};
  if (shift >= width) return ones;
  return static_cast<Word>(static_cast<Word>(value >> shift) | static_cast<Word>(ones << (width - shift)));
}

void set_acc(Registers& r, std::uint32_t value) {
  r.acc = value;
  set_nz32(r, value);
}
void set_ax(Registers& r, const Instruction& i, std::uint16_t value) {
  r.set_ax(i.high, value);
  set_nz16(r, value);
}
void set_wide(Registers& r, std::uint64_t value) {
  set_acc_p(r, value);
  set_nz64(r, value);
}

}  // namespace

void lsl_acc(Core& core, const Instruction& i) { set_acc(core.r, left(core.r, core.r.acc, i.shift)); }
void lsl_acc_t(Core& core, const Instruction&) { set_acc(core.r, left(core.r, core.r.acc, core.r.t() & 0xFU)); }
void lsll_t(Core& core, const Instruction&) { set_acc(core.r, left(core.r, core.r.acc, core.r.t() & 0x1FU)); }
void sfr(Core& core, const Instruction& i) { set_acc(core.r, right(core.r, core.r.acc, i.shift, core.r.sxm)); }
void sfr_t(Core& core, const Instruction&) {
  set_acc(core.r, right(core.r, core.r.acc, core.r.t() & 0xFU, core.r.sxm));
}
void asrl_t(Core& core, const Instruction&) { set_acc(core.r, right(core.r, core.r.acc, core.r.t() & 0x1FU, true)); }
void lsrl_t(Core& core, const Instruction&) { set_acc(core.r, right(core.r, core.r.acc, core.r.t() & 0x1FU, false)); }
void rol(Core& core, const Instruction&) {
  const std::uint32_t in = core.r.c ? 1U : 0U;
  core.r.c = core.r.acc >> 31 != 0;
  set_acc(core.r, core.r.acc << 1 | in);
}
void ror(Core& core, const Instruction&) {
  const std::uint32_t in = core.r.c ? kLeast : 0U;
  core.r.c = (core.r.acc & 1U) != 0;
  set_acc(core.r, core.r.acc >> 1 | in);
}

void lsl_ax(Core& core, const Instruction& i) { set_ax(core.r, i, left(core.r, core.r.ax(i.high), i.shift)); }
void lsr_ax(Core& core, const Instruction& i) { set_ax(core.r, i, right(core.r, core.r.ax(i.high), i.shift, false)); }
void asr_ax(Core& core, const Instruction& i) { set_ax(core.r, i, right(core.r, core.r.ax(i.high), i.shift, true)); }
void lsl_ax_t(Core& core, const Instruction& i) {
  set_ax(core.r, i, left(core.r, core.r.ax(i.high), core.r.t() & 0xFU));
}
void lsr_ax_t(Core& core, const Instruction& i) {
  set_ax(core.r, i, right(core.r, core.r.ax(i.high), core.r.t() & 0xFU, false));
}
void asr_ax_t(Core& core, const Instruction& i) {
  set_ax(core.r, i, right(core.r, core.r.ax(i.high), core.r.t() & 0xFU, true));
}

void lsl64(Core& core, const Instruction& i) { set_wide(core.r, left(core.r, acc_p(core.r), i.shift)); }
void lsr64(Core& core, const Instruction& i) { set_wide(core.r, right(core.r, acc_p(core.r), i.shift, false)); }
void asr64(Core& core, const Instruction& i) { set_wide(core.r, right(core.r, acc_p(core.r), i.shift, true)); }
void lsl64_t(Core& core, const Instruction&) { set_wide(core.r, left(core.r, acc_p(core.r), core.r.t() & 0x3FU)); }
void lsr64_t(Core& core, const Instruction&) {
  set_wide(core.r, right(core.r, acc_p(core.r), core.r.t() & 0x3FU, false));
}
void asr64_t(Core& core, const Instruction&) {
  set_wide(core.r, right(core.r, acc_p(core.r), core.r.t() & 0x3FU, true));
}

// After an overflow the sign is the opposite of the one that is seen. V is cleared.
void cmp64(Core& core, const Instruction&) {
  const std::uint64_t value = acc_p(core.r);
  core.r.n = (value >> 63 != 0) != core.r.v;
  core.r.z = value == 0;
  core.r.v = false;
}
void neg64(Core& core, const Instruction&) {
  Registers& r = core.r;
  const std::uint64_t value = acc_p(r);
  const bool overflows = value == kLeast64;
  r.c = value == 0;
  if (overflows) r.v = true;
  set_wide(r, overflows && r.ovm ? kMost64 : 0U - value);
}
void sat64(Core& core, const Instruction&) {
  Registers& r = core.r;
  r.v = r.ovc != 0;
  const std::uint64_t value = r.ovc > 0 ? kMost64 : r.ovc < 0 ? kLeast64 : acc_p(r);
  r.ovc = 0;
  r.c = false;
  set_wide(r, value);
}

// The count of sign bits but one; TC is the sign.
void csb(Core& core, const Instruction&) {
  const std::uint32_t folded = core.r.acc >> 31 != 0 ? ~core.r.acc : core.r.acc;
  unsigned same = 0;
  while (same < 31 && (folded >> (30 - same) & 1U) == 0) ++same;
  core.r.set_t(static_cast<std::uint16_t>(same));
  core.r.tc = core.r.acc >> 31 != 0;
  set_nz32(core.r, core.r.acc);
}

namespace {

// One step left while both upper bits are the same; TC says that there is nothing more to do.
void normalise(Core& core, std::uint32_t& pointer, unsigned kind) {
  Registers& r = core.r;
  const bool steps = r.acc != 0 && ((r.acc ^ r.acc << 1) >> 31) == 0;
  r.tc = !steps;
  if (steps) {
    r.acc <<= 1;
    core.step_pointer(kind, pointer, 1);
  }
  set_nz32(r, r.acc);
}

}  // namespace

void norm_ind(Core& core, const Instruction& i) { normalise(core, core.r.xar[core.r.arp], i.shift); }
void norm_xar(Core& core, const Instruction& i) { normalise(core, core.r.xar[i.reg], i.shift); }

}  // namespace stillspin::c28x::operations
