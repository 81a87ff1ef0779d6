// Rotor angle from the vectors of stator flux and current (Ton et al. 2021, eqs (7b), (11)-(15), (27)-(31), (33)).
//
// Everything is in units of the magnet's flux (flux_machine.h): p = psi_s / psi_m, x = L_q i / psi_m. With
// s = L_q / L_d the paper's equations become
//   (11), (12)  angle of p - x
//   (15)        tan delta = (p cross x) / (|p|^2 - p . x)         the same angle, in f-t components
//   (18)        (s^2 - 1) y^2 - 2 y + c = 0,  y = L_d i_d / psi_m,  c = |p|^2 - 1 - |x|^2
//   (27), (29)  y = c / (1 + sqrt(1 - (s^2 - 1) c))
//   (30)        z = L_q i_q / psi_m = (p cross x) / (1 - (s - 1) y)
//   (31)        tan delta = z / (1 + y)
// The root of (18) in this form has no difference of large numbers as L_q comes near L_d, and at L_q = L_d it is (29):
// salient and surface magnets are one formula. (The paper's constant D is short of a square; here it does not occur.)
// A negative argument of the root, which noise of the flux can make, counts as 0: y = 1 / (s^2 - 1). With that the
// denominator of (30) is 1/2 or more for s >= 1.
//
// p stands for the flux seen in PP-01; in PP-02 |p| comes from the current references by (33).

#ifndef STILLSPIN_ESTIMATORS_FLUX_ANGLE_H
#define STILLSPIN_ESTIMATORS_FLUX_ANGLE_H

#include "estimators/flux_machine.h"

/// At one instant, stationary frame.
typedef struct {
  ab_t flux_q24;     // p
  ab_t current_q24;  // x
} flux_vectors_t;

/// flux_q16: flux/T, V period; current_q20: A.
flux_vectors_t flux_vectors(const flux_machine_t* f, ab_t flux_q16, ab_t current_q20);

/// |p|^2
int32_t flux_square_q24(const flux_vectors_t* v);

/// (33), squared: |p|^2 that currents in the rotor frame let expect.
int32_t flux_reference_square_q24(const flux_machine_t* f, dq_t current_q20);

/// (7b), N m.
int32_t flux_torque_q16(const flux_machine_t* f, const flux_vectors_t* v);

/// (14)
uint32_t flux_stator_angle(const flux_vectors_t* v);

/// (11), (12): the rotor's angle.
uint32_t flux_active_angle(const flux_vectors_t* v);

/// (15): load angle, flux before rotor.
int32_t flux_load_angle_ft(const flux_vectors_t* v);

/// (27), (29) and (30): y and z of a flux of this square.
dq_t flux_currents_q24(const flux_machine_t* f, const flux_vectors_t* v, int32_t square_q24);

/// (31) of y and z.
int32_t flux_load_angle_dq(dq_t yz_q24);

#endif
