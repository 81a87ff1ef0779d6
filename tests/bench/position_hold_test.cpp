// The place that is kept at a reference of zero is that of the last start, however the drive ended before.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/mode/commands.h"
#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kDegree = kTurn / 360.0;
constexpr double kMoved = 0.3;  // s: by then the shaft has been moved and stands

// Coasts, is turned by a good eighth of a mechanical turn by hand, as it were, and starts again.
RunRequest moved_by_hand() {
  RunRequest request = encoder_request(1.5);
  request.load = {{0.12, 0.0}, {0.121, 0.5}, {0.18, 0.5}, {0.181, -0.5}, {0.24, -0.5}, {0.241, 0.0}};
  request.commands = {{0.1, "coast", 0.0}, {kMoved, "start", 0.0}};
  return request;
}

double furthest(const RunResult& result, double from, double to) {
  const auto& time = column(result, "time");
  const auto& angle = column(result, "true_angle");
  double first = NAN, most = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] < from || time[k] > to) continue;
    if (std::isnan(first)) first = angle[k];
    most = std::max(most, std::fabs(std::remainder(angle[k] - first, kTurn)));
  }
  return most;
}

TEST(PositionHold, AStartTakesThePlaceWhereTheShaftIs) {
  const RunResult result = run(moved_by_hand());
  ASSERT_TRUE(result.completed) << result.reason;
  EXPECT_EQ(column(result, "state").back(), DRIVE_RUN);
  ASSERT_GT(furthest(result, 0.1, kMoved), 60.0 * kDegree) << "it was not moved";
  EXPECT_LT(furthest(result, 0.6, 1.5), 5.0 * kDegree);
}

}  // namespace
}  // namespace stillspin::bench
