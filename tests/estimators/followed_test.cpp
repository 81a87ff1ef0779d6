// Whether a current counts as having followed: by the end of each step alone, and the worst of them.

#include <gtest/gtest.h>

#include <cmath>

extern "C" {
#include "estimators/followed.h"
}

namespace {

constexpr std::int16_t kLength = 40;

std::int32_t amps(double x) { return static_cast<std::int32_t>(std::lround(x * 1048576.0)); }

/// A current that slews towards +-1 A for four steps, this much in a period.
followed_t slewed(double step) {
  followed_t f = {};
  double current = 0.0;
  for (int segment = 0; segment < 4; ++segment) {
    const double asked = (segment % 2 == 0) ? 1.0 : -1.0;
    for (std::int16_t tick = 0; tick < kLength; ++tick) {
      current += std::fmin(std::fmax(asked - current, -step), step);
      followed_step(&f, tick, kLength, amps(asked), amps(current));
    }
  }
  return f;
}

TEST(Followed, OneThatIsThereInTimeHas) {
  const followed_t f = slewed(0.1);
  EXPECT_EQ(f.worst_q20, 0);
  EXPECT_TRUE(followed_well(&f, amps(1.0)));
}

// From -1 to 1 A at s a period, the mean of periods 31 .. 40 is 2 - 35.5 s away: 0.375 A at s = 0.0458.
TEST(Followed, ThreeEighthsOfTheAmplitudeAreTheLimit) {
  const followed_t well = slewed(0.0460), late = slewed(0.0450);
  EXPECT_NEAR(late.worst_q20 / 1048576.0, 2.0 - 35.5 * 0.0450, 0.02);
  EXPECT_TRUE(followed_well(&well, amps(1.0)));
  EXPECT_FALSE(followed_well(&late, amps(1.0)));
}

TEST(Followed, TheWorstStepCounts) {
  followed_t f = {};
  for (const double error : {0.1, -0.7, 0.2}) {
    for (std::int16_t tick = 0; tick < kLength; ++tick) followed_step(&f, tick, kLength, amps(1.0), amps(1.0 - error));
  }
  EXPECT_NEAR(f.worst_q20 / 1048576.0, 0.7, 1e-4);
}

TEST(Followed, NothingOverflows) {
  followed_t f = {};
  for (std::int16_t tick = 0; tick < 81; ++tick) followed_step(&f, tick, 81, INT32_MIN, INT32_MAX);
  EXPECT_NEAR(f.worst_q20, INT32_MAX, 100);
  EXPECT_FALSE(followed_well(&f, INT32_MAX));
}

}  // namespace
