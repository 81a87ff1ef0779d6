// The worst error of a function over many arguments, and where it occurs; and arguments worth trying.

#ifndef STILLSPIN_TESTS_QMATH_WORST_HPP
#define STILLSPIN_TESTS_QMATH_WORST_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace stillspin::test {

// Collects errors; on destruction prints the worst one and records it with the test.
class Worst {
 public:
  explicit Worst(std::string what) : what_(std::move(what)) {}
  Worst(const Worst&) = delete;
  Worst& operator=(const Worst&) = delete;

  ~Worst() {
    std::printf("  %s: worst error %.6g at (%lld, %lld)\n", what_.c_str(), error_, a_, b_);
    testing::Test::RecordProperty("worst_" + what_, std::to_string(error_));
  }

  void add(double error, std::int64_t a, std::int64_t b = 0) {
    if (std::fabs(error) > error_) {
      error_ = std::fabs(error);
      a_ = a;
      b_ = b;
    }
  }

  double error() const { return error_; }

 private:
  std::string what_;
  double error_ = 0.0;
  long long a_ = 0;
  long long b_ = 0;
};

// 0, the ends of the range, and every power of two with its neighbours, of both signs: where carries and signs turn.
inline std::vector<std::int32_t> edges() {
  std::vector<std::int32_t> list = {0};
  for (int bit = 0; bit < 32; ++bit) {
    for (std::int64_t delta = -2; delta <= 2; ++delta) {
      const std::int64_t value = (std::int64_t{1} << bit) + delta;
      if (value <= INT32_MAX) list.push_back(static_cast<std::int32_t>(value));
      if (-value >= INT32_MIN) list.push_back(static_cast<std::int32_t>(-value));
    }
  }
  return list;
}

// Random numbers of every magnitude: uniform bits, shifted right by a random amount.
class RandomInt32 {
 public:
  explicit RandomInt32(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  std::int32_t operator()() {
    const auto value = static_cast<std::int32_t>(bits());
    return value / (std::int32_t{1} << (bits() % 31));
  }
  unsigned below(unsigned limit) { return bits() % limit; }

 private:
  std::mt19937 engine_;
};

}  // namespace stillspin::test

#endif
