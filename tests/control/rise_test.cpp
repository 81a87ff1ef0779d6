// The straight line between two ends against the same in double precision, for any ends.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>

extern "C" {
#include "control/rise.h"
}

namespace {

double wanted(int32_t x, int32_t from, int32_t to) {
  const double share = (static_cast<double>(x) - from) / (static_cast<double>(to) - from);
  return std::clamp(share, 0.0, 1.0) * RISE_ONE_Q30;
}

TEST(Rise, IsNothingUpToItsBeginningAndOneFromItsEndOn) {
  for (const int32_t x : {INT32_MIN, -5, 3}) EXPECT_EQ(rise_q30(x, 3, 4), 0) << x;
  for (const int32_t x : {4, 5, INT32_MAX}) EXPECT_NEAR(rise_q30(x, 3, 4), RISE_ONE_Q30, 4) << x;
  EXPECT_NEAR(rise_q30(4, 3, 5), RISE_ONE_Q30 / 2, 4);
}

TEST(Rise, IsAStraightLine) {
  std::mt19937 source(2808);
  std::uniform_int_distribution<int32_t> any(INT32_MIN / 2, INT32_MAX / 2);
  for (int k = 0; k < 100000; k++) {
    const int32_t shift = k % 28;
    const int32_t one = any(source) >> shift;
    const int32_t other = any(source) >> shift;
    const int32_t from = std::min(one, other);
    const int32_t to = std::max(one, other);
    const int32_t x = any(source) >> shift;
    if (from == to) continue;
    ASSERT_NEAR(rise_q30(x, from, to), wanted(x, from, to), 4.0) << from << " " << to << " " << x;
  }
}

}  // namespace
