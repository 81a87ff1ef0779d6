// Loads and stores. A store sets N and Z only where the location is AH, AL or ACC.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

constexpr std::uint32_t kHighPage = 0x3F0000;  // where programs of the C2xLP are
constexpr unsigned kAh = 0xA8;
constexpr unsigned kAcc = 0xA9;  // AL of a 16-bit location

void set_acc(Core& core, std::uint32_t value) {
  core.r.acc = value;
  set_nz32(core.r, value);
}
void store(Core& core, const Instruction& i, std::uint16_t value) {
  core.store16(core.locate(i.loc, 1), value);
  if (i.loc == kAh || i.loc == kAcc) set_nz16(core.r, value);
}
void store_long(Core& core, const Instruction& i, std::uint32_t value) {
  core.store32(core.locate(i.loc, 2), value);
  if (i.loc == kAcc) set_nz32(core.r, value);
}
// The pointer of a conditional store steps whether it stores or not.
void store_if(Core& core, const Instruction& i, std::uint16_t value) {
  const std::uint32_t place = core.locate(i.loc, 1);
  if (!core.holds(i.condition)) return;
  core.store16(place, value);
  if (i.loc == kAh || i.loc == kAcc) set_nz16(core.r, value);
}
// Reading the register comes before the pointer of its location steps.
std::uint32_t shifted_acc(const Core& core, const Instruction& i) { return core.r.acc << i.shift; }

}  // namespace

void mov_acc_const(Core& core, const Instruction& i) {
  set_acc(core, extended(core.r, low_half(i.constant)) << i.shift);
}
void mov_acc_loc16(Core& core, const Instruction& i) { set_acc(core, extended(core.r, core.loc16(i)) << i.shift); }
void mov_acc_loc16_t(Core& core, const Instruction& i) {
  const unsigned shift = core.r.t() & 0xFU;
  set_acc(core, extended(core.r, core.loc16(i)) << shift);
}
void movb_acc(Core& core, const Instruction& i) { set_acc(core, i.constant); }
void movu_acc_loc16(Core& core, const Instruction& i) { set_acc(core, core.loc16(i)); }
void movl_acc_loc32(Core& core, const Instruction& i) { set_acc(core, core.loc32(i)); }

void mov_ax_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  core.r.set_ax(i.high, value);
  set_nz16(core.r, value);
}
void movb_ax(Core& core, const Instruction& i) {
  core.r.set_ax(i.high, low_half(i.constant));
  set_nz16(core.r, low_half(i.constant));
}
void mov_ar_loc16(Core& core, const Instruction& i) { core.r.set_ar(i.reg, core.loc16(i)); }
void movb_ar(Core& core, const Instruction& i) { core.r.set_ar(i.reg, low_half(i.constant)); }
void movz_ar_loc16(Core& core, const Instruction& i) { core.r.xar[i.reg] = core.loc16(i); }
void movb_xar(Core& core, const Instruction& i) { core.r.xar[i.reg] = i.constant; }
void movl_xar_const(Core& core, const Instruction& i) { core.r.xar[i.reg] = i.constant; }
void movl_xar_loc32(Core& core, const Instruction& i) { core.r.xar[i.reg] = core.loc32(i); }
void mov_xar_pc(Core& core, const Instruction& i) { core.r.xar[i.reg] = i.address; }
void movl_p_acc(Core& core, const Instruction&) { core.r.p = core.r.acc; }
void movl_p_loc32(Core& core, const Instruction& i) { core.r.p = core.loc32(i); }
void movl_xt_loc32(Core& core, const Instruction& i) { core.r.xt = core.loc32(i); }
void mov_ph_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  core.r.p = joined(value, low_half(core.r.p));
}
void mov_pl_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  core.r.p = joined(high_half(core.r.p), value);
}
void mov_t_loc16(Core& core, const Instruction& i) { core.r.set_t(core.loc16(i)); }
void mov_tl_zero(Core& core, const Instruction&) { core.r.xt = joined(core.r.t(), 0); }
void movx_tl_loc16(Core& core, const Instruction& i) { core.r.xt = sign_extended(core.loc16(i)); }
void mov_dp(Core& core, const Instruction& i) {
  core.r.dp = static_cast<std::uint16_t>((core.r.dp & 0xFC00U) | i.constant);
}
void movw_dp(Core& core, const Instruction& i) { core.r.dp = low_half(i.constant); }

void mov_loc16_const(Core& core, const Instruction& i) { store(core, i, low_half(i.constant)); }
void mov_loc16_acc(Core& core, const Instruction& i) { store(core, i, low_half(shifted_acc(core, i))); }
void movh_loc16_acc(Core& core, const Instruction& i) { store(core, i, high_half(shifted_acc(core, i))); }
void mov_loc16_p(Core& core, const Instruction& i) { store(core, i, low_half(shifted_product(core.r))); }
void movh_loc16_p(Core& core, const Instruction& i) { store(core, i, high_half(shifted_product(core.r))); }
void mov_loc16_ar(Core& core, const Instruction& i) { store(core, i, core.r.ar(i.reg)); }
void mov_loc16_ax(Core& core, const Instruction& i) { store(core, i, core.r.ax(i.high)); }
void mov_loc16_t(Core& core, const Instruction& i) { store(core, i, core.r.t()); }
void mov_loc16_ax_cond(Core& core, const Instruction& i) { store_if(core, i, core.r.ax(i.high)); }
void movb_loc16_const_cond(Core& core, const Instruction& i) { store_if(core, i, low_half(i.constant)); }

