// Runs of the drive in which synchronism is lost on purpose, and what came of it.
//
// Lost is a position error (true minus used angle) beyond 90 degrees el. A kick adds an angle to every estimator at
// once, written into the drive from here; the other causes act on the plant.

#ifndef STILLSPIN_TESTS_BENCH_LOSS_HPP
#define STILLSPIN_TESTS_BENCH_LOSS_HPP

#include <string>
#include <vector>

#include "sim_host/bench/run.hpp"

namespace stillspin::bench {

enum class Cause { kNone, kKick, kLoadStep, kSensorStuck, kSensorDrift, kOpenPhase };

struct LossCase {
  Cause cause;
  double value;   // degrees el., N m, A, A/s, phase 1..3
  double rpm;     // signed
  double torque;  // N m, load before
  int source;     // firmware parameter position_source
  bool bench;     // profile: bench, else ideal
  double watch;   // s after the cause
};

struct Loss {
  bool ran = false;  // up to speed, the cause has acted
  bool lost = false;
  double lost_after = 0.0;    // s from the cause to the loss
  double faulted_after = -1;  // s from the loss to the fault (from the cause when nothing was lost); negative: no fault
  double lost_for = 0.0;      // s beyond 90 degrees while the gates were on, in all
  double worst_ratio = 0.0;   // largest EMF error over its limit before the cause
  double speed_at_fault = 0.0;  // rpm
  std::string fault;            // its words
};

std::string words(const LossCase& c);
Loss run_case(const LossCase& c);

/// The campaign; `fast`: a part of it that covers every cause.
std::vector<LossCase> loss_cases(bool fast);

}  // namespace stillspin::bench

#endif
