// The current deviation of one window against the machine model, in the estimated rotor frame.
//
// Residual = measured slope - model slope at the estimated angle and speed; with the true angle theta^ + e the residual
// is (to first order) h_angle e + h_speed (w - w^). Seed paper eqs (15)-(24) with every term kept; Y, K and h = K i +
// k0 as in machine_model.h, u = v - R i:
//   h_angle = (J Y - Y J) u + w (J h - K J i),  h_speed = h.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_H
#define STILLSPIN_ESTIMATORS_DEVIATION_H

#include "estimators/estimator.h"

typedef struct {
  dq_t residual_q20;  // A per period
  dq_t voltage_q16;   // V
  dq_t drive_q16;     // V, voltage less the resistance's: u
  dq_t current_q20;   // A
  dq_t turn_q20;      // h, A per period and (rad per period)
  int32_t w_q30;      // estimated speed, rad per period
} deviation_t;

/// Angle of the estimator in the middle of a window.
static inline uint32_t deviation_angle_at(uint32_t angle_bam, int32_t speed_bpp, int16_t middle_tick) {
  const int32_t before_q30 = (ESTIMATOR_PERIOD_TICKS - (int32_t)middle_tick) * 107374;
  return angle_bam - (uint32_t)q_mul_floor(speed_bpp, before_q30, 30);
}

/// A window in the frame of an angle.
static inline estimator_frame_t deviation_frame(const estimator_window_t* w, uint32_t angle_bam) {
  const rotation_t r = frame_rotation(angle_bam);
  const estimator_frame_t f = {r, frame_park(w->current_q20, r)};
  return f;
}

/// w_q30: speed of the frame, rad per period.
deviation_t deviation_in_frame(const machine_model_t* m, const estimator_window_t* w, const estimator_frame_t* f,
                               int32_t w_q30);

deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp);

/// Sensitivity of the residual to the angle, A per period and rad, Q20.
dq_t deviation_angle_sensitivity(const machine_model_t* m, const deviation_t* d);

#endif
