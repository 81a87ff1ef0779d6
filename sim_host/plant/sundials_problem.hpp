// One segment as an initial value problem for SUNDIALS: vectors, right-hand side and errors, for both of its solvers.

#ifndef STILLSPIN_SIM_HOST_PLANT_SUNDIALS_PROBLEM_HPP
#define STILLSPIN_SIM_HOST_PLANT_SUNDIALS_PROBLEM_HPP

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "sim_host/plant/flow.hpp"
#include "sim_host/plant/state_vector.hpp"
#include "sim_host/plant/sundials_handles.hpp"

namespace stillspin::plant {

class SundialsProblem {
 public:
  /// The absolute tolerance is `absolute` of a typical value of each state.
  explicit SundialsProblem(double absolute) : vector(context), tolerance(context) {
    tolerance.state() << 1.0, 1.0, 1.0, 1.0, 100.0;  // A, A, rad/s, rad, V
    tolerance.state() *= absolute;
  }

  void begin(const Model& model, const SegmentStart& start, double h) {
    model_ = &model;
    start_ = &start;
    h_ = h;
    vector.state() = start.y;
  }

  /// dy/dt after h seconds, where the solver has left `vector`: it has nearly always been evaluated there last.
  State end_slope() const {
    if (end_ == vector.state()) return end_slope_;
    State slope;
    model_->derive(h_, vector.state(), slope);
    return slope;
  }

  /// For every return code of SUNDIALS: throws what the right-hand side has thrown, or names `what`.
  void check(int flag, const char* what) {
    if (flag >= 0) return;
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    sundials_check(flag, what);
  }

  // The functions that SUNDIALS calls with `user` = this.
  static int right_hand_side(double t, N_Vector y, N_Vector dy, void* user) {
    return guarded(user, [&](SundialsProblem& p) {
      if (t == 0.0) {
        state_of(dy) = p.start_->slope;
        return;
      }
      p.model_->derive(t, state_of(y), state_of(dy));
      if (t != p.h_) return;
      p.end_ = state_of(y);
      p.end_slope_ = state_of(dy);
    });
  }
  static int event_functions(double t, N_Vector y, double* g, void* user) {
    return guarded(user, [&](SundialsProblem& p) {
      Events out;
      p.model_->events(t, state_of(y), out);
      std::copy_n(out.begin(), kEvents, g);
    });
  }
  static void silent(int, const char*, const char*, char*, void*) {}  // errors arrive as return codes

  Context context;
  StateVector vector;  // the state, at the start and then where the solver has got to
  StateVector tolerance;

 private:
  template <typename Call>
  static int guarded(void* user, Call call) {
    auto* problem = static_cast<SundialsProblem*>(user);
    try {
      call(*problem);
      return 0;
    } catch (...) {
      problem->error_ = std::current_exception();
      return -1;
    }
  }

  const Model* model_ = nullptr;
  const SegmentStart* start_ = nullptr;
  double h_ = 0.0;
  State end_ = State::Constant(std::numeric_limits<double>::quiet_NaN());  // the last state seen at h_
  State end_slope_;
  std::exception_ptr error_;
};

}  // namespace stillspin::plant

#endif
