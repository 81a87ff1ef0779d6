// Loses synchronism on purpose in many ways and prints what came of it, one line a run, tab-separated: the case, ms
// from the cause to the loss, ms from the loss to the fault, ms beyond 90 degrees, speed at the end, the fault's words.
// Argument --fast: a part of the campaign.

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "tests/bench/loss.hpp"

using namespace stillspin::bench;

int main(int argc, char** argv) {
  const bool fast = argc > 1 && std::strcmp(argv[1], "--fast") == 0;
  double worst = 0.0;
  double ratio = 0.0;
  for (const LossCase& c : loss_cases(fast)) {
    const Loss l = run_case(c);
    std::printf("%s\t%d\t%d\t%.1f\t%.1f\t%.1f\t%.0f\t%.2f\t%s\n", words(c).c_str(), l.ran, l.lost,
                l.lost ? 1e3 * l.lost_after : -1.0, l.faulted_after >= 0 ? 1e3 * l.faulted_after : -1.0,
                1e3 * l.lost_for, l.speed_at_fault, l.worst_ratio, l.fault.c_str());
    std::fflush(stdout);
    if (l.lost) worst = std::max(worst, l.faulted_after >= 0 ? l.faulted_after : l.lost_for);
    ratio = std::max(ratio, l.worst_ratio);
  }
  std::printf("worst\t%.1f\nratio\t%.2f\n", 1e3 * worst, ratio);
  return 0;
}
