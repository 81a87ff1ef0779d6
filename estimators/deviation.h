// The current deviation of one window against the machine model, in the estimated rotor frame.
//
// Residual = measured slope - model slope at the estimated angle and speed; with the true angle theta^ + e the residual
// is (to first order) h_angle e + h_speed (w - w^). Seed paper eqs (15)-(24) with every term kept; Y, K and h = K i +
// k0 as in machine_model.h, u = v - R i:
//   residual = s - Y v + A i - w k0,  A = Y R - w K,
//   h_angle = (J Y - Y J) u + w (J h - K J i),  h_speed = h.
// A and w k0 are the same for all windows of a period, and of the sensitivities, which only weight the residuals, the
// part that the current makes is taken at one current of the period.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_H
#define STILLSPIN_ESTIMATORS_DEVIATION_H

#include "estimators/estimator.h"

/// The model at a speed.
typedef struct {
  int32_t less_dd_q26, less_dq_q26, less_qq_q26;   // -Y, A per V and period
  int32_t a_dd_q22, a_dq_q22, a_qd_q22, a_qq_q22;  // A, A per period and A
  struct {
    int64_t d, q;
  } less_emf_q42;  // -w k0, A per period
} deviation_model_t;

typedef struct {
  dq_t residual_q20;  // A per period, within +-512
  dq_t voltage_q16;   // V
  dq_t current_q20;   // A
} deviation_t;

/// What the residuals of a period say about angle and speed.
typedef struct {
  int32_t saliency_q30, tilt_q30, less_tilt_q30;  // J Y - Y J = [-tilt, saliency; saliency, tilt]
  dq_t rest_q17;                                  // what of h_angle does not hang on the voltage, A per period and rad
  dq_t h_speed_q20;                               // h_speed, A per period and (rad per period)
} deviation_sensitivity_t;

/// Angle of the estimator in the middle of the period in which the windows lie, from that at its end.
static inline uint32_t deviation_middle(uint32_t angle_bam, int32_t speed_bpp) {
  return angle_bam - (uint32_t)q_shr(speed_bpp, 1);
}

/// The period's windows in the frame that has an angle in the middle of that period and turns evenly; w_q30: its speed,
/// rad per period, below 1.9. An angle is right to 2e-5 rad up to 0.6 rad per period.
void deviation_frames(const estimator_window_t windows[], uint16_t count, uint32_t middle_bam, int32_t w_q30,
                      estimator_frame_t frames[]);

deviation_model_t deviation_model(const machine_model_t* m, int32_t w_q30);

/// sum + a x + b y + c u + d v, Q42: whole products.
static inline int64_t deviation_of_four(int64_t sum_q42, int32_t a, int32_t x, int32_t b, int32_t y, int32_t c,
                                        int32_t u, int32_t d, int32_t v) {
  return q_mac(q_mac(q_mac(q_mac(sum_q42, a, x), b, y), c, u), d, v);
}

/// A slope, A per period Q20, and what EMF, current and voltage leave of it, Q42. Samples that no machine makes have a
/// residual of 512 A per period.
static inline int32_t deviation_left_q20(int32_t slope_q20, int64_t rest_q42) {
  return q_sat_bits(q_mac(rest_q42, slope_q20, 4194304L), 22, 29u);
}

static inline void deviation_in_frame(const deviation_model_t* at, const estimator_window_t* w,
                                      const estimator_frame_t* f, deviation_t* out) {
  const dq_t s = frame_park(w->slope_q20, f->rotation);
  const dq_t v = frame_park(w->voltage_q16, f->rotation);
  const dq_t i = f->current_q20;
  out->residual_q20.d = deviation_left_q20(s.d, deviation_of_four(at->less_emf_q42.d, at->a_dd_q22, i.d, at->a_dq_q22,
                                                                  i.q, at->less_dd_q26, v.d, at->less_dq_q26, v.q));
  out->residual_q20.q = deviation_left_q20(s.q, deviation_of_four(at->less_emf_q42.q, at->a_qd_q22, i.d, at->a_qq_q22,
                                                                  i.q, at->less_dq_q26, v.d, at->less_qq_q26, v.q));
  out->voltage_q16 = v;
  out->current_q20 = i;
}

/// One window, at the angle of the estimator at the end of its period.
deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp);

deviation_sensitivity_t deviation_sensitivity(const machine_model_t* m, int32_t w_q30, dq_t current_q20);

/// h_angle of a window, A per period and rad, Q17: upper words. Each component of the voltage below 4096 V.
static inline dq_t deviation_by_angle_q17(const deviation_sensitivity_t* s, dq_t v_q16) {
  const dq_t v_q19 = {v_q16.d * 8, v_q16.q * 8};
  const dq_t h = {q_mul_add_floor(s->saliency_q30, v_q19.q, s->less_tilt_q30, v_q19.d, 32) + s->rest_q17.d,
                  q_mul_add_floor(s->saliency_q30, v_q19.d, s->tilt_q30, v_q19.q, 32) + s->rest_q17.q};
  return h;
}

#endif
