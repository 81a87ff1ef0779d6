// The registers of the C28x and what they are after a reset. Flags are kept apart and joined where ST0 or ST1 is read.

#ifndef STILLSPIN_SIM_HOST_CHIP_C28X_REGISTERS_HPP
#define STILLSPIN_SIM_HOST_CHIP_C28X_REGISTERS_HPP

#include <array>
#include <cstdint>

namespace stillspin::c28x {

constexpr std::uint32_t kProgramMask = 0x3FFFFF;  // 22 bits of a program address

constexpr std::uint16_t high_half(std::uint32_t value) { return static_cast<std::uint16_t>(value >> 16); }
constexpr std::uint16_t low_half(std::uint32_t value) { return static_cast<std::uint16_t>(value); }
constexpr std::uint32_t joined(std::uint16_t high, std::uint16_t low) {
  return static_cast<std::uint32_t>(high) << 16 | low;
}

struct Registers {
  std::uint32_t acc = 0;
  std::uint32_t p = 0;
  std::uint32_t xt = 0;
  std::array<std::uint32_t, 8> xar{};
  std::uint32_t pc = 0x3FFFC0;
  std::uint32_t rpc = 0;
  std::uint16_t sp = 0x0400;
  std::uint16_t dp = 0;
  std::uint16_t ifr = 0;
  std::uint16_t ier = 0;
  std::uint16_t dbgier = 0;

  // ST0
  bool sxm = false;
  bool ovm = false;
  bool tc = false;
  bool c = false;
  bool z = false;
  bool n = false;
  bool v = false;
  std::uint8_t pm = 0;  // 0: left by one, 1: none, k: right by k - 1
  std::int8_t ovc = 0;  // -32 .. 31

  // ST1
  bool intm = true;
  bool dbgm = true;
  bool page0 = false;
  bool vmap = true;
  bool spa = false;
  bool loop = false;
  bool eallow = false;
  bool idlestat = false;
  bool amode = false;
  bool objmode = false;
  bool m0m1map = true;
  bool xf = false;
  std::uint8_t arp = 0;

  std::uint16_t ax(bool high) const { return high ? high_half(acc) : low_half(acc); }
  void set_ax(bool high, std::uint16_t value) {
    acc = high ? joined(value, low_half(acc)) : joined(high_half(acc), value);
  }
  std::uint16_t t() const { return high_half(xt); }
  void set_t(std::uint16_t value) { xt = joined(value, low_half(xt)); }
  std::uint16_t ar(unsigned number) const { return low_half(xar[number]); }
  void set_ar(unsigned number, std::uint16_t value) { xar[number] = joined(high_half(xar[number]), value); }

  std::uint16_t st0() const;
  void set_st0(std::uint16_t value);
  std::uint16_t st1() const;
  /// LOOP, IDLESTAT, M0M1MAP and the reserved bit are not written by software.
  void set_st1(std::uint16_t value);
};

}  // namespace stillspin::c28x

#endif
