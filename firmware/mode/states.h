// Faults of the drive, beside its states, and what limits it.

#ifndef STILLSPIN_FIRMWARE_MODE_STATES_H
#define STILLSPIN_FIRMWARE_MODE_STATES_H

#include "firmware/interfaces/state.h"

#define FAULT(number, name, words, remedy) FAULT_##name = (number),
typedef enum {
#include "firmware/dictionary/all_faults.h"
} drive_fault_t;
#undef FAULT

typedef enum {
  LIMIT_CURRENT = 1,
  LIMIT_VOLTAGE = 2,
  LIMIT_WEAKENING = 4,
  LIMIT_OVERRUN = 8,
  LIMIT_BRAKING = 16  // the DC link takes no more
} drive_limit_t;

/// What is known beside the drive's own state.
typedef enum {
  // Angle and speed in use are the rotor's: the power stage is on and the start has found them. With the gates off
  // nothing is, with an encoder neither: what it counts has an angle from the start's end on, while the drive runs.
  KNOWN_ROTOR = 1,
  KNOWN_FRAME = 2,  // the currents are seen in the frame that the control uses; in a start that need not be the rotor's
  KNOWN_HEAT_SINK = 4  // the board has a temperature sensor that is in use and whole
} known_t;

#endif
