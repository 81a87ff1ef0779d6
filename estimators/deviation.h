// The current deviation of one window against the machine model, in the estimated rotor frame.
//
// Residual = measured slope - model slope at the estimated angle and speed; with the true angle theta^ + e the residual
// is (to first order) h_angle e + h_speed (w - w^). Seed paper eqs (15)-(24) with every term kept; Y, K and h = K i +
// k0 as in machine_model.h, u = v - R i:
//   residual = s - Y v + A i - w k0,  A = Y R - w K,
//   h_angle = (J Y - Y J) u + w (J h - K J i),  h_speed = h.
// What is measured is a change of the current, so all of it is multiplied with the window's span instead of divided by
// it. With Y = mean + mirror S, J Y - Y J is 2 J S of the mirrored voltage, which Y v has made already. Products are
// upper words.
// A and w k0 are the same for all windows of a period, and of the sensitivities, which only weight the residuals, the
// part that the current makes is taken at one current of the period.
// Y is that at the window's own torque current: a ripple puts windows under opposite vectors at opposite places of it,
// and what dY/di_q makes of both is one and the same slope, as if the back-EMF had changed.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_H
#define STILLSPIN_ESTIMATORS_DEVIATION_H

#include "estimators/estimator.h"

#define DEVIATION_PERIOD_Q17 ((int32_t)1310720000L)  // ESTIMATOR_PERIOD_TICKS

#define DEVIATION_DAMPING_BITS 23u  // 2 per period, Q22
#define DEVIATION_DAMPING_END_Q22 ((int32_t)1 << DEVIATION_DAMPING_BITS)

/// The model at a speed. A beyond 2 per period is taken as 2.
typedef struct {
  int32_t mean_q30, half_q30, cross_q30;           // Y = [mean + half, cross; cross, mean - half], A per V and period
  int32_t a_dd_q29, a_dq_q29, a_qd_q29, a_qq_q29;  // A, A per period and A
  dq_t emf_q15;                                    // w k0, A per period
  machine_slope_t slope;                           // of Y, for a segment of torque current
  int32_t per_segment_q26;                         // segments per ampere
} deviation_model_t;

/// What a window shows.
typedef struct {
  dq_t left_q17;      // of the current's change, what the model does not explain, A
  dq_t mirrored_q15;  // half, cross; cross, -half times the voltage, A per period
  dq_t voltage_q17;   // V
} deviation_change_t;

/// The same of one window as a slope.
typedef struct {
  dq_t residual_q20;  // A per period, within +-512
  dq_t voltage_q16;   // V
} deviation_t;

/// What the residuals of a period say about angle and speed.
typedef struct {
  dq_t rest_q17;     // what of h_angle does not hang on the voltage, A per period and rad, within +-2048
  dq_t h_speed_q20;  // h_speed, A per period and (rad per period)
} deviation_sensitivity_t;

/// Angle of the estimator in the middle of the period in which the windows lie, from that at its end.
static inline uint32_t deviation_middle(uint32_t angle_bam, int32_t speed_bpp) {
  return angle_bam - (uint32_t)q_shr(speed_bpp, 1);
}

/// The period's windows in the frame that has an angle in the middle of that period and turns evenly; w_q30: its speed,
/// rad per period, below 1.9. An angle is right to a sixth of the cube of what the frame turns from the period's middle
/// to the window's: 4.5e-3 rad at the end of a period of 0.6 rad.
void deviation_frames(const estimator_window_t windows[], uint16_t count, uint32_t middle_bam, int32_t w_q30,
                      estimator_frame_t frames[]);

deviation_model_t deviation_model(const machine_model_t* m, int32_t w_q30);

/// What the saliency makes of a voltage.
static inline dq_t deviation_mirrored_q15(int32_t half_q30, int32_t cross_q30, dq_t v_q17) {
  const dq_t s = {q_mul_hi(half_q30, v_q17.d) + q_mul_hi(cross_q30, v_q17.q),
                  q_mul_hi(cross_q30, v_q17.d) - q_mul_hi(half_q30, v_q17.q)};
  return s;
}

/// What windows show, in their frames; iq_q18: the torque current that the model is for, A.
void deviation_changes(const deviation_model_t* at, const estimator_window_t windows[],
                       const estimator_frame_t frames[], uint16_t count, int32_t iq_q18, deviation_change_t seen[]);

/// The same of a period at an estimator's angle and speed, at least one window. Returns the current in the middle one,
/// A, Q18.
dq_t deviation_see(const estimator_input_t* in, uint32_t angle_bam, int32_t speed_bpp, deviation_change_t seen[]);

/// A change of this many fraction bits as a slope, A per period, Q20. Samples that no machine makes have 512 A per
/// period.
static inline int32_t deviation_slope_q20(int32_t change, unsigned bits, int32_t span_ticks) {
  return q_sat_bits(q_product(change, DEVIATION_PERIOD_Q17 / span_ticks), bits - 3u, 29);
}

/// What a window shows as a slope.
deviation_t deviation_slope(const deviation_change_t* c, int32_t span_ticks);

/// The slope of one window at the angle of the estimator at the end of its period, of a current that has no ripple.
deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp);

deviation_sensitivity_t deviation_sensitivity(const machine_model_t* m, int32_t w_q30, dq_t current_q20);

/// h_angle of a window, A per period and rad, Q17.
static inline dq_t deviation_by_angle_q17(const deviation_sensitivity_t* s, dq_t mirrored_q15) {
  const dq_t h = {s->rest_q17.d - mirrored_q15.q * 8, s->rest_q17.q + mirrored_q15.d * 8};
  return h;
}

#endif
