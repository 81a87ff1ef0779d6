#include "tests/bench/drive_runs.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace stillspin::bench {

RunRequest encoder_request(double duration) {
  RunRequest request;
  request.setup.nominal = plant::PlantConfig::ideal();
  request.setup.nominal.initial.angle = 0.0;  // where the encoder counts from
  request.parameters = {{"position_source", 0.0}};
  request.duration = duration;
  return request;
}

RunRequest noisy_request(double duration, std::uint64_t seed) {
  RunRequest request = encoder_request(duration);
  request.setup.nominal = plant::PlantConfig();
  request.setup.nominal.initial.angle = 0.0;
  request.setup.nominal.adc.seed = seed;
  return request;
}

const std::vector<double>& column(const RunResult& result, std::string_view name) {
  for (std::size_t k = 0; k < columns().size(); ++k) {
    if (name == columns()[k].name) return result.values.at(k);
  }
  throw std::out_of_range("no column " + std::string(name));
}

double at(const RunResult& result, std::string_view name, double when) {
  const auto& time = column(result, "time");
  const auto k = std::lower_bound(time.begin(), time.end(), when) - time.begin();
  return column(result, name).at(static_cast<std::size_t>(k));
}

double error_between(const RunResult& result, double begin, double end) {
  constexpr double kPi = 3.14159265358979323846;
  const auto& time = column(result, "time");
  const auto& truth = column(result, "true_angle");
  const auto& used = column(result, "est_angle");
  double worst = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (time[k] < begin || time[k] > end) continue;
    worst = std::max(worst, std::fabs(std::remainder(truth[k] - used[k], 2.0 * kPi)) * 180.0 / kPi);
  }
  return worst;
}

}  // namespace stillspin::bench
