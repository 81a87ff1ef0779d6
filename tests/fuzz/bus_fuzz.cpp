// libFuzzer's way in: see play_bus.hpp. Built by `make fuzz` alone.

#include <cstdio>

#include "tests/fuzz/play_bus.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* octets, std::size_t count) {
  const std::string problem = stillspin::test::play_bus(octets, count);
  if (problem.empty()) return 0;
  std::fprintf(stderr, "%s\n", problem.c_str());
  __builtin_trap();
}
