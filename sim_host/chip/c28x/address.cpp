// The addressing modes of loc16 and loc32, with AMODE clear.

#include "sim_host/chip/c28x/core.hpp"

namespace stillspin::c28x {
namespace {

constexpr std::uint32_t reversed16(std::uint32_t value) {
  std::uint32_t result = 0;
  for (unsigned k = 0; k < 16; ++k) result |= (value >> k & 1U) << (15 - k);
  return result;
}

// *BR0++ and *BR0--: the carry runs from the highest bit of the lower half to the lowest.
constexpr std::uint32_t bit_reversed(std::uint32_t pointer, std::uint32_t step, bool back) {
  const std::uint32_t from = reversed16(pointer);
  const std::uint32_t by = reversed16(step);
  return (pointer & 0xFFFF0000U) | reversed16((back ? from - by : from + by) & 0xFFFFU);
}

enum : unsigned { kRegisterAh = 8, kRegisterAl, kRegisterPh, kRegisterPl, kRegisterTh, kRegisterSp };

}  // namespace

std::uint32_t Core::locate(unsigned loc, unsigned step) {
  const unsigned n = loc & 7U;
  std::uint32_t& pointer = r.xar[n];
  switch (loc >> 3) {
    case 0x10:  // *XARn++
      r.arp = static_cast<std::uint8_t>(n);
      pointer += step;
      return (pointer - step) & kProgramMask;
    case 0x11:  // *--XARn
      r.arp = static_cast<std::uint8_t>(n);
      pointer -= step;
      return pointer & kProgramMask;
    case 0x12:  // *+XARn[AR0]
      r.arp = static_cast<std::uint8_t>(n);
      return (pointer + r.ar(0)) & kProgramMask;
    case 0x13:  // *+XARn[AR1]
      r.arp = static_cast<std::uint8_t>(n);
      return (pointer + r.ar(1)) & kProgramMask;
    case 0x14:
      return kInRegister | n;  // @ARn, @XARn
    case 0x15:
    case 0x16:
    case 0x17:
      return locate_indirect(loc, step);
    default:
      break;
  }
  if (loc >= 0xC0) {  // *+XARn[3bit]
    r.arp = static_cast<std::uint8_t>(n);
    return (pointer + (loc >> 3 & 7U)) & kProgramMask;
  }
  const unsigned offset = loc & 0x3FU;
  if (loc < 0x40) return (static_cast<std::uint32_t>(r.dp) << 6 | offset) & kProgramMask;  // @6bit
  return r.page0 ? offset : static_cast<std::uint16_t>(r.sp - offset);                     // *-SP[6bit], or @0:6bit
}

std::uint32_t Core::locate_indirect(unsigned loc, unsigned step) {
  if (loc < 0xAE) return kInRegister | (loc & 0xFU);
  if (loc == 0xBD) {  // *SP++
    const std::uint16_t place = r.sp;
    r.sp = static_cast<std::uint16_t>(r.sp + step);
    return place;
  }
  if (loc == 0xBE) return r.sp = static_cast<std::uint16_t>(r.sp - step);  // *--SP
  if (loc == 0xBF) {                                                       // *AR6%++
    const std::uint32_t place = r.xar[6];
    const bool at_end = ((place ^ r.xar[1]) & 0xFFU) == 0;
    r.xar[6] = at_end ? place & 0xFFFFFF00U : (place & 0xFFFF0000U) | ((place + step) & 0xFFFFU);
    r.arp = 6;
    return place & kProgramMask;
  }
  std::uint32_t& pointer = r.xar[r.arp];
  const std::uint32_t place = pointer & kProgramMask;
  if (loc < 0xB0) {  // *BR0++, *BR0--
    pointer = bit_reversed(pointer, r.ar(0), loc == 0xAF);
  } else if (loc < 0xB8) {  // *,ARPn
    r.arp = static_cast<std::uint8_t>(loc & 7U);
  } else {
    step_pointer(loc - 0xB8U, pointer, step);
  }
  return place;
}

void Core::step_pointer(unsigned kind, std::uint32_t& pointer, unsigned step) const {
  switch (kind) {
    case 1:
      pointer += step;
      break;
    case 2:
      pointer -= step;
      break;
    case 3:
      pointer += r.ar(0);
      break;
    case 4:
      pointer -= r.ar(0);
      break;
    default:
      break;
  }
}

// An index of the byte moves counts bytes from the word that XARn points to; every other mode means the lower byte.
Core::BytePlace Core::locate_byte(unsigned loc) {
  const unsigned mode = loc >> 3;
  const bool indexed = mode == 0x12 || mode == 0x13 || loc >= 0xC0;
  if (!indexed) return {locate(loc, 1), false};
  const unsigned n = loc & 7U;
  const unsigned offset = loc >= 0xC0 ? (mode & 7U) : r.ar(mode & 1U);
  r.arp = static_cast<std::uint8_t>(n);
  return {(r.xar[n] + offset / 2) & kProgramMask, (offset & 1U) != 0};
}

std::uint16_t Core::register16(unsigned code) const {
  switch (code) {
    case kRegisterAh:
      return high_half(r.acc);
    case kRegisterAl:
      return low_half(r.acc);
    case kRegisterPh:
      return high_half(r.p);
    case kRegisterPl:
      return low_half(r.p);
    case kRegisterTh:
      return r.t();
    case kRegisterSp:
      return r.sp;
    default:
      return r.ar(code);
  }
}

void Core::set_register16(unsigned code, std::uint16_t value) {
  switch (code) {
    case kRegisterAh:
      return r.set_ax(true, value);
    case kRegisterAl:
      return r.set_ax(false, value);
    case kRegisterPh:
      r.p = joined(value, low_half(r.p));
      return;
    case kRegisterPl:
      r.p = joined(high_half(r.p), value);
      return;
    case kRegisterTh:
      return r.set_t(value);
    case kRegisterSp:
      r.sp = value;
      return;
    default:
      return r.set_ar(code, value);
  }
}

std::uint32_t* Core::register32(unsigned code) {
  switch (code) {
    case kRegisterAl:
      return &r.acc;
    case kRegisterPl:
      return &r.p;
    case kRegisterTh:
      return &r.xt;
    default:
      return &r.xar[code & 7U];
  }
}

}  // namespace stillspin::c28x
