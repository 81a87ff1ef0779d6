// Additions, subtractions, comparisons and logic of the 32-bit accumulator, of P and of 32-bit locations.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

void add(Core& core, std::uint32_t value) { core.r.acc = add_signed(core.r, core.r.acc, value); }
void subtract(Core& core, std::uint32_t value) { core.r.acc = subtract_signed(core.r, core.r.acc, value); }

std::uint32_t shifted_loc16(Core& core, const Instruction& i, unsigned shift) {
  return extended(core.r, core.loc16(i)) << shift;
}
unsigned shift_by_t(const Core& core) { return core.r.t() & 0xFU; }
std::uint32_t shifted_constant(const Core& core, const Instruction& i) {
  return extended(core.r, low_half(i.constant)) << i.shift;
}

void compare32(Core& core, std::uint32_t value) {
  core.r.c = core.r.acc >= value;
  compare(core.r, as_signed(core.r.acc), as_signed(value));
}

void set_acc(Core& core, std::uint32_t value) {
  core.r.acc = value;
  set_nz32(core.r, value);
}

}  // namespace

// With a shift of 16 an addition can set C and not clear it, and a subtraction can clear C and not set it.
void add_acc_loc16(Core& core, const Instruction& i) {
  const bool carry = core.r.c;
  add(core, shifted_loc16(core, i, i.shift));
  if (i.shift == 16) core.r.c = core.r.c || carry;
}
void sub_acc_loc16(Core& core, const Instruction& i) {
  const bool carry = core.r.c;
  subtract(core, shifted_loc16(core, i, i.shift));
  if (i.shift == 16) core.r.c = core.r.c && carry;
}
void add_acc_loc16_t(Core& core, const Instruction& i) { add(core, shifted_loc16(core, i, shift_by_t(core))); }
void sub_acc_loc16_t(Core& core, const Instruction& i) { subtract(core, shifted_loc16(core, i, shift_by_t(core))); }
void add_acc_const(Core& core, const Instruction& i) { add(core, shifted_constant(core, i)); }
void sub_acc_const(Core& core, const Instruction& i) { subtract(core, shifted_constant(core, i)); }
void addb_acc(Core& core, const Instruction& i) { add(core, i.constant); }
void subb_acc(Core& core, const Instruction& i) { subtract(core, i.constant); }
void addu(Core& core, const Instruction& i) { add(core, core.loc16(i)); }
void subu(Core& core, const Instruction& i) { subtract(core, core.loc16(i)); }
void addl_acc_loc32(Core& core, const Instruction& i) { add(core, core.loc32(i)); }
void subl_acc_loc32(Core& core, const Instruction& i) { subtract(core, core.loc32(i)); }
void addcu(Core& core, const Instruction& i) { core.r.acc = add_signed(core.r, core.r.acc, core.loc16(i), core.r.c); }
void addcl(Core& core, const Instruction& i) { core.r.acc = add_signed(core.r, core.r.acc, core.loc32(i), core.r.c); }
void sbbu(Core& core, const Instruction& i) {
  core.r.acc = subtract_signed(core.r, core.r.acc, core.loc16(i), !core.r.c);
}
void subbl(Core& core, const Instruction& i) {
  core.r.acc = subtract_signed(core.r, core.r.acc, core.loc32(i), !core.r.c);
}
void addul_acc(Core& core, const Instruction& i) { core.r.acc = add_unsigned(core.r, core.r.acc, core.loc32(i)); }
void addul_p(Core& core, const Instruction& i) { core.r.p = add_unsigned(core.r, core.r.p, core.loc32(i)); }
void subul_acc(Core& core, const Instruction& i) { core.r.acc = subtract_unsigned(core.r, core.r.acc, core.loc32(i)); }
void subul_p(Core& core, const Instruction& i) { core.r.p = subtract_unsigned(core.r, core.r.p, core.loc32(i)); }

void addl_loc32_acc(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 2);
  core.store32(place, add_signed(core.r, core.load32(place), core.r.acc));
}
void subl_loc32_acc(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 2);
  core.store32(place, subtract_signed(core.r, core.load32(place), core.r.acc));
}
void subrl(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 2);
  core.store32(place, subtract_signed(core.r, core.r.acc, core.load32(place)));
}

void cmpl_loc32(Core& core, const Instruction& i) { compare32(core, core.loc32(i)); }
void cmpl_p(Core& core, const Instruction&) { compare32(core, shifted_product(core.r)); }
void test_acc(Core& core, const Instruction&) { set_nz32(core.r, core.r.acc); }

