// A control of the phase currents that takes the place of windows, current control and modulator: it samples in slices
// of its own (hal/hal_sampling_timer.h) and sets the legs itself.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_PHASE_CONTROL_H
#define STILLSPIN_FIRMWARE_INTERFACES_PHASE_CONTROL_H

#include <stdbool.h>

#include "firmware/interfaces/period.h"

struct drive;

typedef struct {
  /// Switches itself on and off with the state; true while it has the legs.
  bool (*step)(const struct drive* d, drive_modulation_t* m);
  /// In the place of the windows: the mean current of the period, and how many periods in a row were without one.
  /// False where one of its samples is beyond the trip current.
  bool (*samples)(const struct drive* d, drive_samples_t* s, dq_t* measured_q20, uint16_t* missing);
  void (*slice)(void);  // the slice interrupt
} phase_control_t;

/// That of the edition, NULL where there is none (editions/). It keeps `sliced` of the modulation.
extern const phase_control_t* const edition_phase_control;

#endif
