// The SUNDIALS flows: ERKStep (work horse) and CVODE (reference). Both restart at every segment, stop exactly at its
// end, and find events with SUNDIALS' own root search on falling event functions.

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "sim_host/plant/flow.hpp"
#include "sim_host/plant/sundials_handles.hpp"

namespace stillspin::plant {
namespace {

constexpr double kMissed = 1e-8;       // A or V: an event function below this has crossed unseen
constexpr double kShortest = 1e-12;    // s: shorter segments are one Euler step (a change of at most 1e-7 A)
constexpr double kFirstPart = 1.6e-6;  // s: where to look closer for a crossing that went unseen
constexpr double kReferenceTolerance = 1e-10;
constexpr double kReferenceStep = 2e-6;                            // s: what a double crossing inside a step may hide
constexpr double kTypical[kStates] = {1.0, 1.0, 1.0, 1.0, 100.0};  // scale of the absolute tolerance; angle in rad

struct UserData {
  const Model* model = nullptr;
  std::exception_ptr error;
};

template <typename Call>
int guarded(void* user, Call call) {
  auto* data = static_cast<UserData*>(user);
  try {
    call(*data->model);
    return 0;
  } catch (...) {
    data->error = std::current_exception();
    return -1;
  }
}

int right_hand_side(realtype t, N_Vector y, N_Vector dy, void* user) {
  return guarded(user, [&](const Model& model) {
    State in, out;
    std::copy_n(N_VGetArrayPointer(y), kStates, in.begin());
    model.derive(t, in, out);
    std::copy_n(out.begin(), kStates, N_VGetArrayPointer(dy));
  });
}

int event_functions(realtype t, N_Vector y, realtype* g, void* user) {
  return guarded(user, [&](const Model& model) {
    State in;
    std::copy_n(N_VGetArrayPointer(y), kStates, in.begin());
    Events out;
    model.events(t, in, out);
    std::copy_n(out.begin(), kEvents, g);
  });
}

void silent(int, const char*, const char*, char*, void*) {}  // errors arrive as return codes

/// What both solvers share; `evolve` integrates from 0 to h and reports the time reached and the roots found.
class SundialsFlow : public Flow {
 public:
  SundialsFlow() : vector_(kStates, context_), tolerance_(kStates, context_) {}

  void advance(const Model& model, const SegmentStart& start, double h, State& end, Advance& result) override {
    user_.model = &model;
    result = search(model, start, h, end);
  }

