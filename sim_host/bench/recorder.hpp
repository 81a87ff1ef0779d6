// The record of a run: true values at the start of a period beside the firmware's signals of that very period.
//
// At the start of every period the plant is looked at; the control interrupt then runs with the angle of that instant,
// and its signals are read when the next period starts. So a row compares like with like.

#ifndef STILLSPIN_SIM_HOST_BENCH_RECORDER_HPP
#define STILLSPIN_SIM_HOST_BENCH_RECORDER_HPP

#include <vector>

#include "firmware/drive/signals.h"
#include "firmware/mode/commands.h"
#include "sim_host/bench/information.hpp"
#include "sim_host/bench/run.hpp"
#include "sim_host/plant/plant.hpp"

namespace stillspin::bench {

class Recorder {
 public:
  Recorder(int every, const plant::PlantConfig& config);

  void reserve(std::size_t rows);

  /// Completes the row of the period before with the firmware's signals and what its windows told.
  void finish_row(const drive_signals_t& signals, const drive_samples_t& samples);

  /// Begins a row with the plant's present state, if one is due.
  void begin_row(double time, const plant::Plant& plant);

  /// The record, with times counted from `origin` (s).
  std::vector<std::vector<double>> take(double origin);

 private:
  WindowInformation information_;
  int every_;
  int skipped_ = 0;
  bool open_ = false;
  double time_ = 0.0;
  plant::PlantState state_;
  std::vector<std::vector<double>> values_;
};

}  // namespace stillspin::bench

#endif
