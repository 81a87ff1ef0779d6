// The console's commands: a table of names, arguments and help, and the functions behind it in commands_*.c.

#ifndef STILLSPIN_FIRMWARE_CONSOLE_COMMANDS_H
#define STILLSPIN_FIRMWARE_CONSOLE_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/api/comm_watchdog.h"
#include "firmware/api/status.h"
#include "firmware/console/command_table.h"
#include "firmware/console/editor.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// Carries a line out, or says why not. The line stays unchanged until its job is through.
void command_obey(const editor_line_t* line, bool expired);

/// False, and said, where something stands behind a command that takes nothing.
bool no_arguments(const words_of_line_t* a);

/// For what energises or moves the motor: false, and said, when the line has expired. Whether a line does that depends
/// on its words and on the drive ('ref 0', 'commission results'): so it is asked where it is about to happen.
bool command_may_move(const words_of_line_t* a);

/// Who is to watch over what moves the motor: word k, the only one left. False, and said, when nobody would and that
/// was not asked for, or when the line has expired.
bool choose_watchdog(const words_of_line_t* a, uint16_t k, comm_watchdog_t* watchdog);
/// What that means for who types.
void say_watchdog(comm_watchdog_t watchdog);

/// Whether the line stops the motor, whatever else it says.
bool command_makes_safe(const editor_line_t* line);

void command_help(const words_of_line_t* a);

// commands_parameters.c
void command_list(const words_of_line_t* a);
void command_get(const words_of_line_t* a);
void command_set(const words_of_line_t* a);

// commands_drive.c
void command_start(const words_of_line_t* a);
void command_stop(const words_of_line_t* a);
void command_coast(const words_of_line_t* a);
void command_reset(const words_of_line_t* a);
void command_ref(const words_of_line_t* a);

// commands_status.c
/// What would be lost with the power, behind what the line says; nothing where nothing would.
void put_unsaved(octet_writer_t* w);
extern const status_line_t state_line, speed_line, current_line, dc_link_line, limits_line, fault_line, parameters_line;
void command_status(const words_of_line_t* a);

// commands_faults.c
void command_faults(const words_of_line_t* a);

// commands_signals.c
void command_signals(const words_of_line_t* a);
void command_watch(const words_of_line_t* a);

// commands.c
void command_version(const words_of_line_t* a);

#if defined(__cplusplus)
}
#endif

#endif
