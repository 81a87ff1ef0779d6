// Field weakening: the d-axis current that keeps the voltage inside what the modulator can really give.
//
// Feed-forward from the steady-state voltage equation without resistance, (w Lq iq)^2 + w^2 (lambda + Ld id)^2 = V^2:
//   id = (sqrt((V/w)^2 - (Lq iq)^2) - lambda) / Ld, and an integrator on the voltage that is left corrects it.
// i_d takes its share of the current limit from i_q, and less i_q needs less i_d: where that loop has a gain above one
// the two would swing. So i_d comes at once and goes slowly.
// Needed above the speed at which the back-EMF alone reaches V; physics: 3000 rpm on motor A needs about -7 A at 160 V.
// Step: one speed period. Voltages V Q16, currents A Q20.

#ifndef STILLSPIN_CONTROL_FIELD_WEAKENING_H
#define STILLSPIN_CONTROL_FIELD_WEAKENING_H

#include "control/machine_model.h"

typedef struct {
  int32_t trim_q20;  // integrator, A
  int32_t id_q20;    // to be added to the reference, A, -limit..0
} field_weakening_t;

typedef struct {
  int32_t speed_bpp;          // electrical speed
  int32_t iq_q20;             // q-axis current reference
  int32_t voltage_q16;        // magnitude of the voltage command
  int32_t voltage_limit_q16;  // what it may be
  int32_t current_limit_q20;  // largest |id| allowed, A
  int32_t trim_gain_q20;      // A per V and step, Q20
} field_weakening_input_t;

void field_weakening_reset(field_weakening_t* s);

/// One step.
void field_weakening_step(field_weakening_t* s, const field_weakening_input_t* in, const machine_model_t* m);

#endif
