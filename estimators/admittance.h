// Slow adaptation of the machine's admittances to what the windows show (saturation, nameplate errors).
//
// With differences of active vectors, y = (Y0 + 1/2 dY S(2 theta)) dv is linear in Y0 and 1/2 dY: the residual along dv
// belongs to Y0, the one along the mirrored dv to 1/2 dY (avv.h). A least-mean-squares step per period moves both,
// within bounds around the nameplate. It makes AVV independent of the inductances, which the paper's three-vector form
// is too.

#ifndef STILLSPIN_ESTIMATORS_ADMITTANCE_H
#define STILLSPIN_ESTIMATORS_ADMITTANCE_H

#include "estimators/avv.h"

typedef struct {
  int32_t mean_q30, half_q30;                  // Y0 T and 1/2 dY T now
  int32_t nominal_mean_q30, nominal_half_q30;  // from the nameplate
} admittance_t;

void admittance_init(admittance_t* s, const machine_model_t* m);

/// share_q30: part of the error taken over per period, 0 for none.
void admittance_step(admittance_t* s, const avv_regression_t* r, int32_t share_q30);

/// Writes the present values into the model (two divisions: once a millisecond is enough).
void admittance_apply(const admittance_t* s, machine_model_t* m);

#endif
