// One run of the virtual drive: power-on, start, a sequence of commands and loads, and a record of it.
//
// The firmware has static state, so one run at a time in a process. Time 0 of commands, loads, record and duration is
// the moment at which the drive has finished its start procedure; a speed reference for time 0 is given with the start
// already, as a user would: an I-F start turns the way that it says.

#ifndef STILLSPIN_SIM_HOST_BENCH_RUN_HPP
#define STILLSPIN_SIM_HOST_BENCH_RUN_HPP

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/bench/recording_tap.hpp"
#include "sim_host/bench/scale.hpp"
#include "sim_host/bench/setup.hpp"
#include "sim_host/bench/waveform.hpp"

namespace stillspin::bench {

struct Command {
  double time;       // s
  std::string what;  // "speed_ref_rpm", "start", "stop", "coast", "reset", "set:<parameter>"
  double value;
};

struct RunRequest {
  Setup setup;
  std::map<std::string, double> parameters;     // firmware parameters, in the table's units
  std::vector<Command> commands;                // in the order of time
  std::vector<std::pair<double, double>> load;  // s, N m; piecewise linear
  double duration = 1.0;                        // s, 0..3600
  double max_start = 2.0;                       // s from power-on to the end of the start procedure
  int record_every = 1;                         // PWM periods per record
  WaveformRequest waveform;                     // a stretch to look into
  bool record_start = false;                    // also record the start procedure, at negative times
  std::function<bool(double)> progress;         // share done; false stops the run
  RecordingSink recording;                      // gets every period from power-on, to be stepped elsewhere
  std::function<void(double)> on_period;        // for tests: time since the start, before each control interrupt
};

/// A recorded column and what it is.
struct ColumnInfo {
  const char* name;
  const char* unit;
  const char* meaning;
};
const std::vector<ColumnInfo>& columns();

struct RunResult {
  std::vector<std::vector<double>> values;  // one per column
  bool completed = false;
  std::string reason;
  std::vector<std::pair<double, std::string>> faults;
  std::map<std::string, double> stats;
  Waveform waveform;
};

/// Throws std::invalid_argument for what cannot be run (unknown parameter or command, value out of range).
RunResult run(const RunRequest& request);

/// Checks firmware parameters as the drive would: throws std::invalid_argument for an unknown one, a value out of range
/// or values that do not fit together.
void check_parameters(const std::map<std::string, double>& parameters);

/// Raw value of a firmware parameter from user units; throws std::invalid_argument with value, range and unit.
std::int32_t parameter_raw(const std::string& name, double value, const Scale& scale, unsigned& id);

}  // namespace stillspin::bench

#endif
