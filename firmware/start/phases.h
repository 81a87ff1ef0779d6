// The phases of the state START: each begins by itself, and its step says which one follows (step.h). None knows
// another; start.c goes from one to the next.

#ifndef STILLSPIN_FIRMWARE_START_PHASES_H
#define STILLSPIN_FIRMWARE_START_PHASES_H

#include "firmware/start/step.h"

// bootstrap.c
void start_begin_charge(drive_t* d);
start_phase_t start_step_charge(drive_t* d);

// flying.c
void start_begin_listen(drive_t* d);
start_phase_t start_step_listen(drive_t* d);
void start_begin_pulse(drive_t* d);
start_phase_t start_step_pulse(drive_t* d);
void start_begin_catch(drive_t* d);
start_phase_t start_step_catch(drive_t* d);

// standing.c
void start_begin_axis(drive_t* d);
start_phase_t start_step_axis(drive_t* d);
void start_begin_settle(drive_t* d);
start_phase_t start_step_settle(drive_t* d);
void start_begin_saturation(drive_t* d);  // or by motion, where the machine's slopes do not show
start_phase_t start_step_saturation(drive_t* d);
void start_begin_motion(drive_t* d);
start_phase_t start_step_motion(drive_t* d);

// if_start.c
void start_begin_if_ramp(drive_t* d);
start_phase_t start_step_if_ramp(drive_t* d);
/// Angle and speed meanwhile, of the vector (interfaces/state.h).
void start_estimate(drive_t* d, estimator_input_t* in);

#endif
