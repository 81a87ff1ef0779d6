// The same seed gives the same bytes; another seed gives other noise.

#include <gtest/gtest.h>

#include <cstring>

#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

RunRequest request(std::uint64_t seed) {
  RunRequest r = noisy_request(0.2, seed);
  r.commands = {{0.02, "speed_ref_rpm", 300.0}};
  r.load = {{0.1, 0.0}, {0.105, 2.0}};
  return r;
}

bool same_bytes(const RunResult& one, const RunResult& other) {
  if (one.values.size() != other.values.size()) return false;
  for (std::size_t c = 0; c < one.values.size(); ++c) {
    const auto& x = one.values[c];
    const auto& y = other.values[c];
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) != 0) return false;
  }
  return true;
}

TEST(Determinism, TheSameSeedGivesTheSameBytes) {
  const RunResult one = run(request(5));
  const RunResult other = run(request(5));
  ASSERT_TRUE(one.completed) << one.reason;
  EXPECT_TRUE(same_bytes(one, other));
}

// The firmware's variables outlive a run: what a run before has done must not show.
TEST(Determinism, ARunDoesNotDependOnTheRunBefore) {
  const RunResult fresh = run(request(5));
  RunRequest different = request(9);
  different.parameters["current_limit"] = 6.0;
  different.parameters["weakening_limit"] = 6.0;
  different.parameters["speed_ramp"] = 500.0;
  different.parameters["dead_time"] = 1.5;
  different.commands = {{0.0, "speed_ref_rpm", -200.0}};
  const RunResult between = run(different);
  ASSERT_TRUE(between.completed) << between.reason;
  const RunResult again = run(request(5));
  ASSERT_TRUE(fresh.completed) << fresh.reason;
  EXPECT_TRUE(same_bytes(fresh, again));
}

TEST(Determinism, AnotherSeedGivesOtherNoise) {
  const RunResult one = run(request(5));
  const RunResult other = run(request(6));
  EXPECT_FALSE(same_bytes(one, other));
}

}  // namespace
}  // namespace stillspin::bench
