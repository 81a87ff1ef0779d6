// 16-bit arithmetic and logic on AH, AL and locations, bits of locations, and the steps of pointers by constants.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

std::uint16_t word(unsigned value) { return static_cast<std::uint16_t>(value); }

void set_ax(Core& core, const Instruction& i, std::uint16_t value) {
  core.r.set_ax(i.high, value);
  set_nz16(core.r, value);
}
std::uint16_t ax(const Core& core, const Instruction& i) { return core.r.ax(i.high); }

// A location is found once: its pointer steps once.
template <typename Change>
void change(Core& core, const Instruction& i, Change&& value_of) {
  const std::uint32_t place = core.locate(i.loc, 1);
  core.store16(place, value_of(core.load16(place)));
}
std::uint16_t flagged(Core& core, unsigned value) {
  set_nz16(core.r, word(value));
  return word(value);
}

// C is the borrow of the words; N and Z are those of the exact difference.
void compare16(Core& core, std::uint16_t a, std::uint16_t b) {
  core.r.c = a >= b;
  compare(core.r, static_cast<std::int16_t>(a), static_cast<std::int16_t>(b));
}

}  // namespace

void add_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  core.r.set_ax(i.high, add16(core.r, ax(core, i), value));
}
void sub_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  core.r.set_ax(i.high, subtract16(core.r, ax(core, i), value));
}
void addb_ax(Core& core, const Instruction& i) {
  core.r.set_ax(i.high, add16(core.r, ax(core, i), low_half(i.constant)));
}
void add_loc16_ax(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return add16(core.r, value, ax(core, i)); });
}
void sub_loc16_ax(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return subtract16(core.r, value, ax(core, i)); });
}
void subr(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return subtract16(core.r, ax(core, i), value); });
}
void add_loc16_const(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return add16(core.r, value, low_half(i.constant)); });
}
void inc(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return add16(core.r, value, 1); });
}
void dec(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return subtract16(core.r, value, 1); });
}

void cmp_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  compare16(core, ax(core, i), value);
}
void cmp_loc16_const(Core& core, const Instruction& i) { compare16(core, core.loc16(i), low_half(i.constant)); }
void cmpb(Core& core, const Instruction& i) { compare16(core, ax(core, i), low_half(i.constant)); }

void max_ax(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  compare(core.r, static_cast<std::int16_t>(ax(core, i)), static_cast<std::int16_t>(value));
  if (!core.r.n) return;
  core.r.set_ax(i.high, value);
  core.r.v = true;
}
void min_ax(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  compare(core.r, static_cast<std::int16_t>(ax(core, i)), static_cast<std::int16_t>(value));
  if (core.r.n || core.r.z) return;
  core.r.set_ax(i.high, value);
  core.r.v = true;
}

void and_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  set_ax(core, i, word(ax(core, i) & value));
}
void or_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  set_ax(core, i, word(ax(core, i) | value));
}
void xor_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  set_ax(core, i, word(ax(core, i) ^ value));
}
void and_ax_loc16_const(Core& core, const Instruction& i) { set_ax(core, i, word(core.loc16(i) & i.constant)); }
void andb(Core& core, const Instruction& i) { set_ax(core, i, word(ax(core, i) & i.constant)); }
void orb(Core& core, const Instruction& i) { set_ax(core, i, word(ax(core, i) | i.constant)); }
void xorb(Core& core, const Instruction& i) { set_ax(core, i, word(ax(core, i) ^ i.constant)); }
void and_loc16_ax(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return flagged(core, value & ax(core, i)); });
}
void or_loc16_ax(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return flagged(core, value | ax(core, i)); });
}
void xor_loc16_ax(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return flagged(core, value ^ ax(core, i)); });
}
void and_loc16_const(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return flagged(core, value & i.constant); });
}
void or_loc16_const(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return flagged(core, value | i.constant); });
}
void xor_loc16_const(Core& core, const Instruction& i) {
  change(core, i, [&](std::uint16_t value) { return flagged(core, value ^ i.constant); });
}

void not_ax(Core& core, const Instruction& i) { set_ax(core, i, word(~static_cast<unsigned>(ax(core, i)))); }
void neg_ax(Core& core, const Instruction& i) {
  const std::uint16_t value = ax(core, i);
  core.r.c = value == 0;
  if (value == 0x8000) core.r.v = true;
  set_ax(core, i, word(0U - value));
}
void flip(Core& core, const Instruction& i) {
  unsigned turned = 0;
  for (unsigned k = 0; k < 16; ++k) turned |= (ax(core, i) >> k & 1U) << (15 - k);
  set_ax(core, i, word(turned));
}

void tbit(Core& core, const Instruction& i) { core.r.tc = (core.loc16(i) >> i.bit & 1U) != 0; }
// T counts from the upper end.
void tbit_t(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  core.r.tc = (value >> (15U - (core.r.t() & 0xFU)) & 1U) != 0;
}

namespace {

// Of the bits of locations N and Z are set only where the location is AH or AL.
bool is_ax(const Instruction& i) { return i.loc == 0xA8 || i.loc == 0xA9; }

void change_bit(Core& core, const Instruction& i, bool set) {
  change(core, i, [&](std::uint16_t value) {
    const unsigned mask = 1U << i.bit;
    core.r.tc = (value & mask) != 0;
    const std::uint16_t result = word(set ? value | mask : value & ~mask);
    if (is_ax(i)) set_nz16(core.r, result);
    return result;
  });
}

}  // namespace

void tset(Core& core, const Instruction& i) { change_bit(core, i, true); }
void tclr(Core& core, const Instruction& i) { change_bit(core, i, false); }

void addb_sp(Core& core, const Instruction& i) { core.r.sp = word(core.r.sp + i.constant); }
void subb_sp(Core& core, const Instruction& i) { core.r.sp = word(core.r.sp - i.constant); }
void addb_xar(Core& core, const Instruction& i) { core.r.xar[i.reg] += i.constant; }
void subb_xar(Core& core, const Instruction& i) { core.r.xar[i.reg] -= i.constant; }
void adrk(Core& core, const Instruction& i) { core.r.xar[core.r.arp] += i.constant; }
void sbrk(Core& core, const Instruction& i) { core.r.xar[core.r.arp] -= i.constant; }
void cmpr(Core& core, const Instruction& i) {
  const std::uint16_t pointer = core.r.ar(core.r.arp);
  const std::uint16_t other = core.r.ar(0);
  const bool answers[] = {pointer == other, pointer<other, pointer> other, pointer != other};
  core.r.tc = answers[i.shift];
}

}  // namespace stillspin::c28x::operations
