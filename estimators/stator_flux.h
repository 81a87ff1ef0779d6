// Stator flux by integration of the EMF: the low-pass integrator (Ton et al. 2021, Fig. 5, after Hu and Wu 1998).
//
// A pure integrator keeps every offset for ever; a low-pass of cut-off w_c in its place, dpsi/dt = e - w_c psi,
// forgets, but leads by atan(w_c/w) and loses magnitude, w/sqrt(w^2 + w_c^2). Two cures:
//
// COMPENSATED: what the low-pass lost is given back, as a vector of the length psi_c along the flux itself,
//   dpsi/dt = e - w_c (1 - psi_c/|psi|) psi,      dpsi_c = k (e . psi)/|psi| dt.
// This is Fig. 5 with both of its low-passes in one: their sum obeys this equation. The controller sees whether flux
// and EMF are at right angles, that is, by how much the EMF alone changes the length. The length follows with k w_c, an
// offset of the flux decays with (1 - k) w_c / 2: hence 0 < k < 1. A proportional part turns the offset without
// damping it and is left out. An offset longer than the flux itself is not lost: such a sum does not turn about zero,
// and the compensation takes the offset for flux. It must start near the truth.
//
// BARE: the low-pass alone. In steady rotation the true flux is (1 - j w_c/w) times its output: the phase (34), whose
// sign follows the direction, and the magnitude with it. With Fig. 5 in the loop this would correct twice. Here it is
// that quotient at any time: the same low-pass gets a unit vector that turns with the observed speed, and what it shows
// of that it shows of the flux. In steady rotation this is (34); where the speed or w_c changes, and through zero, it
// stays right, where (34) takes the low-pass for settled. Both low-passes have to begin alike.
//
// PLAIN: the low-pass alone and nothing given back, as the paper's text has the flux of CONV and PP-01. For comparison.
//
// Fluxes are flux/T, V period, Q16; the EMF is the mean of a period, V Q16.

#ifndef STILLSPIN_ESTIMATORS_STATOR_FLUX_H
#define STILLSPIN_ESTIMATORS_STATOR_FLUX_H

#include "control/frame.h"

typedef enum { STATOR_FLUX_COMPENSATED = 0, STATOR_FLUX_BARE = 1, STATOR_FLUX_PLAIN = 2 } stator_flux_form_t;

typedef struct {
  stator_flux_form_t form;
  int32_t cutoff_q30;  // w_c T, 1e-4..0.05
  int32_t follow_q30;  // k, 0.05..0.95
} stator_flux_config_t;

typedef struct {
  ab_t flux_q16;             // of the low-pass
  int32_t length_q16;        // of it
  int32_t compensation_q16;  // psi_c
  ab_t shown_q28;            // what the bare low-pass shows of a unit vector that turns with the speed, in its frame
} stator_flux_t;

/// Starts with a flux that is known.
void stator_flux_preset(stator_flux_t* s, ab_t flux_q16);

/// One period with this mean EMF, in which the flux turns by speed_bpp. Beyond +-bound, eight times the magnet's flux,
/// the integral begins anew.
void stator_flux_step(stator_flux_t* s, const stator_flux_config_t* c, ab_t emf_q16, int32_t speed_bpp,
                      int32_t bound_q16);

/// The flux at the period's end. Of the bare form it is at most 4.1 times the low-pass's output: slower than a quarter
/// of the cut-off for long, and it is too small.
ab_t stator_flux_q16(const stator_flux_t* s, const stator_flux_config_t* c);

#endif
