// Additions, flags and the product shifter, as the operations share them.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_ALU_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_ALU_HPP

#include <cstdint>

#include "sim_host/chip/c28x/registers.hpp"

namespace stillspin::c28x {

constexpr std::uint32_t kMost = 0x7FFFFFFF;
constexpr std::uint32_t kLeast = 0x80000000;

constexpr std::uint32_t sign_extended(std::uint16_t value) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(static_cast<std::int16_t>(value)));
}
constexpr std::int64_t as_signed(std::uint32_t value) { return static_cast<std::int32_t>(value); }

inline void set_nz16(Registers& r, std::uint16_t value) {
  r.n = value >> 15 != 0;
  r.z = value == 0;
}
inline void set_nz32(Registers& r, std::uint32_t value) {
  r.n = value >> 31 != 0;
  r.z = value == 0;
}
inline void set_nz64(Registers& r, std::uint64_t value) {
  r.n = value >> 63 != 0;
  r.z = value == 0;
}

/// The 16-bit value that MOV, ADD and SUB take into the accumulator.
inline std::uint32_t extended(const Registers& r, std::uint16_t value) { return r.sxm ? sign_extended(value) : value; }

inline void count_overflow(Registers& r, bool up) {
  const int next = r.ovc + (up ? 1 : -1);
  r.ovc = static_cast<std::int8_t>(next > 31 ? -32 : next < -32 ? 31 : next);
}

/// a + b + carry through the accumulator's adder: C, V and, with OVM clear, the overflow counter; saturated with OVM
/// set.
inline std::uint32_t add_signed(Registers& r, std::uint32_t a, std::uint32_t b, bool carry = false) {
  const std::uint64_t wide = static_cast<std::uint64_t>(a) + b + (carry ? 1U : 0U);
  const std::uint32_t sum = static_cast<std::uint32_t>(wide);
  r.c = wide >> 32 != 0;
  std::uint32_t result = sum;
  if (((a ^ sum) & (b ^ sum)) >> 31 != 0) {
    const bool up = a >> 31 == 0;
    r.v = true;
    if (r.ovm) result = up ? kMost : kLeast;
    if (!r.ovm) count_overflow(r, up);
  }
  set_nz32(r, result);
  return result;
}

/// a - b - borrow, likewise. C is cleared by a borrow and set otherwise.
inline std::uint32_t subtract_signed(Registers& r, std::uint32_t a, std::uint32_t b, bool borrow = false) {
  const std::uint64_t wide = static_cast<std::uint64_t>(a) - b - (borrow ? 1U : 0U);
  const std::uint32_t difference = static_cast<std::uint32_t>(wide);
  r.c = wide >> 32 == 0;
  std::uint32_t result = difference;
  if (((a ^ b) & (a ^ difference)) >> 31 != 0) {
    const bool up = a >> 31 == 0;
    r.v = true;
    if (r.ovm) result = up ? kMost : kLeast;
    if (!r.ovm) count_overflow(r, up);
  }
  set_nz32(r, result);
  return result;
}

/// Unsigned: the counter counts carries and borrows whatever OVM says, and nothing saturates. V is the signed overflow.
inline std::uint32_t add_unsigned(Registers& r, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t sum = a + b;
  r.c = sum < a;
  if (r.c) count_overflow(r, true);
  if (((a ^ sum) & (b ^ sum)) >> 31 != 0) r.v = true;
  set_nz32(r, sum);
  return sum;
}
inline std::uint32_t subtract_unsigned(Registers& r, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t difference = a - b;
  r.c = a >= b;
  if (!r.c) count_overflow(r, false);
  if (((a ^ b) & (a ^ difference)) >> 31 != 0) r.v = true;
  set_nz32(r, difference);
  return difference;
}

inline std::uint16_t add16(Registers& r, std::uint16_t a, std::uint16_t b) {
  const unsigned wide = static_cast<unsigned>(a) + b;
  const std::uint16_t sum = static_cast<std::uint16_t>(wide);
  r.c = wide > 0xFFFF;
  if (((a ^ sum) & (b ^ sum) & 0x8000) != 0) r.v = true;
  set_nz16(r, sum);
  return sum;
}
inline std::uint16_t subtract16(Registers& r, std::uint16_t a, std::uint16_t b) {
  const std::uint16_t difference = static_cast<std::uint16_t>(a - b);
  r.c = a >= b;
  if (((a ^ b) & (a ^ difference) & 0x8000) != 0) r.v = true;
  set_nz16(r, difference);
  return difference;
}

/// Comparisons have N as of the exact difference. `a` and `b` are extended as they are meant.
inline void compare(Registers& r, std::int64_t a, std::int64_t b) {
  r.n = a < b;
  r.z = a == b;
}

/// P as the product shifter hands it out.
inline std::uint32_t shifted_product(const Registers& r) {
  if (r.pm == 0) return r.p << 1;
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(r.p) >> (r.pm - 1));
}
/// The 32 bits of a long product that P takes: the product shifter moves a window over its lower 38 bits.
inline std::uint32_t product_window(const Registers& r, std::int64_t product) {
  const std::uint64_t bits = static_cast<std::uint64_t>(product);
  return static_cast<std::uint32_t>(r.pm == 0 ? bits << 1 : bits >> (r.pm - 1));
}

inline std::uint64_t acc_p(const Registers& r) { return static_cast<std::uint64_t>(r.acc) << 32 | r.p; }
inline void set_acc_p(Registers& r, std::uint64_t value) {
  r.acc = static_cast<std::uint32_t>(value >> 32);
  r.p = static_cast<std::uint32_t>(value);
}

}  // namespace stillspin::c28x

#endif
