// A look at the shaft that is no start: two short-circuit pulses say how it turns. Background level.

#ifndef STILLSPIN_FIRMWARE_START_FLYING_LOOK_H
#define STILLSPIN_FIRMWARE_START_FLYING_LOOK_H

#include "firmware/api/actions.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// What two short-circuit pulses say of a shaft.
typedef enum {
  LOOK_NONE = 0,     // nobody has looked since power-on
  LOOK_RUNNING = 1,  // under way
  LOOK_TURNS = 2,    // at drive_look_rpm
  LOOK_STANDS = 3,   // or turns more slowly than drive_look_rpm
  LOOK_UNCLEAR = 4,  // the pulses contradict each other; by the size of its EMF alone it turns at drive_look_rpm
  LOOK_ENDED = 5     // by a stop or a fault
} look_outcome_t;

/// From READY, a tenth of a second: short-circuits the motor twice for up to a millisecond. READY follows.
void drive_command_look(void);
look_outcome_t drive_look_outcome(void);
/// Mechanical, Q16; its sign only when it TURNS.
int32_t drive_look_rpm(void);
/// By the look itself: what it has found.
void drive_look_end(look_outcome_t outcome, int32_t rpm_q16);

/// As after power-on.
void look_reset(void);

/// The command where the drive can begin; the outcome is asked for afterwards (drive_look_outcome).
answer_status_t action_look(octet_writer_t* why);
void put_look(octet_writer_t* w);

#if defined(__cplusplus)
}
#endif

#endif
