// Multiplications, with and without an accumulation of the product before.

#include "made/c28x/operations.hpp"
#include "sim_host/chip/c28x/alu.hpp"
#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x::operations {
namespace {

constexpr std::uint32_t kHighPage = 0x3F0000;  // where programs of the C2xLP are

std::uint32_t product(std::uint32_t a, std::uint32_t b) { return a * b; }
std::uint32_t signed_t(const Core& core) { return sign_extended(core.r.t()); }
std::uint32_t signed_loc16(Core& core, const Instruction& i) { return sign_extended(core.loc16(i)); }

void accumulate(Core& core) { core.r.acc = add_signed(core.r, core.r.acc, shifted_product(core.r)); }
void deduct(Core& core) { core.r.acc = subtract_signed(core.r, core.r.acc, shifted_product(core.r)); }

void set_acc(Core& core, std::uint32_t value) {
  core.r.acc = value;
  set_nz32(core.r, value);
}

std::int64_t wide(const Core& core, std::uint32_t value) { return as_signed(core.r.xt) * as_signed(value); }
std::int64_t wide_by_unsigned(const Core& core, std::uint32_t value) {
  return as_signed(core.r.xt) * static_cast<std::int64_t>(value);
}
std::uint32_t upper(std::int64_t value) { return static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) >> 32); }

// The multiply-and-accumulates read their second factor from program memory, where XAR7 points to before the first
// factor's pointer steps. If that is XAR7 too, its step is the one that counts.
struct Factors {
  std::uint32_t own;
  std::uint32_t from_program;
};
Factors factors32(Core& core, const Instruction& i) {
  const std::uint32_t before = core.r.xar[7];
  const std::uint32_t from_program = core.read32(before);
  const std::uint32_t own = core.loc32(i);
  if (i.reg != 0 && core.r.xar[7] == before) core.r.xar[7] += 2;
  return {own, from_program};
}
Factors factors16(Core& core, const Instruction& i) {
  const std::uint32_t before = core.r.xar[7];
  const std::uint16_t from_program = core.read16(before);
  const std::uint16_t own = core.loc16(i);
  if (i.reg != 0 && core.r.xar[7] == before) core.r.xar[7] += 1;
  return {own, from_program};
}

void mac(Core& core, std::uint16_t factor, std::uint16_t from_program) {
  accumulate(core);
  core.r.set_t(factor);
  core.r.p = product(signed_t(core), sign_extended(from_program));
}

}  // namespace

void mpy_acc_t(Core& core, const Instruction& i) {
  const std::uint32_t factor = signed_loc16(core, i);
  set_acc(core, product(signed_t(core), factor));
}
void mpy_p_t(Core& core, const Instruction& i) {
  const std::uint32_t factor = signed_loc16(core, i);
  core.r.p = product(signed_t(core), factor);
}
void mpy_acc_loc16_const(Core& core, const Instruction& i) {
  core.r.set_t(core.loc16(i));
  set_acc(core, product(signed_t(core), i.constant));
}
void mpy_p_loc16_const(Core& core, const Instruction& i) { core.r.p = product(signed_loc16(core, i), i.constant); }
void mpyb_acc(Core& core, const Instruction& i) { set_acc(core, product(signed_t(core), i.constant)); }
void mpyb_p(Core& core, const Instruction& i) { core.r.p = product(signed_t(core), i.constant); }
void mpyu_acc(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  set_acc(core, product(core.r.t(), factor));
}
void mpyu_p(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  core.r.p = product(core.r.t(), factor);
}
void mpyxu_acc(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  set_acc(core, product(signed_t(core), factor));
}
void mpyxu_p(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  core.r.p = product(signed_t(core), factor);
}

// The operand is read before the accumulator is written, as with every instruction: it matters where it is AH, AL or
// ACC.
void mpya_t(Core& core, const Instruction& i) {
  const std::uint32_t factor = signed_loc16(core, i);
  accumulate(core);
  core.r.p = product(signed_t(core), factor);
}
void mpys_t(Core& core, const Instruction& i) {
  const std::uint32_t factor = signed_loc16(core, i);
  deduct(core);
  core.r.p = product(signed_t(core), factor);
}
void mpya_loc16_const(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  accumulate(core);
  core.r.set_t(factor);
  core.r.p = product(signed_t(core), i.constant);
}
void sqra(Core& core, const Instruction& i) {
  mova(core, i);
  core.r.p = product(signed_t(core), signed_t(core));
}
void sqrs(Core& core, const Instruction& i) {
  movs(core, i);
  core.r.p = product(signed_t(core), signed_t(core));
}
void mova(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  accumulate(core);
  core.r.set_t(factor);
}
void movs(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  deduct(core);
  core.r.set_t(factor);
}
void movp(Core& core, const Instruction& i) {
  const std::uint16_t factor = core.loc16(i);
  set_acc(core, shifted_product(core.r));
  core.r.set_t(factor);
}
void movad(Core& core, const Instruction& i) {
  accumulate(core);
  const std::uint32_t place = core.locate(i.loc, 1);
  core.r.set_t(core.read16(place));
  core.write16(place + 1, core.r.t());
}

