// Commissioning on the virtual drive: power-on, the firmware's own commissioning, its results.

#ifndef STILLSPIN_SIM_HOST_BENCH_COMMISSION_HPP
#define STILLSPIN_SIM_HOST_BENCH_COMMISSION_HPP

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim_host/bench/recording_tap.hpp"
#include "sim_host/bench/setup.hpp"

namespace stillspin::bench {

struct CommissionRequest {
  Setup setup;
  std::map<std::string, double> parameters;                  // what the drive is told beforehand
  double limit = 120.0;                                      // s of simulated time, 0..3600
  std::function<bool(double, const std::string&)> progress;  // share done, phase in words; false stops
  RecordingSink recording;                                   // gets every period, to be stepped elsewhere
};

/// One identified parameter, in the table's units.
struct Identified {
  std::string name, unit;
  int decimals = 0;
  double before = 0.0, value = 0.0;
  bool used = false;
  std::string words;
};

struct CommissionResult {
  std::vector<Identified> values;
  bool completed = false;  // ran to its end, whatever became of the values
  std::string reason;      // why not
  std::map<std::string, double> stats;
};

/// Throws std::invalid_argument for what cannot be run.
CommissionResult commission(const CommissionRequest& request);

}  // namespace stillspin::bench

#endif
