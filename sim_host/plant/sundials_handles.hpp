// Owners of SUNDIALS objects: created in the constructor, freed in the destructor, never copied.

#ifndef STILLSPIN_SIM_HOST_PLANT_SUNDIALS_HANDLES_HPP
#define STILLSPIN_SIM_HOST_PLANT_SUNDIALS_HANDLES_HPP

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <stdexcept>
#include <string>

namespace stillspin::plant {

inline void sundials_check(int flag, const char* what) {
  if (flag >= 0) return;
  throw std::runtime_error(std::string("plant: SUNDIALS ") + what + " returned " + std::to_string(flag));
}

template <typename T>
T sundials_made(T object, const char* what) {
  if (object == nullptr) throw std::runtime_error(std::string("plant: SUNDIALS ") + what + " failed");
  return object;
}

class Context {
 public:
  Context() { sundials_check(SUNContext_Create(nullptr, &handle_), "SUNContext_Create"); }
  ~Context() { SUNContext_Free(&handle_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  operator SUNContext() const { return handle_; }

 private:
  SUNContext handle_ = nullptr;
};

/// The memory of one solver; `kFree` is its *Free function.
template <void (*kFree)(void**)>
class SolverMemory {
 public:
  explicit SolverMemory(void* memory) : handle_(sundials_made(memory, "solver creation")) {}
  ~SolverMemory() { kFree(&handle_); }
  SolverMemory(const SolverMemory&) = delete;
  SolverMemory& operator=(const SolverMemory&) = delete;
  operator void*() const { return handle_; }

 private:
  void* handle_;
};

class FixedPoint {
 public:
  FixedPoint(N_Vector like, SUNContext context)
      : handle_(sundials_made(SUNNonlinSol_FixedPoint(like, 0, context), "SUNNonlinSol_FixedPoint")) {}
  ~FixedPoint() { SUNNonlinSolFree(handle_); }
  FixedPoint(const FixedPoint&) = delete;
  FixedPoint& operator=(const FixedPoint&) = delete;
  operator SUNNonlinearSolver() const { return handle_; }

 private:
  SUNNonlinearSolver handle_;
};

}  // namespace stillspin::plant

#endif
