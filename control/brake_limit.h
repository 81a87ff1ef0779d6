// Limit of the braking current, for a DC link whose source takes nothing back.
//
// What a braking machine returns charges the link. Between two voltages of the link the braking current is reduced in
// proportion, to nothing at the upper one: the link rests where the current that is left returns what the machine's
// resistance and the load of the link use up. Near standstill nothing is returned: braking with i returns
// 3/2 i (w lambda - R i), so an EMF below half the resistive drop at full current stays free of the limit, and the
// limit comes in up to the whole drop. Without that a link that stays charged would take the torque from a standing
// shaft. Voltages V Q16, currents A Q20.

#ifndef STILLSPIN_CONTROL_BRAKE_LIMIT_H
#define STILLSPIN_CONTROL_BRAKE_LIMIT_H

#include "hal/qmath/qmath.h"

typedef struct {
  int32_t link_q16;            // DC-link voltage, 0..2000 V
  int32_t start_q16, end_q16;  // from which braking is reduced, at which none is left; start < end
  int32_t emf_q16;             // magnitude of the back-EMF
  int32_t drop_q16;            // R times the current limit
} brake_limit_input_t;

/// Largest current against the rotation, 0..limit.
int32_t brake_limit_q20(const brake_limit_input_t* in, int32_t limit_q20);

#endif
