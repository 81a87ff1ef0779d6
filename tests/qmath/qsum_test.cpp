// Sums against 128-bit integers.

#include "hal/qmath/qsum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace {

using Wide = __int128;

constexpr std::int64_t kEnd = INT64_MAX / 2;
constexpr std::int64_t kEdges[] = {
    INT64_MIN, INT64_MIN + 1, -kEnd - 2, -kEnd - 1, -kEnd,    -kEnd + 1,     INT32_MIN, -1, 0,
    1,         INT32_MAX,     kEnd - 1,  kEnd,      kEnd + 1, INT64_MAX - 1, INT64_MAX};

TEST(QSum, IsTheSumUpToItsEnd) {
  for (const std::int64_t sum : kEdges) {
    for (const std::int64_t x : kEdges) {
      if (x < -kEnd - 1 || x > kEnd + 1) continue;
      const Wide wanted = std::clamp<Wide>(sum, -kEnd, kEnd) + Wide{x};
      ASSERT_LE(wanted, INT64_MAX);
      ASSERT_GE(wanted, INT64_MIN);
      std::int64_t got = sum;
      q_gather(&got, x);
      EXPECT_EQ(got, static_cast<std::int64_t>(wanted)) << sum << " + " << x;
    }
  }
}

TEST(QSum, NeverWraps) {
  std::int64_t up = 0;
  std::int64_t down = 0;
  for (int k = 0; k < 100; ++k) {
    q_gather(&up, kEnd + 1);
    q_gather(&down, -kEnd - 1);
    EXPECT_GT(up, 0);
    EXPECT_LT(down, 0);
  }
}

}  // namespace
