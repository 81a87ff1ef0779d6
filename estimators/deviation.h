// The current deviation of one window against the machine model, in the estimated rotor frame.
//
// Residual = measured slope - model slope at the estimated angle and speed; with the true angle theta^ + e the residual
// is (to first order) h_angle e + h_speed (w - w^). Seed paper eqs (15)-(24) with every term kept; Y, K and h = K i +
// k0 as in machine_model.h, u = v - R i:
//   residual = s - Y v + A i - w k0,  A = Y R - w K,
//   h_angle = (J Y - Y J) u + w (J h - K J i),  h_speed = h.
// What is measured is a change of the current, so all of it is multiplied with the window's span instead of divided by
// it: every window then has the same noise. With Y = mean + mirror S, J Y - Y J is 2 J S of the mirrored voltage, which
// Y v has made already. Products are upper words.
// A and w k0 are the same for all windows of a period, and of the sensitivities, which only weight the residuals, the
// part that the current makes is taken at one current of the period.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_H
#define STILLSPIN_ESTIMATORS_DEVIATION_H

#include "estimators/estimator.h"

#define DEVIATION_PERIOD_Q17 ((int32_t)1310720000L)  // ESTIMATOR_PERIOD_TICKS

#define DEVIATION_DAMPING_END_Q22 8388608L  // 2 per period

/// The model at a speed. A beyond 2 per period is taken as 2.
typedef struct {
  int32_t mean_q30, half_q30, cross_q30;           // Y = [mean + half, cross; cross, mean - half], A per V and period
  int32_t a_dd_q29, a_dq_q29, a_qd_q29, a_qq_q29;  // A, A per period and A
  dq_t emf_q15;                                    // w k0, A per period
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
  dq_t current_q20;   // A
} deviation_t;

/// What the residuals of a period say about angle and speed.
typedef struct {
  dq_t rest_q17;     // what of h_angle does not hang on the voltage, A per period and rad, within +-4096
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

/// A change of the current that the model makes of a slope, A, Q17.
static inline int32_t deviation_made_q17(int32_t slope_q15, int32_t share_q30) {
  return q_mul_floor(slope_q15, share_q30, 28);
}

static inline void deviation_in_frame(const deviation_model_t* at, const estimator_window_t* w,
                                      const estimator_frame_t* f, deviation_change_t* out) {
  const int32_t share_q30 = estimator_share_q30(w);
  const dq_t v = frame_park_hi(w->voltage_q19, f->rotation);
  const dq_t i = f->current_q18;
  const dq_t mirrored = deviation_mirrored_q15(at->half_q30, at->cross_q30, v);
  const dq_t slope_q15 = {q_mul_hi(at->mean_q30, v.d) + mirrored.d + at->emf_q15.d - q_mul_hi(at->a_dd_q29, i.d) -
                              q_mul_hi(at->a_dq_q29, i.q),
                          q_mul_hi(at->mean_q30, v.q) + mirrored.q + at->emf_q15.q - q_mul_hi(at->a_qd_q29, i.d) -
                              q_mul_hi(at->a_qq_q29, i.q)};
  const dq_t seen_q17 = frame_park_hi(w->change_q19, f->rotation);
  // Two upper words lose a unit together, and a difference of them none.
  out->left_q17.d = seen_q17.d + 1 - deviation_made_q17(slope_q15.d, share_q30);
  out->left_q17.q = seen_q17.q - deviation_made_q17(slope_q15.q, share_q30);
  out->mirrored_q15 = mirrored;
  out->voltage_q17 = v;
}

/// A change of this many fraction bits as a slope, A per period, Q20. Samples that no machine makes have 512 A per
/// period.
static inline int32_t deviation_slope_q20(int32_t change, unsigned bits, int32_t span_ticks) {
  return q_sat_bits(q_product(change, DEVIATION_PERIOD_Q17 / span_ticks), bits - 3u, 29);
}

/// One window in its frame.
deviation_t deviation_of(const deviation_model_t* at, const estimator_window_t* w, const estimator_frame_t* f);

/// The same at the angle of the estimator at the end of its period.
deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp);

deviation_sensitivity_t deviation_sensitivity(const machine_model_t* m, int32_t w_q30, dq_t current_q20);

/// h_angle of a window, A per period and rad, Q17.
static inline dq_t deviation_by_angle_q17(const deviation_sensitivity_t* s, dq_t mirrored_q15) {
  const dq_t h = {s->rest_q17.d - mirrored_q15.q * 8, s->rest_q17.q + mirrored_q15.d * 8};
  return h;
}

#endif
