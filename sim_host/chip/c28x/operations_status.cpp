// Status bits, interrupt registers, the product shift mode and what stops or protects the core.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

bool Registers::* const kModes[] = {&Registers::sxm,  &Registers::ovm,  &Registers::tc,    &Registers::c,
                                    &Registers::intm, &Registers::dbgm, &Registers::page0, &Registers::vmap};

void set_modes(Core& core, std::uint32_t chosen, bool value) {
  for (const auto& mode : kModes) {
    if ((chosen & 1U) != 0) core.r.*mode = value;
    chosen >>= 1;
  }
}
std::uint16_t word(unsigned value) { return static_cast<std::uint16_t>(value); }

void store(Core& core, const Instruction& i, std::uint16_t value) {
  core.store16(core.locate(i.loc, 1), value);
  if (i.loc == 0xA8 || i.loc == 0xA9) set_nz16(core.r, value);
}
std::int8_t counter_of(unsigned bits) {
  return static_cast<std::int8_t>(bits > 31 ? static_cast<int>(bits) - 64 : static_cast<int>(bits));
}

// Location fields mean something else with AMODE set.
void set_st1(Core& core, std::uint16_t value) {
  core.r.set_st1(value);
  if (core.r.amode) core.stop_unmodelled();
}

}  // namespace

void setc(Core& core, const Instruction& i) { set_modes(core, i.constant, true); }
void clrc(Core& core, const Instruction& i) { set_modes(core, i.constant, false); }
void setc_xf(Core& core, const Instruction&) { core.r.xf = true; }
void clrc_xf(Core& core, const Instruction&) { core.r.xf = false; }
void clrc_ovc(Core& core, const Instruction&) { core.r.ovc = 0; }
void c27map(Core& core, const Instruction&) { core.r.m0m1map = false; }
void c28map(Core& core, const Instruction&) { core.r.m0m1map = true; }
void c27obj(Core& core, const Instruction&) { core.r.objmode = false; }
void c28obj(Core& core, const Instruction&) { core.r.objmode = true; }
void c28addr(Core& core, const Instruction&) { core.r.amode = false; }
void lpaddr(Core& core, const Instruction&) {
  core.r.amode = true;
  core.stop_unmodelled();
}
void eallow(Core& core, const Instruction&) { core.r.eallow = true; }
void edis(Core& core, const Instruction&) { core.r.eallow = false; }
void aborti(Core& core, const Instruction&) { core.r.dbgm = true; }
void estop0(Core& core, const Instruction& i) { core.breakpoint(i); }
void estop1(Core&, const Instruction&) {}
void iack(Core&, const Instruction&) {}
void idle(Core& core, const Instruction&) { core.wait_for_interrupt(); }

void asp(Core& core, const Instruction&) {
  core.r.spa = (core.r.sp & 1U) != 0;
  if (core.r.spa) ++core.r.sp;
}
void nasp(Core& core, const Instruction&) {
  if (core.r.spa) --core.r.sp;
  core.r.spa = false;
}

void spm(Core& core, const Instruction& i) { core.r.pm = static_cast<std::uint8_t>(i.constant); }
void mov_pm_ax(Core& core, const Instruction& i) { core.r.pm = static_cast<std::uint8_t>(core.r.ax(i.high) & 7U); }
void mov_ovc_loc16(Core& core, const Instruction& i) { core.r.ovc = counter_of(core.loc16(i) >> 10); }
void movu_ovc_loc16(Core& core, const Instruction& i) { core.r.ovc = counter_of(core.loc16(i) & 0x3FU); }
void mov_loc16_ovc(Core& core, const Instruction& i) { store(core, i, word(static_cast<unsigned>(core.r.ovc) << 10)); }
void movu_loc16_ovc(Core& core, const Instruction& i) {
  store(core, i, word(static_cast<unsigned>(core.r.ovc) & 0x3FU));
}

void and_ier(Core& core, const Instruction& i) { core.r.ier = word(core.r.ier & i.constant); }
void or_ier(Core& core, const Instruction& i) { core.r.ier = word(core.r.ier | i.constant); }
void and_ifr(Core& core, const Instruction& i) { core.r.ifr = word(core.r.ifr & i.constant); }
void or_ifr(Core& core, const Instruction& i) { core.r.ifr = word(core.r.ifr | i.constant); }
void mov_ier_loc16(Core& core, const Instruction& i) { core.r.ier = core.loc16(i); }
void mov_loc16_ier(Core& core, const Instruction& i) { store(core, i, core.r.ier); }

void push_st0(Core& core, const Instruction&) { core.push16(core.r.st0()); }
void pop_st0(Core& core, const Instruction&) { core.r.set_st0(core.pop16()); }
void push_st1(Core& core, const Instruction&) { core.push16(core.r.st1()); }
void pop_st1(Core& core, const Instruction&) { set_st1(core, core.pop16()); }
void push_t_st0(Core& core, const Instruction&) { core.push32(joined(core.r.t(), core.r.st0())); }
void pop_t_st0(Core& core, const Instruction&) {
  const std::uint32_t value = core.pop32();
  core.r.set_st0(low_half(value));
  core.r.set_t(high_half(value));
}
void push_dp_st1(Core& core, const Instruction&) { core.push32(joined(core.r.dp, core.r.st1())); }
void pop_dp_st1(Core& core, const Instruction&) {
  const std::uint32_t value = core.pop32();
  core.r.dp = high_half(value);
  set_st1(core, low_half(value));
}
void push_ifr(Core& core, const Instruction&) { core.push16(core.r.ifr); }
void pop_ifr(Core& core, const Instruction&) { core.r.ifr = core.pop16(); }
void push_dbgier(Core& core, const Instruction&) { core.push16(core.r.dbgier); }
void pop_dbgier(Core& core, const Instruction&) { core.r.dbgier = core.pop16(); }

}  // namespace stillspin::c28x::operations
