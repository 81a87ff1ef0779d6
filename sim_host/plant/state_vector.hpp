// The plant's state as SUNDIALS sees it: an N_Vector whose content is a State.
//
// SUNDIALS' own serial vector has any length and is compiled for any processor; with five numbers most of a step would
// go into its loops and calls.

#ifndef STILLSPIN_SIM_HOST_PLANT_STATE_VECTOR_HPP
#define STILLSPIN_SIM_HOST_PLANT_STATE_VECTOR_HPP

#include <sundials/sundials_nvector.h>

#include "sim_host/plant/model.hpp"

namespace stillspin::plant {

/// The content of any vector cloned from a StateVector.
inline State& state_of(N_Vector v) { return *static_cast<State*>(v->content); }

class StateVector {
 public:
  explicit StateVector(SUNContext context);
  ~StateVector() { N_VDestroy(handle_); }
  StateVector(const StateVector&) = delete;
  StateVector& operator=(const StateVector&) = delete;
  operator N_Vector() const { return handle_; }
  State& state() { return state_of(handle_); }
  const State& state() const { return state_of(handle_); }

 private:
  N_Vector handle_;
};

}  // namespace stillspin::plant

#endif
