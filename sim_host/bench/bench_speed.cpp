// Simulated seconds per wall second of the whole virtual drive in profile `bench`, all events on, recorded once a
// millisecond, for both integrators: the best of several runs of the same bytes, since whatever else the machine does
// can only slow a run down.
// With a speed in rpm as argument: one short run at that speed and nothing else, for instruction counting; a second
// argument 0 or 1 chooses ERKStep or the fast path (default).

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "sim_host/bench/run.hpp"

using namespace stillspin::bench;

namespace {

RunRequest bench_request(double solver) {
  RunRequest r;
  r.record_every = 10;                                // once a millisecond
  r.setup.nominal = stillspin::plant::PlantConfig();  // the defaults are the bench inverter and true parameters
  r.setup.solver = solver;
  r.commands = {{0.1, "speed_ref_rpm", 600.0}};
  r.load = {{1.0, 0.0}, {1.005, 2.0}};
  r.duration = 2.0;
  return r;
}

constexpr int REPEATS = 9;

double speed(const RunResult& result) { return result.stats.at("simulated_seconds") / result.stats.at("wall_seconds"); }

RunResult fastest(int solver) {
  RunResult best = run(bench_request(solver));
  for (int k = 1; k < REPEATS; k++) {
    RunResult next = run(bench_request(solver));
    if (speed(next) > speed(best)) {
      std::swap(best, next);
    }
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    RunRequest r = bench_request(argc > 2 ? std::atof(argv[2]) : 1.0);
    r.commands = {{0.0, "speed_ref_rpm", std::atof(argv[1])}};
    r.duration = 0.5;
    const RunResult result = run(r);
    std::printf("%s\n", result.completed ? "completed" : result.reason.c_str());
    return result.completed ? 0 : 1;
  }
  const char* names[] = {"ERKStep", "fast fixed step"};
  double ratios[2] = {};
  for (int k = 0; k < 2; k++) {
    RunResult r = fastest(k);
    ratios[k] = speed(r);
    std::printf(
        "%-16s %6.2f simulated seconds per second, %2.0f %% of it plant  (best of %d, %s, %.0f register accesses "
        "and %.1f interrupts per period)\n",
        names[k], ratios[k], 100.0 * r.stats["plant_share"], REPEATS, r.completed ? "completed" : r.reason.c_str(),
        r.stats["register_accesses"] / (r.stats["simulated_seconds"] * 1e4),
        r.stats["interrupts"] / (r.stats["simulated_seconds"] * 1e4));
  }
  std::printf("ratio of the two  %.2f\n", ratios[1] / ratios[0]);
  return 0;
}
