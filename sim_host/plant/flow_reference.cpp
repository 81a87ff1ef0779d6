// The yardstick: CVODE, restarted at every segment, with SUNDIALS' own root search on falling event functions: it has
// nothing in common with the other flows but the model.

#include <algorithm>
#include <cmath>

#include "sim_host/plant/sundials_problem.hpp"

namespace stillspin::plant {
namespace {

constexpr double kMissed = 1e-8;       // A or V: an event function below this has crossed unseen
constexpr double kShortest = 1e-12;    // s: shorter segments are one Euler step (a change of at most 1e-7 A)
constexpr double kFirstPart = 1.6e-6;  // s: where to look closer for a crossing that went unseen
constexpr double kTolerance = 1e-10;
constexpr double kLongestStep = 2e-6;  // s: what a double crossing inside a step may hide

class Reference final : public Flow {
 public:
  Reference()
      : problem_(0.1 * kTolerance),
        memory_(CVodeCreate(CV_ADAMS, problem_.context)),
        nonlinear_(problem_.vector, problem_.context) {
    check(CVodeInit(memory_, SundialsProblem::right_hand_side, 0.0, problem_.vector), "CVodeInit");
    check(CVodeSetErrHandlerFn(memory_, SundialsProblem::silent, nullptr), "CVodeSetErrHandlerFn");
    check(CVodeSetUserData(memory_, &problem_), "CVodeSetUserData");
    check(CVodeSVtolerances(memory_, kTolerance, problem_.tolerance), "CVodeSVtolerances");
    check(CVodeSetNonlinearSolver(memory_, nonlinear_), "CVodeSetNonlinearSolver");
    check(CVodeSetMaxStep(memory_, kLongestStep), "CVodeSetMaxStep");
    check(CVodeSetMaxNumSteps(memory_, 100000), "CVodeSetMaxNumSteps");
    check(CVodeRootInit(memory_, kEvents, SundialsProblem::event_functions), "CVodeRootInit");
    int falling[kEvents];
    std::fill_n(falling, kEvents, -1);
    check(CVodeSetRootDirection(memory_, falling), "CVodeSetRootDirection");
    check(CVodeSetNoInactiveRootWarn(memory_), "CVodeSetNoInactiveRootWarn");
  }

  void advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) override {
    result = search(model, start, h, end);
  }

 private:
  /// Whole way, or to the first event; a part of the way when a crossing went unseen.
  Advance search(const Model& model, const SegmentStart& start, double h, State& end) {
    Advance a;
    if (h < kShortest) {
      end = start.y + h * start.slope;
      a.reached = h;
      return a;
    }
    a = attempt(model, start, h, end);
    if (a.event) return sharpened(a, model, start, h, end);
    Events g;
    model.events(h, end, g);
    if (*std::min_element(g.begin(), g.end()) >= -kMissed) return a;
    // Both ends of a step on the same side, or a start within rounding of zero, hide a crossing: look closer.
    for (double part = kFirstPart; part > kShortest; part *= 0.25) {
      if (part >= h) continue;
      a = attempt(model, start, part, end);
      if (a.event) return a;
      model.events(part, end, g);
      if (*std::min_element(g.begin(), g.end()) >= -kMissed) return a;
    }
    a.reached = 0.0;  // wrong from the start
    a.event = true;
    for (int n = 0; n < kEvents; ++n) a.fired[n] = g[n] < -kMissed;
    end = start.y;
    return a;
  }

  /// The event again, over a step that ends just behind it: a shorter interpolant is a better one.
  Advance sharpened(const Advance& first, const Model& model, const SegmentStart& start, double h, State& end) {
    const double again = std::ceil(first.reached / kEventCell) * kEventCell;
    if (again < kShortest) return first;
    const Advance better = attempt(model, start, again, end);
    return better.event ? better : attempt(model, start, h, end);
  }

  Advance attempt(const Model& model, const SegmentStart& start, double h, State& end) {
    problem_.begin(model, start, h);
    check(CVodeReInit(memory_, 0.0, problem_.vector), "CVodeReInit");
    check(CVodeSetStopTime(memory_, h), "CVodeSetStopTime");
    Advance a;
    a.reached = h;
    const int flag = CVode(memory_, h, problem_.vector, &a.reached, CV_NORMAL);
    check(flag, "CVode");
    end = problem_.vector.state();
    if (flag != CV_ROOT_RETURN) return a;
    int roots[kEvents];
    check(CVodeGetRootInfo(memory_, roots), "CVodeGetRootInfo");
    for (int n = 0; n < kEvents; ++n) a.fired[n] = roots[n] != 0;
    a.event = true;
    return a;
  }

  void check(int flag, const char* what) { problem_.check(flag, what); }

  SundialsProblem problem_;
  SolverMemory<CVodeFree> memory_;
  FixedPoint nonlinear_;
};

}  // namespace

std::unique_ptr<Flow> make_reference() { return std::make_unique<Reference>(); }

std::unique_ptr<Flow> make_flow(const SolverConfig& config) {
  switch (config.solver) {
    case Solver::kErkStep:
      return make_erkstep(config.relative_tolerance);
    case Solver::kReference:
      return make_reference();
    case Solver::kRungeKutta:
      break;
  }
  return make_runge_kutta();
}

}  // namespace stillspin::plant
