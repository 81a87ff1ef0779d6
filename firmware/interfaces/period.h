// What the steps of the control interrupt have of each other, period by period.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_PERIOD_H
#define STILLSPIN_FIRMWARE_INTERFACES_PERIOD_H

#include "control/current_controller.h"
#include "control/field_weakening.h"
#include "control/position_hold.h"
#include "control/ramp.h"
#include "control/speed_controller.h"
#include "estimators/avv.h"
#include "estimators/blend.h"
#include "estimators/deviation_observer.h"
#include "estimators/inverse_inductance.h"
#include "estimators/slopes.h"
#include "estimators/synchronism.h"
#include "estimators/voltage_match.h"
#include "firmware/interfaces/references.h"
#include "firmware/interfaces/schedule.h"
#include "firmware/interfaces/source.h"
#include "svpwm/modulator.h"

#define DRIVE_PERIOD_US 100
#define DRIVE_PERIODS_PER_MS 10
#define DRIVE_CURRENT_BITS 29u  // 512 A: no two sensors show more
#define DRIVE_CURRENT_END_Q20 ((int32_t)1 << DRIVE_CURRENT_BITS)
#define DRIVE_MIDDLE_Q8 (2048L * 256L)  // of the converter's codes: no current

/// What the control interrupt knows about the last period.
typedef struct {
  estimator_window_t windows[ESTIMATOR_WINDOWS];
  ab_t ripple_q16;  // ripple flux at the middles of all windows, added up, V period
  uint16_t count;
  slopes_scale_t scale;                     // of the sensors, renewed in a slot
  int32_t link_end_q16[ESTIMATOR_WINDOWS];  // DC link at the end of each window, unfiltered, V
  int32_t raw_a_q8, raw_b_q8;               // mean codes of the first burst, for the calibration
  int32_t link_q16;                         // filtered DC-link voltage, V
} drive_samples_t;

/// Angle and speed in use, the estimators behind them, and what is known of machine and sensors.
typedef struct estimate {
  estimator_output_t selected, low, high;
  estimator_output_t seen;  // by the position source, while it looks on and another angle is in use
  dq_t measured_q20;        // mean current of the last period, A
  dq_t seen_q20;            // the same in the frame that the windows were turned into
  avv_t avv;
  deviation_observer_t observer;
  blend_t blend;
  int32_t torque_accel_q8;                      // acceleration of the torque of the measured current
  estimator_frame_t frames[ESTIMATOR_WINDOWS];  // the windows in the frame of who looks at them first, or in use
  machine_model_t model;                        // nameplate, at the operating point and with what was learnt
  slopes_trim_t trim;                           // current offsets, mismatch of the sensors
} drive_estimate_t;

typedef struct {
  current_controller_t current;
  speed_controller_t speed;
  field_weakening_t weakening;
  int32_t current_limit_q20;                   // by the background level: largest phase current now
  int32_t headroom_q20, braking_headroom_q20;  // torque current that the limits leave, and against the rotation, A
  q_inverse_t per_torque_constant;             // of N m per A, Q24, at the reference of i_d
  ramp_t ramp;
  position_hold_t position_hold;  // kept at a reference of zero
  references_t references;
  dq_t command_q16;         // voltage command
  int32_t limits;           // of current and speed, one bit each (mode/states.h)
  int32_t command_rpm_q16;  // speed command, mechanical
  int32_t target_bpp;       // the same, electrical
  bool speed_ready;         // the speed controller could be set up
} drive_control_t;

typedef struct {
  volatile uint16_t sliced;  // 1: a phase control has the legs (interfaces/phase_control.h)
  uint16_t sampled;          // place of the pattern of the period whose windows were just read
  uint16_t running;          // of that which has just begun
  uint16_t overrun;          // periods repeated because the interrupt was late
  uint16_t limits;           // of voltage and time since the millisecond began, one bit each (mode/states.h)
  modulator_t state;
  svpwm_pattern_t patterns[2];  // where one is made, nobody needs what it held any more
  ab_t command_q16;             // voltage commanded of the modulator, drops of the devices added
} drive_modulation_t;

static inline const svpwm_pattern_t* modulation_sampled(const drive_modulation_t* m) {
  return &m->patterns[m->sampled];
}

typedef struct {
  uint16_t missing, diverged_periods;
  uint16_t judged_at;         // heartbeat when the angle in use was last judged
  uint32_t judged_bam;        // and that angle
  uint32_t stopping_periods;  // in STOP with the reference at zero
  synchronism_t synchronism;
} drive_supervision_t;

#endif
