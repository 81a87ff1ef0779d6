// The state START: standing.c, and flying.c for a shaft that turns.

#ifndef STILLSPIN_FIRMWARE_START_PHASES_H
#define STILLSPIN_FIRMWARE_START_PHASES_H

#include "firmware/mode/mode.h"

/// Lets the position sources and the speed control start from this angle and speed.
void drive_hand_over(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);
void drive_begin_start(drive_t* d);
/// Two pulses that tell how the shaft turns, and back to READY (start/flying.c).
void drive_begin_look(drive_t* d);
void drive_start(drive_t* d);
void start_enter(drive_t* d, start_phase_t phase);
void start_power(drive_t* d, bool on);
void start_listen(drive_t* d, uint16_t pause);
void start_find_axis(drive_t* d);
void start_run(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

/// Takes the period's regression where it is valid. True, in a period for the decision, when the axis is known: the
/// model has the admittances, and *axis_bam is how far the axis is from where it was looked for. Too late is a fault.
bool start_sees_axis(drive_t* d, bool valid, int32_t* axis_bam);

/// Asks for the next period for a decision alone; true in that period, which has room for it.
bool start_decides(drive_t* d);

void start_step_listen(drive_t* d);
void start_step_pulse(drive_t* d);
void start_step_catch(drive_t* d);
void start_turn(drive_t* d);    // start/if_start.c
void start_charge(drive_t* d);  // start/bootstrap.c
void start_step_charge(drive_t* d);
void start_look(drive_t* d);
void start_step_turn(drive_t* d);
svpwm_pattern_t start_short_circuit(const sampling_config_t* c);

#endif
