// What stands above the drive may do with it: commands, parameters, inspection. The console and the bus use these
// calls; so does the test bench. All are called from the background level.

#ifndef STILLSPIN_FIRMWARE_MODE_COMMANDS_H
#define STILLSPIN_FIRMWARE_MODE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/dictionary/parameters.h"
#include "firmware/mode/states.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// A value of the drive's, kept where it is in its range and may be changed now; what is made of the parameters follows
/// in the background.
parameter_result_t parameter_set(uint16_t id, int32_t raw);
/// In two steps: whether it may be set now, which stays so until the change is made or the next interrupts are over
/// that may start the drive; and the change. NULL is unknown.
parameter_result_t parameter_settable(const parameter_info_t* info, int32_t raw);
void parameter_change(const parameter_info_t* info, int32_t raw);

/// Since power-on, by the control interrupt; wraps after 49 days.
uint32_t drive_time_ms(void);
drive_state_t drive_state(void);
bool drive_is_energised(void);

void drive_command_start(void);
/// It has been, and the control interrupt has not taken it yet.
bool drive_start_is_asked(void);
/// Speed to zero along the ramp, then gates off; a start procedure is broken off at once.
void drive_command_stop(void);
/// Gates off with the next control interrupt, whatever the speed: the shaft runs out. READY follows.
void drive_command_coast(void);
/// Mechanical speed reference, rpm Q16; clamped to the speed limit. Taken in every state and kept through stop and
/// start, so it may be given before the start; a fault puts it to zero.
void drive_command_speed(int32_t rpm_q16);
/// What was asked for last, rpm Q16, whether the control interrupt has taken it yet or not; 0 after a fault.
int32_t drive_commanded_speed(void);
/// Clears a latched fault; the drive calibrates its offsets again and is READY.
void drive_command_reset(void);

#if defined(__cplusplus)
}
#endif

#endif