void mac_pma(Core& core, const Instruction& i) {
  mac(core, core.loc16(i), core.read16(i.constant + core.repeats_done));
}
void mac_xar7(Core& core, const Instruction& i) {
  const Factors factors = factors16(core, i);
  mac(core, low_half(factors.own), low_half(factors.from_program));
}
void xmac(Core& core, const Instruction& i) {
  mac(core, core.loc16(i), core.read16(kHighPage | low_half(i.constant + core.repeats_done)));
}
void xmacd(Core& core, const Instruction& i) {
  const std::uint32_t place = core.locate(i.loc, 1);
  mac(core, core.read16(place), core.read16(kHighPage | low_half(i.constant + core.repeats_done)));
  core.write16(place + 1, core.r.t());
}

// Two 16 x 16 products at once: the upper halves into ACC, the lower into P, both through the product shifter.
void dmac(Core& core, const Instruction& i) {
  Registers& r = core.r;
  const auto [own, other] = factors32(core, i);
  r.xt = own;
  Registers shifter = r;
  shifter.p = product(sign_extended(low_half(r.xt)), sign_extended(low_half(other)));
  const std::uint32_t lower = shifted_product(shifter);
  shifter.p = product(sign_extended(high_half(r.xt)), sign_extended(high_half(other)));
  r.p += lower;
  r.acc = add_signed(r, r.acc, shifted_product(shifter));
}

void impyl_acc(Core& core, const Instruction& i) {
  const std::uint32_t factor = core.loc32(i);
  set_acc(core, product(core.r.xt, factor));
}
void impyl_p(Core& core, const Instruction& i) { core.r.p = product_window(core.r, wide(core, core.loc32(i))); }
void impyxul(Core& core, const Instruction& i) {
  core.r.p = product_window(core.r, wide_by_unsigned(core, core.loc32(i)));
}
void impyal(Core& core, const Instruction& i) {
  const std::int64_t next = wide(core, core.loc32(i));
  core.r.acc = add_unsigned(core.r, core.r.acc, core.r.p);
  core.r.p = product_window(core.r, next);
}
void impysl(Core& core, const Instruction& i) {
  const std::int64_t next = wide(core, core.loc32(i));
  core.r.acc = subtract_unsigned(core.r, core.r.acc, core.r.p);
  core.r.p = product_window(core.r, next);
}
void imacl(Core& core, const Instruction& i) {
  const Factors factors = factors32(core, i);
  core.r.acc = add_unsigned(core.r, core.r.acc, core.r.p);
  core.r.p = product_window(core.r, as_signed(factors.own) * as_signed(factors.from_program));
}
void qmpyl_acc(Core& core, const Instruction& i) { set_acc(core, upper(wide(core, core.loc32(i)))); }
void qmpyl_p(Core& core, const Instruction& i) { core.r.p = upper(wide(core, core.loc32(i))); }
void qmpyul(Core& core, const Instruction& i) {
  core.r.p = static_cast<std::uint32_t>(static_cast<std::uint64_t>(core.r.xt) * core.loc32(i) >> 32);
}
void qmpyxul(Core& core, const Instruction& i) { core.r.p = upper(wide_by_unsigned(core, core.loc32(i))); }
void qmpyal(Core& core, const Instruction& i) {
  const std::int64_t next = wide(core, core.loc32(i));
  accumulate(core);
  core.r.p = upper(next);
}
void qmpysl(Core& core, const Instruction& i) {
  const std::int64_t next = wide(core, core.loc32(i));
  deduct(core);
  core.r.p = upper(next);
}
void qmacl(Core& core, const Instruction& i) {
  const Factors factors = factors32(core, i);
  accumulate(core);
  core.r.p = upper(as_signed(factors.own) * as_signed(factors.from_program));
}

}  // namespace stillspin::c28x::operations