 protected:
  /// Whole way, or to the first event; a part of the way when a crossing went unseen.
  Advance search(const Model& model, const SegmentStart& start, double h, State& end) {
    Advance a;
    if (h < kShortest) {
      for (int n = 0; n < kStates; ++n) end[n] = start.y[n] + h * start.slope[n];
      a.reached = h;
      return a;
    }
    a = attempt(start, h, end);
    if (a.event) return sharpened(a, start, h, end);
    Events g;
    model.events(h, end, g);
    if (*std::min_element(g.begin(), g.end()) >= -kMissed) return a;
    // Both ends of a step on the same side, or a start within rounding of zero, hide a crossing: look closer.
    for (double part = kFirstPart; part > kShortest; part *= 0.25) {
      if (part >= h) continue;
      a = attempt(start, part, end);
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
  Advance sharpened(const Advance& first, const SegmentStart& start, double h, State& end) {
    const double again = std::ceil(first.reached / kEventCell) * kEventCell;
    if (again < kShortest) return first;
    const Advance better = attempt(start, again, end);
    return better.event ? better : attempt(start, h, end);
  }

  Advance attempt(const SegmentStart& start, double h, State& end) {
    std::copy_n(start.y.begin(), kStates, vector_.data());
    Advance a;
    a.reached = h;
    a.event = evolve(h, &a.reached, a.fired);
    std::copy_n(vector_.data(), kStates, end.begin());
    return a;
  }

  virtual bool evolve(double h, double* reached, Fired& fired) = 0;

  void set_tolerance(double relative) {
    for (int n = 0; n < kStates; ++n) tolerance_.data()[n] = relative * kTypical[n];
  }

  void check(int flag, const char* what) {
    if (flag >= 0) return;
    if (user_.error) std::rethrow_exception(std::exchange(user_.error, nullptr));
    sundials_check(flag, what);
  }

  static void mark(const int* roots, Fired& fired) {
    for (int n = 0; n < kEvents; ++n) fired[n] = roots[n] != 0;
  }

  Context context_;
  Vector vector_;
  Vector tolerance_;
  UserData user_;
  int falling_[kEvents] = {-1, -1, -1, -1, -1, -1, -1, -1};
};

class ErkStep final : public SundialsFlow {
 public:
  explicit ErkStep(double relative_tolerance) : memory_(ERKStepCreate(right_hand_side, 0.0, vector_, context_)) {
    set_tolerance(relative_tolerance);
    check(ERKStepSetErrHandlerFn(memory_, silent, nullptr), "ERKStepSetErrHandlerFn");
    check(ERKStepSetUserData(memory_, &user_), "ERKStepSetUserData");
    check(ERKStepSetTableNum(memory_, ARKODE_ZONNEVELD_5_3_4), "ERKStepSetTableNum");
    check(ERKStepSVtolerances(memory_, relative_tolerance, tolerance_), "ERKStepSVtolerances");
    check(ERKStepRootInit(memory_, kEvents, event_functions), "ERKStepRootInit");
    check(ERKStepSetRootDirection(memory_, falling_), "ERKStepSetRootDirection");
    check(ERKStepSetNoInactiveRootWarn(memory_), "ERKStepSetNoInactiveRootWarn");
  }

 private:
  bool evolve(double h, double* reached, Fired& fired) override {
    check(ERKStepReset(memory_, 0.0, vector_), "ERKStepReset");
    check(ERKStepSetInitStep(memory_, h), "ERKStepSetInitStep");
    check(ERKStepSetStopTime(memory_, h), "ERKStepSetStopTime");
    const int flag = ERKStepEvolve(memory_, h, vector_, reached, ARK_NORMAL);
    check(flag, "ERKStepEvolve");
    if (flag != ARK_ROOT_RETURN) return false;
    int roots[kEvents];
    check(ERKStepGetRootInfo(memory_, roots), "ERKStepGetRootInfo");
    mark(roots, fired);
    return true;
  }

  SolverMemory<ERKStepFree> memory_;
};

class Reference final : public SundialsFlow {
 public:
  Reference() : memory_(CVodeCreate(CV_ADAMS, context_)), nonlinear_(vector_, context_) {
    set_tolerance(0.1 * kReferenceTolerance);
    check(CVodeInit(memory_, right_hand_side, 0.0, vector_), "CVodeInit");
    check(CVodeSetErrHandlerFn(memory_, silent, nullptr), "CVodeSetErrHandlerFn");
    check(CVodeSetUserData(memory_, &user_), "CVodeSetUserData");
    check(CVodeSVtolerances(memory_, kReferenceTolerance, tolerance_), "CVodeSVtolerances");
    check(CVodeSetNonlinearSolver(memory_, nonlinear_), "CVodeSetNonlinearSolver");
    check(CVodeSetMaxStep(memory_, kReferenceStep), "CVodeSetMaxStep");
    check(CVodeSetMaxNumSteps(memory_, 100000), "CVodeSetMaxNumSteps");
    check(CVodeRootInit(memory_, kEvents, event_functions), "CVodeRootInit");
    check(CVodeSetRootDirection(memory_, falling_), "CVodeSetRootDirection");
    check(CVodeSetNoInactiveRootWarn(memory_), "CVodeSetNoInactiveRootWarn");
  }

 private:
  bool evolve(double h, double* reached, Fired& fired) override {
    check(CVodeReInit(memory_, 0.0, vector_), "CVodeReInit");
    check(CVodeSetStopTime(memory_, h), "CVodeSetStopTime");
    const int flag = CVode(memory_, h, vector_, reached, CV_NORMAL);
    check(flag, "CVode");
    if (flag != CV_ROOT_RETURN) return false;
    int roots[kEvents];
    check(CVodeGetRootInfo(memory_, roots), "CVodeGetRootInfo");
    mark(roots, fired);
    return true;
  }

  SolverMemory<CVodeFree> memory_;
  FixedPoint nonlinear_;
};

}  // namespace

std::unique_ptr<Flow> make_erkstep(double relative_tolerance) { return std::make_unique<ErkStep>(relative_tolerance); }
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
