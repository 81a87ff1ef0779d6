#include "sim_host/chip/c28x/registers.hpp"

namespace stillspin::c28x {
namespace {

constexpr unsigned kPmShift = 7;
constexpr unsigned kOvcShift = 10;
constexpr unsigned kArpShift = 13;

struct Bit {
  bool Registers::* flag;
  unsigned position;
  bool written;  // by software
};

constexpr Bit kSt0[] = {{&Registers::sxm, 0, true}, {&Registers::ovm, 1, true}, {&Registers::tc, 2, true},
                        {&Registers::c, 3, true},   {&Registers::z, 4, true},   {&Registers::n, 5, true},
                        {&Registers::v, 6, true}};
constexpr Bit kSt1[] = {{&Registers::intm, 0, true},    {&Registers::dbgm, 1, true},      {&Registers::page0, 2, true},
                        {&Registers::vmap, 3, true},    {&Registers::spa, 4, true},       {&Registers::loop, 5, false},
                        {&Registers::eallow, 6, true},  {&Registers::idlestat, 7, false}, {&Registers::amode, 8, true},
                        {&Registers::objmode, 9, true}, {&Registers::m0m1map, 11, false}, {&Registers::xf, 12, true}};

template <std::size_t count>
unsigned bits_of(const Registers& registers, const Bit (&bits)[count]) {
  unsigned value = 0;
  for (const Bit& bit : bits) value |= (registers.*bit.flag ? 1U : 0U) << bit.position;
  return value;
}

template <std::size_t count>
void set_bits(Registers& registers, const Bit (&bits)[count], unsigned value) {
  for (const Bit& bit : bits) {
    if (bit.written) registers.*bit.flag = (value >> bit.position & 1U) != 0;
  }
}

}  // namespace

std::uint16_t Registers::st0() const {
  const unsigned counter = static_cast<unsigned>(ovc) & 0x3FU;
  return static_cast<std::uint16_t>(bits_of(*this, kSt0) | static_cast<unsigned>(pm) << kPmShift |
                                    counter << kOvcShift);
}

void Registers::set_st0(std::uint16_t value) {
  set_bits(*this, kSt0, value);
  pm = static_cast<std::uint8_t>(value >> kPmShift & 7U);
  const int counter = value >> kOvcShift;
  ovc = static_cast<std::int8_t>(counter > 31 ? counter - 64 : counter);
}

std::uint16_t Registers::st1() const {
  return static_cast<std::uint16_t>(bits_of(*this, kSt1) | static_cast<unsigned>(arp) << kArpShift);
}

void Registers::set_st1(std::uint16_t value) {
  set_bits(*this, kSt1, value);
  arp = static_cast<std::uint8_t>(value >> kArpShift);
}

}  // namespace stillspin::c28x
