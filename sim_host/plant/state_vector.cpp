#include "sim_host/plant/state_vector.hpp"

#include <cmath>
#include <new>

#include "sim_host/plant/sundials_handles.hpp"

namespace stillspin::plant {
namespace {

N_Vector made(SUNContext context) {
  N_Vector v = N_VNewEmpty(context);
  if (v != nullptr) v->content = new (std::nothrow) State(State::Zero());
  if (v == nullptr || v->content != nullptr) return v;
  N_VFreeEmpty(v);
  return nullptr;
}

// What ERKStep and CVODE with a fixed-point iteration call.
void set_operations(_generic_N_Vector_Ops& ops) {
  ops.nvgetvectorid = [](N_Vector) { return SUNDIALS_NVEC_CUSTOM; };
  ops.nvgetlength = [](N_Vector) { return sunindextype{kStates}; };
  ops.nvclone = [](N_Vector like) {
    N_Vector v = made(like->sunctx);
    if (v != nullptr) *v->ops = *like->ops;
    return v;
  };
  ops.nvdestroy = [](N_Vector v) {
    delete &state_of(v);
    N_VFreeEmpty(v);
  };
  ops.nvconst = [](double c, N_Vector z) { state_of(z).setConstant(c); };
  ops.nvscale = [](double c, N_Vector x, N_Vector z) { state_of(z) = c * state_of(x); };
  ops.nvlinearsum = [](double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    state_of(z) = a * state_of(x) + b * state_of(y);
  };
  ops.nvlinearcombination = [](int count, double* c, N_Vector* x, N_Vector z) {
    State sum = c[0] * state_of(x[0]);
    for (int n = 1; n < count; ++n) sum += c[n] * state_of(x[n]);
    state_of(z) = sum;
    return 0;
  };
  ops.nvprod = [](N_Vector x, N_Vector y, N_Vector z) { state_of(z) = state_of(x).cwiseProduct(state_of(y)); };
  ops.nvdiv = [](N_Vector x, N_Vector y, N_Vector z) { state_of(z) = state_of(x).cwiseQuotient(state_of(y)); };
  ops.nvabs = [](N_Vector x, N_Vector z) { state_of(z) = state_of(x).cwiseAbs(); };
  ops.nvinv = [](N_Vector x, N_Vector z) { state_of(z) = state_of(x).cwiseInverse(); };
  ops.nvaddconst = [](N_Vector x, double b, N_Vector z) { state_of(z) = state_of(x).array() + b; };
  ops.nvmaxnorm = [](N_Vector x) { return state_of(x).cwiseAbs().maxCoeff(); };
  ops.nvmin = [](N_Vector x) { return state_of(x).minCoeff(); };
  ops.nvdotprod = [](N_Vector x, N_Vector y) {
    double sum = 0.0;  // in this order on every processor
    for (int n = 0; n < kStates; ++n) sum += state_of(x)[n] * state_of(y)[n];
    return sum;
  };
  ops.nvwrmsnorm = [](N_Vector x, N_Vector weight) {
    double sum = 0.0;
    for (int n = 0; n < kStates; ++n) {
      const double part = state_of(x)[n] * state_of(weight)[n];
      sum += part * part;
    }
    return std::sqrt(sum / kStates);
  };
}

}  // namespace

StateVector::StateVector(SUNContext context) : handle_(sundials_made(made(context), "N_VNewEmpty")) {
  set_operations(*handle_->ops);
}

}  // namespace stillspin::plant
