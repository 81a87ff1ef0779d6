// libFuzzer's way in: see play.hpp. Built by `make fuzz` alone.

#include <cstdio>

#include "tests/fuzz/play.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* octets, std::size_t count) {
  const std::string problem = stillspin::test::play(octets, count);
  if (problem.empty()) return 0;
  std::fprintf(stderr, "%s\n", problem.c_str());
  __builtin_trap();
}