// V says that the value was replaced; it is not cleared.
void maxl(Core& core, const Instruction& i) {
  const std::uint32_t value = core.loc32(i);
  compare32(core, value);
  if (!core.r.n) return;
  core.r.acc = value;
  core.r.v = true;
}
void minl(Core& core, const Instruction& i) {
  const std::uint32_t value = core.loc32(i);
  compare32(core, value);
  if (core.r.n || core.r.z) return;
  core.r.acc = value;
  core.r.v = true;
}

// The lower halves of 64-bit extremes: N and Z are those of MAXL or MINL on the upper halves.
void maxcul(Core& core, const Instruction& i) {
  const std::uint32_t value = core.loc32(i);
  const bool by_upper = core.r.n && !core.r.z;
  const bool by_lower = !core.r.n && core.r.z && core.r.p < value;
  if (by_upper || by_lower) core.r.p = value;
  if (by_lower) core.r.v = true;
}
void mincul(Core& core, const Instruction& i) {
  const std::uint32_t value = core.loc32(i);
  const bool by_upper = !core.r.n && !core.r.z;
  const bool by_lower = !core.r.n && core.r.z && core.r.p > value;
  if (by_upper || by_lower) core.r.p = value;
  if (by_lower) core.r.v = true;
}

// One step of an unsigned division: the remainder in ACC takes a bit more, the quotient comes in at the lower end.
void subcu(Core& core, const Instruction& i) {
  const std::int64_t rest =
      (static_cast<std::int64_t>(core.r.acc) << 1) - (static_cast<std::int64_t>(core.loc16(i)) << 16);
  core.r.c = rest >= 0;
  set_acc(core, core.r.c ? static_cast<std::uint32_t>(rest) + 1 : core.r.acc << 1);
}
void subcul(Core& core, const Instruction& i) {
  const std::uint64_t doubled = acc_p(core.r) << 1;
  const std::int64_t rest =
      (static_cast<std::int64_t>(core.r.acc) << 1) + (core.r.p >> 31) - static_cast<std::int64_t>(core.loc32(i));
  core.r.c = rest >= 0;
  set_acc_p(core.r, doubled | (core.r.c ? 1U : 0U));
  set_acc(core, core.r.c ? static_cast<std::uint32_t>(rest) : core.r.acc);
}

void and_acc_const(Core& core, const Instruction& i) { set_acc(core, core.r.acc & i.constant << i.shift); }
void or_acc_const(Core& core, const Instruction& i) { set_acc(core, core.r.acc | i.constant << i.shift); }
void xor_acc_const(Core& core, const Instruction& i) { set_acc(core, core.r.acc ^ i.constant << i.shift); }
void and_acc_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  set_acc(core, core.r.acc & value);
}
void or_acc_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  set_acc(core, core.r.acc | value);
}
void xor_acc_loc16(Core& core, const Instruction& i) {
  const std::uint16_t value = core.loc16(i);
  set_acc(core, core.r.acc ^ value);
}
void not_acc(Core& core, const Instruction&) { set_acc(core, ~core.r.acc); }

void neg_acc(Core& core, const Instruction&) {
  Registers& r = core.r;
  r.c = r.acc == 0;
  const bool overflows = r.acc == kLeast;
  if (overflows) r.v = true;
  set_acc(core, overflows && r.ovm ? kMost : 0U - r.acc);
}
void negtc(Core& core, const Instruction& i) {
  if (core.r.tc) return neg_acc(core, i);
  set_nz32(core.r, core.r.acc);
}
void abs(Core& core, const Instruction& i) {
  if (core.r.acc >> 31 != 0) neg_acc(core, i);
  set_nz32(core.r, core.r.acc);
  core.r.c = false;
}
void abstc(Core& core, const Instruction& i) {
  if (core.r.acc >> 31 != 0) core.r.tc = !core.r.tc;
  abs(core, i);
}

void sat(Core& core, const Instruction&) {
  Registers& r = core.r;
  r.v = r.ovc != 0;
  if (r.ovc > 0) r.acc = kMost;
  if (r.ovc < 0) r.acc = kLeast;
  r.ovc = 0;
  r.c = false;
  set_nz32(r, r.acc);
}
void zalr(Core& core, const Instruction& i) { set_acc(core, joined(core.loc16(i), 0x8000)); }
void zapa(Core& core, const Instruction&) {
  core.r.p = 0;
  core.r.ovc = 0;
  set_acc(core, 0);
}

}  // namespace stillspin::c28x::operations