void movl_loc32_acc(Core& core, const Instruction& i) { store_long(core, i, core.r.acc); }
void movl_loc32_p(Core& core, const Instruction& i) { store_long(core, i, core.r.p); }
void movl_loc32_xar(Core& core, const Instruction& i) { store_long(core, i, core.r.xar[i.reg]); }
void movl_loc32_xt(Core& core, const Instruction& i) { store_long(core, i, core.r.xt); }
void movl_loc32_acc_cond(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 2);
  if (!core.holds(i.condition)) return;
  core.store32(place, core.r.acc);
  if (i.loc == kAcc) set_nz32(core.r, core.r.acc);
}

namespace {

std::uint16_t byte_at(Core& core, const Core::BytePlace& at) {
  const unsigned value = core.load16(at.place);
  return static_cast<std::uint16_t>((at.upper ? value >> 8 : value) & 0xFFU);
}
void store_byte(Core& core, const Instruction& i, unsigned value) {
  const Core::BytePlace at = core.locate_byte(i.loc);
  const unsigned other = core.load16(at.place);
  const unsigned merged = at.upper ? (other & 0x00FFU) | value << 8 : (other & 0xFF00U) | value;
  core.store16(at.place, static_cast<std::uint16_t>(merged));
  if (i.loc == kAh || i.loc == kAcc) set_nz16(core.r, static_cast<std::uint16_t>(merged));
}

}  // namespace

void movb_axlsb_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = byte_at(core, core.locate_byte(i.loc));
  core.r.set_ax(i.high, value);
  set_nz16(core.r, value);
}
void movb_axmsb_loc16(Core& core, const Instruction& i) {
  const unsigned value = byte_at(core, core.locate_byte(i.loc));
  core.r.set_ax(i.high, static_cast<std::uint16_t>((core.r.ax(i.high) & 0xFFU) | value << 8));
  set_nz16(core.r, core.r.ax(i.high));
}
void movb_loc16_axlsb(Core& core, const Instruction& i) { store_byte(core, i, core.r.ax(i.high) & 0xFFU); }
void movb_loc16_axmsb(Core& core, const Instruction& i) {
  store_byte(core, i, static_cast<unsigned>(core.r.ax(i.high)) >> 8);
}

// Delay lines: the value goes on to the next place.
void dmov(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 1);
  core.write16(place + 1, core.read16(place));
}
void movdl(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 2);
  core.r.xt = core.read32(place);
  core.write32(place + 2, core.r.xt);
}

// Addresses in the instruction, in XAR7 and in AL advance with each repetition; the registers keep theirs.
void mov_direct_loc16(Core& core, const Instruction& i) {
  core.write16(low_half(i.constant + core.repeats_done), core.loc16(i));
}
void mov_loc16_direct(Core& core, const Instruction& i) {
  store(core, i, core.read16(low_half(i.constant + core.repeats_done)));
}
void pread(Core& core, const Instruction& i) { store(core, i, core.read16(core.r.xar[7] + core.repeats_done)); }
void pwrite(Core& core, const Instruction& i) {
  const std::uint32_t address = core.r.xar[7] + core.repeats_done;
  core.write16(address, core.loc16(i));
}
void xpread_pma(Core& core, const Instruction& i) {
  store(core, i, core.read16(kHighPage | low_half(i.constant + core.repeats_done)));
}
void xpread_al(Core& core, const Instruction& i) {
  store(core, i, core.read16(kHighPage | low_half(core.r.ax(false) + core.repeats_done)));
}
void xpwrite_al(Core& core, const Instruction& i) {
  core.write16(kHighPage | low_half(core.r.ax(false) + core.repeats_done), core.loc16(i));
}
void in(Core& core, const Instruction& i) {
  store(core, i, core.bus().read_port(low_half(i.constant + core.repeats_done)));
}
void out(Core& core, const Instruction& i) {
  core.bus().write_port(low_half(i.constant + core.repeats_done), core.loc16(i));
}

void nop(Core& core, const Instruction& i) { core.locate(i.loc, 1); }

// --- the stack -----------------------------------------------------------------------------------------------------

void push_loc16(Core& core, const Instruction& i) { core.push16(core.loc16(i)); }
void pop_loc16(Core& core, const Instruction& i) { store(core, i, core.pop16()); }
void push_ar(Core& core, const Instruction& i) { core.push32(joined(core.r.ar(i.reg + 1U), core.r.ar(i.reg))); }
void pop_ar(Core& core, const Instruction& i) {
  const std::uint32_t value = core.pop32();
  core.r.set_ar(i.reg, low_half(value));
  core.r.set_ar(i.reg + 1U, high_half(value));
}
void push_arh(Core& core, const Instruction&) {
  core.push32(joined(high_half(core.r.xar[1]), high_half(core.r.xar[0])));
}
void pop_arh(Core& core, const Instruction&) {
  const std::uint32_t value = core.pop32();
  core.r.xar[0] = joined(low_half(value), core.r.ar(0));
  core.r.xar[1] = joined(high_half(value), core.r.ar(1));
}
void push_p(Core& core, const Instruction&) { core.push32(core.r.p); }
void pop_p(Core& core, const Instruction&) { core.r.p = core.pop32(); }
void push_dp(Core& core, const Instruction&) { core.push16(core.r.dp); }
void pop_dp(Core& core, const Instruction&) { core.r.dp = core.pop16(); }

}  // namespace stillspin::c28x::operations
