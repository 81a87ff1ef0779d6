// A control of the phase currents that takes the place of windows, current control and modulator: it samples in slices
// of its own (hal/hal_sampling_timer.h) and sets the legs itself.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_PHASE_CONTROL_H
#define STILLSPIN_FIRMWARE_INTERFACES_PHASE_CONTROL_H

#include <stdbool.h>

struct drive;

typedef struct {
  bool (*step)(struct drive* d);     // switches it on and off with the state; true while it has the legs
  void (*samples)(struct drive* d);  // in the place of the windows
  void (*slice)(void);               // the slice interrupt
} phase_control_t;

/// That of the edition, NULL where there is none (editions/). It keeps `sliced` of the drive.
extern const phase_control_t* const edition_phase_control;

#endif
