// Mismatch of the two current sensors, found while running.
//
// Gains 1 + g and 1 - g on phases a and b multiply the slopes by 1 + g ([1, 1/sqrt3; 1/sqrt3, -1] + J/sqrt3). The first
// part looks like a saliency of Y0 g that stands still: left alone it bends the angle by up to Y0 g / (sqrt3 1/2 dY),
// 0.7 degrees at 0.5 % on the paper's motor, twice an electrical turn. The second part, Y0 g / sqrt3 across dv, is like
// nothing that a machine does, once the direction of dv goes round evenly (then the saliency's own part cancels), as it
// does in the alternating layout, at standstill too. So g is read from there and taken off the samples.

#ifndef STILLSPIN_ESTIMATORS_SENSOR_MATCH_H
#define STILLSPIN_ESTIMATORS_SENSOR_MATCH_H

#include "estimators/regression.h"

/// Moves g, which stays within +-0.05. per_spread: of r->spread_q8; per_y0: of Y0 T, or of another that is near it: the
/// error seen is in proportion; share_q30: part of the error taken over per period. Call it in the alternating layout
/// only.
void sensor_match_step(int32_t* mismatch_q30, const regression_t* r, q_inverse_t per_spread, q_inverse_t per_y0,
                       int32_t share_q30);

#endif
