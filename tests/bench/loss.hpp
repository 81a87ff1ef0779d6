// Runs of the drive in which synchronism is lost on purpose, and what came of it.
//
// Lost is a position error (true minus used angle) beyond 90 degrees el. A kick adds an angle to every estimator at
// once, written into the drive from here; the other causes act on the plant. All runs are of profile `bench` with the
// fast integrator.

#ifndef STILLSPIN_TESTS_BENCH_LOSS_HPP
#define STILLSPIN_TESTS_BENCH_LOSS_HPP

#include <cmath>
#include <string>
#include <vector>

#include "sim_host/bench/run.hpp"

namespace stillspin::bench {

enum class Cause { kKick, kLoadStep, kSensorStuck, kSensorDrift, kOpenPhase };

struct LossCase {
  Cause cause;
  double value;   // degrees el., N m, A, A/s, phase 1..3
  double rpm;     // before, signed
  double torque;  // N m, load before
  int source;     // firmware parameter position_source
  int seed = 1;   // of the noise

  /// A polarity that turns over at rest without torque moves nothing, so nothing shows it until noise has.
  bool hidden() const { return cause == Cause::kKick && rpm == 0.0 && torque == 0.0 && std::fabs(value) > 179.0; }
};

struct Loss {
  bool ran = false;         // up to speed without a fault, and the cause has acted
  bool lost = false;        // beyond 90 degrees at some time before the fault
  double lost_after = 0.0;  // s from the cause to the loss
  double faulted_after =
      -1.0;               // s from the loss (from the cause when nothing was lost) to the fault; negative: no fault
  double lost_for = 0.0;  // s beyond 90 degrees with the gates on
  double end_rpm = 0.0;   // true speed at the fault, or at the end
  std::string end;        // the fault's words, or why the run ended
};

std::string words(const LossCase& c);
Loss run_case(const LossCase& c);

/// The campaign; `fast`: the part of it with the default source in one direction, which covers every cause.
std::vector<LossCase> loss_cases(bool fast);

}  // namespace stillspin::bench

#endif
