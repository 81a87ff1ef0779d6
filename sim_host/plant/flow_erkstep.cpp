// The work horse: ARKODE's ERKStep with Zonneveld's 4(3) pair, restarted at every segment. Nearly always its first step
// is the whole segment. It finds no events itself: its root search would cost as much as all else together.

#include <cmath>

#include "sim_host/plant/event_search.hpp"
#include "sim_host/plant/sundials_problem.hpp"

namespace stillspin::plant {
namespace {

constexpr double kShortest = 1e-12;  // s: shorter segments are one Euler step (a change of at most 1e-7 A)

/// Next step size from the error of the last one, third-order estimate. In place of ARKODE's own controllers, whose
/// pow() depends on the processor.
int next_step(N_Vector, double, double h, double, double, double error, double, double, int, int, double* next, void*) {
  *next = h / std::sqrt(std::sqrt(std::fmax(error, 1e-10)));
  return 0;
}

class ErkStep final : public SteppingFlow {
 public:
  explicit ErkStep(double relative_tolerance)
      : problem_(relative_tolerance),
        memory_(ERKStepCreate(SundialsProblem::right_hand_side, 0.0, problem_.vector, problem_.context)) {
    check(ERKStepSetErrHandlerFn(memory_, SundialsProblem::silent, nullptr), "ERKStepSetErrHandlerFn");
    check(ERKStepSetUserData(memory_, &problem_), "ERKStepSetUserData");
    check(ERKStepSetTableNum(memory_, ARKODE_ZONNEVELD_5_3_4), "ERKStepSetTableNum");
    check(ERKStepSetAdaptivityFn(memory_, next_step, nullptr), "ERKStepSetAdaptivityFn");
    check(ERKStepSVtolerances(memory_, relative_tolerance, problem_.tolerance), "ERKStepSVtolerances");
  }

 private:
  void step(const Model& model, const SegmentStart& start, double h, State& end, State& end_slope) override {
    if (h < kShortest) {
      end = start.y + h * start.slope;
      end_slope = start.slope;
      return;
    }
    problem_.begin(model, start, h);
    check(ERKStepReset(memory_, 0.0, problem_.vector), "ERKStepReset");
    check(ERKStepSetInitStep(memory_, h), "ERKStepSetInitStep");
    double reached = 0.0;
    while (reached < h) {
      // A stop time costs an interpolation; the first step needs none.
      if (reached > 0.0) check(ERKStepSetStopTime(memory_, h), "ERKStepSetStopTime");
      check(ERKStepEvolve(memory_, h, problem_.vector, &reached, ARK_ONE_STEP), "ERKStepEvolve");
    }
    end = problem_.vector.state();
    end_slope = problem_.end_slope();
  }

  void check(int flag, const char* what) { problem_.check(flag, what); }

  SundialsProblem problem_;
  SolverMemory<ERKStepFree> memory_;
};

}  // namespace

std::unique_ptr<Flow> make_erkstep(double relative_tolerance) { return std::make_unique<ErkStep>(relative_tolerance); }

}  // namespace stillspin::plant
