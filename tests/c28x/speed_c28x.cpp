// How fast the C28x core is: a control loop's mix of loads, products, shifts, stores, branches and a call, without
// peripherals.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "sim_host/chip/c28x/core.hpp"

namespace {

using namespace stillspin::c28x;

class NoMemory final : public Bus {
 public:
  std::uint16_t read(std::uint32_t) override { return 0; }
  void write(std::uint32_t, std::uint16_t) override {}
};

constexpr std::uint16_t kProgram[] = {
    0x761F, 0x0100,  // 00 MOVW DP,#0x100
    0x9201,          // 02 MOV AL,@1
    0x9C03,          // 03 ADDB AL,#3
    0x9601,          // 04 MOV @1,AL
    0x8702,          // 05 MOVL XT,@2
    0x5667, 0x0004,  // 06 QMPYL P,XT,@4
    0x0606,          // 08 MOVL ACC,@6
    0x10AC,          // 09 ADDL ACC,P << PM
    0xFF32,          // 0A LSL ACC,#3
    0x1E02,          // 0B MOVL @2,ACC
    0x767F, 0x8018,  // 0C LCR 0x3F8018
    0x5411,          // 0E CMP AL,@17
    0x6202,          // 0F SB 0x11,GT
    0x0A12,          // 10 INC @18
    0xD405,          // 11 MOVB XAR4,#5
    0x000C, 0x0000,  // 12 BANZ 0x12,AR4--
    0x6FEC,          // 14 SB 0,UNC
    0x7700, 0x7700, 0x7700,
    0x2D08,  // 18 MOV T,@8
    0x3309,  // 19 MPY P,T,@9
    0xA90A,  // 1A MOVL @10,P
    0x0006,  // 1B LRETR
};

}  // namespace

int main() {
  std::vector<std::uint16_t> low(0x10000);
  std::vector<std::uint16_t> high(0x10000);
  for (std::size_t k = 0; k < sizeof kProgram / sizeof *kProgram; ++k) high[0x8000 + k] = kProgram[k];
  NoMemory bus;
  Core core(bus);
  core.map(0, 0x10000, low.data(), true);
  core.map(0x3F0000, 0x10000, high.data(), true);
  core.r.pc = 0x3F8000;
  const auto begin = std::chrono::steady_clock::now();
  core.run(200'000'000);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
  std::printf("%.1f million instructions/s, %.1f million cycles/s\n",
              static_cast<double>(core.instructions) / spent.count() * 1e-6,
              static_cast<double>(core.cycles) / spent.count() * 1e-6);
  return 0;
}
