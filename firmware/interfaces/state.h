// The states of the drive. One that has a folder of its own (START, COMMISSION) keeps what it is about to itself; what
// the other steps of the control interrupt have to know of it stands in flags that it writes and they read.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_STATE_H
#define STILLSPIN_FIRMWARE_INTERFACES_STATE_H

#include "estimators/estimator.h"

struct drive;
struct estimate;

typedef enum {
  DRIVE_BOOT = 0,
  DRIVE_CALIBRATE = 1,  // current offsets, power stage off
  DRIVE_READY = 2,
  DRIVE_START = 3,  // initial angle and polarity
  DRIVE_RUN = 4,
  DRIVE_STOP = 5,  // speed to zero, then ready
  DRIVE_FAULT = 6,
  DRIVE_COMMISSION = 7  // measures machine and inverter
} drive_state_t;

typedef struct {
  /// From READY: what is to follow when it has done its work. It enters its state, or raises a fault.
  void (*begin)(struct drive* d, drive_state_t behind);
  /// One period; in RUN, once in a millisecond. It enters the state that follows.
  void (*step)(struct drive* d);
  /// Angle and speed in use, in the place of the position source: in the open-loop ramp, and at the standstill of
  /// COMMISSION.
  estimator_output_t (*estimate)(const struct drive* d, struct estimate* e, estimator_input_t* in);
  /// COMMISSION: it is not wanted any more, whatever state the drive is in.
  void (*abandon)(void);
} state_t;

/// By drive_state_t; NULL where the drive itself does all there is, or this edition leaves it out (editions/).
extern const state_t* const drive_states[];

/// From READY: which state is to begin, and what is to follow it.
typedef struct {
  drive_state_t state, behind;
} state_request_t;

/// What the state in hand says to the other steps. It alone sets these, and the next one begins with none of them.
typedef struct {
  drive_state_t behind;  // START: what it leads to; READY: how the shaft turns is all that is asked
  uint16_t unseen;       // KNOWN_ROTOR before a start has found it, and where no axis shows at rest; else 0
  uint16_t invalid;      // periods until the samples belong to a power stage that is on and to a known pattern
  bool gates_off;        // by the start, which has no current flow
  bool shorted;          // all lower devices on, in the place of the modulator's pattern
  bool wants_exclusive;  // the next period is for a decision alone
  bool caught;           // a rotor that turns: angle and speed in use are its own
  bool open_loop;        // a current vector turns the rotor: the position source runs, and is not used yet
  bool spins;            // speed control and position source are at work, as in RUN
  bool frozen;           // the model does not follow the windows
  bool over;             // the power stage is open again, and the background level has the rest
} state_flags_t;

#endif
