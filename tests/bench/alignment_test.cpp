// A row compares like with like: the true angle and the angle that the controller used are of one instant.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;

double wrapped_degrees(double radians) { return std::remainder(radians, 2.0 * kPi) * 180.0 / kPi; }

struct ErrorRange {
  double lowest = 1e9, highest = -1e9, mean = 0.0;
};

// True minus used angle, degrees el., over the last part of a run whose rows are `shift` apart.
ErrorRange error_of(const RunResult& result, std::size_t shift) {
  const auto& truth = column(result, "true_angle");
  const auto& used = column(result, "est_angle");
  ErrorRange range;
  const std::size_t begin = truth.size() / 2;
  for (std::size_t k = begin; k + shift < truth.size(); ++k) {
    const double error = wrapped_degrees(truth[k + shift] - used[k]);
    range.lowest = std::min(range.lowest, error);
    range.highest = std::max(range.highest, error);
    range.mean += error / static_cast<double>(truth.size() - shift - begin);
  }
  return range;
}

TEST(Alignment, TrueAndUsedAngleAreOfOneInstant) {
  RunRequest request = encoder_request(1.0);
  request.parameters["speed_ramp"] = 0.0;
  request.commands = {{0.0, "speed_ref_rpm", 1500.0}};
  const RunResult result = run(request);
  ASSERT_TRUE(result.completed) << result.reason;
  ASSERT_NEAR(column(result, "true_speed").back(), 1500.0, 5.0);

  // 1500 rpm with 4 pole pairs is 3.6 degrees el. a period; one count of the encoder is 0.35 degrees el., so the mean
  // lags by half a count, and the zero found at the start is as good as AVV was then. Half of the 3.6 degrees tells a
  // row of the same instant from one of the next.
  const ErrorRange same = error_of(result, 0);
  EXPECT_NEAR(same.mean, 0.18, 1.8);
  EXPECT_LT(same.highest - same.lowest, 1.0);
  // The measure itself must see a shift of one row.
  EXPECT_NEAR(error_of(result, 1).mean - same.mean, 3.6, 0.1);
}

TEST(Alignment, RowsAreOnePeriodApartAndCoverTheDuration) {
  const RunResult result = run(encoder_request(0.05));
  ASSERT_TRUE(result.completed) << result.reason;
  const auto& time = column(result, "time");
  ASSERT_GE(time.size(), 500u);
  EXPECT_EQ(time.front(), 0.0);
  EXPECT_GE(time.back(), 0.05 - 1.5e-4);
  EXPECT_LE(time.back(), 0.05 + 1.5e-4);
  // Times are differences of tick counts in double: 1e-12 is rounding.
  for (std::size_t k = 0; k < time.size(); ++k) EXPECT_NEAR(time[k], 1e-4 * static_cast<double>(k), 1e-12);
  for (const auto& values : result.values) EXPECT_EQ(values.size(), time.size());
}

TEST(Alignment, RecordEveryThinsTheRowsAndChangesNothingElse) {
  RunRequest request = noisy_request(0.03, 1);
  const RunResult every = run(request);
  request.record_every = 7;
  const RunResult thinned = run(request);
  ASSERT_TRUE(every.completed) << every.reason;
  ASSERT_TRUE(thinned.completed) << thinned.reason;
  for (std::size_t c = 0; c < columns().size(); ++c) {
    ASSERT_EQ(thinned.values[c].size(), (every.values[c].size() + 6) / 7);
    for (std::size_t k = 0; k < thinned.values[c].size(); ++k) {
      EXPECT_EQ(thinned.values[c][k], every.values[c][7 * k]) << columns()[c].name << ", row " << k;
    }
  }
}

}  // namespace
}  // namespace stillspin::bench
