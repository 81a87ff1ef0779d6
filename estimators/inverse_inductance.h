// Slow adaptation of the machine's inverse inductances to what the windows show (saturation, nameplate errors).
//
// With differences of active vectors, y = (Y0 + 1/2 dY S(2 theta)) dv is linear in Y0 and 1/2 dY: the residual along dv
// belongs to Y0, the one along the mirrored dv to 1/2 dY (regression.h). A least-mean-squares step per period moves
// both, within bounds around what the parameters say; where they say next to no saliency, an eighth of Y0 to either
// side, since iron that saturates turns it over. It makes AVV independent of the inductances, which the paper's
// three-vector form is too.

#ifndef STILLSPIN_ESTIMATORS_INVERSE_INDUCTANCE_H
#define STILLSPIN_ESTIMATORS_INVERSE_INDUCTANCE_H

#include "estimators/regression.h"

/// Whether the parameters say next to no saliency: Lq less than an eighth above Ld.
static inline bool inverse_inductance_is_weak(const machine_model_t* m) {
  const machine_point_t* const p = &m->map.points[0];
  return p->ydd_q30 - p->yqq_q30 < q_shr(p->yqq_q30, 3);
}

/// Moves the model's trim; per_spread: of r->spread_q8; share_q30: part of the error taken over per period, 0 for none.
/// The model takes the trim into account with its next move to an operating point.
void inverse_inductance_step(machine_model_t* m, const regression_t* r, q_inverse_t per_spread, int32_t share_q30);

/// Takes Y0 T and 1/2 dY T at no current that were found otherwise, within the same bounds.
void inverse_inductance_preset(machine_model_t* m, int32_t mean_q30, int32_t half_q30);

#endif
