// The drive under a search: every state as the drive's own interrupt has reached it, and time that passes fast.
//
// The control interrupt is the firmware's own, on the windows of a machine at rest. One is played for a step of time
// instead of ten for a millisecond: the one in which the tasks of the millisecond have their turn. The background level
// is the caller's, but for background_step.
//
// Neither an int nor an enumeration nor a structure passes here, so that the drive may have an int of 16 bits and the
// search one of 32.

#ifndef STILLSPIN_TESTS_FUZZ_FUZZ_DRIVE_H
#define STILLSPIN_TESTS_FUZZ_FUZZ_DRIVE_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/mode/commands.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FUZZ_STATES (DRIVE_COMMISSION + 1u)

/// Power-on of the whole firmware with a memory that has never been written, READY.
void fuzz_power_on(void);

/// The node of the bus, as after power-on.
void fuzz_node_on(void);

/// Puts the drive into a state (drive_state_t); time, requests and parameters stay.
void fuzz_put_into(uint16_t state);

/// A fault that comes now; `which` may be anything.
void fuzz_fault(uint16_t which);

/// `ms` of the drive's time, at the end of which the control interrupt comes.
void fuzz_pass(uint16_t ms);

/// Background level: background_step, one round of the serial port's tasks, one of the bus's.
void fuzz_background(void);
void fuzz_serve_port(void);
void fuzz_serve_bus(void);

/// Nobody has asked for anything.
void fuzz_forget_requests(void);

bool fuzz_is_running(void);
bool fuzz_is_to_stop(void);  // somebody has asked for it
bool fuzz_has_host(void);    // in the loop
uint32_t fuzz_time_ms(void);
uint16_t fuzz_node(void);  // on the bus

/// The place in parameter_list.h, counted from 1, of a parameter that is out of its range; 0 when there is none.
uint16_t fuzz_parameter_out_of_range(void);

// The board underneath: fuzz_board.cpp.
void fuzz_board_power_on(void);
void fuzz_board_still_window(void);  // waits in the converter
void fuzz_board_gates(bool on);
void fuzz_board_serial_errors(uint16_t* flat);  // the members of hal_sci_errors_t
void fuzz_board_can_status(uint16_t* flat);     // of hal_can_status_t

#ifdef __cplusplus
}
#endif

#endif
