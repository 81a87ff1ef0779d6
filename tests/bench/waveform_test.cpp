// The oscilloscope of the bench: it sees every edge, it keeps its raster, and it changes nothing.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/bench/drive_runs.hpp"

namespace stillspin::bench {
namespace {

RunRequest request() {
  RunRequest r = noisy_request(0.1, 3);
  r.commands = {{0.02, "speed_ref_rpm", 200.0}};
  return r;
}

RunRequest looking() {
  RunRequest r = request();
  r.waveform = {0.05, 0.06, 100};
  return r;
}

const std::vector<double>& values(const RunResult& result, std::string_view table, std::string_view name) {
  for (const auto& [known, columns_of] : result.waveform) {
    for (const auto& [column_name, data] : columns_of) {
      if (known == table && column_name == name) return data;
    }
  }
  throw std::out_of_range(std::string(table) + "." + std::string(name));
}

TEST(Waveform, LookingChangesNothing) {
  const RunResult blind = run(request());
  const RunResult seen = run(looking());
  ASSERT_TRUE(blind.completed) << blind.reason;
  ASSERT_EQ(blind.values.size(), seen.values.size());
  for (std::size_t c = 0; c < blind.values.size(); ++c) {
    ASSERT_EQ(blind.values[c].size(), seen.values[c].size());
    EXPECT_EQ(std::memcmp(blind.values[c].data(), seen.values[c].data(), blind.values[c].size() * sizeof(double)), 0)
        << columns()[c].name;
  }
  EXPECT_TRUE(values(blind, "raster", "time").empty());
}

TEST(Waveform, RasterIsEvenAndAgreesWithTheRecord) {
  const RunResult result = run(looking());
  const auto& time = values(result, "raster", "time");
  ASSERT_EQ(time.size(), 10000u);
  EXPECT_NEAR(time.front(), 0.05, 1e-12);
  for (std::size_t k = 1; k < time.size(); ++k) ASSERT_NEAR(time[k] - time[k - 1], 1e-6, 1e-12);
  const auto& recorded = column(result, "i_a");
  const auto& at = column(result, "time");
  for (std::size_t row = 0; row < at.size(); ++row) {
    if (at[row] < 0.05 - 1e-9 || at[row] > 0.06 - 1e-9) continue;
    const auto k = static_cast<std::size_t>(std::lround((at[row] - 0.05) * 1e6));
    EXPECT_EQ(values(result, "raster", "i_a")[k], recorded[row]) << at[row];
  }
}

// In every period each leg has one pulse, and each device is switched on and off once.
TEST(Waveform, SeesEveryEdgeAndEverySample) {
  const RunResult result = run(looking());
  const auto& leg = values(result, "edges", "leg");
  const auto& upper = values(result, "edges", "upper");
  for (int k = 0; k < 3; ++k) {
    int rises = 0;
    double level = 0.0;
    for (std::size_t n = 0; n < leg.size(); ++n) {
      if (static_cast<int>(leg[n]) != k) continue;
      rises += upper[n] > level ? 1 : 0;
      level = upper[n];
    }
    EXPECT_NEAR(rises, 100, 1) << "leg " << k;
  }
  // two or three windows a period, seven samples of the currents in each
  const std::size_t samples = values(result, "samples", "time").size();
  EXPECT_GE(samples, 2u * 7u * 100u);
  EXPECT_LE(samples, 3u * 7u * 100u);
}

TEST(Waveform, RefusesARasterOfNothing) {
  RunRequest r = looking();
  r.waveform.raster = 0;
  EXPECT_THROW(run(r), std::invalid_argument);
}

}  // namespace
}  // namespace stillspin::bench
