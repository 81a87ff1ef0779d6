// The control interrupt, its steps in their order, and what they have of each other.

#ifndef STILLSPIN_FIRMWARE_DRIVE_STEPS_H
#define STILLSPIN_FIRMWARE_DRIVE_STEPS_H

#include "firmware/mode/mode.h"

/// What the control interrupt does in a period, between its begin and its end (control_interrupt.c).
void drive_control_step(drive_t* d);

/// Called at the end of that, at control interrupt level; NULL while nobody looks on, which costs least. The background
/// level changes it at any time.
extern void (*volatile drive_onlooker)(void);
typedef int32_t signal_look_t(const volatile drive_t* d, uint16_t known);
/// By the places of the signals; look_at_nothing for those of features that the edition has not (editions/).
extern signal_look_t* const edition_signal_looks[];
signal_look_t look_at_nothing;
/// How it looks at a signal: found once, by a place below signal_count().
signal_look_t* signal_look(uint16_t place);

/// Background level: what is worked out between two control interrupts (drive/reload.c).
void background_step(drive_t* d);
/// Of that, what was changed of the parameters.
void drive_exchange(void);
/// In every pass; rests while a host steps the drive.
void drive_service(void);

/// The dead band of the gate signals by the parameter; the power stage's own minimum is the parameter's business.
uint16_t drive_dead_band_ticks(void);

void drive_control_interrupt(void);
void drive_window_interrupt(void);

// The steps of the control interrupt, in their order: the drive to be read, and the groups of it that the step writes.
// Which members of a group those are is the check `writers`' to hold.
/// What the period that begins does (interfaces/schedule.h), from that of the period before.
void schedule_next(const drive_t* d, schedule_t* s);  // schedule.c
/// *missing: periods in a row without all of their samples.
void drive_read_samples(const drive_t* d, drive_samples_t* s, uint16_t* missing);  // sampling.c
void drive_estimate(const drive_t* d, drive_estimate_t* e);                        // position.c
/// What opens the power stage, or FAULT_NONE; takes what the observer has left unexplained.
drive_fault_t drive_protect(const drive_t* d, drive_supervision_t* v, deviation_residual_t* left);  // protection.c
/// The states and the requests, which may do anything.
void drive_sequence(drive_t* d);  // drive/sequence.c
/// Speed control and field weakening, and what is learnt of load and inertia.
void drive_control_speed(const drive_t* d, drive_control_t* c, drive_estimate_t* e);  // drive/speed.c
void drive_control_current(const drive_t* d, drive_control_t* c);                     // drive/current.c
/// Tells the current control what of its command has no voltage.
void drive_modulate(const drive_t* d, drive_modulation_t* m, current_controller_t* current);  // modulation.c
void drive_modulation_reset(drive_modulation_t* m);

/// Lets the position sources and the speed control start from this angle and speed (drive/bumpless_transfer.c).
void drive_bumpless_transfer(drive_t* d, uint32_t angle_bam, int32_t speed_bpp);

/// Torque current that the limit leaves beside the reference of i_d, A.
int32_t drive_current_headroom(const drive_t* d);

// Once in a millisecond each, in periods of their own, and at once for a shaft that has just been caught
// (drive/speed.c).
/// TASK_FIELD: what weakens the field.
void drive_weaken_field(const drive_t* d, drive_control_t* c);
/// TASK_SPEED: the reference of i_d, by that, torque per ampere, and what the source bears.
void drive_refer_field(const drive_t* d, drive_control_t* c);

#endif
