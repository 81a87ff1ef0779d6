// Loses synchronism on purpose in many ways and prints what came of it: a line a run, tab-separated, then the worst
// times from the loss to the fault by speed. Argument --fast: the default position source in one direction only. Exit
// status 1 when a loss goes unnoticed; one that is noticed later than the goal is said.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>

#include "tests/bench/loss.hpp"

using namespace stillspin::bench;

namespace {

constexpr double GOAL_MS = 20.0;

struct Worst {
  int runs = 0, lost = 0, unnoticed = 0;
  double ms = 0.0;
};

void print(const LossCase& c, const Loss& l) {
  std::printf("%s\t%s\t%s\t", words(c).c_str(), l.ran ? "yes" : "no", l.lost ? "yes" : "no");
  std::printf("%.1f\t%.1f\t%.1f\t%.0f\t%s\n", 1e3 * l.lost_after, l.faulted_after < 0.0 ? -1.0 : 1e3 * l.faulted_after,
              1e3 * l.lost_for, l.end_rpm, l.end.c_str());
  std::fflush(stdout);
}

void count(const Loss& l, Worst& w) {
  w.runs++;
  if (!l.lost) return;
  w.lost++;
  w.unnoticed += l.faulted_after < 0.0;
  w.ms = std::max(w.ms, 1e3 * (l.faulted_after < 0.0 ? l.lost_for : l.faulted_after));
}

bool short_of_goal(const Worst& w) { return w.unnoticed > 0 || w.ms > GOAL_MS; }

}  // namespace

int main(int argc, char** argv) {
  const bool fast = argc > 1 && std::strcmp(argv[1], "--fast") == 0;
  std::map<double, Worst> by_speed;
  Worst hidden;
  std::printf("cause\trpm\tload Nm\tsource\tran\tlost\tlost after ms\tfault after ms\tlost for ms\tend rpm\tend\n");
  for (const LossCase& c : loss_cases(fast)) {
    const Loss l = run_case(c);
    print(c, l);
    count(l, c.hidden() ? hidden : by_speed[std::fabs(c.rpm)]);
  }
  std::printf("\nrpm\truns\tlost\tunnoticed\tworst ms\n");
  bool is_short = short_of_goal(hidden);
  int unnoticed = hidden.unnoticed;
  for (const auto& [rpm, w] : by_speed) {
    std::printf("%.0f\t%d\t%d\t%d\t%.1f\n", rpm, w.runs, w.lost, w.unnoticed, w.ms);
    is_short = is_short || short_of_goal(w);
    unnoticed += w.unnoticed;
  }
  std::printf("reversed at rest without torque\t%d\t%d\t%d\t%.1f\n", hidden.runs, hidden.lost, hidden.unnoticed,
              hidden.ms);
  std::printf("goal: all within %.0f ms: %s\n", GOAL_MS, is_short ? "short" : "met");
  return unnoticed > 0 ? 1 : 0;
}
