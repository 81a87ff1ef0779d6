// Buffers between the window interrupt and the control interrupt.

#ifndef STILLSPIN_FIRMWARE_DRIVE_SAMPLING_H
#define STILLSPIN_FIRMWARE_DRIVE_SAMPLING_H

#include "estimators/estimator.h"
#include "firmware/mode/mode.h"
#include "hal/hal_adc.h"

typedef struct {
  hal_adc_window_t windows[ESTIMATOR_WINDOWS];
  uint16_t count;
} sampling_buffer_t;

/// Gives the buffer of the period that has ended and opens the other one.
const sampling_buffer_t* sampling_swap(void);

/// Empties both.
void sampling_reset(void);

/// From offsets and mismatch of the sensors as they are now to what their codes mean.
static inline void sampling_scale_sensors(const drive_t* d, drive_samples_t* s) {
  s->scale = slopes_scale(&d->config.slopes, &d->estimate.trim);
}

/// Background level: code of the auxiliary input in the last period's first window.
uint16_t sampling_auxiliary(void);

#endif
