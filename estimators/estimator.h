// What every position estimator is given and what it gives.
//
// All estimators keep their angle at the *start of the running period* (the instant at which the control interrupt is
// raised); the windows lie in the period before. Angles are binary angles (2^32 a turn), speeds binary angle per
// period, accelerations binary angle per period^2 with eight fractional bits.

#ifndef STILLSPIN_ESTIMATORS_ESTIMATOR_H
#define STILLSPIN_ESTIMATORS_ESTIMATOR_H

#include <stdbool.h>

#include "control/machine_model.h"
#include "hal/qmath/period.h"

#define ESTIMATOR_WINDOWS 3
#define ESTIMATOR_PERIOD_TICKS PERIOD_TICKS

/// One window: the current deviation under a constant voltage vector.
typedef struct {
  ab_t change_q19;      // of the current between the two bursts, A
  ab_t voltage_q19;     // voltage at the terminals: switching state and DC link less the devices' drops, V
  ab_t current_q20;     // current in the middle of the window, A
  int16_t middle_tick;  // instant half-way between the two bursts
  int16_t span_ticks;   // time between the two bursts
  bool zero_vector;
} estimator_window_t;

/// A window in a rotor frame.
typedef struct {
  rotation_t rotation;  // of the frame at the window's middle
  dq_t current_q18;     // current there, A
} estimator_frame_t;

/// Span of one or more windows, up to 20 000 ticks, as a share of the period, Q30, 2e-6 of it less.
static inline int32_t estimator_span_q30(int32_t span_ticks) { return span_ticks * 107374L; }
static inline int32_t estimator_share_q30(const estimator_window_t* w) { return estimator_span_q30(w->span_ticks); }

typedef struct {
  const machine_model_t* model;
  const estimator_window_t* windows;
  uint16_t window_count;    // 0..ESTIMATOR_WINDOWS
  int32_t torque_accel_q8;  // acceleration by the air-gap torque of the measured current
  // The windows are regressed on their voltages. The deviation observer alone can leave it (the machine's model then
  // learns nothing); AVV lives on it.
  bool regress;
  // The deviation observer renews its covariance with what the windows have told since the last time; in between it
  // corrects with the gain as it is.
  bool renew;
  // It takes its sensitivities anew: as the model, the speed and the current are now.
  bool refresh;
  // The period has something long beside it: a covariance that nobody has asked for can wait for the next.
  bool busy;
  // The windows in a frame that runs on evenly from the estimator's last angle, where they are known, or null. From the
  // predicted angle it differs by half the change of speed over a period at most, 1e-4 rad.
  const estimator_frame_t* frames;
  int32_t iq_q20;  // torque current without its ripple: the mean of the period, A
} estimator_input_t;

typedef struct {
  uint32_t angle_bam;
  int32_t speed_bpp;
  int32_t load_accel_q8;  // acceleration that the load takes away
  int32_t quality_q15;    // 0 useless .. 32767 as good as it gets
} estimator_output_t;

#endif
