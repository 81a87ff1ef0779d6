#include "estimators/deviation.h"

#define PER_TICK_Q32 429496L     // 1 / ESTIMATOR_PERIOD_TICKS, rounded down: half a period of ticks stays in 31 bits
#define LOST_MAX_Q17 196608000L  // 1500 V over the resistance: more the samples alone can say
#define REST_END_Q17 536870912L  // 4096 A per period and rad

// A rotation turned on by an angle x below 1 rad, to x^3/6: 1 - cos x = x^2/2, sin x = x.
static rotation_t turned(rotation_t r, int32_t x_q30) {
  const int32_t versine_q30 = q_mul_hi(x_q30, x_q30) * 2;
  const rotation_t next = {r.sin_q30 + (q_mul_hi(r.cos_q30, x_q30) - q_mul_hi(r.sin_q30, versine_q30)) * 4,
                           r.cos_q30 - (q_mul_hi(r.sin_q30, x_q30) + q_mul_hi(r.cos_q30, versine_q30)) * 4};
  return next;
}

void deviation_frames(const estimator_window_t windows[], uint16_t count, uint32_t middle_bam, int32_t w_q30,
                      estimator_frame_t frames[]) {
  const rotation_t middle = frame_rotation(middle_bam);
  for (uint16_t k = 0; k < count; k++) {
    const int32_t after_q32 = (windows[k].middle_tick - ESTIMATOR_PERIOD_TICKS / 2) * PER_TICK_Q32;
    frames[k].rotation = turned(middle, q_mul_hi(w_q30, after_q32));
    frames[k].current_q18 = frame_park_hi(windows[k].current_q20, frames[k].rotation);
  }
}

// Element of A = Y R - w K, to 2.4e-7.
static int32_t damping_q29(const machine_model_t* m, int32_t y_q30, int32_t w_q30, int32_t k_q24) {
  return q_limit(q_mul_hi(y_q30, m->rs_q24) - q_mul_hi(w_q30, k_q24), DEVIATION_DAMPING_END_Q22) * 128;
}

deviation_model_t deviation_model(const machine_model_t* m, int32_t w_q30) {
  const deviation_model_t at = {q_shr(m->yd_q30, 1) + q_shr(m->yq_q30, 1),
                                q_shr(m->yd_q30 - m->yq_q30, 1),
                                m->ydq_q30,
                                damping_q29(m, m->yd_q30, w_q30, m->k_dd_q24),
                                damping_q29(m, m->ydq_q30, w_q30, m->k_dq_q24),
                                damping_q29(m, m->ydq_q30, w_q30, m->k_qd_q24),
                                damping_q29(m, m->yq_q30, w_q30, -m->k_dd_q24),
                                {q_shr(q_mul_hi(w_q30, m->k0_q20.d), 3), q_shr(q_mul_hi(w_q30, m->k0_q20.q), 3)}};
  return at;
}

deviation_t deviation_of(const deviation_model_t* at, const estimator_window_t* w, const estimator_frame_t* f) {
  deviation_change_t c;
  deviation_in_frame(at, w, f, &c);
  const deviation_t d = {
      {deviation_slope_q20(c.left_q17.d, 17, w->span_ticks), deviation_slope_q20(c.left_q17.q, 17, w->span_ticks)},
      {q_shr(c.voltage_q17.d, 1), q_shr(c.voltage_q17.q, 1)},
      {f->current_q18.d * 4, f->current_q18.q * 4}};
  return d;
}

deviation_t deviation_evaluate(const machine_model_t* m, const estimator_window_t* w, uint32_t angle_bam,
                               int32_t speed_bpp) {
  const int32_t w_q30 = machine_speed_rad_q30(speed_bpp);
  const deviation_model_t at = deviation_model(m, w_q30);
  estimator_frame_t f;
  deviation_frames(w, 1, deviation_middle(angle_bam, speed_bpp), w_q30, &f);
  return deviation_of(&at, w, &f);
}

deviation_sensitivity_t deviation_sensitivity(const machine_model_t* m, int32_t w_q30, dq_t i) {
  // J K - K J = [-p, q; q, p] with p = K_dq + K_qd, q = 2 K_dd; J k0 = (-k0_q, k0_d).
  const int32_t p_q24 = q_add_sat(m->k_dq_q24, m->k_qd_q24);
  const int32_t q_q24 = 2 * m->k_dd_q24;
  const dq_t turn = {machine_sensitivity_q20(q_product(q_q24, i.q) - q_product(p_q24, i.d), -(int64_t)m->k0_q20.q),
                     machine_sensitivity_q20(q_mac(q_product(q_q24, i.d), p_q24, i.q), m->k0_q20.d)};
  const dq_t lost_q17 = {q_limit(q_mul_floor(m->rs_q24, i.d, 27), LOST_MAX_Q17),
                         q_limit(q_mul_floor(m->rs_q24, i.q, 27), LOST_MAX_Q17)};
  const dq_t mirrored_q15 = deviation_mirrored_q15(q_shr(m->yd_q30 - m->yq_q30, 1), m->ydq_q30, lost_q17);
  const deviation_sensitivity_t s = {{q_limit(q_mul_floor(turn.d, w_q30, 33) + mirrored_q15.q * 8, REST_END_Q17),
                                      q_limit(q_mul_floor(turn.q, w_q30, 33) - mirrored_q15.d * 8, REST_END_Q17)},
                                     machine_speed_sensitivity_q20(m, i)};
  return s;
}
