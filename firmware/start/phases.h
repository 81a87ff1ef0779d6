// The phases of the state START, and what they have of each other.

#ifndef STILLSPIN_FIRMWARE_START_PHASES_H
#define STILLSPIN_FIRMWARE_START_PHASES_H

#include "firmware/mode/mode.h"
#include "firmware/start/start.h"

void start_enter(drive_t* d, start_phase_t phase);
void start_power(drive_t* d, bool on);

/// Asks for the next period for a decision alone; true in that period, which has room for it.
bool start_has_exclusive_slot(drive_t* d);

/// Takes the period's regression where it is valid. True, in a period for the decision, when the axis is known: the
/// model has the inverse inductances, and *axis_bam is how far the axis is from where it was looked for. Too late is a
/// fault.
bool start_sees_axis(drive_t* d, bool valid, int32_t* axis_bam);

// start.c
void start_look(drive_t* d);
void start_run(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

// bootstrap.c: where there is nothing to charge it looks at the shaft at once
void start_charge(drive_t* d);
void start_step_charge(drive_t* d);

// flying.c
void start_listen(drive_t* d, uint16_t pause);
void start_step_listen(drive_t* d);
void start_step_pulse(drive_t* d);
void start_step_catch(drive_t* d);

// standing.c
void start_find_axis(drive_t* d);
bool start_checks_wiring(void);
void start_step_axis(drive_t* d);
void start_step_settle(drive_t* d);
void start_step_saturation(drive_t* d);
void start_step_motion(drive_t* d);

// if_start.c
void start_if_ramp(drive_t* d);
void start_step_if_ramp(drive_t* d);
void start_estimate(drive_t* d, estimator_input_t* in);

#endif
