// Commissioning. It takes a minute and a half, turns the shaft, and ends in READY.

#ifndef STILLSPIN_FIRMWARE_COMMISSIONING_OUTCOME_H
#define STILLSPIN_FIRMWARE_COMMISSIONING_OUTCOME_H

#include <stdint.h>

#if defined(__cplusplus)
extern "C" {
#endif

typedef enum {
  COMMISSIONING_IDLE = 0,
  COMMISSIONING_ALIGN = 1,      // to where no phase is without current
  COMMISSIONING_STAIRCASE = 2,  // resistance, drop, dead time
  COMMISSIONING_SPIN = 3,       // flux linkage, inertia, friction
  COMMISSIONING_MAP = 4,        // inductances against torque current, sensors
  COMMISSIONING_EVALUATE = 5,
  COMMISSIONING_COOLING = 6  // waits within staircase or map: only told, none that is gone through
} commissioning_phase_t;

typedef enum {
  COMMISSIONING_NONE = 0,
  COMMISSIONING_RUNNING = 1,
  COMMISSIONING_DONE = 2,     // every value is plausible and in use
  COMMISSIONING_PARTLY = 3,   // some are not; those keep their old value
  COMMISSIONING_ABORTED = 4,  // by a stop command
  COMMISSIONING_FAILED = 5    // by a fault
} commissioning_outcome_t;

/// Why an identified value is or is not used.
typedef enum {
  VERDICT_USED = 0,
  VERDICT_NOT_MEASURED = 1,  // too few samples
  VERDICT_SPREAD = 2,        // the points do not lie on the curve that is fitted to them
  VERDICT_NAMEPLATE = 3,     // too far from the value so far
  VERDICT_INCONSISTENT = 4,  // two ways to the same value disagree
  VERDICT_RANGE = 5,         // outside of the parameter's range
  VERDICT_NOT_PHYSICAL = 6,  // no machine has this
  VERDICT_DEPENDS = 7        // rests on another value that was refused
} commissioning_verdict_t;

typedef struct {
  uint16_t id;                      // of the parameter
  int32_t before, value;            // raw, in the parameter's format
  commissioning_verdict_t verdict;  // `value` is in use when it is VERDICT_USED
} commissioning_result_t;

/// From READY. A stop command aborts it.
void drive_command_commission(void);
commissioning_outcome_t drive_commissioning_outcome(void);
/// As told to the user: COMMISSIONING_COOLING in the place of a phase that waits.
commissioning_phase_t drive_commissioning_phase(void);
/// Share done, 0..1000.
int32_t drive_commissioning_progress(void);
/// None but when the outcome is DONE or PARTLY.
uint16_t drive_commissioning_count(void);
/// NULL behind the last one.
const commissioning_result_t* drive_commissioning_result(uint16_t index);

#if defined(__cplusplus)
}
#endif

#endif
