// The machine as the stator-flux family of estimators computes it (Ton, Hsieh, Chen, IEEE Access 2021, Table 2): in
// units of the magnet's flux, which makes its quotients and roots numbers near one.
//
// A flux linkage is kept as flux/T in V per period (Q16), the unit of the voltage that is integrated; divided by the
// magnet's it is a number, Q24. A current becomes a flux by L_q: x = L_q i / psi_m, Q24 as well.

#ifndef STILLSPIN_ESTIMATORS_FLUX_MACHINE_H
#define STILLSPIN_ESTIMATORS_FLUX_MACHINE_H

#include "control/machine_model.h"

#define FLUX_ONE_Q24 16777216L
#define FLUX_LARGEST 8  // the largest flux, and flux of a current, that is told from a larger one

/// By how much the machine has moved from the nameplate.
typedef struct {
  int32_t lq_q24;   // L_q over nameplate, 0.25..1.25
  int32_t psi_q24;  // magnet's flux over nameplate, 0.5..1.25
} flux_shares_t;

typedef struct {
  int32_t psi_q16;  // magnet's flux / T, V period
  q_inverse_t per_psi;
  int32_t bound_q16;       // 8 psi_m or 30000 V: a larger flux is none
  int32_t ld_per_psi_q30;  // L_d / psi_m, 1/A
  int32_t lq_per_psi_q30;  // L_q / psi_m, 1/A
  int32_t saliency_q24;    // L_q / L_d - 1
  int32_t torque_q24;      // 3/2 p psi_m, N m per A
} flux_machine_t;

/// Nameplate. False, with nothing written, where L_q / psi_m is above 0.5 1/A or L_q / L_d above 6.
bool flux_machine_init(flux_machine_t* f, const machine_model_t* m);

/// The same, moved; the shares are taken to the nearest end of their range.
void flux_machine_move(flux_machine_t* f, const machine_model_t* m, const flux_shares_t* shares);

#endif
