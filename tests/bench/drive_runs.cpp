#include "tests/bench/drive_runs.hpp"

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

}  // namespace stillspin::bench
