// What the stator-flux family learns of its machine: L_q by the torque, and the magnet's flux (Ton et al. 2021, eqs
// (36)-(38)). A tenth as often as the speed control; the angle's path sees constants.
//
// (36): L_q~ = L_q / (1 + K_t |T| / T_rated). K_t is no torque constant but how much the q-axis saturates; K_t /
// T_rated is one number, which flux_adaptation_identify fits to the machine's map. The torque's sign does not count.
//
// (37), (38): psi_m~ += share ((psi_s - L_q~ i_f) i_q / i_t - (psi_m~ + L_d i_d)). i_d and i_q are the currents fed
// back, in the frame in use. With (27) and (30) in their place it would diverge: what a wrong psi_m does to them is 1.7
// times its own error (motor B). It is a quotient by i_t, and as good as the flux: it counts where the shaft turns
// faster than `lowest`, and i_t makes a flux of `current` at least.

#ifndef STILLSPIN_ESTIMATORS_FLUX_ADAPTATION_H
#define STILLSPIN_ESTIMATORS_FLUX_ADAPTATION_H

#include "estimators/flux_angle.h"

typedef struct {
  int32_t saturation_q24;  // K_t / T_rated, 1/(N m), 0..1; 0 leaves L_q as it is
  int32_t lowest_bpp;      // electrical speed from which the magnet's flux is learnt
  int32_t current_q24;     // |L_q i_t| / psi_m from which it is, 0.01..1
  int32_t inductance_q30;  // share of (36) taken over per step, 0..1
  int32_t magnet_q30;      // of (37); 0 learns none
} flux_adaptation_config_t;

typedef struct {
  flux_shares_t shares;
} flux_adaptation_t;

bool flux_adaptation_config_valid(const flux_adaptation_config_t* c);

void flux_adaptation_reset(flux_adaptation_t* s);

/// K_t / T_rated of (36), 1/(N m) Q24: least squares over the map's points. 0 without saturation.
int32_t flux_adaptation_identify_q24(const machine_model_t* m);

/// (36) as a share of the nameplate's L_q.
int32_t flux_adaptation_lq_q24(int32_t saturation_q24, int32_t torque_q16);

/// (37) in units of psi_m; false, with nothing written, where i_t is too small.
bool flux_adaptation_change_q24(const flux_machine_t* f, const flux_vectors_t* v, dq_t current_q20,
                                int32_t least_current_q24, int32_t* change_q24);

/// One step; current_q20: fed back, in the frame in use, A. Moves f as well.
void flux_adaptation_step(flux_adaptation_t* s, const flux_adaptation_config_t* c, const machine_model_t* m,
                          flux_machine_t* f, const flux_vectors_t* v, dq_t current_q20, int32_t speed_bpp);

#endif
