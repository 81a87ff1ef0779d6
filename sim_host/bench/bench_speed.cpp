// Simulated seconds per wall second of the whole virtual drive in profile `bench`, all events on, for both integrators.

#include <cstdio>

#include "sim_host/bench/run.hpp"

using namespace stillspin::bench;

namespace {

RunRequest bench_request(double solver) {
  RunRequest r;
  r.setup.nominal = stillspin::plant::PlantConfig();  // the defaults are the bench inverter and true parameters
  r.setup.solver = solver;
  r.commands = {{0.1, "speed_ref_rpm", 600.0}};
  r.load = {{1.0, 0.0}, {1.005, 2.0}};
  r.duration = 2.0;
  return r;
}

}  // namespace

int main() {
  const char* names[] = {"ERKStep", "fast fixed step"};
  double ratios[2] = {};
  for (int k = 0; k < 2; k++) {
    RunResult r = run(bench_request(k));
    ratios[k] = r.stats["simulated_seconds"] / r.stats["wall_seconds"];
    std::printf("%-16s %6.2f simulated seconds per second  (%s, %.0f register accesses and %.1f interrupts per period)\n",
                names[k], ratios[k], r.completed ? "completed" : r.reason.c_str(),
                r.stats["register_accesses"] / (r.stats["simulated_seconds"] * 1e4),
                r.stats["interrupts"] / (r.stats["simulated_seconds"] * 1e4));
  }
  std::printf("ratio of the two  %.2f\n", ratios[1] / ratios[0]);
  return 0;
}
