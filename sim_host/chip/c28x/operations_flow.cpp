// Branches, calls, returns, loops and traps.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

constexpr std::uint32_t kHighPage = 0x3F0000;  // where programs of the C2xLP are, with 16-bit addresses

void branch_if(Core& core, const Instruction& i, bool taken, std::uint32_t target) {
  if (taken) return core.jump(target);
  core.not_taken(i);
}
std::uint32_t relative(const Instruction& i) { return i.address + i.constant; }

// A return address is two words on the stack, at any address: the lower half comes first.
void push_address(Core& core, std::uint32_t address) {
  core.push16(low_half(address));
  core.push16(high_half(address));
}
std::uint32_t pop_address(Core& core) {
  const std::uint16_t high = core.pop16();
  return joined(high, core.pop16()) & kProgramMask;
}

void call(Core& core, std::uint32_t target) {
  push_address(core, core.r.pc);
  core.jump(target);
}
void call_through_rpc(Core& core, std::uint32_t target) {
  push_address(core, core.r.rpc);
  core.r.rpc = core.r.pc;
  core.jump(target);
}
void call_high_page(Core& core, std::uint16_t target) {
  core.push16(low_half(core.r.pc));
  core.jump(kHighPage | target);
}

}  // namespace

void branch(Core& core, const Instruction& i) { branch_if(core, i, core.holds(i.condition), relative(i)); }
void branch_short(Core& core, const Instruction& i) { branch_if(core, i, core.holds(i.condition), relative(i)); }
void banz(Core& core, const Instruction& i) {
  const std::uint16_t count = core.r.ar(i.reg);
  core.r.set_ar(i.reg, static_cast<std::uint16_t>(count - 1));
  branch_if(core, i, count != 0, relative(i));
}
void bar_eq(Core& core, const Instruction& i) {
  branch_if(core, i, core.r.ar(i.reg) == core.r.ar(i.reg2), relative(i));
}
void bar_neq(Core& core, const Instruction& i) {
  branch_if(core, i, core.r.ar(i.reg) != core.r.ar(i.reg2), relative(i));
}
void lb(Core& core, const Instruction& i) { core.jump(i.constant); }
void lb_xar7(Core& core, const Instruction&) { core.jump(core.r.xar[7]); }

void lc(Core& core, const Instruction& i) { call(core, i.constant); }
void lc_xar7(Core& core, const Instruction&) { call(core, core.r.xar[7]); }
void lcr(Core& core, const Instruction& i) { call_through_rpc(core, i.constant); }
void lcr_xar(Core& core, const Instruction& i) { call_through_rpc(core, core.r.xar[i.reg]); }
void ffc(Core& core, const Instruction& i) {
  core.r.xar[7] = core.r.pc;
  core.jump(i.constant);
}
void lret(Core& core, const Instruction&) { core.jump(pop_address(core)); }
void lrete(Core& core, const Instruction&) {
  core.jump(pop_address(core));
  core.r.intm = false;
}
void lretr(Core& core, const Instruction&) {
  core.jump(core.r.rpc);
  core.r.rpc = pop_address(core);
}
void push_rpc(Core& core, const Instruction&) { push_address(core, core.r.rpc); }
void pop_rpc(Core& core, const Instruction&) { core.r.rpc = pop_address(core); }

void xb_al(Core& core, const Instruction&) { core.jump(kHighPage | core.r.ax(false)); }
void xb_arp(Core& core, const Instruction& i) {
  core.r.arp = i.reg;
  core.jump(kHighPage | i.constant);
}
void xb_cond(Core& core, const Instruction& i) { branch_if(core, i, core.holds(i.condition), kHighPage | i.constant); }
void xbanz(Core& core, const Instruction& i) {
  std::uint32_t& pointer = core.r.xar[core.r.arp];
  const bool taken = low_half(pointer) != 0;
  core.step_pointer(i.shift, pointer, 1);
  branch_if(core, i, taken, kHighPage | i.constant);
}
void xbanz_arp(Core& core, const Instruction& i) {
  xbanz(core, i);
  core.r.arp = i.reg;
}
void xcall_al(Core& core, const Instruction&) { call_high_page(core, core.r.ax(false)); }
void xcall_arp(Core& core, const Instruction& i) {
  core.r.arp = i.reg;
  call_high_page(core, low_half(i.constant));
}
void xcall_cond(Core& core, const Instruction& i) {
  if (core.holds(i.condition)) return call_high_page(core, low_half(i.constant));
  core.not_taken(i);
}
void xretc(Core& core, const Instruction& i) {
  if (core.holds(i.condition)) return core.jump(kHighPage | core.pop16());
  core.not_taken(i);
}

namespace {

// The loops execute themselves again and may be interrupted between.
void loop_while(Core& core, const Instruction& i, bool zero) {
  const std::uint16_t value = static_cast<std::uint16_t>(core.loc16(i) & i.constant);
  set_nz16(core.r, value);
  core.r.loop = core.r.z == zero;
  if (core.r.loop) core.r.pc = i.address;  // nothing is fetched anew
}

}  // namespace

void loopz(Core& core, const Instruction& i) { loop_while(core, i, true); }
void loopnz(Core& core, const Instruction& i) { loop_while(core, i, false); }
void rpt_const(Core& core, const Instruction& i) { core.repeat(i.constant); }
void rpt_loc16(Core& core, const Instruction& i) { core.repeat(core.loc16(i)); }

void iret(Core& core, const Instruction&) { core.return_from_interrupt(); }
// A trap leaves IFR and IER alone, INTR clears the bits of its interrupt as the interrupt would.
void trap(Core& core, const Instruction& i) {
  const std::uint16_t ifr = core.r.ifr;
  const std::uint16_t ier = core.r.ier;
  core.take_interrupt(i.constant);
  core.r.ifr = ifr;
  core.r.ier = ier;
}
void intr(Core& core, const Instruction& i) { core.take_interrupt(i.constant + 1); }
void intr_fixed(Core& core, const Instruction& i) { core.take_interrupt(i.constant); }
void illegal(Core& core, const Instruction& i) {
  if (core.stops_at_illegal() && core.breakpoint(i)) return;
  core.note_trap(i);
  core.take_interrupt(kVectorIllegal);
}

}  // namespace stillspin::c28x::operations
