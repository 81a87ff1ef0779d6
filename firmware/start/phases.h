// The phases of the state START, a row of the edition's table each. None knows another; start.c goes from one to the
// next.

#ifndef STILLSPIN_FIRMWARE_START_PHASES_H
#define STILLSPIN_FIRMWARE_START_PHASES_H

#include "firmware/start/step.h"

typedef struct {
  /// It enters its phase, or raises a fault.
  void (*begin)(drive_t* d);
  /// One period; says which one follows.
  start_phase_t (*step)(drive_t* d);
  /// Angle and speed meanwhile, where the phase turns the rotor by a vector (interfaces/state.h); NULL elsewhere.
  estimator_output_t (*estimate)(const drive_t* d, drive_estimate_t* e, estimator_input_t* in);
} phase_t;

/// By start_phase_t; NULL where the edition leaves it out (editions/).
extern const phase_t* const start_phases[];

extern const phase_t charge_phase;                                              // bootstrap.c
extern const phase_t axis_phase, settle_phase, saturation_phase, motion_phase;  // standing.c

#endif
